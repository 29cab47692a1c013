// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The ways to get a gradient (Luneau 2025, section 2.3), over columns of points. All but `autodiff` only need values.
#pragma once

#include "kernels/kernels.h"
#include "solve/arena.h"

namespace thalweg {

/// Probe distance o: max(absolute, relative * |f|). The thesis' rule is the default; it was made for pixels.
struct ProbeOffset {
  float absolute = 0.005F;
  float relative = 0.005F / 20;
};

/// Columns of points and where the answers go; all padded (kernels.h).
struct GradientColumns {
  const float* const* points = nullptr;
  std::size_t count = 0;
  float* value = nullptr;
  float* const* gradient = nullptr;
};

/// Evaluations of f that one gradient takes; a forward-mode pass counts as one.
[[nodiscard]] std::uint32_t evaluations_of(Gradient strategy, int dimension);

/// Values and gradients by a strategy. Differences are normalised; where they vanish the gradient is zero.
/// `dichotomy` exists in 2D only.
void evaluate_gradient(Gradient strategy, const Tape& tape, const Kernels& kernels, const GradientColumns& columns,
                       ProbeOffset offset, float* kernel_scratch, Arena& arena);

}  // namespace thalweg
