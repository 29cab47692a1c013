// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "stress_timing.h"

#include <algorithm>
#include <cmath>

#include "report.h"

namespace thalweg::cli {

namespace {

// A turn is long against the clock and short against what neighbours on the machine do.
constexpr double kLeastTurn = 4e-3;
constexpr double kMostTurn = 60e-3;
constexpr std::size_t kFirstRows = 256;

struct Turns {
  std::size_t rows = 0;
  std::size_t calls = 1;  ///< of one turn
  std::uint64_t evaluations = 0;
  std::vector<double> seconds;  ///< per call
};

double seconds_of(const StressCase& one, std::size_t rows, std::size_t calls, std::uint64_t& evaluations) {
  const Stopwatch watch;
  for (std::size_t i = 0; i < calls; ++i) evaluations = one.run(rows);
  return watch.seconds() / static_cast<double>(calls);
}

// Warms a case up, and from that sets how many rows a call has and how many calls a turn.
Turns calibrate(const StressCase& one) {
  Turns turns;
  turns.rows = one.rows;
  if (one.may_shrink && one.rows > kFirstRows) {
    seconds_of(one, kFirstRows, 1, turns.evaluations);
    const double each = seconds_of(one, kFirstRows, 1, turns.evaluations) / static_cast<double>(kFirstRows);
    const double fitting = kMostTurn / std::max(each, 1e-12);
    turns.rows = std::max(kFirstRows, static_cast<std::size_t>(std::min(fitting, static_cast<double>(one.rows))));
  }
  const double first = seconds_of(one, turns.rows, 1, turns.evaluations);
  const double calls = std::ceil(kLeastTurn / std::max(first, 1e-7));
  turns.calls = static_cast<std::size_t>(std::max(calls, 1.0));
  return turns;
}

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

StressPoint point_of(const StressCase& one, Turns turns) {
  std::sort(turns.seconds.begin(), turns.seconds.end());
  const double median = quantile(turns.seconds, 0.5);
  const auto rows = static_cast<double>(turns.rows);
  return {.label = one.label,
          .x = one.x,
          .rows = turns.rows,
          .queries_per_second = rows / median,
          .spread = (quantile(turns.seconds, 0.75) - quantile(turns.seconds, 0.25)) / (2 * median),
          .evaluations_per_query = static_cast<double>(turns.evaluations) / rows};
}

}  // namespace

std::vector<StressPoint> time_by_turns(const std::vector<StressCase>& cases, std::size_t rounds) {
  std::vector<Turns> turns;
  turns.reserve(cases.size());
  for (const StressCase& one : cases) turns.push_back(calibrate(one));
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      // Every other round backwards: no case always finds the caches of the same other one.
      const std::size_t which = round % 2 == 0 ? i : cases.size() - 1 - i;
      Turns& turn = turns[which];
      turn.seconds.push_back(seconds_of(cases[which], turn.rows, turn.calls, turn.evaluations));
    }
  }
  std::vector<StressPoint> points;
  points.reserve(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) points.push_back(point_of(cases[i], std::move(turns[i])));
  return points;
}

double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y) {
  const auto count = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / count;
    mean_y += std::log(y[i]) / count;
  }
  double covariance = 0, variance = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x;
    covariance += dx * (std::log(y[i]) - mean_y);
    variance += dx * dx;
  }
  return variance > 0 ? covariance / variance : 0;
}

}  // namespace thalweg::cli
