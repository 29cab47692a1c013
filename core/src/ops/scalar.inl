// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The arithmetic of formulas: coordinates, constants, and operations on one or two numbers. Each has its value and
// gradient (`apply`, forward mode) and its intervals (`enclose`, rounded outward; outward.inl). `rounding` is the
// greatest error in units in the last place, 0 for what is exact; the conformance tests hold it against libm in double.
// Where the real function is not defined the value is NaN and the interval undefined. A derivative that does not exist
// or is infinite (the root at 0) counts as 0, so that finite results have finite gradients.
// Included by all.inl once per SIMD target.

struct Scalar {
  static constexpr std::array<OpParameter, 0> kParameters{};
  static constexpr bool kCallsFunction = false;
  static constexpr bool kIsBrief = false;
  static constexpr bool kTakesSquares = false;
};
struct Unary : Scalar {
  static constexpr int kOperands = 1;
};
struct Binary : Scalar {
  static constexpr int kOperands = 2;
};
/// A few machine operations, so that it matters how the operands come: they do in every way (compile/fuse.cpp).
struct BriefUnary : Unary {
  static constexpr bool kIsBrief = true;
};
struct BriefBinary : Binary {
  static constexpr bool kIsBrief = true;
};

consteval Declaration scalar(std::string_view name, std::string_view opcode, std::string_view meaning, double ulps,
                             int dimension = 0) {
  return {.name = name,
          .kind = OpKind::scalar,
          .dimension = dimension,
          .exactness = "exact but for rounding",
          .note = meaning,
          .rounding = ulps,
          .opcode = opcode};
}

/// u.gradient * s + v.gradient * t
template <class T>
HWY_INLINE Point<T, 2> blended(Point<T, 2> u, T s, Point<T, 2> v, T t) {
  return {mul_add(u.x, s, v.x * t), mul_add(u.y, s, v.y * t)};
}
template <class T>
HWY_INLINE Point<T, 3> blended(Point<T, 3> u, T s, Point<T, 3> v, T t) {
  return {mul_add(u.x, s, v.x * t), mul_add(u.y, s, v.y * t), mul_add(u.z, s, v.z * t)};
}
template <class T, int D>
HWY_INLINE Field<T, D> without_slope(T value) {
  const Point<T, 2> flat = {zero<T>(), zero<T>()};
  if constexpr (D == 2) {
    return {value, flat};
  } else {
    return {value, {flat.x, flat.y, zero<T>()}};
  }
}
/// Scales all at once. Gradients that are finite stay so.
template <class T>
HWY_INLINE T slope_or_zero(T a) {
  return select(abs(a) <= Make<T>::set(1e30), a, zero<T>());
}

/// A coordinate of the query point, as it is.
template <int kAxis>
struct Axis : Scalar {
  static constexpr int kOperands = 0;
  static constexpr int kOfAxis = kAxis;
  template <class T, int D>
  static HWY_INLINE T& component(Point<T, D>& p) {
    static_assert(kAxis < D);
    if constexpr (kAxis == 0) return p.x;
    if constexpr (kAxis == 1) return p.y;
    if constexpr (kAxis == 2) return p.z;
  }
  template <class T, int D>
  static HWY_INLINE Field<T, D> leaf(Point<T, D> p, Constants<T>) {
    Field<T, D> f = without_slope<T, D>(component(p));
    component(f.gradient) = one<T>();
    return f;
  }
  template <class T, int D>
  static HWY_INLINE Interval<T> enclose(Point<T, D> p, const Interval<T>* offset, T place, Constants<T>) {
    const T x = component(p);
    return {below(x + (offset[kAxis].lo - place), kRounded), above(x + (offset[kAxis].hi + place), kRounded)};
  }
};
THALWEG_OP : Axis<0> { static constexpr Declaration kDeclaration = scalar("x", "", "the first coordinate", 0); };
THALWEG_OP : Axis<1> { static constexpr Declaration kDeclaration = scalar("y", "", "the second coordinate", 0); };
THALWEG_OP : Axis<2> { static constexpr Declaration kDeclaration = scalar("z", "", "the third coordinate", 0, 3); };

