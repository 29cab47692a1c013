// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Where descents over a triangle start: a policy is a list of points in barycentric coordinates.
#pragma once

#include <cstdint>

#include "solve/simplex.h"
#include "thalweg/query.h"

namespace thalweg {

/// The centroid, the corners, the mid-edges, then Halton points.
[[nodiscard]] Barycentric start_point(std::uint32_t index);

/// Start `index` of a policy; `best_of_4` has four candidates instead, of which its one start is the lowest.
[[nodiscard]] Barycentric start_point(Start policy, std::uint32_t index);

/// How many starts a policy has when the caller does not say, and how many at the most.
[[nodiscard]] std::uint32_t usual_starts(Start policy);
[[nodiscard]] std::uint32_t most_starts(Start policy);

}  // namespace thalweg
