// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Gradients of a shape at a few points, through the public batch query, with what the tests of the strategies compare
// them by.
#pragma once

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "thalweg/batch.h"

namespace thalweg::testing_gradients {

inline Tape compiled(const Shape& shape) { return std::move(compile(shape)).value(); }

struct Asked {
  std::size_t dimension = 2;
  std::vector<float> points, value, gradient, witness;
  std::vector<std::uint32_t> evaluations;

  [[nodiscard]] std::size_t count() const { return value.size(); }
  [[nodiscard]] const float* point(std::size_t i) const { return points.data() + i * dimension; }
  [[nodiscard]] const float* direction(std::size_t i) const { return gradient.data() + i * dimension; }
};

inline Asked ask(const Tape& tape, const std::vector<float>& points, const GradientOptions& options) {
  Asked asked;
  asked.dimension = static_cast<std::size_t>(tape.dimension);
  asked.points = points;
  const std::size_t count = points.size() / asked.dimension;
  asked.value.resize(count);
  asked.gradient.resize(points.size());
  asked.evaluations.resize(count);
  PointColumns columns{
      .value = asked.value.data(), .gradient = asked.gradient.data(), .evaluations = asked.evaluations.data()};
  if (options.strategy == Gradient::closest_point) {
    asked.witness.resize(points.size());
    columns.witness = asked.witness.data();
  }
  const auto done = evaluate(tape, Points{points.data(), count}, options, columns, {.threads = 1});
  if (!done) throw std::logic_error(to_string(done.error()));
  return asked;
}

/// The angle between two vectors, in radians; a quarter of a turn when one of them is zero.
template <class A, class B>
double angle_between(const A* a, const B* b, std::size_t dimension) {
  double dot = 0, aa = 0, bb = 0;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const auto x = static_cast<double>(a[axis]), y = static_cast<double>(b[axis]);
    dot += x * y, aa += x * x, bb += y * y;
  }
  // By the sine where the cosine has lost its digits.
  double cross = 0;
  for (std::size_t i = 0; i < dimension; ++i) {
    for (std::size_t j = i + 1; j < dimension; ++j) {
      const double w =
          static_cast<double>(a[i]) * static_cast<double>(b[j]) - static_cast<double>(a[j]) * static_cast<double>(b[i]);
      cross += w * w;
    }
  }
  return aa > 0 && bb > 0 ? std::atan2(std::sqrt(cross), dot) : 1.5707963267948966;
}

}  // namespace thalweg::testing_gradients
