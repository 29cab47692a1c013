// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Branch and bound in double for the few queries that float32 cannot decide.
#pragma once

#include "solve/finish.h"
#include "solve/tile.h"

namespace thalweg {

/// A query's region in double: a triangle's corners, or a ball's centre and radius.
struct Region64 {
  int dimension = 2;
  bool is_ball = false;
  double corner[3][3] = {};  ///< triangle: corners; ball: corner[0] is the centre
  double radius = 0;
};

/// Once the goal is reached but for a proven sign, one part in this many of the budget may have gone into proving it.
inline constexpr std::uint32_t kTouchingEffort = 4;

/// Whether a budget is enough to begin.
[[nodiscard]] bool can_decide(std::uint32_t evaluations, bool by_ranges = false);

/// Searches on for query q of a tile with what is left of its budget, and puts what is found into its state.
void decide_in_double(const Region64& region, const SolveLimits& limits, QueryState& state, std::size_t q,
                      TileScratch& scratch);

/// Short of a proven sign, whether a lower bound ends the search for query q: what is left is to prove more.
[[nodiscard]] bool goal_reached(const SolveLimits& limits, const QueryState& state, std::size_t q, float lower);

}  // namespace thalweg
