// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Rows in the order of a space-filling curve (Morton 1966), so that a run of them lies close together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// What a row of numbers holds: points, and for circles a radius after them.
struct RowLayout {
  std::size_t dimension = 2;
  std::size_t points = 1;
  bool has_radius = false;
  [[nodiscard]] std::size_t width() const { return points * dimension + (has_radius ? 1 : 0); }
};

/// The box around some rows. Rows that cannot be answered are left out.
struct Extent {
  float lo[3] = {};
  float hi[3] = {};
  float largest_row = 0;  ///< greatest diagonal of one row's own box
  bool is_empty = true;

  void add(const RowLayout& layout, const float* row);
};

/// A permutation of the rows: equal keys keep the rows' order, so it depends on the rows alone.
[[nodiscard]] std::vector<std::uint32_t> spatial_order(const RowLayout& layout, const float* rows, std::size_t count);

}  // namespace thalweg
