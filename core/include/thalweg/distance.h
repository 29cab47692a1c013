// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// How far two shapes are apart: a proven bracket of their separation distance, and the two points that its upper end is
// measured between. Queries are those of pairs (thalweg/pairs.h); everything is told in the frame of the first shape.
#pragma once

#include <cstdint>

#include "thalweg/pairs.h"

namespace thalweg {

struct DistanceOptions {
  double tolerance = 0;  ///< scene units; 0: 1e-2 of the diagonal of the smaller of the two bounding boxes
  /// Evaluations of both fields per query. A first descent, witnesses and the roots, some 300, are had in any case.
  std::uint32_t budget = 4096;
};

/// Result columns, N rows each; a null column is not written. Points and normals are (N,d) in C order.
struct DistanceColumns {
  /// `separated`: a distance above 0 is proven; `overlapping`: a common point is; `touching`: neither is, and the
  /// distance is proven to be at most the tolerance.
  std::uint8_t* status = nullptr;
  float* distance = nullptr;  ///< between `point_a` and `point_b`: proven upper bound; infinite without them
  float* lower = nullptr;     ///< proven lower bound, at least 0
  /// Witnesses of the first shape and of the second: proven inside or, where a shape has no inside, as near to it as
  /// `distance` allows for; the common point where they overlap; NaN where none were found.
  float* point_a = nullptr;
  float* point_b = nullptr;
  float* normal = nullptr;            ///< unit, from `point_a` to `point_b`; that of collide_pairs where they meet
  std::uint8_t* converged = nullptr;  ///< distance - lower <= tolerance
  std::uint32_t* evaluations = nullptr;
};

}  // namespace thalweg
