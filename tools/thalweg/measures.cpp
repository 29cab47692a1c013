// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "failure.h"
#include "profile_sample.h"

namespace thalweg::cli {

namespace {

constexpr int kLeastDecade = -6;
constexpr std::size_t kMostSteps = 32;
constexpr double kArrived = 1e-5;

}  // namespace

Ramp measure_ramp() { return {{0.22F, 0.09F, 4.55F}, {0.96F, 0.13F, 1.85F}}; }

std::vector<float> error_shares(const Tape& tape, const std::vector<float>& points,
                                const std::vector<float>& gradient) {
  const auto d = static_cast<std::size_t>(tape.dimension);
  std::vector<float> shares(points.size() / d);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    double p[3] = {}, reference[3];
    for (std::size_t axis = 0; axis < d; ++axis) p[axis] = static_cast<double>(points[i * d + axis]);
    evaluate_double(tape, p, reference);
    const double angle = angle_between(gradient.data() + i * d, reference, d);
    const double decades = std::log10(std::max(angle, 1e-30)) - kLeastDecade;
    shares[i] = static_cast<float>(std::isnan(angle) ? angle : std::clamp(decades / -kLeastDecade, 0.0, 1.0));
  }
  return shares;
}

Legend error_legend() {
  Legend legend;
  for (int decade = kLeastDecade; decade <= 0; decade += 2) {
    legend.ticks.push_back(
        {1 - static_cast<float>(decade) / kLeastDecade, decade == 0 ? "1" : "1e" + std::to_string(decade)});
  }
  legend.unit = "rad";
  return legend;
}

std::vector<float> step_shares(const Tape& tape, const std::vector<float>& points, const GradientOptions& options,
                               const Execution& execution) {
  const auto d = static_cast<std::size_t>(tape.dimension);
  const std::size_t count = points.size() / d;
  const Bounds& bounds = tape.facts.bounds;
  const bool bounded = bounds.finite(tape.dimension) && !bounds.empty(tape.dimension);
  const double arrived = kArrived * (bounded ? bounds.diagonal(tape.dimension) : 1);
  std::vector<float> at = points, value(count), gradient(points.size()), shares(count, 1);
  std::vector<std::uint8_t> done(count);
  for (std::size_t step = 0; step <= kMostSteps; ++step) {
    static_cast<void>(unwrap(evaluate(tape, Points{at.data(), count}, options,
                                      {.value = value.data(), .gradient = gradient.data()}, execution),
                             kCommandLine, "--gradient"));
    for (std::size_t i = 0; i < count; ++i) {
      if (done[i] != 0) continue;
      if (std::fabs(static_cast<double>(value[i])) <= arrived) {
        done[i] = 1;
        shares[i] = static_cast<float>(step) / kMostSteps;
      }
      for (std::size_t axis = 0; axis < d; ++axis) at[i * d + axis] -= value[i] * gradient[i * d + axis];
    }
  }
  return shares;
}

Legend steps_legend() {
  Legend legend;
  for (const int steps : {0, 8, 16, 24, 32}) {
    legend.ticks.push_back({static_cast<float>(steps) / kMostSteps, std::to_string(steps)});
  }
  legend.unit = "steps";
  return legend;
}

}  // namespace thalweg::cli
