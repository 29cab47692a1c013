// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// f, with or without its gradient, over row-major points as callers have them.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/rows.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "kernels/rows.inl"
#include "kernels/scalars.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <int D>
size_t values_of(const Tape& tape, const float* points, size_t count, float* value, float* scratch) {
  using T = Pack<kValueWidth>;
  size_t i = 0, bad_rows = 0;
  if (tape.only_scalars) {
    ScalarBatch batch{.rows = points, .count = count, .value = value};
    run_scalars(tape, batch, scratch);
    i = batch.done;
    bad_rows = batch.bad_rows;
  }
  const Machine<T> m = machine_for<ValueMode<T, D>>(tape, scratch);
  RowColumns<T, D> rows{points, count, value, nullptr, tape.has_formulas};
  for (; i < count; i += lanes_of<T>()) {
    const bool all_good = rows.take(i, m.positions);
    rows.give(i, all_good, run(ValueMode<T, D>{}, m).value);
  }
  return bad_rows + rows.bad_rows;
}

template <class Mode>
size_t gradients_by(const Tape& tape, const float* points, size_t count, float* value, float* gradient,
                    float* scratch) {
  using T = typename Mode::T;
  constexpr int D = Mode::D;
  const Machine<T> m = machine_for<Mode>(tape, scratch);
  RowColumns<T, D> rows{points, count, value, gradient, tape.has_formulas};
  for (size_t i = 0; i < count; i += lanes_of<T>()) {
    const bool all_good = rows.take(i, m.positions);
    rows.give(i, all_good, divided(run(Mode{}, m)));
  }
  return rows.bad_rows;
}

template <int D>
size_t gradients_of(const Tape& tape, const float* points, size_t count, float* value, float* gradient,
                    float* scratch) {
  using T = Pack<kPlainGradientWidth>;
  const auto by_mode = tape.only_scalars ? gradients_by<ScalarGradientMode<T, D>> : gradients_by<GradientMode<T, D>>;
  return by_mode(tape, points, count, value, gradient, scratch);
}

size_t rows_kernel(const Tape& tape, const float* points, size_t count, float* value, float* gradient, float* scratch) {
  if (gradient == nullptr) {
    return tape.dimension == 2 ? values_of<2>(tape, points, count, value, scratch)
                               : values_of<3>(tape, points, count, value, scratch);
  }
  return tape.dimension == 2 ? gradients_of<2>(tape, points, count, value, gradient, scratch)
                             : gradients_of<3>(tape, points, count, value, gradient, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(rows_kernel);
RowsKernel rows_entry(std::int64_t target) { return THALWEG_ENTRY_OF(rows_kernel, target); }
}  // namespace thalweg
#endif
