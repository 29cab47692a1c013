// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One tile of distance queries, and what is found for a row of it.
#pragma once

#include "solve/pairs/pair_tile.h"
#include "thalweg/distance.h"

namespace thalweg {

struct DistanceTile {
  PairTile pairs;  ///< queries, kernels and rows; its columns are not used
  const DistanceOptions* options = nullptr;
  DistanceColumns columns;  ///< of all rows
};

/// The bracket of a distance and its witnesses, in A's frame.
struct DistanceFinding {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Status status = Status::undecided;
  double lower = 0;
  double upper = std::numeric_limits<double>::infinity();
  double a[3] = {kNone, kNone, kNone}, b[3] = {kNone, kNone, kNone};
  float normal[3] = {};
  bool converged = false;
  std::uint32_t evaluations = 0;
};

void write_distance(const DistanceTile& tile, std::size_t row, const DistanceFinding& found);
/// Nothing is near an empty shape.
void write_empty_distance(const DistanceTile& tile, std::size_t row);
void write_bad_distance(const DistanceTile& tile, std::size_t row);

}  // namespace thalweg
