// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The proof behind one row's verdict, in a form that somebody else can check without knowing how it was found: cells
// that cover the query, each with a lower bound of f over it, and a point of the query with f there. What must hold:
//
//   separated    the cells cover the query, every bound is valid, and the least of them is above 0
//   overlapping  the point lies in the query and f < 0 there; cells are not needed
//   touching     the cells cover the query with valid bounds of at least -tolerance, and f <= tolerance at the point
//   undecided    nothing but that the cells cover the query with valid bounds
#pragma once

#include <cstdint>
#include <vector>

#include "thalweg/query.h"
#include "thalweg/tape.h"

namespace thalweg {

struct ProofCell {
  /// Triangles: u, v of the cell's three corners, barycentric coordinates of the query's second and third corner.
  /// Balls: centre from the ball's centre (d numbers; 2D: the third is 0) and half size of a box, in radii. Dyadic, so
  /// exact.
  double at[6] = {};
  double bound = 0;  ///< f is at least this over the part of the query in the cell
};

struct Proof {
  int dimension = 2;
  bool is_ball = false;
  float corners[3][3] = {};  ///< the query: corners of the triangle, or the ball's centre first
  float radius = 0;
  double tolerance = 0;
  Status row_status = Status::undecided;  ///< what the batch says of the row
  Status status = Status::undecided;      ///< what is proven here: the same, or more
  float point[3] = {};                    ///< the deepest point found
  double u = 0, v = 0;                    ///< triangles: where exactly it is, before it was rounded
  double value = 0;                       ///< f at the point, in double
  double lower = 0;                       ///< the least bound over the cells
  std::uint64_t evaluations = 0;
  std::vector<ProofCell> cells;
};

/// Answers one triangle (3 d numbers) as the batch with these options does, then searches again in double and keeps the
/// cells. Refuses what the batch refuses, bad rows, and methods other than `certified`.
[[nodiscard]] Result<Proof> prove_triangle(const Tape& tape, const float* row, const CollideOptions& options);
/// The same for one circle or sphere (d + 1 numbers).
[[nodiscard]] Result<Proof> prove_circle(const Tape& tape, const float* row, const CollideOptions& options);

}  // namespace thalweg
