// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The mode of the tape's machine that tapes with formulas are proven by: interval arithmetic with outward rounding,
// from the coordinates of the cell on. Nothing else bounds a formula: it has no Lipschitz constant, and its rounding no
// bound that could be known beforehand.
//
// Primitives of the same tape give the intervals that they give without formulas, which leave their own rounding to be
// added to the result (Tape::enclosure_slack). Operators on fields owe a rounding of what a formula may have made
// large. A result that may be undefined is NaN at both ends.
// Included once per SIMD target.
#if defined(THALWEG_KERNELS_RANGES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_KERNELS_RANGES_INL
#undef THALWEG_KERNELS_RANGES_INL
#else
#define THALWEG_KERNELS_RANGES_INL
#endif

#include "kernels/interpreter.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Of a cell also `offset(axis)`, from where to where it reaches from its centre, and `place()`, how far the places of
/// its points may be off by rounding.
template <class T_, int D_, class Cell>
struct RangeMode {
  using T = T_;
  static constexpr int D = D_;
  static constexpr size_t kComponents = 3;
  static constexpr bool kHasScalars = true;
  struct Register {
    T lo, value, hi;
  };

  Cell cell;

  template <class Declared>
  HWY_INLINE Register primitive(const Machine<T>& m, const Instruction& in, Point<T, D> p, Constants<T> c) const {
    const auto f = EnclosureMode<T, D, Cell, false>{cell}.template primitive<Declared>(m, in, p, c);
    return {f.lo, f.value, f.hi};
  }
  template <class Declared>
  HWY_INLINE Register combine(const Machine<T>&, const Instruction&, const Register& a, const Register& b,
                              Constants<T> c) const {
    constexpr bool kRising = Declared::kTrend[1] > 0;
    const auto at = [&](T x, T y) HWY_ATTR {
      return Declared::combine(Field<T, D>{x, {}}, Field<T, D>{y, {}}, c).value;
    };
    const Register f = {at(a.lo, kRising ? b.lo : b.hi), at(a.value, b.value), at(a.hi, kRising ? b.hi : b.lo)};
    Interval<T> ends = {f.lo, f.hi};
    if constexpr (Declared::kDeclaration.rounding != 0) ends = {below(f.lo, kRounded), above(f.hi, kRounded)};
    // A comparison passes over what may be undefined.
    ends = defined_like(Interval<T>{a.lo, a.hi}, Interval<T>{b.lo, b.hi}, ends);
    return {ends.lo, f.value, ends.hi};
  }
  template <class Declared>
  HWY_INLINE Register map(const Machine<T>&, const Instruction&, const Register& a, Constants<T> c) const {
    const auto at = [&](T x) HWY_ATTR { return Declared::map(Field<T, D>{x, {}}, c).value; };
    const T owes =
        max(abs(a.lo), abs(a.hi)) * Make<T>::set((Declared::kDeclaration.rounding + kRounded) * Precision<T>::kUnit);
    if constexpr (Declared::kTrend == 0) {
      const Interval<T> ends = Declared::enclose(Interval<T>{a.lo, a.hi}, c);
      return {ends.lo - owes, at(a.value), ends.hi + owes};
    } else {
      return {at(a.lo) - owes, at(a.value), at(a.hi) + owes};
    }
  }
  template <class Declared>
  HWY_INLINE Register leaf(const Machine<T>&, const Instruction& in, Point<T, D> p, Constants<T> c) const {
    Interval<T> offsets[D];
    for (int axis = 0; axis < D; ++axis) {
      // Warps are 1-Lipschitz: what they map the cell to lies within its reach.
      offsets[axis] = in.operand == 0 ? cell.offset(axis) : Interval<T>{-cell.reach(), cell.reach()};
    }
    const Interval<T> f = Declared::enclose(p, offsets, cell.place(), c);
    return {f.lo, Declared::leaf(p, c).value, f.hi};
  }
  template <class Declared>
  HWY_INLINE Register unary(const Machine<T>&, const Instruction&, const Register& a) const {
    const Interval<T> f = Declared::enclose(Interval<T>{a.lo, a.hi});
    return {f.lo, Declared::apply(Field<T, D>{a.value, {}}).value, f.hi};
  }
  template <class Declared>
  HWY_INLINE Register binary(const Machine<T>&, const Instruction&, const Register& a, const Register& b) const {
    const Interval<T> f = Declared::enclose(Interval<T>{a.lo, a.hi}, Interval<T>{b.lo, b.hi});
    return {f.lo, Declared::apply(Field<T, D>{a.value, {}}, Field<T, D>{b.value, {}}).value, f.hi};
  }
  static HWY_INLINE Register immediate(Constants<T> c) { return {c[1], c[0], c[2]}; }
  template <class S>
  static HWY_INLINE Register load(const S* from) {
    const size_t n = lanes_of<T>();
    return {Make<T>::load(from), Make<T>::load(from + n), Make<T>::load(from + 2 * n)};
  }
  template <class S>
  static HWY_INLINE void save(const Register& a, S* to) {
    const size_t n = lanes_of<T>();
    store(a.lo, to);
    store(a.value, to + n);
    store(a.hi, to + 2 * n);
  }
};

/// What the intervals say in the end: nothing where the field may be undefined.
template <class T>
HWY_INLINE Interval<T> said_of(T lo, T hi) {
  const T infinite = Make<T>::set(std::numeric_limits<double>::infinity());
  const auto known = is_number(lo);
  return {select(known, lo, -infinite), select(known, hi, infinite)};
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
