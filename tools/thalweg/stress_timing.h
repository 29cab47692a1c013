// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Timing that survives a busy machine: the configurations of a sweep run by turns within each round, and the median of
// the rounds is what counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace thalweg::cli {

/// One configuration of a sweep.
struct StressCase {
  std::string label;
  double x = 0;             ///< its place on the axis; names are counted
  std::size_t rows = 0;     ///< queries of one call, at most
  bool may_shrink = false;  ///< fewer rows will do when a call takes long
  /// Answers the first rows; returns how often f was evaluated.
  std::function<std::uint64_t(std::size_t rows)> run;
};

/// What it reached.
struct StressPoint {
  std::string label;
  double x = 0;
  std::size_t rows = 0;  ///< of one call
  double queries_per_second = 0;
  double spread = 0;  ///< half the distance between the quartiles, relative to the median
  double evaluations_per_query = 0;

  [[nodiscard]] double evaluations_per_second() const { return queries_per_second * evaluations_per_query; }
};

struct StressSweep {
  std::string name;
  std::string axis;      ///< what x is
  bool numeric = false;  ///< x is a number to be plotted on a logarithmic axis, not a name
  std::vector<StressPoint> points;
};

/// Runs all cases once, then `rounds` times by turns.
[[nodiscard]] std::vector<StressPoint> time_by_turns(const std::vector<StressCase>& cases, std::size_t rounds);

/// The exponent b of y = a x^b through the points, by least squares of the logarithms.
[[nodiscard]] double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace thalweg::cli
