// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Enclosures of tapes with formulas over columns of cells.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/ranges.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "kernels/column_cell.inl"
#include "kernels/ranges.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <int D>
void ranges_of(const Tape& tape, const float* const* centres, const CellColumns& cells, size_t count,
               const RangeColumns& range, float* scratch) {
  using T = Pack<kGradientWidth>;
  using Mode = RangeMode<T, D, ColumnCell<T, D>>;
  const Machine<T> m = machine_for<Mode>(tape, scratch);
  const size_t lanes = lanes_of<T>();
  for (size_t i = 0; i < count; i += lanes) {
    for (int axis = 0; axis < D; ++axis)
      store(Make<T>::load(centres[axis] + i), m.positions + static_cast<size_t>(axis) * lanes);
    const auto f = run(Mode{{&cells, i}}, m);
    const Interval<T> said = said_of(f.lo, f.hi);
    store(said.lo, range.lower + i);
    store(f.value, range.value + i);
    store(said.hi, range.upper + i);
  }
}

void ranges_kernel(const Tape& tape, const float* const* centres, const CellColumns& cells, size_t count,
                   const RangeColumns& range, float* scratch) {
  tape.dimension == 2 ? ranges_of<2>(tape, centres, cells, count, range, scratch)
                      : ranges_of<3>(tape, centres, cells, count, range, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(ranges_kernel);
RangeKernel ranges_entry(std::int64_t target) { return THALWEG_ENTRY_OF(ranges_kernel, target); }
}  // namespace thalweg
#endif
