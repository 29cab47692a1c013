// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The elementary functions of formulas (kernels/functions.inl has their values). Where one is monotone its enclosure
// comes from the interval's ends; waves ask for crests and troughs, powers and angles for corners.
// Included by all.inl once per SIMD target.

/// The chain rule for a function with this slope.
template <class T, int D>
HWY_INLINE Field<T, D> chained(const Field<T, D>& a, T value, T slope) {
  return {value, scaled(a.gradient, slope_or_zero(slope))};
}
/// Between the values at the ends of the interval of a rising function.
template <class T>
HWY_INLINE Interval<T> rising(T at_lo, T at_hi, double ulps) {
  return {far_below(at_lo, owed(ulps)), far_above(at_hi, owed(ulps))};
}
/// Within what the function can be at all.
template <class T>
HWY_INLINE Interval<T> within(const Interval<T>& a, double least, double most) {
  return {max(Make<T>::set(least), a.lo), min(Make<T>::set(most), a.hi)};
}
/// Bounds of angles, rounded outward.
inline constexpr double kPiAbove = 3.1415929;
inline constexpr double kHalfPiAbove = 1.5707965;

/// Their values are calls (kernels/functions.inl).
struct UnaryFunction : Unary {
  static constexpr bool kCallsFunction = true;
};
struct BinaryFunction : Binary {
  static constexpr bool kCallsFunction = true;
};

THALWEG_OP : UnaryFunction {
  static constexpr Declaration kDeclaration = scalar("sin", "sin", "sine, in radians", 3);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return chained(a, sin(a.value), cos(a.value));
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    return wave_range(a, 0.25, Interval<T>{sin(a.lo), sin(a.hi)}, kDeclaration.rounding);
  }
};

THALWEG_OP : UnaryFunction {
  static constexpr Declaration kDeclaration = scalar("cos", "cos", "cosine, in radians", 3);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return chained(a, cos(a.value), -sin(a.value));
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    return wave_range(a, 0, Interval<T>{cos(a.lo), cos(a.hi)}, kDeclaration.rounding);
  }
};

THALWEG_OP : UnaryFunction {
  static constexpr Declaration kDeclaration = scalar("tan", "tan", "tangent, in radians", 6);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    const T value = tan(a.value);
    return chained(a, value, mul_add(value, value, one<T>()));
  }
  /// Not defined where a pole, half a turn after the last, may lie in the interval.
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    const T turn = Make<T>::set(std::numbers::inv_pi);
    const T half = Make<T>::set(0.5);
    const Interval<T> turns = {a.lo * turn - half, a.hi * turn - half};
    const T margin = (most_size(turns) + one<T>()) * Make<T>::set(8 * Precision<T>::kUnit);
    const auto poles = either(holds_whole(turns, margin), Make<T>::set(Precision<T>::kLargest) < most_size(a));
    return undefined_where(poles, rising(tan(a.lo), tan(a.hi), kDeclaration.rounding));
  }
};

THALWEG_OP : UnaryFunction {
  static constexpr Declaration kDeclaration = scalar("asin", "asin", "arc sine; not defined beyond 1", 3);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return chained(a, asin(a.value), reciprocal_or_zero(sqrt(neg_mul_add(a.value, a.value, one<T>()))));
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    const Interval<T> angles = rising(asin(a.lo), asin(a.hi), kDeclaration.rounding);
    return undefined_where(one<T>() < most_size(a), within(angles, -kHalfPiAbove, kHalfPiAbove));
  }
};

THALWEG_OP : UnaryFunction {
  static constexpr Declaration kDeclaration = scalar("acos", "acos", "arc cosine; not defined beyond 1", 3);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return chained(a, acos(a.value), -reciprocal_or_zero(sqrt(neg_mul_add(a.value, a.value, one<T>()))));
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    const Interval<T> angles = rising(acos(a.hi), acos(a.lo), kDeclaration.rounding);
    return undefined_where(one<T>() < most_size(a), within(angles, 0, kPiAbove));
  }
};

THALWEG_OP : UnaryFunction {
  static constexpr Declaration kDeclaration = scalar("atan", "atan", "arc tangent", 3);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return chained(a, atan(a.value), one<T>() / mul_add(a.value, a.value, one<T>()));
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    return within(rising(atan(a.lo), atan(a.hi), kDeclaration.rounding), -kHalfPiAbove, kHalfPiAbove);
  }
};

THALWEG_OP : UnaryFunction {
  static constexpr Declaration kDeclaration = scalar("exp", "exp", "e to the power of a", 2);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    const T value = exp(a.value);
    return chained(a, value, value);
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    const Interval<T> ends = rising(exp(a.lo), exp(a.hi), kDeclaration.rounding);
    return {max(zero<T>(), ends.lo), ends.hi};
  }
};

