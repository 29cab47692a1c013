// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A counting sort over the cells of a coarse grid: two passes over the rows, whatever their number.
#include "order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernels/kernels.h"

namespace thalweg {
namespace {

/// Bits of a cell's number per axis: 2^16 cells in the plane, 2^15 in space.
constexpr int bits_per_axis(std::size_t dimension) { return dimension == 2 ? 8 : 5; }

bool is_answerable(const RowLayout& layout, const float* row) {
  return std::all_of(row, row + layout.width(), [](float x) { return std::fabs(x) <= kLargestCoordinate; });
}

/// The grid of cells over all rows.
class Grid {
 public:
  Grid(const RowLayout& layout, const Extent& extent) : layout_(layout), bits_(bits_per_axis(layout.dimension)) {
    const auto cells = static_cast<float>(1 << bits_);
    for (std::size_t axis = 0; axis < layout.dimension; ++axis) {
      const float size = extent.hi[axis] - extent.lo[axis];
      lo_[axis] = extent.lo[axis];
      per_unit_[axis] = size > 0 ? cells / size : 0;
    }
  }
  [[nodiscard]] std::size_t cells() const {
    return std::size_t{1} << (static_cast<std::size_t>(bits_) * layout_.dimension);
  }

  /// The cell of a row's first point, bits of the axes interleaved; 0 for rows that cannot be answered.
  [[nodiscard]] std::size_t cell(const float* row) const {
    if (!is_answerable(layout_, row)) return 0;
    const auto last = static_cast<float>((1 << bits_) - 1);
    std::size_t key = 0;
    for (std::size_t axis = 0; axis < layout_.dimension; ++axis) {
      const float at = std::clamp((row[axis] - lo_[axis]) * per_unit_[axis], 0.0F, last);
      const auto index = static_cast<std::size_t>(at);
      for (int bit = 0; bit < bits_; ++bit) {
        key |= (index >> bit & 1) << (static_cast<std::size_t>(bit) * layout_.dimension + axis);
      }
    }
    return key;
  }

 private:
  RowLayout layout_;
  int bits_;
  float lo_[3] = {};
  float per_unit_[3] = {};
};

}  // namespace

void Extent::add(const RowLayout& layout, const float* row) {
  if (!is_answerable(layout, row)) return;
  const float radius = layout.has_radius ? std::fabs(row[layout.dimension]) : 0;
  double square = 0;
  for (std::size_t axis = 0; axis < layout.dimension; ++axis) {
    float least = row[axis];
    float most = row[axis];
    for (std::size_t p = 1; p < layout.points; ++p) {
      least = std::min(least, row[p * layout.dimension + axis]);
      most = std::max(most, row[p * layout.dimension + axis]);
    }
    least -= radius;
    most += radius;
    lo[axis] = is_empty ? least : std::min(lo[axis], least);
    hi[axis] = is_empty ? most : std::max(hi[axis], most);
    square += static_cast<double>(most - least) * static_cast<double>(most - least);
  }
  largest_row = std::max(largest_row, static_cast<float>(std::sqrt(square) * 1.000001));
  is_empty = false;
}

std::vector<std::uint32_t> spatial_order(const RowLayout& layout, const float* rows, std::size_t count) {
  Extent extent;
  RowLayout first_points = layout;
  first_points.points = 1;
  for (std::size_t i = 0; i < count; ++i) extent.add(first_points, rows + i * layout.width());
  const Grid grid(layout, extent);
  std::vector<std::uint16_t> cell(count);
  std::vector<std::size_t> next(grid.cells() + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    cell[i] = static_cast<std::uint16_t>(grid.cell(rows + i * layout.width()));
    ++next[cell[i] + std::size_t{1}];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<std::uint32_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[next[cell[i]]++] = static_cast<std::uint32_t>(i);
  return order;
}

}  // namespace thalweg
