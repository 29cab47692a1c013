// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What conformance is tested on, drawn from the op table alone: for every row shapes of ordinary size, shapes with
// parameters at the ends of their ranges and at values that break formulas, and the points where formulas break.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "oracle.h"
#include "random.h"
#include "thalweg/shape.h"
#include "thalweg/simd.h"

namespace thalweg::conformance {

/// `quick`, or twenty times that when the environment has THALWEG_FULL=1.
[[nodiscard]] std::size_t amount(std::size_t quick);

struct Case {
  std::uint64_t seed = 0;
  Shape shape;
};

/// Shapes whose root is this row of the op table, of the order of 1 in size.
[[nodiscard]] std::vector<Case> plain_cases(int op, std::size_t count);
/// The same with extremes of the ranges, sqrt 2, pi, zeros and equal numbers, at scales from 1e-15 to 1e15.
[[nodiscard]] std::vector<Case> spicy_cases(int op, std::size_t count);

/// Points as float32 columns, padded for the kernels.
struct Points {
  explicit Points(int dimension_of_points) : dimension(dimension_of_points) {}
  int dimension = 2;
  std::size_t count = 0;
  std::vector<float> column[3];

  void add(oracle::Vec p);
  [[nodiscard]] oracle::Vec at(std::size_t i) const;
  /// Largest coordinate magnitude of a point, the m of a slack.
  [[nodiscard]] double magnitude(std::size_t i) const;
  /// Fills the columns up to the kernels' padding; call after the last add().
  void pad();
};

/// The centre, the axes, corners of the bounds, edges of folding sectors, the surface and a few ulps beside it, far
/// away, tiny, and at random.
[[nodiscard]] Points spicy_points(oracle::Random& random, const Shape& shape, const oracle::Field& field);
/// Anywhere around the shape.
[[nodiscard]] Points plain_points(oracle::Random& random, const Shape& shape, std::size_t count);

/// A row of the op table on a SIMD target: what most suites are instantiated for.
struct OnTarget {
  int op = 0;
  const Target* target = nullptr;
};
[[nodiscard]] std::vector<OnTarget> every_op_on_every_target();
[[nodiscard]] std::vector<int> every_op();
/// "box_3d", and "rotate_3d_2" for the second of two rows with one name and dimension.
[[nodiscard]] std::string label(int op);
[[nodiscard]] std::string label(const OnTarget& on);
std::ostream& operator<<(std::ostream& out, const OnTarget& on);

}  // namespace thalweg::conformance
