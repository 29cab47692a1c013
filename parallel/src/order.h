// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Rows in the order of a space-filling curve (Morton 1966), so that a run of them lies close together.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/kernels.h"
#include "thalweg/batch.h"

namespace thalweg {

/// What a row of numbers holds: points, and for circles a radius after them. Two points are corners of a box.
struct RowLayout {
  std::size_t dimension = 2;
  std::size_t points = 1;
  bool has_radius = false;
  [[nodiscard]] std::size_t width() const { return points * dimension + (has_radius ? 1 : 0); }
};

/// The box around some rows. Rows that cannot be answered are left out.
struct Extent {
  float lo[3];
  float hi[3];
  float largest_row = 0;  ///< greatest diagonal of one row's own box

  Extent() {  // of no row: lo > hi
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::fill_n(lo, 3, kInfinity);
    std::fill_n(hi, 3, -kInfinity);
  }
  [[nodiscard]] float middle(std::size_t axis) const { return 0.5F * (lo[axis] + hi[axis]); }
  void add(const Extent& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], other.lo[axis]);
      hi[axis] = std::max(hi[axis], other.hi[axis]);
    }
    largest_row = std::max(largest_row, other.largest_row);
  }
};

/// A row's own extent, where the layout is known when compiled.
template <std::size_t kDimension, std::size_t kPoints, bool kHasRadius>
struct RowOf {
  static constexpr std::size_t kAxes = kDimension;
  static constexpr std::size_t kWidth = kPoints * kDimension + (kHasRadius ? 1 : 0);

  [[nodiscard]] static bool is_answerable(const float* row) {
    bool good = true;
    for (std::size_t i = 0; i < kWidth; ++i) good &= std::fabs(row[i]) <= kLargestCoordinate;
    return good;
  }
  [[nodiscard]] static Extent extent(const float* row) {
    Extent extent;
    if (!is_answerable(row)) return extent;
    const float radius = kHasRadius ? std::fabs(row[kWidth - 1]) : 0;
    float square = 0, longest = 0;
    for (std::size_t axis = 0; axis < kDimension; ++axis) {
      float least = row[axis], most = row[axis];
      for (std::size_t p = 1; p < kPoints; ++p) {
        least = std::min(least, row[p * kDimension + axis]);
        most = std::max(most, row[p * kDimension + axis]);
      }
      extent.lo[axis] = least - radius;
      extent.hi[axis] = most + radius;
      const float size = extent.hi[axis] - extent.lo[axis];
      longest = std::max(longest, size);
      square += size * size;
    }
    // Six roundings; and what has a size has one when its square underflows.
    extent.largest_row = std::max(longest, std::sqrt(square) * 1.000001F);
    return extent;
  }
};

/// Calls body(RowOf<...>()) for a layout.
template <class Body>
void with_row(const RowLayout& layout, const Body& body) {
  const auto with_dimension = [&]<std::size_t kDimension>() {
    if (layout.points == 3) return body(RowOf<kDimension, 3, false>());
    if (layout.points == 2) return body(RowOf<kDimension, 2, false>());
    return layout.has_radius ? body(RowOf<kDimension, 1, true>()) : body(RowOf<kDimension, 1, false>());
  };
  layout.dimension == 2 ? with_dimension.template operator()<2>() : with_dimension.template operator()<3>();
}

/// A permutation of the rows, sorted by the cells of a grid along the curve: equal cells keep the rows' order, so it
/// depends on the rows alone. Keeps its memory from batch to batch.
class SpatialOrder {
 public:
  void sort(const RowLayout& layout, const float* rows, std::size_t count, const Execution& execution);

  [[nodiscard]] const std::vector<std::uint32_t>& rows() const { return rows_; }
  /// There are 2^levels cells, and an aligned run of 2^level of them is a box: halving the run halves the box.
  [[nodiscard]] int levels() const { return static_cast<int>(halvings_ * layout_.dimension); }
  /// Where in rows() those of a cell begin.
  [[nodiscard]] std::uint32_t begin_of(std::size_t cell) const { return begin_[cell]; }
  /// A box that holds all rows whose middle lies in an aligned run of 2^level cells.
  [[nodiscard]] Extent extent_of(std::size_t first_cell, int level) const;

 private:
  RowLayout layout_;
  Extent sample_;  ///< middles of some rows: where the grid lies
  Extent all_;
  std::size_t halvings_ = 0;  ///< of each axis
  std::vector<std::uint32_t> rows_, begin_;
  std::vector<std::uint16_t> cell_;  ///< of each row
  std::vector<Extent> found_;        ///< per worker
};

}  // namespace thalweg
