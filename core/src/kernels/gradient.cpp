// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// f and its gradient over columns of points.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/gradient.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "kernels/interpreter.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <int D>
void gradient_of(const Tape& tape, const float* const* points, size_t count, float* value, float* const* gradient,
                 float* scratch) {
  using T = Pack<kGradientWidth>;
  const Machine<T> m = machine_for<GradientMode<T, D>>(tape, scratch);
  const size_t lanes = lanes_of<T>();
  for (size_t i = 0; i < count; i += lanes) {
    for (int axis = 0; axis < D; ++axis)
      store(Make<T>::load(points[axis] + i), m.positions + static_cast<size_t>(axis) * lanes);
    Field<T, D> f = divided(run(GradientMode<T, D>{}, m));
    if (tape.has_formulas) f.gradient = finite_or_zero(f.gradient);
    if (value != nullptr) store(f.value, value + i);
    store(f.gradient.x, gradient[0] + i);
    store(f.gradient.y, gradient[1] + i);
    if constexpr (D == 3) store(f.gradient.z, gradient[2] + i);
  }
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
