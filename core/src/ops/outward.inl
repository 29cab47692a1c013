// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Interval arithmetic with outward rounding, over lanes. An interval [lo, hi] of an operation holds
//   the real result for every choice of real operands in their intervals, and
//   what the lane type computes for every choice of operands of that type in them,
// so it bounds both the real function and the values that the kernels compute. lo = hi = NaN says that the result may
// be undefined for some operand (a root of a negative number): nothing is known then, and every operation passes it on.
// lo is never +infinity and hi never -infinity: beyond the largest finite number an end point stays at it.
//
// Why `below(x, units)` is outward. u is the unit roundoff. A result rounded to nearest is within u |true| of the true
// one, and being monotone the rounded results of other operands lie on the right side by themselves; x less 2.5 u |x|,
// rounded, is at least 1.5 u |x| lower (kRounded). A function within k units in the last place is within 2k u |true|,
// which is owed twice, by x and by other computed results: 4k + 2 units of u.
// Included by all.inl once per SIMD target.

inline constexpr double kRounded = 2.5;
constexpr double owed(double ulps) { return 4 * ulps + 2; }

template <class T>
HWY_INLINE T below(T x, double units) {
  const T most = min(Make<T>::set(Precision<T>::kLargest), x);  // the second operand is the one that passes NaN on
  return neg_mul_add(abs(most), Make<T>::set(units * Precision<T>::kUnit), most);
}
template <class T>
HWY_INLINE T above(T x, double units) {
  const T least = max(Make<T>::set(-Precision<T>::kLargest), x);
  return mul_add(abs(least), Make<T>::set(units * Precision<T>::kUnit), least);
}
/// The same for operations that may underflow.
template <class T>
HWY_INLINE T far_below(T x, double units) {
  return below(x, units) - Make<T>::set(Precision<T>::kSmallest);
}
template <class T>
HWY_INLINE T far_above(T x, double units) {
  return above(x, units) + Make<T>::set(Precision<T>::kSmallest);
}

template <class T, class M>
HWY_INLINE Interval<T> undefined_where(M m, const Interval<T>& a) {
  return {select(m, not_a_number<T>(), a.lo), select(m, not_a_number<T>(), a.hi)};
}
/// For results of comparisons, which NaN does not pass through.
template <class T>
HWY_INLINE Interval<T> defined_like(const Interval<T>& a, const Interval<T>& result) {
  const auto good = is_number(a.lo);
  return {select(good, result.lo, a.lo), select(good, result.hi, a.lo)};
}
template <class T>
HWY_INLINE Interval<T> defined_like(const Interval<T>& a, const Interval<T>& b, const Interval<T>& result) {
  return defined_like(a, defined_like(b, result));
}

template <class T>
HWY_INLINE auto holds_zero(const Interval<T>& a) {
  return both(a.lo <= zero<T>(), zero<T>() <= a.hi);
}
/// The greatest and the least magnitude, NaN of NaN.
template <class T>
HWY_INLINE T most_size(const Interval<T>& a) {
  return max(abs(a.lo), abs(a.hi));
}
template <class T>
HWY_INLINE T least_size(const Interval<T>& a) {
  return max(zero<T>(), max(a.lo, -a.hi));
}

template <class T>
HWY_INLINE Interval<T> sum(const Interval<T>& a, const Interval<T>& b) {
  return {below(a.lo + b.lo, kRounded), above(a.hi + b.hi, kRounded)};
}
template <class T>
HWY_INLINE Interval<T> difference(const Interval<T>& a, const Interval<T>& b) {
  return {below(a.lo - b.hi, kRounded), above(a.hi - b.lo, kRounded)};
}

/// Of the four results at the corners of two intervals the least and the greatest; 0 inf and inf / inf count as 0,
/// which the products of finite numbers near them come close to.
template <class T>
HWY_INLINE Interval<T> corner_hull(T p, T q, T r, T s) {
  const auto tame = [](T x) HWY_ATTR { return select(is_number(x), x, zero<T>()); };
  p = tame(p);
  q = tame(q);
  r = tame(r);
  s = tame(s);
  return {min(min(p, q), min(r, s)), max(max(p, q), max(r, s))};
}
/// Outward, but not across 0 where operands of known sign forbid it.
template <class T, class M>
HWY_INLINE Interval<T> widened_product(const Interval<T>& p, M positive, M negative) {
  const T lo = far_below(p.lo, kRounded);
  const T hi = far_above(p.hi, kRounded);
  return {select(positive, max(zero<T>(), lo), lo), select(negative, min(zero<T>(), hi), hi)};
}
template <class T>
HWY_INLINE Interval<T> product(const Interval<T>& a, const Interval<T>& b) {
  const auto a_up = zero<T>() <= a.lo, a_down = a.hi <= zero<T>();
  const auto b_up = zero<T>() <= b.lo, b_down = b.hi <= zero<T>();
  const auto corners = corner_hull(a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi);
  return defined_like(a, b,
                      widened_product(corners, either(both(a_up, b_up), both(a_down, b_down)),
                                      either(both(a_up, b_down), both(a_down, b_up))));
}
template <class T>
HWY_INLINE Interval<T> quotient(const Interval<T>& a, const Interval<T>& b) {
  const auto a_up = zero<T>() <= a.lo, a_down = a.hi <= zero<T>();
  const auto b_up = zero<T>() < b.lo, b_down = b.hi < zero<T>();
  const auto corners = corner_hull(a.lo / b.lo, a.lo / b.hi, a.hi / b.lo, a.hi / b.hi);
  return defined_like(
      a, b,
      undefined_where(holds_zero(b), widened_product(corners, either(both(a_up, b_up), both(a_down, b_down)),
                                                     either(both(a_up, b_down), both(a_down, b_up)))));
}

/// Whether a whole number lies in [lo, hi], or nearly.
template <class T>
HWY_INLINE auto holds_whole(const Interval<T>& a, T margin) {
  return ceil(a.lo - margin) <= floor(a.hi + margin);
}
/// Of a function with period tau that falls and rises between a least value -1 and a greatest 1, the latter at
/// `crest` turns; `at` are its values at the interval's ends.
template <class T>
HWY_INLINE Interval<T> wave_range(const Interval<T>& a, double crest, const Interval<T>& at, double ulps) {
  const T turn = Make<T>::set(0.5 * std::numbers::inv_pi);
  const Interval<T> turns = {a.lo * turn - Make<T>::set(crest), a.hi * turn - Make<T>::set(crest)};
  const T half = Make<T>::set(0.5);
  // Far more than the rounding of the turns; where they have no fraction left, every one is held.
  const T margin =
      mul_add(most_size(turns), Make<T>::set(8 * Precision<T>::kUnit), Make<T>::set(8 * Precision<T>::kUnit));
  const T lo = max(-one<T>(), far_below(min(at.lo, at.hi), owed(ulps)));
  const T hi = min(one<T>(), far_above(max(at.lo, at.hi), owed(ulps)));
  const auto unbounded = Make<T>::set(Precision<T>::kLargest) < most_size(a);
  const auto crests = holds_whole(turns, margin);
  const auto troughs = holds_whole(Interval<T>{turns.lo - half, turns.hi - half}, margin);
  return defined_like(
      a, {select(either(unbounded, troughs), -one<T>(), lo), select(either(unbounded, crests), one<T>(), hi)});
}
