// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Operators on fields. Every combining op is monotone in each operand (kTrend), so an enclosure of the operands gives
// an enclosure of the result from its end points. At a tie of min or max the first operand gives the gradient.
// Smooth minima follow Inigo Quilez, "smooth minimum" (quadratic polynomial, normalised k).
// Included by all.inl once per SIMD target.

// What operators do to the slope of a field, whichever way it is kept.

template <class T, int D>
HWY_INLINE Field<T, D> with_value(const Field<T, D>& f, T value) {
  return {value, f.gradient};
}
template <class T, int D>
HWY_INLINE Ray<T, D> with_value(const Ray<T, D>& f, T value) {
  return {value, f.toward, f.length};
}
template <class T, int D, class M>
HWY_INLINE Field<T, D> select(M m, const Field<T, D>& yes, const Field<T, D>& no) {
  return {select(m, yes.value, no.value), select(m, yes.gradient, no.gradient)};
}
template <class T, int D, class M>
HWY_INLINE Ray<T, D> select(M m, const Ray<T, D>& yes, const Ray<T, D>& no) {
  return {select(m, yes.value, no.value), select(m, yes.toward, no.toward), select(m, yes.length, no.length)};
}
/// f where `sign` is not negative, -f where it is.
template <class T, int D>
HWY_INLINE Field<T, D> times_sign(const Field<T, D>& f, T sign) {
  return {times_sign(f.value, sign), times_sign(f.gradient, sign)};
}
template <class T, int D>
HWY_INLINE Ray<T, D> times_sign(const Ray<T, D>& f, T sign) {
  return {times_sign(f.value, sign), times_sign(f.toward, sign), f.length};
}
template <class F>
HWY_INLINE F negated(const F& f) {
  return times_sign(f, -one<decltype(f.value)>());
}

template <class F>
HWY_INLINE F lesser(const F& a, const F& b) {
  return with_value(select(b.value < a.value, b, a), min(a.value, b.value));
}

/// The slope of (1 - weight) a + weight b where `within`; elsewhere weight is 0 or 1 and the slope a's or b's own.
template <class T, int D, class M>
HWY_INLINE Field<T, D> blended(const Field<T, D>& a, const Field<T, D>& b, T weight, M within) {
  const auto takes_b = zero<T>() < weight;
  const Point<T, D> own = select(takes_b, b.gradient, a.gradient);
  return {a.value, select(within, a.gradient + scaled(b.gradient - a.gradient, weight), own)};
}
/// Divides once for both. Lengths of at least 2^-62 keep the product a normal number, and no way is much longer than
/// its length, so the shares are not either.
template <class T, int D, class M>
HWY_INLINE Ray<T, D> blended(const Ray<T, D>& a, const Ray<T, D>& b, T weight, M within) {
  const T least = Make<T>::set(0x1p-62);
  const T a_length = max(a.length, least);
  const T b_length = max(b.length, least);
  const T inverse = one<T>() / (a_length * b_length);
  const T rest = one<T>() - weight;
  const T a_share = select(within, rest * (b_length * inverse), rest);
  const T b_share = select(within, weight * (a_length * inverse), weight);
  return {a.value, sum_of(a.toward, a_share, b.toward, b_share),
          select(within, one<T>(), select(zero<T>() < weight, b.length, a.length))};
}

/// Constants: 4k and 1 / 4k, or 0 and 0 for the hard minimum.
inline void derive_smoothness(Numbers p, Constants64& c) {
  const double width = 4 * p[0];
  c = {width, width < kSmallest ? 0.0 : 1.0 / width};
}

/// min(a, b) - h^2 width / 4 with h = max(width - |a - b|, 0) / width. The blend's weight of the greater operand is
/// h / 2, so the gradient is a convex combination: no Lipschitz constant grows, and neither does an operand's error.
/// h <= 1 carries at most 4 eps (the constants, the difference, the product), its square 9, and the blend, for which
/// the width is rounded again, 10 eps width / 4 = 10 eps k; 12 with the products' own roundings where nothing is fused.
template <class F, class T>
HWY_INLINE F smooth_lesser(const F& a, const F& b, Constants<T> c) {
  const T h = max(c[0] - abs(a.value - b.value), zero<T>()) * c[1];
  const T value = neg_mul_add(h * h, c[0] * Make<T>::set(0.25), min(a.value, b.value));
  const T far = h * Make<T>::set(0.5);
  const T weight = select(b.value < a.value, one<T>() - far, far);
  return with_value(blended(a, b, weight, zero<T>() < h), value);
}

inline constexpr std::string_view kSmoothKinds = "quadratic";

