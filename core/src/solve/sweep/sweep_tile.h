// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One tile of moving queries, and what is found of each.
#pragma once

#include "kernels/kernels.h"
#include "solve/arena.h"
#include "thalweg/sweep.h"

namespace thalweg {

struct SweepTile {
  const Tape* tape = nullptr;
  bool stays_near = false;  ///< no point is asked for further than Path::margin from where the query is
  const Kernels* kernels = nullptr;
  float tolerance = 0;
  std::uint32_t budget = 0;
  // From the tile's first row on.
  SweepQueries queries;
  SweepColumns columns;
};
struct TriangleSweepTile : SweepTile {};
struct BallSweepTile : SweepTile {};

/// A worker's memory.
struct SweepScratch {
  Arena arena;
};

/// The findings on a tile's queries, in columns, one entry each. Points are in the scene's frame.
struct SweepState {
  float* upper = nullptr;       ///< time of the earliest contact proven, infinite without one
  float* tolerance = nullptr;   ///< how far before it the search has ended
  float* open_lower = nullptr;  ///< first of the times that were not excluded, infinite without any
  float* open_upper = nullptr;  ///< last of them
  float* value = nullptr;
  float* point[3] = {};
  float* barycentric[2] = {};
  float* is_bad = nullptr;  ///< 1 or 0
  std::uint32_t* evaluations = nullptr;
  std::uint8_t* spent = nullptr;  ///< the budget ended the search

  static SweepState make(Arena& arena, std::size_t count);
};

/// Writes the columns of a tile.
void finish_sweeps(const SweepTile& tile, const SweepState& state, float* kernel_scratch, Arena& arena);

}  // namespace thalweg
