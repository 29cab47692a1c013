// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/finish.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Status status_of(const QueryState& s, std::size_t q, float tolerance) {
  if (s.is_bad[q] != 0) return Status::bad_row;
  if (s.lower[q] > 0) return Status::separated;
  if (s.witness[q] != 0) return Status::overlapping;
  const bool brackets_zero = s.value[q] + s.slack[q] <= tolerance && s.lower[q] >= -tolerance;
  return brackets_zero ? Status::touching : Status::undecided;
}

void write_verdicts(const QueryTile& tile, const QueryState& s) {
  const CollideColumns& out = tile.columns;
  const auto tolerance = static_cast<float>(tile.limits->tolerance);
  for (std::size_t q = 0; q < tile.count; ++q) {
    if (out.status != nullptr) out.status[q] = static_cast<std::uint8_t>(status_of(s, q, tolerance));
    if (out.converged != nullptr) out.converged[q] = s.is_bad[q] != 0 ? 0 : s.converged[q];
    if (out.claimed != nullptr) out.claimed[q] = s.is_bad[q] == 0 && s.value[q] < 0 ? 1 : 0;
    if (out.starts != nullptr) out.starts[q] = s.is_bad[q] != 0 ? 0 : tile.limits->starts;
    if (out.iterations != nullptr) out.iterations[q] = s.is_bad[q] != 0 ? 0 : s.iterations[q];
    if (out.evaluations != nullptr) out.evaluations[q] = s.is_bad[q] != 0 ? 0 : s.evaluations[q];
  }
}

void write_values(const QueryTile& tile, const QueryState& s) {
  const CollideColumns& out = tile.columns;
  const auto d = static_cast<std::size_t>(tile.tape->dimension);
  for (std::size_t q = 0; q < tile.count; ++q) {
    const bool bad = s.is_bad[q] != 0;
    if (out.value != nullptr) out.value[q] = bad ? kNan : s.value[q];
    if (out.lower != nullptr) out.lower[q] = bad ? kNan : std::min(s.lower[q], s.value[q]);
    if (out.point != nullptr) {
      for (std::size_t axis = 0; axis < d; ++axis) out.point[q * d + axis] = bad ? kNan : s.point[axis][q];
    }
    if (out.barycentric != nullptr) {
      const float u = s.barycentric[0][q];
      const float v = s.barycentric[1][q];
      const float weights[3] = {std::max(0.0F, 1 - u - v), u, v};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        out.barycentric[q * 3 + corner] = bad ? kNan : weights[corner];
      }
    }
  }
}

void write_normals(const QueryTile& tile, const QueryState& s, float* kernel_scratch, Arena& arena) {
  const CollideColumns& out = tile.columns;
  if (out.normal == nullptr && out.ambiguous == nullptr) return;
  const auto d = static_cast<std::size_t>(tile.tape->dimension);
  const std::size_t room = padded(tile.count);
  float* value = arena.take<float>(room);
  float* gradient[3] = {};
  for (std::size_t axis = 0; axis < d; ++axis) gradient[axis] = arena.take<float>(room);
  tile.kernels->gradient(*tile.tape, s.point, tile.count, value, gradient, kernel_scratch);
  for (std::size_t q = 0; q < tile.count; ++q) {
    float square = 0;
    for (std::size_t axis = 0; axis < d; ++axis) square += gradient[axis][q] * gradient[axis][q];
    const bool bad = s.is_bad[q] != 0;
    const bool vanishes = !(square > 1e-6F);
    const float inverse = vanishes ? 0 : 1 / std::sqrt(square);
    if (out.ambiguous != nullptr) out.ambiguous[q] = !bad && vanishes ? 1 : 0;
    if (out.normal == nullptr) continue;
    for (std::size_t axis = 0; axis < d; ++axis) {
      const float fixed = axis + 1 == d ? 1.0F : 0.0F;
      out.normal[q * d + axis] = bad ? kNan : vanishes ? fixed : gradient[axis][q] * inverse;
    }
  }
}

}  // namespace

QueryState QueryState::make(Arena& arena, int dimension, std::size_t count) {
  const std::size_t room = padded(count);
  QueryState s;
  for (int axis = 0; axis < dimension; ++axis) s.point[axis] = arena.take<float>(room);
  s.value = arena.take<float>(room);
  s.lower = arena.take<float>(room);
  s.slack = arena.take<float>(room);
  for (float*& column : s.barycentric) column = arena.take<float>(room);
  s.evaluations = arena.take<std::uint32_t>(room);
  s.iterations = arena.take<std::uint32_t>(room);
  s.witness = arena.take<std::uint8_t>(room);
  s.converged = arena.take<std::uint8_t>(room);
  s.is_bad = arena.take<std::uint8_t>(room);
  return s;
}

void finish(const QueryTile& tile, const QueryState& state, float* kernel_scratch, Arena& arena) {
  write_verdicts(tile, state);
  write_values(tile, state);
  write_normals(tile, state, kernel_scratch, arena);
}

}  // namespace thalweg
