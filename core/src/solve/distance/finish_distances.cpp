// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "solve/distance/distance_tile.h"
#include "solve/pairs/problem.h"

namespace thalweg {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The float32 number next to x that is not above it, or not below it.
float rounded(double x, float toward) {
  const auto nearest = static_cast<float>(x);
  const bool passed = toward < 0 ? static_cast<double>(nearest) > x : static_cast<double>(nearest) < x;
  return passed ? std::nextafter(nearest, toward) : nearest;
}

template <class T>
void put(T* column, std::size_t row, T value) {
  if (column != nullptr) column[row] = value;
}
template <class T>
void put_vector(float* column, std::size_t row, const T* vector, int dimension) {
  if (column == nullptr) return;
  const auto d = static_cast<std::size_t>(dimension);
  for (std::size_t axis = 0; axis < d; ++axis) column[row * d + axis] = static_cast<float>(vector[axis]);
}

int dimension_of(const PairTile& tile, std::size_t row) {
  return tile.queries->shapes[shapes_of(*tile.queries, row).first]->dimension;
}

}  // namespace

void write_distance(const DistanceTile& tile, std::size_t row, const DistanceFinding& found) {
  const int dimension = dimension_of(tile.pairs, row);
  const DistanceColumns& out = tile.columns;
  put(out.status, row, static_cast<std::uint8_t>(found.status));
  put(out.distance, row, rounded(found.upper, kInfinity));
  put(out.lower, row, std::max(rounded(found.lower, -kInfinity), 0.0F));
  put_vector(out.point_a, row, found.a, dimension);
  put_vector(out.point_b, row, found.b, dimension);
  put_vector(out.normal, row, found.normal, dimension);
  put(out.converged, row, static_cast<std::uint8_t>(found.converged ? 1 : 0));
  put(out.evaluations, row, found.evaluations);
}

void write_empty_distance(const DistanceTile& tile, std::size_t row) {
  DistanceFinding found;
  found.status = Status::separated;
  found.lower = std::numeric_limits<double>::infinity();
  found.normal[dimension_of(tile.pairs, row) - 1] = 1;
  found.converged = true;
  write_distance(tile, row, found);
}

void write_bad_distance(const DistanceTile& tile, std::size_t row) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  DistanceFinding nothing;
  nothing.status = Status::bad_row;
  std::fill_n(nothing.normal, 3, static_cast<float>(kNan));
  write_distance(tile, row, nothing);
  put(tile.columns.distance, row, static_cast<float>(kNan));
  put(tile.columns.lower, row, static_cast<float>(kNan));
}

}  // namespace thalweg
