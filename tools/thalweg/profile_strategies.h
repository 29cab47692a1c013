// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// How well and at what cost each gradient strategy finds the direction of the gradient in double precision.
#pragma once

#include <array>
#include <vector>

#include "command.h"
#include "profile_sample.h"
#include "report.h"

namespace thalweg::cli {

/// Angular errors of some of the points, in radians. A gradient that is zero has no angle; its row counts as vanished.
struct AngleErrors {
  std::size_t count = 0;
  double median = 0, p99 = 0, most = 0;  ///< of those with an angle; NaN where there are none
  double wrong_half_space = 0;           ///< share with more than a quarter of a turn
  double vanished = 0;                   ///< share of zero gradients
  std::size_t nan = 0;
};
[[nodiscard]] Json to_json(const AngleErrors& errors);

struct StrategyProfile {
  Gradient strategy = Gradient::autodiff;
  double evaluations = 0;  ///< of f, a gradient and the value with it
  double nanoseconds = 0;  ///< the same, on one thread, the median of several runs
  AngleErrors all, smooth, kinks;
  std::array<AngleErrors, kBandNames.size()> bands;
};

/// Errors against the offset, for strategies that have one.
struct OffsetSweep {
  Gradient strategy = Gradient::central;
  std::vector<double> offset;  ///< in diagonals of the scene
  std::vector<AngleErrors> smooth, kinks;
};

/// The strategies that a dimension has.
[[nodiscard]] std::vector<Gradient> strategies_of(int dimension);

[[nodiscard]] StrategyProfile profile_strategy(const Tape& tape, const ProfileSample& sample,
                                               const GradientOptions& options, const Globals& globals);
/// Offsets from 1e-8 to 1 diagonals, two a decade.
[[nodiscard]] OffsetSweep sweep_offset(const Tape& tape, const ProfileSample& sample, Gradient strategy,
                                       const Globals& globals);

/// The middle of several timings of `body`, in seconds.
template <class Body>
[[nodiscard]] double median_seconds(int runs, Body&& body) {
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) {
    const Stopwatch watch;
    body();
    seconds.push_back(watch.seconds());
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

}  // namespace thalweg::cli
