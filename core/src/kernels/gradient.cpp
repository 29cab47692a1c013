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

/// The points from `first` on in chunks of W vectors, and the last, partial one in fewer where they hold it.
template <template <class, int> class Mode, int W, int D>
void gradients_from(size_t first, const Tape& tape, const float* const* points, size_t count, float* value,
                    float* const* gradient, float* scratch) {
  using T = Pack<W>;
  const Machine<T> m = machine_for<Mode<T, D>>(tape, scratch);
  const size_t lanes = lanes_of<T>(), fewer = W == 1 ? 0 : lanes / 2;
  for (; first + fewer < count; first += lanes) {
    for (int axis = 0; axis < D; ++axis)
      store(Make<T>::load(points[axis] + first), m.positions + static_cast<size_t>(axis) * lanes);
    Field<T, D> f = divided(run(Mode<T, D>{}, m));
    if (tape.has_formulas) f.gradient = finite_or_zero(f.gradient);
    if (value != nullptr) store(f.value, value + first);
    store(f.gradient.x, gradient[0] + first);
    store(f.gradient.y, gradient[1] + first);
    if constexpr (D == 3) store(f.gradient.z, gradient[2] + first);
  }
  if constexpr (W > 1) gradients_from<Mode, W / 2, D>(first, tape, points, count, value, gradient, scratch);
}

template <int D>
void gradient_of(const Tape& tape, const float* const* points, size_t count, float* value, float* const* gradient,
                 float* scratch) {
  const auto by_mode = tape.only_scalars ? gradients_from<ScalarGradientMode, kPlainGradientWidth, D>
                                         : gradients_from<GradientMode, kPlainGradientWidth, D>;
  by_mode(0, tape, points, count, value, gradient, scratch);
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
