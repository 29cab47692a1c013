// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The path of one moving query as seen from the scene, in double: q(t) = R(-t angle) (p + t move).
#pragma once

#include "solve/sweep/sweep_tile.h"

namespace thalweg {

/// A turn by more says less than its rounding.
inline constexpr double kMostTurn = 1e4;

/// What holds for all points of a query at all times; lengths and speeds are rounded up.
struct Path {
  bool is_bad = false;  ///< it cannot be answered
  double axis[3] = {0, 0, 1};
  double angle = 0;     ///< of the scene about the axis, until time 1
  double fastest = 0;   ///< speed of a point
  double furthest = 0;  ///< distance of a point from the scene's origin
  double bend = 0;      ///< acceleration of a point
  double margin = 0;    ///< the query's size and an eighth of its way
};
[[nodiscard]] Path path_of(const SweepTile& tile, std::size_t row, bool is_ball);

/// A box of the scene's frame that holds the whole path and `margin` around it; empty (lo > hi) for bad rows.
[[nodiscard]] Bounds box_of(const SweepTile& tile, std::size_t row, bool is_ball);

/// The scene's place at time t.
struct ScenePlace {
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major, from the scene's frame
  double translation[3] = {};
};
[[nodiscard]] ScenePlace place_of_scene(const SweepTile& tile, std::size_t row, double time);

}  // namespace thalweg