THALWEG_OP : UnaryFunction {
  static constexpr Declaration kDeclaration = scalar("log", "ln", "natural logarithm; not defined at 0 and below", 4);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a) {
    return chained(a, log(a.value), one<T>() / a.value);
  }
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a) {
    return undefined_where(a.lo <= zero<T>(), rising(log(a.lo), log(a.hi), kDeclaration.rounding));
  }
};

/// The angle of the point (b, a), in (-pi, pi], and 0 at the origin.
THALWEG_OP : BinaryFunction {
  static constexpr Declaration kDeclaration = scalar("atan2", "atan2", "the angle of the point (b, a)", 5);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    const T inverse = slope_or_zero(one<T>() / mul_add(a.value, a.value, b.value * b.value));
    return {atan2(a.value, b.value), blended(a.gradient, b.value * inverse, b.gradient, -(a.value * inverse))};
  }
  /// The corners have the extreme angles of a box that does not cross the cut along the negative axis.
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    const T p = atan2(a.lo, b.lo), q = atan2(a.lo, b.hi), r = atan2(a.hi, b.lo), s = atan2(a.hi, b.hi);
    const Interval<T> angles = rising(min(min(p, q), min(r, s)), max(max(p, q), max(r, s)), kDeclaration.rounding);
    const auto above_cut = both(a.lo < zero<T>(), zero<T>() <= a.hi);
    const auto crosses = both(above_cut, b.lo <= zero<T>());
    const T half_turn = Make<T>::set(kPiAbove);
    return defined_like(
        a, b,
        within(Interval<T>{select(crosses, -half_turn, angles.lo), select(crosses, half_turn, angles.hi)}, -kPiAbove,
               kPiAbove));
  }
};

THALWEG_OP : BinaryFunction {
  static constexpr Declaration kDeclaration =
      scalar("mod", "mod", "what a leaves over by |b|, in [0, |b|); not defined for b = 0", 0.5);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    const T rest = modulo(a.value, b.value);
    const T turns = slope_or_zero((a.value - rest) / b.value);
    return {rest, a.gradient - scaled(b.gradient, turns)};
  }
  /// Where all quotients have one floor the rest is affine; else it can be anything.
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    const Interval<T> size = {least_size(b), most_size(b)};
    const Interval<T> turns = quotient(a, size);
    const T floor_lo = floor(turns.lo);
    const Interval<T> whole = {floor_lo, floor_lo};
    const Interval<T> rest = difference(a, product(size, whole));
    const auto is_one = both(floor_lo == floor(turns.hi), abs(floor_lo) <= Make<T>::set(1e6));
    return undefined_where(holds_zero(b), defined_like(a, b,
                                                       {select(is_one, max(zero<T>(), rest.lo), zero<T>()),
                                                        select(is_one, min(size.hi, rest.hi), size.hi)}));
  }
};

/// Whole numbers of either parity.
template <class T>
HWY_INLINE auto is_whole(T a) {
  return a == floor(a);
}
template <class T>
HWY_INLINE auto is_even(T a) {
  return is_whole(a * Make<T>::set(0.5));
}

THALWEG_OP : BinaryFunction {
  static constexpr Declaration kDeclaration =
      scalar("pow", "", "a to the power of b; not defined for 0 to a negative one, nor a < 0 to a fraction", 1);
  template <class T, int D>
  static HWY_INLINE Field<T, D> apply(const Field<T, D>& a, const Field<T, D>& b) {
    const T value = pow(a.value, b.value);
    const T by_base = slope_or_zero(b.value * pow(a.value, b.value - one<T>()));
    const T by_power = slope_or_zero(value * log(abs(a.value)));
    return {value, blended(a.gradient, by_base, b.gradient, by_power)};
  }
  /// For positive bases monotone in each operand, so the corners tell; a whole power keeps or drops the sign.
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, const Interval<T>& b) {
    const auto whole = both(b.lo == b.hi, is_whole(b.lo));
    const auto even = both(whole, is_even(b.lo));
    const Interval<T> base = {select(even, least_size(a), a.lo), select(even, most_size(a), a.hi)};
    const T p = pow(base.lo, b.lo), q = pow(base.lo, b.hi), r = pow(base.hi, b.lo), s = pow(base.hi, b.hi);
    const Interval<T> ends = rising(min(min(p, q), min(r, s)), max(max(p, q), max(r, s)), kDeclaration.rounding);
    const Interval<T> powers = {select(zero<T>() <= base.lo, max(zero<T>(), ends.lo), ends.lo), ends.hi};
    const auto needs_positive = both(base.lo < zero<T>(), differ(whole, is_number(b.lo)));
    const auto needs_other = both(holds_zero(a), b.lo <= zero<T>());
    return defined_like(a, b, undefined_where(either(needs_positive, needs_other), powers));
  }
};
