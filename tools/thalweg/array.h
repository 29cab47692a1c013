// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The arrays that commands read and write: float32 rows in, typed columns out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg::cli {

/// A float32 array in C order.
struct Array {
  std::vector<std::size_t> shape;
  std::vector<float> values;  ///< as many as the product of the shape
};

/// Rows of a known inner shape, for readers of formats that carry none (CSV, meshes).
struct RowShape {
  std::vector<std::size_t> inner;  ///< {2}: points of the plane; {3, 2}: triangles of the plane
  std::string_view noun;           ///< what a row is: `points`, `circles`, `triangles`

  [[nodiscard]] std::size_t width() const;  ///< numbers in a row
  [[nodiscard]] int dimension() const;      ///< the last inner number
};

enum class Dtype : std::uint8_t { float32, float64, uint8, uint32 };

[[nodiscard]] std::size_t size_of(Dtype dtype);
[[nodiscard]] std::string_view descr(Dtype dtype);  ///< as NPY headers spell it: `<f4`

/// One array to be written; the caller owns the numbers.
struct Column {
  std::string name;
  Dtype dtype = Dtype::float32;
  std::vector<std::size_t> shape;
  const void* numbers = nullptr;

  [[nodiscard]] std::size_t byte_count() const;
};

/// `(3, 2)`, `(5,)`, `()`: as NumPy prints a shape.
[[nodiscard]] std::string shape_text(std::span<const std::size_t> shape);

/// `(N, 3, 2)`: the shape that an array of such rows must have.
[[nodiscard]] std::string shape_text(const RowShape& row);

/// A double as the nearest float32; beyond its range an infinity, which makes a bad row.
[[nodiscard]] float to_float32(double number);

}  // namespace thalweg::cli