/// A row of the affine map from the position to the coordinate: weights, offset, and what its enclosure owes for the
/// rounding of the row: `units` of the unit roundoff times the products, `owed` of it, and `places` of the place's own.
THALWEG_OP : Scalar {
  static constexpr Declaration kDeclaration = scalar("coordinate", "", "x, y or z of a frame", 1);
  static constexpr int kOperands = 0;
  template <class T>
  static HWY_INLINE Field<T, 2> leaf(Point<T, 2> p, Constants<T> c) {
    return {mul_add(c[0], p.x, mul_add(c[1], p.y, c[2])), {c[0], c[1]}};
  }
  template <class T>
  static HWY_INLINE Field<T, 3> leaf(Point<T, 3> p, Constants<T> c) {
    return {mul_add(c[0], p.x, mul_add(c[1], p.y, mul_add(c[2], p.z, c[3]))), {c[0], c[1], c[2]}};
  }
  /// Over the points p + offset, and `place` more around each for the rounding of places.
  template <class T, int D>
  static HWY_INLINE Interval<T> enclose(Point<T, D> p, const Interval<T>* offset, T place, Constants<T> c) {
    const T around = place * c[D + 3];
    Interval<T> sum = {c[D], c[D]};
    T size = zero<T>();
    const auto add = [&](T x, const Interval<T>& by, T weight) HWY_ATTR {
      const T lo = below(x + (by.lo - around), kRounded);
      const T hi = above(x + (by.hi + around), kRounded);
      sum = {sum.lo + min(weight * lo, weight * hi), sum.hi + max(weight * lo, weight * hi)};
      size = mul_add(abs(weight), max(abs(lo), abs(hi)), size);
    };
    add(p.x, offset[0], c[0]);
    add(p.y, offset[1], c[1]);
    if constexpr (D == 3) add(p.z, offset[2], c[2]);
    const T owes = mul_add(c[D + 1], size, c[D + 2]) * Make<T>::set(Precision<T>::kUnit);
    return {sum.lo - owes, sum.hi + owes};
  }
};

THALWEG_OP : Scalar {
  static constexpr Declaration kDeclaration = scalar("constant", "const", "a number", 0.5);
  static constexpr int kOperands = 0;
  template <class T, int D>
  static HWY_INLINE Field<T, D> leaf(Point<T, D>, Constants<T> c) {
    return without_slope<T, D>(c[0]);
  }
  template <class T, int D>
  static HWY_INLINE Interval<T> enclose(Point<T, D>, const Interval<T>*, T, Constants<T> c) {
    return {c[1], c[2]};
  }
};

THALWEG_OP : Unary {
  static constexpr Declaration kDeclaration = scalar("neg", "neg", "-a", 0);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return negated(a);
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    return {-a.hi, -a.lo};
  }
};

THALWEG_OP : BriefUnary {
  static constexpr Declaration kDeclaration = scalar("abs", "abs", "magnitude", 0);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return {abs(a.value), scaled(a.gradient, sign_of(a.value))};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    return {least_size(a), most_size(a)};
  }
};

THALWEG_OP : BriefUnary {
  static constexpr Declaration kDeclaration = scalar("sqrt", "sqrt", "square root; not defined below 0", 0.5);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    const T root = sqrt(a.value);
    return {root, scaled(a.gradient, Make<T>::set(0.5) * reciprocal_or_zero(root))};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    const Interval<T> roots = {max(zero<T>(), below(sqrt(a.lo), kRounded)), above(sqrt(a.hi), kRounded)};
    return undefined_where(a.lo < zero<T>(), roots);
  }
};

THALWEG_OP : BriefUnary {
  static constexpr Declaration kDeclaration = scalar("square", "square", "a a", 0.5);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return {a.value * a.value, scaled(a.gradient, a.value + a.value)};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    const T lo = least_size(a);
    const T hi = most_size(a);
    return {max(zero<T>(), far_below(lo * lo, kRounded)), far_above(hi * hi, kRounded)};
  }
};

#define THALWEG_STEP_OP(NAME, FUNCTION, MEANING)                                \
  THALWEG_OP:                                                                   \
  Unary {                                                                       \
    static constexpr Declaration kDeclaration = scalar(NAME, NAME, MEANING, 0); \
    template <class T, int D>                                                   \
    static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {                 \
      return without_slope<T, D>(FUNCTION(a.value));                            \
    }                                                                           \
    template <class T>                                                          \
    static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {               \
      return {FUNCTION(a.lo), FUNCTION(a.hi)};                                  \
    }                                                                           \
  };
THALWEG_STEP_OP("floor", floor, "the whole number at or below a")
THALWEG_STEP_OP("ceil", ceil, "the whole number at or above a")
THALWEG_STEP_OP("round", round, "the nearest whole number, halves away from 0")
#undef THALWEG_STEP_OP

THALWEG_OP : Unary {
  static constexpr Declaration kDeclaration = scalar("not", "not", "1 where a is 0, else 0", 0);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return without_slope<T, D>(select(is_number(a.value), select(a.value == zero<T>(), one<T>(), zero<T>()), a.value));
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    const auto is_zero = both(a.lo == zero<T>(), a.hi == zero<T>());
    return defined_like(a, {select(is_zero, one<T>(), zero<T>()), select(holds_zero(a), one<T>(), zero<T>())});
  }
};

THALWEG_OP : BriefBinary {
  static constexpr Declaration kDeclaration = scalar("add", "add", "a + b", 0.5);
  static constexpr bool kTakesSquares = true;  // of lengths
  static constexpr bool kCommutes = true;
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    return {a.value + b.value, a.gradient + b.gradient};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return sum(a, b);
  }
};

