// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One tile of collision queries: what a solver reads and writes. A tile is solved by one thread from start to end.
#pragma once

#include <vector>

#include "gradient/strategies.h"
#include "kernels/kernels.h"
#include "kernels/twin.h"
#include "solve/arena.h"
#include "solve/columns.h"
#include "thalweg/query.h"

namespace thalweg {

/// Options with every default filled in.
struct SolveLimits {
  Goal goal = Goal::verdict;
  Method method = Method::certified;
  GradientRule gradient;  ///< of the steps of a local method
  GradientRule normals;   ///< of the normal of the final point
  Start start = Start::centroid;
  std::uint32_t starts = 1;
  std::uint32_t iterations = 1;
  std::uint32_t budget = 4096;
  double tolerance = 1e-4;
  double step = 0;   ///< alpha
  double floor = 0;  ///< mu
  double stop = 0;   ///< least move in barycentric coordinates
  bool stop_at_witness = false;
  std::uint32_t contacts = 0;
  double margin = 0;
  double feature = 0;
  float far_reaches = 0;  ///< far points (far_points.inl) are at most so many reaches of the query away
  Affine slack;           ///< of a float32 evaluation in a search: rounding of values, centres and bounds
  Affine slack64;         ///< the same in double; with formulas, of enclosures
};

struct QueryTile {
  const Tape* tape = nullptr;
  const Kernels* kernels = nullptr;
  const SolveLimits* limits = nullptr;
  const float* rows = nullptr;  ///< the tile's first row
  std::size_t count = 0;
  CollideColumns columns;  ///< already moved to the tile's first row
};
struct TriangleTile : QueryTile {};
struct CircleTile : QueryTile {};

/// A cell that waits for its query's turn (certify.inl).
struct WaitingCell {
  std::uint32_t query;
  std::uint32_t level;
  std::uint32_t order;  ///< among the query's cells
  float at[6];
};

/// A worker's memory, reused from tile to tile.
struct TileScratch {
  TileScratch() = default;
  explicit TileScratch(const Tape& tape) : twin(tape) {}
  Arena arena;
  Arena block_arena;     ///< of the results of one block of rows
  ResultBuffer results;  ///< of rows whose results do not lie side by side
  Twin twin;
  std::vector<WaitingCell> waiting;  ///< cells that the current wave cannot hold
  struct HeapCell {
    double lo;     ///< lower bound of f over it
    double at[6];  ///< triangle: barycentric u, v of its corners; box: centre and half size in radii
  };
  std::vector<HeapCell> heap;  ///< of the search in double
};

}  // namespace thalweg
