// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "solve/sweep/path.h"

namespace thalweg {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <class T>
void put(T* column, std::size_t row, T value) {
  if (column != nullptr) column[row] = value;
}

/// What is proven of one query.
struct Bracket {
  Status status = Status::separated;
  float lower = 1, upper = 1;
  bool contact = false;
};

Bracket bracket_of(const SweepState& state, std::size_t q) {
  Bracket found;
  found.contact = std::isfinite(state.upper[q]);
  const bool open = std::isfinite(state.open_lower[q]);
  if (found.contact) {
    found.status = Status::overlapping;
    found.upper = state.upper[q];
    found.lower = std::max(std::min(state.open_lower[q], found.upper - state.tolerance[q]), 0.0F);
  } else if (open) {
    found.status = state.spent[q] != 0 ? Status::undecided : Status::touching;
    found.lower = state.open_lower[q];
    found.upper = state.open_upper[q];
  }
  return found;
}

void write_bracket(const SweepTile& tile, std::size_t q, const Bracket& found) {
  const SweepColumns& out = tile.columns;
  put(out.status, q, static_cast<std::uint8_t>(found.status));
  put(out.toi_lower, q, found.lower);
  put(out.toi_upper, q, found.upper);
  const bool converged = found.status != Status::undecided && found.upper - found.lower <= tile.tolerance * 1.0001F;
  put(out.converged, q, static_cast<std::uint8_t>(converged ? 1 : 0));
}

void write_bad_row(const SweepTile& tile, std::size_t q) {
  write_bracket(tile, q, {.status = Status::bad_row, .lower = kNan, .upper = kNan});
  put(tile.columns.evaluations, q, std::uint32_t{0});
}

void write_nowhere(const SweepTile& tile, std::size_t q) {
  const auto d = static_cast<std::size_t>(tile.tape->dimension);
  put(tile.columns.value, q, kNan);
  for (float* vectors : {tile.columns.point, tile.columns.normal}) {
    if (vectors != nullptr) std::fill_n(vectors + q * d, d, kNan);
  }
  if (tile.columns.barycentric != nullptr) std::fill_n(tile.columns.barycentric + q * 3, 3, kNan);
}

/// A vector of the scene's frame, turned as the scene is.
void turned(const ScenePlace& place, const double* vector, int dimension, double* to) {
  for (int row = 0; row < dimension; ++row) {
    to[row] = 0;
    for (int column = 0; column < dimension; ++column) to[row] += place.rotation[3 * row + column] * vector[column];
  }
}

/// The contacts of a tile side by side, for one gradient pass.
class Contacts {
 public:
  Contacts(const SweepTile& tile, const SweepState& state, Arena& arena)
      : tile_(tile), state_(state), d_(tile.tape->dimension) {
    const std::size_t room = padded(tile.queries.count);
    rows_ = arena.take<std::uint32_t>(room);
    for (int axis = 0; axis < d_; ++axis) {
      point_[axis] = arena.take<float>(room);
      gradient_[axis] = arena.take<float>(room);
    }
  }
  void add(std::size_t q) {
    rows_[count_] = static_cast<std::uint32_t>(q);
    for (int axis = 0; axis < d_; ++axis) point_[axis][count_] = state_.point[axis][q];
    ++count_;
  }
  void write(float* kernel_scratch) const {
    if (count_ == 0) return;
    if (tile_.columns.normal != nullptr) {
      tile_.kernels->gradient(*tile_.tape, point_, count_, nullptr, gradient_, kernel_scratch);
    }
    for (std::size_t i = 0; i < count_; ++i) write(i);
  }

 private:
  void write(std::size_t i) const {
    const SweepColumns& out = tile_.columns;
    const std::size_t q = rows_[i], d = static_cast<std::size_t>(d_);
    const ScenePlace place = place_of_scene(tile_, q, static_cast<double>(state_.upper[q]));
    put(out.value, q, state_.value[q]);
    if (out.barycentric != nullptr) {
      const float u = state_.barycentric[0][q], v = state_.barycentric[1][q];
      const float all[3] = {std::max(1 - u - v, 0.0F), u, v};
      std::copy_n(all, 3, out.barycentric + 3 * q);
    }
    double at[3] = {}, there[3] = {};
    for (int axis = 0; axis < d_; ++axis) at[axis] = static_cast<double>(point_[axis][i]);
    turned(place, at, d_, there);
    for (std::size_t axis = 0; axis < d && out.point != nullptr; ++axis) {
      out.point[q * d + axis] = static_cast<float>(there[axis] + place.translation[axis]);
    }
    if (out.normal == nullptr) return;
    double square = 0;
    for (int axis = 0; axis < d_; ++axis) {
      at[axis] = static_cast<double>(gradient_[axis][i]);
      square += at[axis] * at[axis];
    }
    // Where the gradient vanishes the last axis stands in.
    if (!(square > 1e-6)) {
      std::fill_n(at, d_, 0.0);
      at[d_ - 1] = square = 1;
    }
    turned(place, at, d_, there);
    for (std::size_t axis = 0; axis < d; ++axis) {
      out.normal[q * d + axis] = static_cast<float>(there[axis] / std::sqrt(square));
    }
  }

  const SweepTile& tile_;
  const SweepState& state_;
  int d_;
  std::size_t count_ = 0;
  std::uint32_t* rows_ = nullptr;
  float* point_[3] = {};
  float* gradient_[3] = {};
};

}  // namespace

SweepState SweepState::make(Arena& arena, std::size_t count) {
  SweepState s;
  for (float** column : {&s.upper, &s.tolerance, &s.open_lower, &s.open_upper, &s.value, &s.point[0], &s.point[1],
                         &s.point[2], &s.barycentric[0], &s.barycentric[1], &s.is_bad}) {
    *column = arena.take<float>(count);
  }
  s.evaluations = arena.take<std::uint32_t>(count);
  s.spent = arena.take<std::uint8_t>(count);
  std::fill_n(s.spent, count, std::uint8_t{0});
  return s;
}

void finish_sweeps(const SweepTile& tile, const SweepState& state, float* kernel_scratch, Arena& arena) {
  Contacts contacts(tile, state, arena);
  for (std::size_t q = 0; q < tile.queries.count; ++q) {
    if (state.is_bad[q] != 0) {
      write_bad_row(tile, q);
      write_nowhere(tile, q);
      continue;
    }
    const Bracket found = bracket_of(state, q);
    write_bracket(tile, q, found);
    put(tile.columns.evaluations, q, state.evaluations[q]);
    found.contact ? contacts.add(q) : write_nowhere(tile, q);
  }
  contacts.write(kernel_scratch);
}

}  // namespace thalweg
