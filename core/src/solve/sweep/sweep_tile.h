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

/// The scene's motion of a row in double: its place at time t.
struct ScenePlace {
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major, from the scene's frame
  double translation[3] = {};
};
[[nodiscard]] ScenePlace place_of_scene(const SweepTile& tile, std::size_t row, double time);

/// A turn by the shorter way: unit axis and angle of a quaternion w, x, y, z. False for one of zeros.
bool axis_and_angle(const float* quaternion, double* axis, double& angle);

}  // namespace thalweg