THALWEG_OP : BriefBinary {
  static constexpr Declaration kDeclaration = scalar("sub", "sub", "a - b", 0.5);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    return {a.value - b.value, a.gradient - b.gradient};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return difference(a, b);
  }
};

THALWEG_OP : BriefBinary {
  static constexpr Declaration kDeclaration = scalar("mul", "mul", "a b", 0.5);
  static constexpr bool kCommutes = true;
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    return {a.value * b.value, blended(a.gradient, b.value, b.gradient, a.value)};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return product(a, b);
  }
};

THALWEG_OP : Binary {
  static constexpr Declaration kDeclaration = scalar("div", "div", "a / b; not defined for b = 0", 0.5);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    const T q = select(b.value == zero<T>(), not_a_number<T>(), a.value / b.value);
    const T inverse = slope_or_zero(one<T>() / b.value);
    return {q, blended(a.gradient, inverse, b.gradient, slope_or_zero(-(q * inverse)))};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return quotient(a, b);
  }
};

/// At a tie the first operand gives the gradient.
THALWEG_OP : BriefBinary {
  static constexpr Declaration kDeclaration = scalar("min", "min", "the lesser", 0);
  static constexpr Selection kSelection = Selection::least;
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    return {least(a.value, b.value), select(b.value < a.value, b.gradient, a.gradient)};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return {least(a.lo, b.lo), least(a.hi, b.hi)};
  }
};

THALWEG_OP : BriefBinary {
  static constexpr Declaration kDeclaration = scalar("max", "max", "the greater", 0);
  static constexpr Selection kSelection = Selection::greatest;
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    return {greatest(a.value, b.value), select(a.value < b.value, b.gradient, a.gradient)};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return {greatest(a.lo, b.lo), greatest(a.hi, b.hi)};
  }
};

/// min and max of operands that are numbers wherever a query may be: nothing need be asked of them. Written by the
/// compiler alone.
THALWEG_OP : BriefBinary {
  static constexpr Declaration kDeclaration = scalar("least", "", "the lesser of two numbers", 0);
  static constexpr Selection kSelection = Selection::least;
  static constexpr bool kInternal = true;
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    return {min(a.value, b.value), select(b.value < a.value, b.gradient, a.gradient)};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return {least(a.lo, b.lo), least(a.hi, b.hi)};
  }
};

THALWEG_OP : BriefBinary {
  static constexpr Declaration kDeclaration = scalar("greatest", "", "the greater of two numbers", 0);
  static constexpr Selection kSelection = Selection::greatest;
  static constexpr bool kInternal = true;
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    return {max(a.value, b.value), select(a.value < b.value, b.gradient, a.gradient)};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return {greatest(a.lo, b.lo), greatest(a.hi, b.hi)};
  }
};

THALWEG_OP : Binary {
  static constexpr Declaration kDeclaration =
      scalar("compare", "compare", "-1, 0 or 1: a less than, equal to, above b", 0);
  template <class T>
  static HWY_INLINE T order(T a, T b) {
    return select(a < b, -one<T>(), select(b < a, one<T>(), zero<T>()));
  }
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    const T apart = a.value + b.value;  // NaN if one is
    return without_slope<T, D>(
        select(is_number(a.value), select(is_number(b.value), order(a.value, b.value), apart), apart));
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return defined_like(a, b, {order(a.lo, b.hi), order(a.hi, b.lo)});
  }
};

/// a where it is 0, else b: the programs' way to say "b if a".
THALWEG_OP : Binary {
  static constexpr Declaration kDeclaration = scalar("and", "and", "a where a is 0, else b", 0);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    const auto takes_a = a.value == zero<T>();
    return {select(is_number(a.value), select(takes_a, a.value, b.value), a.value),
            select(takes_a, a.gradient, b.gradient)};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    const Interval<T> with_zero = {min(zero<T>(), b.lo), max(zero<T>(), b.hi)};
    const auto may = holds_zero(a);
    return defined_like(a, b, {select(may, with_zero.lo, b.lo), select(may, with_zero.hi, b.hi)});
  }
};

THALWEG_OP : Binary {
  static constexpr Declaration kDeclaration = scalar("or", "or", "b where a is 0, else a", 0);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    const auto takes_b = a.value == zero<T>();
    return {select(takes_b, b.value, a.value), select(takes_b, b.gradient, a.gradient)};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    const Interval<T> hull = {min(a.lo, b.lo), max(a.hi, b.hi)};
    const auto may = holds_zero(a);
    return defined_like(a, b, {select(may, hull.lo, a.lo), select(may, hull.hi, a.hi)});
  }
};

/// b where a is a number: what an operator on fields makes of an undefined operand is undefined too, although its
/// comparisons would pass over it. Written by the compiler alone.
THALWEG_OP : Binary {
  static constexpr Declaration kDeclaration = scalar("given", "", "b where a is defined", 0);
  static constexpr bool kInternal = true;
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    return {select(is_number(a.value), b.value, a.value), b.gradient};
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    return defined_like(a, b);
  }
};
