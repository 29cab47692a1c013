// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What a picture of numbers shows at each sample, as a share of a scale from 0 to 1, and that scale's legend.
#pragma once

#include <vector>

#include "colour.h"
#include "legend.h"
#include "thalweg/batch.h"

namespace thalweg::cli {

/// From dark blue to light yellow: one order of lightness for all eyes.
[[nodiscard]] Ramp measure_ramp();

/// The angle between each gradient (N,d) and the one in double precision, from 1e-6 to 1 radian by the logarithm. A
/// gradient without direction gives NaN.
[[nodiscard]] std::vector<float> error_shares(const Tape& tape, const std::vector<float>& points,
                                              const std::vector<float>& gradient);
[[nodiscard]] Legend error_legend();

/// How many steps P - f g, g the gradient's direction, bring |f| below 1e-5 of the scene's size; 32 are the most.
[[nodiscard]] std::vector<float> step_shares(const Tape& tape, const std::vector<float>& points,
                                             const GradientOptions& options, const Execution& execution);
[[nodiscard]] Legend steps_legend();

}  // namespace thalweg::cli
