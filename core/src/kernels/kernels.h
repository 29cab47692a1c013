// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The entry points of one SIMD target: whole columns through a tape, and each solver for one tile.
//
// Columns are structures of arrays of float32. Every column must be allocated up to a multiple of kColumnPadding
// entries; what lies beyond `count` may be anything and is computed and ignored.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "thalweg/query.h"
#include "thalweg/tape.h"

namespace thalweg {

/// Vectors of float32 in flight per chunk: four hide the latency of a value's instructions; gradients, where a target
/// has few registers, and enclosures need the registers themselves and do best with two (measured, evaluate/* and
/// triangles/* of thalweg_bench).
inline constexpr int kValueWidth = 4;
inline constexpr int kGradientWidth = 2;
inline constexpr int kMostGradientWidth = 4;
/// Scalar instructions are short: more vectors share the way to each.
inline constexpr int kScalarWidth = 8;
/// The widest chunk of any target: kScalarWidth vectors of 512 bits.
inline constexpr std::size_t kMostChunkLanes = kScalarWidth * 16;
/// A coordinate that can be answered is finite and at most this large.
inline constexpr float kLargestCoordinate = 1e15F;
/// Of float32.
inline constexpr double kUnitRoundoff = 0x1p-24;
/// Corners, centres and edges of cells are off by at most this part of the largest coordinate of their query.
inline constexpr double kPlaceRounding = 16 * kUnitRoundoff;
inline constexpr std::size_t kColumnPadding = 64;
[[nodiscard]] constexpr std::size_t padded(std::size_t count) {
  return (count + kColumnPadding - 1) / kColumnPadding * kColumnPadding;
}

/// Cells of an enclosure: the reach of each, and either its vertices relative to the centre (simplex: `edges` holds
/// d + 1 or fewer vertices times d columns, vertex by vertex) or its half extents (box: d columns).
struct CellColumns {
  const float* reach = nullptr;
  const float* edges[9] = {};
  bool is_box = false;
  float* gradient[3] = {};       ///< where the gradients at the centres go; null: they are not wanted
  const float* place = nullptr;  ///< tapes with formulas: how far the places of each cell's points may be off
};

/// What is known of f over cells; all padded.
struct RangeColumns {
  float* lower = nullptr;
  float* value = nullptr;  ///< f at the centre, as the value kernel has it
  float* upper = nullptr;
};

/// Columns of points and where their gradients go; all padded.
struct GradientColumns {
  const float* const* points = nullptr;
  std::size_t count = 0;
  float* value = nullptr;  ///< f at the points; may be null
  float* const* gradient = nullptr;
  std::uint32_t* evaluations = nullptr;  ///< each point's are added; may be null
  float* const* witness = nullptr;       ///< `closest_point` only: a surface point, the nearest found; may be null
};

/// Room for the instruction that made each position, at the head of a machine's scratch.
[[nodiscard]] constexpr std::size_t definition_floats(const Tape& tape) {
  return (static_cast<std::size_t>(tape.position_count) + 15) / 16 * 16;
}

/// Floats of scratch that any of the evaluating kernels needs for a tape; align it to 64 bytes. Gradients have the
/// largest registers, 2 + d numbers a lane, values the most lanes, and maybe a program with registers of its own.
[[nodiscard]] constexpr std::size_t scratch_floats(const Tape& tape) {
  const auto registers = static_cast<std::size_t>(tape.register_count);
  const auto positions = static_cast<std::size_t>(tape.position_count);
  const auto dimension = static_cast<std::size_t>(tape.dimension);
  constexpr std::size_t kGradientLanes = kMostGradientWidth * 16;
  static_assert(kMostChunkLanes <= kGradientLanes * 4 && kGradientWidth * 5 <= kMostGradientWidth * 4);
  const std::size_t tape_floats =
      kGradientLanes * registers * (dimension + 2) + kMostChunkLanes * positions * dimension;
  const std::size_t value_floats = kMostChunkLanes * static_cast<std::size_t>(tape.values.register_count);
  return std::max(tape_floats, value_floats) + definition_floats(tape);
}

using ValueKernel = void (*)(const Tape& tape, const float* const* points, std::size_t count, float* value,
                             float* scratch);
/// `value` may be null.
using GradientKernel = void (*)(const Tape& tape, const float* const* points, std::size_t count, float* value,
                                float* const* gradient, float* scratch);
/// Row-major points (N,d); `gradient` (N,d) may be null. Rows that cannot be answered give NaN; returns how many.
using RowsKernel = std::size_t (*)(const Tape& tape, const float* points, std::size_t count, float* value,
                                   float* gradient, float* scratch);
struct GradientRule;
/// Gradients by any strategy but `autodiff` (gradient/strategies.h).
using StrategyKernel = void (*)(const Tape& tape, const GradientRule& rule, const GradientColumns& columns,
                                float* scratch);
using EnclosureKernel = void (*)(const Tape& tape, const float* const* centres, const CellColumns& cells,
                                 std::size_t count, float* lower, float* value, float* scratch);
/// [lower, upper] encloses f over each cell, which is what tapes with formulas are proven by: their rounding included
/// but for Tape::enclosure_slack; infinite where f may be undefined.
using RangeKernel = void (*)(const Tape& tape, const float* const* centres, const CellColumns& cells, std::size_t count,
                             const RangeColumns& range, float* scratch);

struct RegionColumns;
struct RegionWork;
/// Which instructions can decide the value over each of many regions (kernels/regions.h).
using RegionKernel = void (*)(const Tape& tape, const RegionColumns& regions, const RegionWork& work);

struct TriangleTile;
struct CircleTile;
struct TileScratch;
struct PairTile;
struct PairScratch;
struct DistanceTile;
struct TriangleSweepTile;
struct BallSweepTile;
struct SweepScratch;
struct QueryTile;
struct QueryState;
class Arena;
/// Writes the result columns that the caller wants; evaluates the gradient at the points for the normals.
using FinishKernel = void (*)(const QueryTile& tile, const QueryState& state, float* scratch, Arena& arena);
using TriangleSolver = void (*)(const TriangleTile& tile, TileScratch& scratch);
using CircleSolver = void (*)(const CircleTile& tile, TileScratch& scratch);
using PairSolver = void (*)(const PairTile& tile, PairScratch& scratch);
using DistanceSolver = void (*)(const DistanceTile& tile, PairScratch& scratch);
using TriangleSweeper = void (*)(const TriangleSweepTile& tile, SweepScratch& scratch);
using BallSweeper = void (*)(const BallSweepTile& tile, SweepScratch& scratch);

struct Kernels {
  ValueKernel value = nullptr;
  GradientKernel gradient = nullptr;
  StrategyKernel strategy = nullptr;
  RowsKernel rows = nullptr;
  EnclosureKernel enclosure = nullptr;
  RegionKernel regions = nullptr;
  std::size_t pieces = 0;  ///< of one region that `regions` takes at once
  RangeKernel ranges = nullptr;
  FinishKernel finish = nullptr;
  TriangleSolver certify_triangles = nullptr;
  CircleSolver certify_circles = nullptr;
  PairSolver certify_pairs = nullptr;
  DistanceSolver certify_distances = nullptr;
  TriangleSweeper sweep_triangles = nullptr;
  BallSweeper sweep_balls = nullptr;
};

}  // namespace thalweg
