// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "profile_strategies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace thalweg::cli {

namespace {

constexpr int kRuns = 5;
constexpr int kOffsetsPerDecade = 2;

/// Which points count.
enum class Part : std::uint8_t { all, smooth, kinks };

struct Gradients {
  std::vector<float> value, gradient;
  EvaluateSummary summary;
};

Gradients take(const Tape& tape, const ProfileSample& sample, const GradientOptions& options, const Globals& globals) {
  Gradients taken;
  taken.value.resize(sample.count());
  taken.gradient.resize(sample.points.size());
  Execution execution = globals.execution();
  execution.threads = 1;
  taken.summary = unwrap(evaluate(tape, Points{sample.points.data(), sample.count()}, options,
                                  {.value = taken.value.data(), .gradient = taken.gradient.data()}, execution),
                         kCommandLine, "--gradient-offset");
  return taken;
}

template <class Wanted>
AngleErrors errors_of(const ProfileSample& sample, const std::vector<float>& gradient, Wanted wanted) {
  AngleErrors errors;
  std::vector<double> angles;
  std::size_t wrong = 0, vanished = 0;
  const std::size_t d = sample.dimension;
  for (std::size_t i = 0; i < sample.count(); ++i) {
    if (!wanted(i)) continue;
    ++errors.count;
    const float* const g = gradient.data() + i * d;
    const bool nan = std::any_of(g, g + d, [](float x) { return std::isnan(x); });
    const bool zero = std::all_of(g, g + d, [](float x) { return x == 0; });
    errors.nan += nan ? 1 : 0;
    vanished += zero ? 1 : 0;
    const double angle = angle_between(g, sample.reference.data() + i * d, d);
    if (std::isnan(angle)) continue;
    angles.push_back(angle);
    wrong += angle > std::numbers::pi / 2 ? 1 : 0;
  }
  std::sort(angles.begin(), angles.end());
  const auto at = [&](double share) {
    if (angles.empty()) return std::numeric_limits<double>::quiet_NaN();
    return angles[std::min(angles.size() - 1, static_cast<std::size_t>(share * static_cast<double>(angles.size())))];
  };
  errors.median = at(0.5);
  errors.p99 = at(0.99);
  errors.most = at(1);
  const double all = std::max<double>(1, static_cast<double>(errors.count));
  errors.wrong_half_space = static_cast<double>(wrong) / all;
  errors.vanished = static_cast<double>(vanished) / all;
  return errors;
}

AngleErrors errors_of(const ProfileSample& sample, const std::vector<float>& gradient, Part part) {
  return errors_of(sample, gradient, [&](std::size_t i) {
    return part == Part::all || (sample.near_kink[i] != 0) == (part == Part::kinks);
  });
}

}  // namespace

Json to_json(const AngleErrors& errors) {
  return {{"points", errors.count},
          {"median", errors.median},
          {"p99", errors.p99},
          {"max", errors.most},
          {"wrong_half_space", errors.wrong_half_space},
          {"vanished", errors.vanished},
          {"nan", errors.nan}};
}

std::vector<Gradient> strategies_of(int dimension) {
  std::vector<Gradient> all = {Gradient::autodiff, Gradient::central, Gradient::forward, Gradient::simplex};
  if (dimension == 2) {
    all.push_back(Gradient::dichotomy);
    all.push_back(Gradient::dichotomy_verbatim);
  }
  all.push_back(Gradient::closest_point);
  return all;
}

StrategyProfile profile_strategy(const Tape& tape, const ProfileSample& sample, const GradientOptions& options,
                                 const Globals& globals) {
  StrategyProfile profile;
  profile.strategy = options.strategy;
  Gradients taken;
  const double seconds = median_seconds(kRuns, [&] { taken = take(tape, sample, options, globals); });
  const auto count = static_cast<double>(sample.count());
  profile.nanoseconds = 1e9 * seconds / count;
  profile.evaluations = static_cast<double>(taken.summary.evaluations) / count;
  profile.all = errors_of(sample, taken.gradient, Part::all);
  profile.smooth = errors_of(sample, taken.gradient, Part::smooth);
  profile.kinks = errors_of(sample, taken.gradient, Part::kinks);
  for (std::size_t band = 0; band < profile.bands.size(); ++band) {
    profile.bands[band] =
        errors_of(sample, taken.gradient, [&](std::size_t i) { return std::size_t{sample.band[i]} == band; });
  }
  return profile;
}

OffsetSweep sweep_offset(const Tape& tape, const ProfileSample& sample, Gradient strategy, const Globals& globals) {
  OffsetSweep sweep;
  sweep.strategy = strategy;
  for (int step = -8 * kOffsetsPerDecade; step <= 0; ++step) {
    const double share = std::pow(10, static_cast<double>(step) / kOffsetsPerDecade);
    const ProbeOffset offset{.absolute = share * sample.diagonal, .of_value = 0, .of_scene = 0};
    const Gradients taken = take(tape, sample, {strategy, offset}, globals);
    sweep.offset.push_back(share);
    sweep.smooth.push_back(errors_of(sample, taken.gradient, Part::smooth));
    sweep.kinks.push_back(errors_of(sample, taken.gradient, Part::kinks));
  }
  return sweep;
}

}  // namespace thalweg::cli
