// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What every solver ends with: its findings as result columns.
#pragma once

#include "solve/tile.h"

namespace thalweg {

/// The findings on a tile's queries, one entry each; columns are padded for the kernels.
struct QueryState {
  float* point[3] = {};            ///< deepest point found
  float* value = nullptr;          ///< f there
  float* lower = nullptr;          ///< proven lower bound, -inf where there is none
  float* slack = nullptr;          ///< rounding slack of the query's float32 evaluations
  float* barycentric[2] = {};      ///< of the second and third corner; triangles only
  std::uint32_t* evaluations = nullptr;
  std::uint32_t* iterations = nullptr;
  std::uint8_t* witness = nullptr;    ///< f < 0 is proven at the point
  std::uint8_t* converged = nullptr;  ///< the goal was reached
  std::uint8_t* is_bad = nullptr;     ///< the row cannot be answered

  static QueryState make(Arena& arena, int dimension, std::size_t count);
};

/// Writes the columns that the caller wants; evaluates the gradient at the points for the normals.
void finish(const QueryTile& tile, const QueryState& state, float* kernel_scratch, Arena& arena);

/// A coordinate that can be answered: finite and at most 1e15 in size.
inline constexpr float kLargestCoordinate = 1e15F;

}  // namespace thalweg
