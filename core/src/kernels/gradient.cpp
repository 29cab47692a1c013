// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// f and its gradient over columns of points.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/gradient.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "kernels/scalars.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <class Mode>
void gradient_by(const Tape& tape, const float* const* points, size_t count, float* value, float* const* gradient,
                 float* scratch) {
  using T = typename Mode::T;
  constexpr int D = Mode::D;
  const Machine<T> m = machine_for<Mode>(tape, scratch);
  const size_t lanes = lanes_of<T>();
  for (size_t i = 0; i < count; i += lanes) {
    for (int axis = 0; axis < D; ++axis)
      store(Make<T>::load(points[axis] + i), m.positions + static_cast<size_t>(axis) * lanes);
    Field<T, D> f = divided(run(Mode{}, m));
    if (tape.has_formulas) f.gradient = finite_or_zero(f.gradient);
    if (value != nullptr) store(f.value, value + i);
    store(f.gradient.x, gradient[0] + i);
    store(f.gradient.y, gradient[1] + i);
    if constexpr (D == 3) store(f.gradient.z, gradient[2] + i);
  }
}

template <int D>
void gradient_of(const Tape& tape, const float* const* points, size_t count, float* value, float* const* gradient,
                 float* scratch) {
  using T = Pack<kPlainGradientWidth>;
  const auto by_mode = tape.only_scalars ? gradient_by<ScalarGradientMode<T, D>> : gradient_by<GradientMode<T, D>>;
  by_mode(tape, points, count, value, gradient, scratch);
}

void gradient_kernel(const Tape& tape, const float* const* points, size_t count, float* value, float* const* gradient,
                     float* scratch) {
  tape.dimension == 2 ? gradient_of<2>(tape, points, count, value, gradient, scratch)
                      : gradient_of<3>(tape, points, count, value, gradient, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(gradient_kernel);
GradientKernel gradient_entry(std::int64_t target) { return THALWEG_ENTRY_OF(gradient_kernel, target); }
}  // namespace thalweg
#endif
