// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Where descents over a triangle start: the centroid, the corners, the mid-edges, then Halton points.
#pragma once

#include <cstdint>

#include "solve/simplex.h"

namespace thalweg {

[[nodiscard]] Barycentric start_point(std::uint32_t index);

}  // namespace thalweg
