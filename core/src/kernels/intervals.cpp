// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Intervals of what every instruction leaves in the accumulator over many regions at once: of the values that float32
// computes there, once the caller has widened the reach by their rounding. Then, backwards, what each is needed for.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/intervals.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include <algorithm>

#include "kernels/relevance.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <class T_, int D_>
struct IntervalMode {
  using T = T_;
  static constexpr int D = D_;
  static constexpr size_t kComponents = 2;
  static constexpr bool kHasScalars = true;
  using Register = Interval<T>;

  T reach;
  const float* halves[D];
  float** record;  ///< where the operands of the next choice go, as if for the least of two

  template <class Declared>
  HWY_INLINE Register primitive(const Machine<T>&, const Instruction&, Point<T, D> p, Constants<T> c) const {
    const T f = Declared::field(p, c).value;
    return {f - reach, f + reach};
  }
  template <class Declared>
  HWY_INLINE Register combine(const Machine<T>&, const Instruction&, const Register& a, const Register& b,
                              Constants<T> c) const {
    note<Declared>(a, b);
    constexpr bool kRising = Declared::kTrend[1] > 0;
    const auto at = [&](T x, T y) { return Declared::combine(Field<T, D>{x, {}}, Field<T, D>{y, {}}, c).value; };
    // Where a formula may be undefined nothing is known of what is joined with it.
    return defined_like(a, b, Register{at(a.lo, kRising ? b.lo : b.hi), at(a.hi, kRising ? b.hi : b.lo)});
  }
  template <class Declared>
  HWY_INLINE void note(const Register& a, const Register& b) const {
    constexpr Role kRole = role_of<Declared>();
    store_interval(kRole.greatest ? mirrored(a) : a, *record, lanes_of<T>());
    store_interval(kRole.greatest != kRole.second_falls ? mirrored(b) : b, *record + 2 * lanes_of<T>(), lanes_of<T>());
    *record += 4 * lanes_of<T>();
  }
  template <class Declared>
  HWY_INLINE Register map(const Machine<T>&, const Instruction&, const Register& a, Constants<T> c) const {
    if constexpr (Declared::kTrend == 0) {
      return Declared::enclose(a, c);
    } else {
      const auto at = [&](T x) { return Declared::map(Field<T, D>{x, {}}, c).value; };
      return {at(a.lo), at(a.hi)};
    }
  }
  template <class Declared>
  HWY_INLINE Register leaf(const Machine<T>&, const Instruction& in, Point<T, D> p, Constants<T> c) const {
    Register offsets[D];
    for (int axis = 0; axis < D; ++axis) {
      // A turned box is not known.
      const T half = in.operand == 0 ? Make<T>::load(halves[axis]) : reach;
      offsets[axis] = {-half, half};
    }
    return Declared::enclose(p, offsets, zero<T>(), c);
  }
  template <class Declared>
  HWY_INLINE Register unary(const Machine<T>&, const Instruction&, const Register& a) const {
    return Declared::enclose(a);
  }
  template <class Declared>
  HWY_INLINE Register binary(const Machine<T>&, const Instruction&, const Register& a, const Register& b) const {
    if constexpr (role_of<Declared>().part != Part::pair) note<Declared>(a, b);
    return Declared::enclose(a, b);
  }
  static HWY_INLINE Register immediate(Constants<T> c) { return {c[1], c[2]}; }
  static HWY_INLINE Register load(const float* from) { return load_interval<T>(from, lanes_of<T>()); }
  static HWY_INLINE void save(const Register& a, float* to) { store_interval(a, to, lanes_of<T>()); }
};

/// Those of one chunk.
size_t most_pieces() { return std::min(lanes_of<Pack<kGradientWidth>>(), kRegionLanes); }

template <int D>
void regions_of(const Tape& tape, const RegionColumns& regions, const RegionWork& work) {
  using T = Pack<kGradientWidth>;
  const Machine<T> m = machine_for<IntervalMode<T, D>>(tape, work.scratch);
  const size_t lanes = lanes_of<T>();
  const size_t end = regions.are_pieces ? most_pieces() : kRegionLanes;
  for (size_t i = 0; i < end; i += lanes) {
    for (int axis = 0; axis < D; ++axis) {
      store(Make<T>::load(regions.centre[axis] + i), m.positions + static_cast<size_t>(axis) * lanes);
    }
    float* record = work.record;
    IntervalMode<T, D> mode{Make<T>::load(regions.reach + i), {}, &record};
    for (int axis = 0; axis < D; ++axis) mode.halves[axis] = regions.half[axis] + i;
    const auto f = run(mode, m);
    store(f.lo, regions.lower + i);
    store(f.hi, regions.upper + i);
    // Where f is beyond what matters everywhere, nothing of the tape is needed.
    const auto least = Make<T>::load(regions.least + i), most = Make<T>::load(regions.most + i);
    const auto decided = either(f.hi < least, most < f.lo);
    const T infinity = Make<T>::set(std::numeric_limits<float>::infinity());
    Relevance<T> relevance(tape, work, record, regions, i / lanes);
    relevance.run({select(decided, infinity, least), select(decided, -infinity, most)});
  }
}

void regions_kernel(const Tape& tape, const RegionColumns& regions, const RegionWork& work) {
  tape.dimension == 2 ? regions_of<2>(tape, regions, work) : regions_of<3>(tape, regions, work);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(regions_kernel);
HWY_EXPORT(most_pieces);
RegionKernel regions_entry(std::int64_t target) { return THALWEG_ENTRY_OF(regions_kernel, target); }
std::size_t most_pieces_of(std::int64_t target) { return THALWEG_ENTRY_OF(most_pieces, target)(); }
}  // namespace thalweg
#endif
