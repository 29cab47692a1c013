// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// f over columns of points.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/value.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "kernels/scalars.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <class T, int D>
HWY_INLINE void take_points(const float* const* points, size_t first, float* position) {
  for (int axis = 0; axis < D; ++axis)
    store(Make<T>::load(points[axis] + first), position + static_cast<size_t>(axis) * lanes_of<T>());
}

/// The points from `first` on in chunks of W vectors, and the last, partial one in fewer where they hold it.
template <int W, int D>
void values_from(size_t first, const Tape& tape, const float* const* points, size_t count, float* value,
                 float* scratch) {
  using T = Pack<W>;
  const Machine<T> m = machine_for<ValueMode<T, D>>(tape, scratch);
  const size_t fewer = W == 1 ? 0 : lanes_of<T>() / 2;
  for (; first + fewer < count; first += lanes_of<T>()) {
    take_points<T, D>(points, first, m.positions);
    store(run(ValueMode<T, D>{}, m).value, value + first);
  }
  if constexpr (W > 1) values_from<W / 2, D>(first, tape, points, count, value, scratch);
}

template <int D>
void value_of(const Tape& tape, const float* const* points, size_t count, float* value, float* scratch) {
  size_t first = 0;
  if (tape.only_scalars) {
    ScalarBatch batch{.columns = points, .count = count, .value = value};
    run_scalars(tape, batch, scratch);
    first = batch.done;
  }
  values_from<kValueWidth, D>(first, tape, points, count, value, scratch);
}

void value_kernel(const Tape& tape, const float* const* points, size_t count, float* value, float* scratch) {
  tape.dimension == 2 ? value_of<2>(tape, points, count, value, scratch)
                      : value_of<3>(tape, points, count, value, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(value_kernel);
ValueKernel value_entry(std::int64_t target) { return THALWEG_ENTRY_OF(value_kernel, target); }
}  // namespace thalweg
#endif
