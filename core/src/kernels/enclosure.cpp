// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A lower bound of f over columns of cells, f at their centres and, if wanted, its gradient there.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/enclosure.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "kernels/column_cell.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <int D, bool kWithGradient>
void enclosure_of(const Tape& tape, const float* const* centres, const CellColumns& cells, size_t count, float* lo,
                  float* value, float* scratch) {
  using T = Pack<kGradientWidth>;
  using Mode = EnclosureMode<T, D, ColumnCell<T, D>, kWithGradient>;
  const Machine<T> m = machine_for<Mode>(tape, scratch);
  const size_t lanes = lanes_of<T>();
  for (size_t i = 0; i < count; i += lanes) {
    for (int axis = 0; axis < D; ++axis)
      store(Make<T>::load(centres[axis] + i), m.positions + static_cast<size_t>(axis) * lanes);
    const auto f = run(Mode{{&cells, i}}, m);
    store(f.lo, lo + i);
    store(f.value, value + i);
    if constexpr (kWithGradient) {
      store(f.gradient.x, cells.gradient[0] + i);
      store(f.gradient.y, cells.gradient[1] + i);
      if constexpr (D == 3) store(f.gradient.z, cells.gradient[2] + i);
    }
  }
}

void enclosure_kernel(const Tape& tape, const float* const* centres, const CellColumns& cells, size_t count, float* lo,
                      float* value, float* scratch) {
  const bool flat = tape.dimension == 2;
  const auto run_all = cells.gradient[0] == nullptr ? (flat ? enclosure_of<2, false> : enclosure_of<3, false>)
                                                    : (flat ? enclosure_of<2, true> : enclosure_of<3, true>);
  run_all(tape, centres, cells, count, lo, value, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(enclosure_kernel);
EnclosureKernel enclosure_entry(std::int64_t target) { return THALWEG_ENTRY_OF(enclosure_kernel, target); }
}  // namespace thalweg
#endif
