// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Branch and bound in double for a pair of shapes that float32 cannot tell apart or together.
#pragma once

#include "solve/pairs/problem.h"

namespace thalweg {

struct PairDecision {
  PairFinding found;
  double slack = 0;
  std::uint32_t evaluations = 0;
};

/// Looks for a sign, best first, over the whole region, from a point already known, with at most `evaluations` more.
[[nodiscard]] PairDecision decide_in_double(const PairProblem& problem, const float* start, std::uint32_t evaluations,
                                            PairTwins& twins, std::vector<PairHeapCell>& heap);

}  // namespace thalweg
