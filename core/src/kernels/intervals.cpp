// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Intervals of what every instruction leaves in the accumulator over many regions at once: of the values that float32
// computes there, once the caller has widened the reach by their rounding (algorithms.md section 1).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/intervals.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "kernels/interpreter.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <class T_, int D_>
struct IntervalMode {
  using T = T_;
  static constexpr int D = D_;
  static constexpr size_t kComponents = 2;
  using Register = Interval<T>;

  T reach;
  float* record;  ///< of the chunk's first lane: [instruction][lo, hi][lane]
  size_t stride;  ///< lanes of all chunks

  HWY_INLINE Register noted(const Machine<T>& m, const Instruction& in, const Register& f) const {
    float* const here = record + static_cast<size_t>(&in - m.instructions) * 2 * stride;
    store(f.lo, here);
    store(f.hi, here + stride);
    return f;
  }

  template <class Declared>
  HWY_INLINE Register primitive(const Machine<T>& m, const Instruction& in, Point<T, D> p, Constants<T> c) const {
    const T f = Declared::field(p, c).value;
    return noted(m, in, {f - reach, f + reach});
  }
  template <class Declared>
  HWY_INLINE Register combine(const Machine<T>& m, const Instruction& in, const Register& a, const Register& b,
                              Constants<T> c) const {
    constexpr bool kRising = Declared::kTrend[1] > 0;
    const auto at = [&](T x, T y) { return Declared::combine(Field<T, D>{x, {}}, Field<T, D>{y, {}}, c).value; };
    return noted(m, in, {at(a.lo, kRising ? b.lo : b.hi), at(a.hi, kRising ? b.hi : b.lo)});
  }
  template <class Declared>
  HWY_INLINE Register map(const Machine<T>& m, const Instruction& in, const Register& a, Constants<T> c) const {
    if constexpr (Declared::kTrend == 0) {
      return noted(m, in, Declared::enclose(a, c));
    } else {
      const auto at = [&](T x) { return Declared::map(Field<T, D>{x, {}}, c).value; };
      return noted(m, in, {at(a.lo), at(a.hi)});
    }
  }
  static HWY_INLINE Register load(const float* from) {
    return {Make<T>::load(from), Make<T>::load(from + lanes_of<T>())};
  }
  static HWY_INLINE void save(const Register& a, float* to) {
    store(a.lo, to);
    store(a.hi, to + lanes_of<T>());
  }
};

template <int D>
void intervals_of(const Tape& tape, const RegionColumns& regions, float* record, float* scratch) {
  using T = Pack<kGradientWidth>;
  const Machine<T> m = machine_for<kGradientWidth>(tape, scratch, 2);
  const size_t lanes = lanes_of<T>();
  for (size_t i = 0; i < regions.count; i += lanes) {
    for (int axis = 0; axis < D; ++axis) {
      store(Make<T>::load(regions.centre[axis] + i), m.positions + static_cast<size_t>(axis) * lanes);
    }
    const IntervalMode<T, D> mode{Make<T>::load(regions.reach + i), record + i, regions.stride};
    const auto f = run(mode, m);
    store(f.lo, regions.lower + i);
    store(f.hi, regions.upper + i);
  }
}

void intervals_kernel(const Tape& tape, const RegionColumns& regions, float* record, float* scratch) {
  tape.dimension == 2 ? intervals_of<2>(tape, regions, record, scratch)
                      : intervals_of<3>(tape, regions, record, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(intervals_kernel);
IntervalKernel intervals_entry(std::int64_t target) { return THALWEG_ENTRY_OF(intervals_kernel, target); }
}  // namespace thalweg
#endif
