// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Long tapes: rows are taken in spatial order, a block of neighbouring tiles at a time, and each tile is answered by a
// tape shortened for where its rows lie. Analysing a tape costs about a value of it per region, and as many regions as
// there are lanes cost no more than one: a block shortens once for itself, then for all of its tiles together. Ordering
// and analysis cost about a hundred nanoseconds a row.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "compile/shorten.h"
#include "gradient/ties.h"
#include "order.h"

namespace thalweg {

/// Rows of a tile and tiles of a block.
inline constexpr std::size_t kOrderedTile = 512;
inline constexpr std::size_t kBlockTiles = 32;

/// One worker's rows and tapes.
class OrderedRows {
 public:
  /// Rows are evaluated at most `around` times their own size away from themselves; with bounds over their cells or
  /// not.
  OrderedRows(const Tape& tape, const RowLayout& layout, bool asks_bounds, float around)
      : tape_(tape), layout_(layout), asks_bounds_(asks_bounds), around_(around), block_tape_(tape), tile_tape_(tape) {
    shortener_.begin(tape);
  }

  /// Gathers a block of rows by their indices, and shortens the tape for it; `tile` rows make a tile.
  void take(const float* rows, std::span<const std::uint32_t> order, std::size_t tile, const Kernels& kernels) {
    const std::size_t width = layout_.width();
    rows_.resize(order.size() * width);
    regions_.clear();
    Extent block;
    for (std::size_t begin = 0; begin < order.size(); begin += tile) {
      Extent extent;
      for (std::size_t i = begin; i < std::min(begin + tile, order.size()); ++i) {
        const float* from = rows + order[i] * width;
        for (std::size_t k = 0; k < width; ++k) rows_[i * width + k] = from[k];
        extent.add(layout_, from);
        block.add(layout_, from);
      }
      regions_.push_back(region_of(extent));
    }
    const Region whole = region_of(block);
    shortener_.analyse(tape_, kernels, {&whole, 1});
    shortener_.shorten(0, block_tape_);
    shortener_.analyse(block_tape_, kernels, regions_);
  }

  [[nodiscard]] const float* rows() const { return rows_.data(); }
  /// The tape for one tile of the block, valid until the next call.
  [[nodiscard]] const Tape& tape_of(std::size_t tile) {
    shortener_.shorten(tile, tile_tape_);
    return tile_tape_;
  }

 private:
  [[nodiscard]] Region region_of(const Extent& extent) const {
    Region region;
    double square = 0;
    float largest = 0;
    for (std::size_t axis = 0; axis < layout_.dimension; ++axis) {
      largest = std::max({largest, std::fabs(extent.lo[axis]), std::fabs(extent.hi[axis])});
      region.centre[axis] = 0.5F * (extent.lo[axis] + extent.hi[axis]);
      const double half = std::max(static_cast<double>(extent.hi[axis]) - static_cast<double>(region.centre[axis]),
                                   static_cast<double>(region.centre[axis]) - static_cast<double>(extent.lo[axis]));
      square += half * half;
    }
    // Kinks are looked for a little way around the rows.
    const float around = std::max(tie_reach(tape_, largest), around_ * extent.largest_row);
    region.reach = static_cast<float>((std::sqrt(square) + static_cast<double>(around)) * 1.000001);
    region.cell_reach = asks_bounds_ ? extent.largest_row : 0;
    return region;
  }

  const Tape& tape_;
  RowLayout layout_;
  bool asks_bounds_;
  float around_;
  Shortener shortener_;
  Tape block_tape_, tile_tape_;
  std::vector<float> rows_;
  std::vector<Region> regions_;
};

}  // namespace thalweg
