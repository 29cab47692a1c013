// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Shapes and element types of arrays.
#include "array.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace thalweg::cli {

namespace {

std::size_t product(std::span<const std::size_t> numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), std::size_t{1}, std::multiplies<>());
}

}  // namespace

std::size_t RowShape::width() const { return product(inner); }

int RowShape::dimension() const { return static_cast<int>(inner.back()); }

std::size_t size_of(Dtype dtype) {
  switch (dtype) {
    case Dtype::float64:
      return 8;
    case Dtype::uint8:
      return 1;
    case Dtype::float32:
    case Dtype::uint32:
      break;
  }
  return 4;
}

std::string_view descr(Dtype dtype) {
  switch (dtype) {
    case Dtype::float32:
      return "<f4";
    case Dtype::float64:
      return "<f8";
    case Dtype::uint8:
      return "|u1";
    case Dtype::uint32:
      break;
  }
  return "<u4";
}

std::size_t Column::byte_count() const { return product(shape) * size_of(dtype); }

std::string shape_text(std::span<const std::size_t> shape) {
  return shape.size() == 1 ? fmt::format("({},)", shape[0]) : fmt::format("({})", fmt::join(shape, ", "));
}

std::string shape_text(const RowShape& row) { return fmt::format("(N, {})", fmt::join(row.inner, ", ")); }

float to_float32(double number) {
  // Halfway between the largest float32 and the next power of two; from there on rounding gives an infinity.
  constexpr double kOverflow = 0x1.ffffffp127;
  if (std::isnan(number)) return std::numeric_limits<float>::quiet_NaN();
  if (std::fabs(number) >= kOverflow) return static_cast<float>(std::copysign(HUGE_VALF, number));
  return static_cast<float>(number);
}

}  // namespace thalweg::cli
