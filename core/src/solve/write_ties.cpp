// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/write_ties.h"

#include <algorithm>
#include <limits>

#include "gradient/ties.h"

namespace thalweg {
namespace {

class TieWriter {
 public:
  TieWriter(const QueryTile& tile, const QueryState& state, Arena& arena)
      : tile_(tile), state_(state), arena_(arena), d_(static_cast<std::size_t>(tile.tape->dimension)) {}

  void run(float* kernel_scratch) {
    auto* rows = arena_.take<std::uint32_t>(tile_.count);
    std::size_t count = 0;
    for (std::size_t q = 0; q < tile_.count; ++q) {
      if (wants_ambiguous(q) || wants_sides(q)) rows[count++] = static_cast<std::uint32_t>(q);
    }
    if (count == 0) return mark_bad_rows();
    float* points[3] = {};
    for (std::size_t axis = 0; axis < d_; ++axis) {
      points[axis] = arena_.take<float>(padded(count));
      for (std::size_t i = 0; i < count; ++i) points[axis][i] = state_.point[axis][rows[i]];
    }
    const Ties ties = Ties::make(arena_, tile_.tape->dimension, count, tile_.columns.one_sided != nullptr);
    find_ties(*tile_.tape, *tile_.kernels, points, count, ties, kernel_scratch, arena_);
    for (std::size_t i = 0; i < count; ++i) {
      if (ties.tied[i] != 0 && wants_ambiguous(rows[i])) tile_.columns.ambiguous[rows[i]] = 1;
      if (wants_sides(rows[i])) write_sides(rows[i], ties, i);
    }
    mark_bad_rows();
  }

 private:
  void mark_bad_rows() const {
    if (tile_.columns.one_sided == nullptr) return;
    for (std::size_t q = 0; q < tile_.count; ++q) {
      if (state_.is_bad[q] != 0) {
        std::fill_n(tile_.columns.one_sided + 2 * d_ * q, 2 * d_, std::numeric_limits<float>::quiet_NaN());
      }
    }
  }
  [[nodiscard]] bool wants_ambiguous(std::size_t q) const {
    const bool separated = state_.lower[q] > 0;
    return tile_.columns.ambiguous != nullptr && state_.is_bad[q] == 0 &&
           !(separated && tile_.limits->goal == Goal::verdict);
  }
  [[nodiscard]] bool wants_sides(std::size_t q) const {
    return tile_.columns.one_sided != nullptr && state_.is_bad[q] == 0;
  }

  void write_sides(std::size_t q, const Ties& ties, std::size_t i) const {
    for (std::size_t side = 0; side < 2; ++side) {
      float* to = tile_.columns.one_sided + (2 * q + side) * d_;
      for (std::size_t axis = 0; axis < d_; ++axis) to[axis] = ties.sides[side][axis][i];
    }
  }

  const QueryTile& tile_;
  const QueryState& state_;
  Arena& arena_;
  std::size_t d_;
};

}  // namespace

void write_ties(const QueryTile& tile, const QueryState& state, float* kernel_scratch, Arena& arena) {
  TieWriter(tile, state, arena).run(kernel_scratch);
}

}  // namespace thalweg
