// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Barycentric coordinates of a triangle and the two projections that descents use.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace thalweg {

/// Weights of the three corners; they are at least 0 and sum to 1.
struct Barycentric {
  float a, b, c;

  [[nodiscard]] float of(float at_a, float at_b, float at_c) const { return a * at_a + (b * at_b + c * at_c); }
};

[[nodiscard]] inline float distance(const Barycentric& p, const Barycentric& q) {
  return std::sqrt((p.a - q.a) * (p.a - q.a) + (p.b - q.b) * (p.b - q.b) + (p.c - q.c) * (p.c - q.c));
}

/// The closest point of the unit simplex in the Euclidean norm (Duchi et al. 2008): subtract the one threshold that
/// leaves the positive parts with sum 1.
[[nodiscard]] inline Barycentric project_on_simplex(float a, float b, float c) {
  float sorted[3] = {a, b, c};
  if (sorted[0] < sorted[1]) std::swap(sorted[0], sorted[1]);
  if (sorted[1] < sorted[2]) std::swap(sorted[1], sorted[2]);
  if (sorted[0] < sorted[1]) std::swap(sorted[0], sorted[1]);
  float sum = 0;
  float threshold = 0;
  for (int k = 0; k < 3; ++k) {
    sum += sorted[k];
    const float candidate = (sum - 1) / static_cast<float>(k + 1);
    if (sorted[k] > candidate) threshold = candidate;
  }
  return {std::max(a - threshold, 0.0F), std::max(b - threshold, 0.0F), std::max(c - threshold, 0.0F)};
}

/// The point of a filled triangle closest to p, in 2D or 3D; `corners` holds three points one after the other.
/// Degenerate triangles are segments or points.
[[nodiscard]] Barycentric closest_point(const float* corners, const float* p, std::size_t dimension);

}  // namespace thalweg
