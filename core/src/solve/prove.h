// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Tapes with formulas: what is proven of f at single points. A point's range is that of a cell of no size but for the
// rounding of places, so it also speaks of the exact point of the query that was rounded to this one.
#pragma once

#include "solve/finish.h"
#include "solve/tile.h"

namespace thalweg {

/// Points with what is known of f there; all columns padded.
struct ProvenPoints {
  std::size_t count = 0;
  std::uint32_t* query = nullptr;
  float* at[3] = {};
  float* place = nullptr;  ///< how far each may be off
  float* value = nullptr;  ///< f
  float* upper = nullptr;  ///< f is at most this, but for Tape::enclosure_slack
  float* slope[3] = {};    ///< for whoever wants gradients
  float* lower = nullptr;
  float* nothing = nullptr;  ///< zeros

  void take(Arena& arena, std::size_t room, int dimension);
};

/// How far places may be off in a query with coordinates of this size, rounded up.
[[nodiscard]] float place_rounding(double largest);
/// To float32, upward.
[[nodiscard]] float rounded_up(double x);

/// Fills in value, lower and upper.
void prove_points(const Tape& tape, const Kernels& kernels, const ProvenPoints& points, float* kernel_scratch);

/// Settles what a local method found: `witness`, and `slack` as the proven error of each value. `largest(q)` is the
/// size of a query's coordinates.
template <class Largest>
void prove_incumbents(const QueryTile& tile, QueryState& state, float* kernel_scratch, Arena& arena,
                      Largest&& largest) {
  ProvenPoints points;
  points.take(arena, tile.count, tile.tape->dimension);
  points.count = tile.count;
  for (int axis = 0; axis < tile.tape->dimension; ++axis) points.at[axis] = state.point[axis];
  for (std::size_t q = 0; q < tile.count; ++q) points.place[q] = place_rounding(largest(q));
  prove_points(*tile.tape, *tile.kernels, points, kernel_scratch);
  for (std::size_t q = 0; q < tile.count; ++q) {
    if (state.is_bad[q] != 0) continue;
    const double upper = static_cast<double>(points.upper[q]) + tile.tape->enclosure_slack(largest(q));
    state.value[q] = points.value[q];
    state.slack[q] = rounded_up(upper - static_cast<double>(points.value[q]));
    state.witness[q] = upper < 0 ? 1 : 0;
    if (tile.limits->goal == Goal::verdict) state.converged[q] = state.witness[q];
  }
}

/// Where no value was found at all: NaN, and nothing proven.
void conclude_undefined(QueryState& state, std::size_t q);

}  // namespace thalweg