#define THALWEG_SMOOTH_PARAMETERS                                                     \
  static constexpr OpParameter kParameters[] = {                                      \
      size_or_zero("k", "how far the blend departs from the hard operator, at most"), \
      OpParameter{.name = "kind",                                                     \
                  .quantity = Quantity::choice,                                       \
                  .meaning = "the polynomial of the blend",                           \
                  .choices = kSmoothKinds,                                            \
                  .optional = true}}

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "union", .kind = OpKind::combine, .exactness = "exact outside; a bound inside", .rounding = 0};
  static constexpr std::array<OpParameter, 0> kParameters{};
  static constexpr int kTrend[2] = {1, 1};
  static constexpr bool kIdempotent = true;
  static constexpr Selection kSelection = Selection::least;
  static constexpr bool kBlends = false;
  static constexpr BoundsRule kBounds = BoundsRule::hull;
  static double widening(Numbers) { return 0; }
  static JoinedFacts join(const Facts& a, const Facts& b, Numbers) {
    return {.outside = weaker(a.outside, b.outside),
            .inside = weaker(Exactness::lower_bound, weaker(a.inside, b.inside)),
            .is_unsigned = a.is_unsigned && b.is_unsigned};
  }
  static void derive(Numbers, Constants64 & c) { c.clear(); }
  template <class F, class T>
  static HWY_INLINE F combine(const F& a, const F& b, Constants<T>) {
    return lesser(a, b);
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "intersection", .kind = OpKind::combine, .exactness = "exact inside; a bound outside", .rounding = 0};
  static constexpr std::array<OpParameter, 0> kParameters{};
  static constexpr int kTrend[2] = {1, 1};
  static constexpr bool kIdempotent = true;
  static constexpr Selection kSelection = Selection::greatest;
  static constexpr bool kBlends = false;
  static constexpr BoundsRule kBounds = BoundsRule::meet;
  static double widening(Numbers) { return 0; }
  static JoinedFacts join(const Facts& a, const Facts& b, Numbers) {
    return {.outside = weaker(Exactness::lower_bound, weaker(a.outside, b.outside)),
            .inside = weaker(a.inside, b.inside),
            .convex = a.convex && b.convex,
            .is_unsigned = a.is_unsigned || b.is_unsigned};
  }
  static void derive(Numbers, Constants64 & c) { c.clear(); }
  template <class F, class T>
  static HWY_INLINE F combine(const F& a, const F& b, Constants<T>) {
    return with_value(select(a.value < b.value, b, a), max(a.value, b.value));
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "subtraction",
                                            .kind = OpKind::combine,
                                            .exactness = "exact inside; a bound outside",
                                            .note = "the first minus the rest",
                                            .rounding = 0};
  static constexpr std::array<OpParameter, 0> kParameters{};
  static constexpr int kTrend[2] = {1, -1};
  static constexpr bool kIdempotent = false;
  static constexpr Selection kSelection = Selection::greatest;
  static constexpr bool kBlends = false;
  static constexpr BoundsRule kBounds = BoundsRule::first;
  static double widening(Numbers) { return 0; }
  static JoinedFacts join(const Facts& a, const Facts& b, Numbers) {
    return {.outside = weaker(Exactness::lower_bound, weaker(a.outside, b.inside)),
            .inside = weaker(a.inside, b.outside),
            .is_unsigned = a.is_unsigned};
  }
  static void derive(Numbers, Constants64 & c) { c.clear(); }
  template <class F, class T>
  static HWY_INLINE F combine(const F& a, const F& b, Constants<T>) {
    return with_value(select(a.value < -b.value, negated(b), a), max(a.value, -b.value));
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "smooth_union", .kind = OpKind::combine, .exactness = "a bound", .note = "k = 0: union", .rounding = 12};
  THALWEG_SMOOTH_PARAMETERS;
  static constexpr int kTrend[2] = {1, 1};
  static constexpr bool kIdempotent = false;
  static constexpr Selection kSelection = Selection::least;
  static constexpr bool kBlends = true;
  static constexpr BoundsRule kBounds = BoundsRule::hull;
  static double widening(Numbers p) { return p[0]; }
  static JoinedFacts join(const Facts& a, const Facts& b, Numbers) {
    return {.outside = weaker(Exactness::lower_bound, weaker(a.outside, b.outside)),
            .inside = weaker(Exactness::lower_bound, weaker(a.inside, b.inside))};
  }
  static void derive(Numbers p, Constants64 & c) { derive_smoothness(p, c); }
  template <class F, class T>
  static HWY_INLINE F combine(const F& a, const F& b, Constants<T> c) {
    return smooth_lesser(a, b, c);
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "smooth_intersection",
                                            .kind = OpKind::combine,
                                            .exactness = "a bound",
                                            .note = "k = 0: intersection",
                                            .rounding = 12};
  THALWEG_SMOOTH_PARAMETERS;
  static constexpr int kTrend[2] = {1, 1};
  static constexpr bool kIdempotent = false;
  static constexpr Selection kSelection = Selection::greatest;
  static constexpr bool kBlends = true;
  static constexpr BoundsRule kBounds = BoundsRule::meet;
  static double widening(Numbers) { return 0; }
  static JoinedFacts join(const Facts& a, const Facts& b, Numbers) {
    return {.outside = weaker(Exactness::lower_bound, weaker(a.outside, b.outside)),
            .inside = weaker(Exactness::lower_bound, weaker(a.inside, b.inside)),
            .convex = a.convex && b.convex,
            .is_unsigned = a.is_unsigned || b.is_unsigned};
  }
  static void derive(Numbers p, Constants64 & c) { derive_smoothness(p, c); }
  template <class F, class T>
  static HWY_INLINE F combine(const F& a, const F& b, Constants<T> c) {
    return negated(smooth_lesser(negated(a), negated(b), c));
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "smooth_subtraction",
                                            .kind = OpKind::combine,
                                            .exactness = "a bound",
                                            .note = "the first minus the rest; k = 0: subtraction",
                                            .rounding = 12};
  THALWEG_SMOOTH_PARAMETERS;
  static constexpr int kTrend[2] = {1, -1};
  static constexpr bool kIdempotent = false;
  static constexpr Selection kSelection = Selection::greatest;
  static constexpr bool kBlends = true;
  static constexpr BoundsRule kBounds = BoundsRule::first;
  static double widening(Numbers) { return 0; }
  static JoinedFacts join(const Facts& a, const Facts& b, Numbers) {
    return {.outside = weaker(Exactness::lower_bound, weaker(a.outside, b.inside)),
            .inside = weaker(Exactness::lower_bound, weaker(a.inside, b.outside)),
            .is_unsigned = a.is_unsigned};
  }
  static void derive(Numbers p, Constants64 & c) { derive_smoothness(p, c); }
  template <class F, class T>
  static HWY_INLINE F combine(const F& a, const F& b, Constants<T> c) {
    return negated(smooth_lesser(negated(a), b, c));
  }
};
#undef THALWEG_SMOOTH_PARAMETERS

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "round",
                                            .kind = OpKind::map,
                                            .exactness = "exact outside of an exact field; inside too if convex",
                                            .note = "f - radius",
                                            .rounding = 2};
  static constexpr OpParameter kParameters[] = {size_or_zero("radius", "how far the surface is moved out")};
  static constexpr int kTrend = 1;
  static double operand_level(double level, Numbers p) { return level + p[0]; }
  static JoinedFacts facts(const Facts& a, Numbers p) {
    return {.outside = a.outside,
            .inside = a.convex || p[0] == 0 ? a.inside : weaker(Exactness::lower_bound, a.inside),
            .convex = a.convex,
            .is_unsigned = a.is_unsigned && p[0] == 0};
  }
  static void derive(Numbers p, Constants64 & c) { c = {p[0]}; }
  template <class F, class T>
  static HWY_INLINE F map(const F& a, Constants<T> c) {
    return with_value(a, a.value - c[0]);
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "onion",
                                            .kind = OpKind::map,
                                            .exactness = "exact outside of an exact field; a bound inside",
                                            .note = "abs(f) - thickness",
                                            .rounding = 2};
  static constexpr OpParameter kParameters[] = {size("thickness", "half of the wall's width")};
  static constexpr int kTrend = 0;
  static double operand_level(double level, Numbers p) { return level + p[0]; }
  static JoinedFacts facts(const Facts& a, Numbers) {
    const auto worst = weaker(a.outside, a.inside);
    return {.outside = worst,
            .inside = a.is_unsigned && a.convex ? worst : weaker(Exactness::lower_bound, worst),
            .convex = a.is_unsigned && a.convex};
  }
  static void derive(Numbers p, Constants64 & c) { c = {p[0]}; }
  template <class F, class T>
  static HWY_INLINE F map(const F& a, Constants<T> c) {
    return with_value(times_sign(a, a.value), abs(a.value) - c[0]);
  }
  /// abs over an interval: its least value is 0 when the interval holds 0.
  template <class T>
  static HWY_INLINE Interval<T> enclose(const Interval<T>& a, Constants<T> c) {
    return {max(max(a.lo, -a.hi), zero<T>()) - c[0], max(-a.lo, a.hi) - c[0]};
  }
};
