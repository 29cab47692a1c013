// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Time of impact: when a triangle or a ball first meets the shape while one of them moves. Time runs from 0 to 1.
#pragma once

#include <cstddef>
#include <cstdint>

#include "thalweg/query.h"

namespace thalweg {

/// Triangles (N,3,d) or circles and spheres (N,d+1) at time 0, and what moves: exactly one of `ends` and `motions`.
struct SweepQueries {
  const float* rows = nullptr;
  /// Triangles at time 1: each vertex moves on a straight line at constant speed.
  const float* ends = nullptr;
  /// The scene moves: (N,3) dx, dy and an angle in radians; (N,7) a translation and a quaternion w, x, y, z, normalised
  /// on reading, of which the shorter turn is meant. At time t the scene is turned by t times the angle about its
  /// origin, which has moved by t times the translation. A quaternion of zeros, or an angle beyond 1e4, is a bad row.
  const float* motions = nullptr;
  std::size_t count = 0;
};

struct SweepOptions {
  double tolerance = 0;         ///< of time, from 1e-5 to 1; 0: 1e-3
  std::uint32_t budget = 1024;  ///< evaluations per query
};
inline constexpr double kDefaultSweepTolerance = 1e-3;

/// Result columns, N rows each; a null column is not written. Points and normals are (N,d) in C order, in the frame
/// that the queries are given in, at time `toi_upper`; NaN where no contact is proven.
struct SweepColumns {
  /// `overlapping`: a contact is proven; `separated`: none is possible; `touching`: neither is, and what could not be
  /// excluded comes about as near to the shape as the query moves in the tolerance of time; `undecided`: the budget is
  /// spent.
  std::uint8_t* status = nullptr;
  float* toi_lower = nullptr;  ///< there is no contact before it, proven; 1 where there is none at all
  /// With a contact, the time of it: f(point) < 0 is proven. Else the end of the times that could not be excluded.
  float* toi_upper = nullptr;
  std::uint8_t* converged = nullptr;  ///< toi_upper - toi_lower <= tolerance
  float* value = nullptr;             ///< f at `point`
  float* point = nullptr;
  float* normal = nullptr;       ///< unit, out of the shape
  float* barycentric = nullptr;  ///< (N,3), triangles only
  std::uint32_t* evaluations = nullptr;
};

}  // namespace thalweg
