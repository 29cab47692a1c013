// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One shape-against-shape query made ready: the pose in double, the box that holds every common point, and how much
// rounding a search over it must allow for.
#pragma once

#include "solve/pairs/pair_tile.h"

namespace thalweg {

/// x_a = rotation x_b + translation. The rotation is row-major.
struct Pose64 {
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  double translation[3] = {0, 0, 0};

  /// The point of B's frame that lies at a point of A's.
  void to_b(const double* point, double* in_b, int dimension) const;
  /// A direction of B's frame in A's.
  void turn_to_a(const double* direction, double* in_a, int dimension) const;
  /// The box in A's frame around a box of B's; unbounded sides stay unbounded.
  [[nodiscard]] Bounds to_a(const Bounds& box, int dimension) const;
};

/// Reads row `row` of the queries; false when it cannot be answered.
[[nodiscard]] bool read_pose(const PairQueries& queries, std::size_t row, int dimension, Pose64& pose);

/// The shapes of row `row`.
struct PairShapes {
  std::size_t first = 0, second = 1;
  bool operator==(const PairShapes&) const = default;
};
[[nodiscard]] PairShapes shapes_of(const PairQueries& queries, std::size_t row);

/// The strategy of a request: what the caller chose, else closed forms for every method.
[[nodiscard]] inline Gradient strategy_of(const PairOptions& options) {
  return options.gradient_given ? options.gradient : Gradient::autodiff;
}

struct PairProblem {
  const Tape* a = nullptr;
  const Tape* b = nullptr;
  int dimension = 2;
  Pose64 pose;
  PairLimits limits;
  double lo[3] = {}, hi[3] = {};  ///< holds every common point; empty when lo > hi
  /// g is at least this outside the box: 0 < g is all that is known where a field may understate distances.
  double outside = 0;

  [[nodiscard]] bool empty() const;
  /// Rounding slack of float32 evaluations in a search over points whose coordinates in A's frame reach `largest`.
  [[nodiscard]] double slack(double largest) const;
  /// Part of slack() that evaluations in double have.
  [[nodiscard]] double slack64(double largest) const { return slack(largest) * Twin::kSlackRatio; }
};

/// Prepares row `row`; false when it cannot be answered.
[[nodiscard]] bool prepare(const PairQueries& queries, const PairOptions& options, std::size_t row,
                           PairProblem& problem);

/// The box, in the frame of the pair's first or second shape, where both bounding boxes meet or, where they do not,
/// what lies between them.
[[nodiscard]] Bounds zone_of(const PairProblem& problem, std::size_t side);

/// The twins of row `row`.
[[nodiscard]] PairTwins twins_of(const PairTile& tile, std::size_t row, PairScratch& scratch);

/// g in double at a point of A's frame.
[[nodiscard]] double evaluate_pair(const PairProblem& problem, PairTwins& twins, const double* point);

/// Defaults filled in for one pair of tapes.
[[nodiscard]] PairLimits limits_of(const Tape& a, const Tape& b, const PairOptions& options);

/// Refuses what cannot be asked: mixed dimensions, two unbounded shapes, a method for other queries.
[[nodiscard]] Result<bool> check_pairs(const PairQueries& queries, const PairOptions& options);

}  // namespace thalweg
