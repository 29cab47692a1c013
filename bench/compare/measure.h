// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One method on one case: how often it is wrong, how far off, and what it costs.
#pragma once

#include <string>
#include <vector>

#include "cases.h"
#include "thalweg/method_table.h"

namespace thalweg::bench {

/// A method with the goal it is asked for.
struct Contender {
  std::string name;
  CollideOptions options;
  bool is_ours = false;  ///< `certified` and `accelerated`; the others are published
};
/// Every method for triangles; those of ours for both goals. Constants given in pixels are scaled to the case, and
/// strategies that exist in the plane only are replaced in space.
[[nodiscard]] std::vector<Contender> contenders(const CompareCase& work);

struct Measurement {
  std::size_t rows = 0, hits = 0;
  std::size_t misses = 0;         ///< the oracle proved an overlap that the method does not report
  std::size_t false_reports = 0;  ///< the method reports an overlap that the oracle excludes
  std::size_t undecided = 0;      ///< status 3 of a method that proves
  double mean_error = 0, p99_error = 0, most_error = 0;  ///< value less the minimum, in parts of the diagonal
  double evaluations = 0;                                ///< a query
  double nanoseconds = 0;                                ///< a query, one thread; the median of the rounds
};

/// The contenders run by turns in each round; answers are held against the truth before anything is timed.
[[nodiscard]] std::vector<Measurement> measure(const CompareCase& work, const std::vector<Contender>& all,
                                               std::size_t rounds);

}  // namespace thalweg::bench
