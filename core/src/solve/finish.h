// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What every solver ends with: its findings, which the kernel `finish` writes as result columns.
#pragma once

#include "solve/tile.h"

namespace thalweg {

/// The findings on a tile's queries, one entry each; columns are padded for the kernels.
struct QueryState {
  float* point[3] = {};        ///< deepest point found
  float* value = nullptr;      ///< f there
  float* lower = nullptr;      ///< proven lower bound, -inf where there is none
  float* slack = nullptr;      ///< rounding slack of the query's float32 evaluations
  float* barycentric[2] = {};  ///< of the second and third corner; triangles only
  std::uint32_t* evaluations = nullptr;
  std::uint32_t* iterations = nullptr;
  std::uint8_t* stop = nullptr;  ///< Stop of local methods; null: it follows from `converged`
  // Flags are 1 or 0, as floats: they meet masks of float lanes.
  float* witness = nullptr;    ///< f < 0 is proven at the point
  float* converged = nullptr;  ///< the goal was reached
  float* is_bad = nullptr;     ///< the row cannot be answered

  static QueryState make(Arena& arena, int dimension, std::size_t count);
};

}  // namespace thalweg
