// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Shape against shape. A point P is common to A and to B placed by a pose when g(P) = max(f_a(P), f_b(B^-1 P)) <= 0.
// The depth of an overlap is -min g, which is not the translational penetration: it is how far the deepest common point
// is from the nearer of the two surfaces, half of what one shape must move where two flat faces overlap.
//
// Everything is told in the frame of the first shape.
#pragma once

#include <cstddef>
#include <cstdint>

#include "thalweg/query.h"
#include "thalweg/tape.h"

namespace thalweg {

/// N queries: pose q places shapes[second] relative to shapes[first].
struct PairQueries {
  const Tape* const* shapes = nullptr;  ///< of one dimension
  std::size_t shape_count = 0;          ///< at least 2 when `pairs` is null
  /// Pose rows, C order: (N,3) x, y, angle in radians; (N,7) x, y, z and a quaternion w, x, y, z, normalised on
  /// reading. A quaternion of zeros is a bad row.
  const float* poses = nullptr;
  const std::uint32_t* pairs = nullptr;  ///< (N,2) indices into `shapes`; null: always the first two
  std::size_t count = 0;
};

struct PairOptions : CollideOptions {
  /// Resolution e of overlap regions, scene units. With delta = min(e, half the depth of the deepest point), every
  /// component of {g <= -delta} belongs to exactly one contact, and two components share a contact only when a path
  /// with g <= e joins them. 0: 1/32 of the diagonal of the smaller of the two bounding boxes.
  double region = 0;
};

/// The diagonal of the smaller of the two bounding boxes, 1 where neither is bounded: what lengths that are not given
/// are parts of.
[[nodiscard]] double pair_size(const Tape& a, const Tape& b);

/// Contacts of each query in slots, deepest first; a query's slots beyond min(found, capacity) are left alone. The
/// caller owns the columns; a null one is not written.
struct PairContacts {
  std::size_t capacity = 0;           ///< K, slots per query; 0: contacts are not looked for
  std::uint32_t* found = nullptr;     ///< (N), before the cut to K
  float* point = nullptr;             ///< (N,K,d) deepest point of the region
  float* normal = nullptr;            ///< (N,K,d) unit, out of the first shape: grad f_a - grad f_b, normalised
  float* value = nullptr;             ///< (N,K) g at `point`; the depth is -value
  float* lower = nullptr;             ///< (N,K) proven lower bound of g over the region; -inf where none is
  std::uint8_t* converged = nullptr;  ///< (N,K) value - lower <= tolerance, and the region is resolved
  std::uint8_t* ambiguous = nullptr;  ///< (N,K) the gradients cancel; the normal is a fixed unit vector
};

/// Descent paths of local methods, kept on request: the points of every start of a query, one after the other.
struct PairPaths {
  std::size_t capacity = 0;         ///< points per start
  float* points = nullptr;          ///< (N, starts, capacity, d)
  std::uint32_t* length = nullptr;  ///< (N, starts) points written
};

}  // namespace thalweg
