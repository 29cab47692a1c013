// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A counting sort over the cells of a coarse grid, its passes over the rows on all threads but for the last.
#include "order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "schedule.h"

namespace thalweg {
namespace {

constexpr std::size_t kRowsPerTask = 8192;
/// About so many rows say where the grid of cells lies.
constexpr std::size_t kSampledRows = 4096;
/// Of each axis: some cells a row, but no more than 2^16 in the plane and 2^15 in space.
std::size_t halvings_for(std::size_t dimension, std::size_t count) {
  return std::min<std::size_t>(dimension == 2 ? 8 : 5, static_cast<std::size_t>(std::bit_width(count)) / dimension + 1);
}

/// The bits of a number below 2^8 with dimension - 1 zeros after each.
constexpr std::array<std::uint32_t, 256> spread_bits(std::size_t dimension) {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    for (std::uint32_t bit = 0; bit < 8; ++bit)
      table[i] |= (i >> bit & 1) << bit * static_cast<std::uint32_t>(dimension);
  }
  return table;
}
constexpr std::array<std::uint32_t, 256> kSpread[2] = {spread_bits(2), spread_bits(3)};

/// The cells of a box: bits of the axes interleaved.
class Cells {
 public:
  Cells(const RowLayout& layout, const Extent& extent, std::size_t halvings) : spread_(kSpread[layout.dimension - 2]) {
    const auto cells = static_cast<float>(std::size_t{1} << halvings);
    last_ = cells - 1;
    for (std::size_t axis = 0; axis < layout.dimension; ++axis) {
      const float size = extent.hi[axis] - extent.lo[axis];
      lo_[axis] = size > 0 ? extent.lo[axis] : 0;  // there may be no extent
      per_unit_[axis] = size > 0 ? cells / size : 0;
    }
  }
  /// Of the middle of a row's box; 0 for rows that cannot be answered.
  [[nodiscard]] std::uint16_t of(const Extent& row, std::size_t dimension) const {
    if (!(row.lo[0] <= row.hi[0])) return 0;
    std::uint32_t key = 0;
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      const float at = std::clamp((row.middle(axis) - lo_[axis]) * per_unit_[axis], 0.0F, last_);
      key |= spread_[static_cast<std::size_t>(at)] << axis;
    }
    return static_cast<std::uint16_t>(key);
  }

 private:
  const std::array<std::uint32_t, 256>& spread_;
  float last_ = 0;
  float lo_[3] = {};
  float per_unit_[3] = {};
};

}  // namespace

void SpatialOrder::sort(const RowLayout& layout, const float* rows, std::size_t count, const Execution& execution) {
  layout_ = layout;
  halvings_ = halvings_for(layout.dimension, count);
  found_.assign(worker_count(execution), {});
  cell_.resize(count);
  with_row(layout, [&]<class Row>(Row row) {
    sample_ = {};
    for (std::size_t i = 0; i < count; i += std::max<std::size_t>(count / kSampledRows, 1)) {
      const Extent own = row.extent(rows + i * Row::kWidth);
      if (!(own.lo[0] <= own.hi[0])) continue;
      Extent middle;
      for (std::size_t axis = 0; axis < Row::kAxes; ++axis) middle.lo[axis] = middle.hi[axis] = own.middle(axis);
      sample_.add(middle);
    }
    const Cells cells(layout, sample_, halvings_);
    prepare_rows(count, kRowsPerTask, execution, [&](std::size_t begin, std::size_t end, std::size_t worker) {
      Extent extent;
      for (std::size_t i = begin; i < end; ++i) {
        const Extent own = row.extent(rows + i * Row::kWidth);
        extent.add(own);
        cell_[i] = cells.of(own, Row::kAxes);
      }
      found_[worker].add(extent);
    });
  });
  all_ = {};
  for (const Extent& extent : found_) all_.add(extent);
  begin_.assign((std::size_t{1} << levels()) + 1, 0);
  for (const std::uint16_t cell : cell_) ++begin_[cell + std::size_t{1}];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  rows_.resize(count);
  for (std::size_t i = 0; i < count; ++i) rows_[begin_[cell_[i]]++] = static_cast<std::uint32_t>(i);
  // Each entry has moved on to the next cell's first row.
  std::move_backward(begin_.begin(), begin_.end() - 1, begin_.end());
  begin_[0] = 0;
}

Extent SpatialOrder::extent_of(std::size_t first_cell, int level) const {
  Extent box;
  const auto cells = static_cast<double>(std::size_t{1} << halvings_);
  for (std::size_t axis = 0; axis < layout_.dimension; ++axis) {
    std::size_t index = 0, wide = 1;
    for (std::size_t bit = axis, place = 0; bit < static_cast<std::size_t>(levels());
         bit += layout_.dimension, ++place) {
      index |= (first_cell >> bit & 1) << place;
      if (bit < static_cast<std::size_t>(level)) wide *= 2;
    }
    const auto lo = static_cast<double>(sample_.lo[axis]), hi = static_cast<double>(sample_.hi[axis]);
    const double size = (hi - lo) / cells;
    // A cell's number is rounded, and its rows reach beyond it by half their size.
    const double margin =
        0.01 * size + 1e-6 * std::max(std::fabs(lo), std::fabs(hi)) + 0.501 * static_cast<double>(all_.largest_row);
    // The cells at the rim hold what lies outside of the sample.
    const bool is_first = index == 0 || !(hi > lo);
    const bool is_last = index + wide == std::size_t{1} << halvings_ || !(hi > lo);
    box.lo[axis] = is_first ? all_.lo[axis] : static_cast<float>(lo + static_cast<double>(index) * size - margin);
    box.hi[axis] = is_last ? all_.hi[axis] : static_cast<float>(lo + static_cast<double>(index + wide) * size + margin);
  }
  box.largest_row = all_.largest_row;
  return box;
}

}  // namespace thalweg
