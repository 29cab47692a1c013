// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The ways to get a gradient (Luneau 2025, section 2.3), over columns of points. Probes of a chunk of points go through
// the tape side by side; all but `autodiff` and `closest_point` only need values.
#pragma once

#include <optional>

#include "kernels/kernels.h"

namespace thalweg {

/// Probe distance o: max(absolute, of_value |f|).
struct ProbeRule {
  float absolute = 0;
  float of_value = 0;
};

/// How gradients are had in one batch.
struct GradientRule {
  Gradient strategy = Gradient::autodiff;
  ProbeRule probe;
};

/// Why a tape's gradient cannot be had so, or nothing; the error's place is the option's name.
[[nodiscard]] std::optional<Error> refusal(const Tape& tape, Gradient strategy, const ProbeOffset& offset);

/// The rule of a request that was not refused.
[[nodiscard]] GradientRule rule_of(const Tape& tape, Gradient strategy, const ProbeOffset& offset);

/// Evaluations of f that a gradient takes, with the one at the point itself where the strategy, its offset or the
/// caller (`with_value`) wants it. A forward-mode pass counts as one. `closest_point` takes this many at least.
[[nodiscard]] std::uint32_t evaluations_of(const GradientRule& rule, int dimension, bool with_value);

/// Values and gradients by a strategy. Differences are normalised; where they vanish the gradient is zero.
void evaluate_gradient(const GradientRule& rule, const Tape& tape, const Kernels& kernels,
                       const GradientColumns& columns, float* kernel_scratch);

}  // namespace thalweg
