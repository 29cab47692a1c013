// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Branch and bound in double for the few queries that float32 cannot decide.
#pragma once

#include "solve/tile.h"

namespace thalweg {

/// A query's region in double: a triangle's corners, or a ball's centre and radius.
struct Region64 {
  int dimension = 2;
  bool is_ball = false;
  double corner[3][3] = {};  ///< triangle: corners; ball: corner[0] is the centre
  double radius = 0;
};

struct Decision {
  double value = 0;      ///< f at `point`
  double lower = 0;      ///< proven lower bound of f over the region
  float point[3] = {};   ///< the deepest point found, as reported
  double u = 0, v = 0;   ///< its barycentric coordinates of the second and third corner
  bool witness = false;  ///< f < 0 is proven at `point` and at the point of the region that it was rounded from
  bool closed = false;   ///< the goal was reached
  std::uint32_t evaluations = 0;
};

/// Whether a budget is enough to begin.
[[nodiscard]] bool can_decide(std::uint32_t evaluations);

/// Searches within `evaluations` evaluations, starting from the incumbent in `best`.
[[nodiscard]] Decision decide(const Region64& region, const SolveLimits& limits, const Decision& best,
                              std::uint32_t evaluations, TileScratch& scratch);

}  // namespace thalweg
