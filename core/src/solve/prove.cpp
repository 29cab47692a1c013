// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/prove.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

void ProvenPoints::take(Arena& arena, std::size_t room, int dimension) {
  const std::size_t all = padded(room);
  query = arena.take<std::uint32_t>(all);
  for (int axis = 0; axis < dimension; ++axis) {
    at[axis] = arena.take<float>(all);
    slope[axis] = arena.take<float>(all);
    std::fill_n(at[axis], all, 0.0F);
  }
  for (float** column : {&place, &value, &lower, &upper, &nothing}) {
    *column = arena.take<float>(all);
    std::fill_n(*column, all, 0.0F);
  }
}

float rounded_up(double x) {
  const auto nearest = static_cast<float>(x);
  return static_cast<double>(nearest) < x ? std::nextafter(nearest, kInfinity) : nearest;
}

float place_rounding(double largest) { return rounded_up(kPlaceRounding * largest); }

void prove_points(const Tape& tape, const Kernels& kernels, const ProvenPoints& points, float* kernel_scratch) {
  CellColumns cells;
  cells.reach = points.nothing;
  for (int axis = 0; axis < tape.dimension; ++axis) cells.edges[axis] = points.nothing;
  cells.is_box = true;
  cells.place = points.place;
  kernels.ranges(tape, points.at, cells, points.count, {points.lower, points.value, points.upper}, kernel_scratch);
}

void conclude_undefined(QueryState& state, std::size_t q) {
  if (std::fabs(state.value[q]) < kInfinity) return;
  state.value[q] = std::numeric_limits<float>::quiet_NaN();
  if (!(state.lower[q] > 0)) state.lower[q] = -kInfinity;
}

}  // namespace thalweg
