// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What `thalweg stress` asks of a scene: triangles and points over the region of its shape, and the shape repeated on a
// grid for larger scenes at the same density.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "collide_result.h"
#include "thalweg/batch.h"
#include "thalweg/shape.h"

namespace thalweg::cli {

/// A shape compiled, with random queries over its region and room for their answers.
class StressWorkload {
 public:
  /// `count` triangles and as many points, uniform over the shape's bounds grown by a quarter; each vertex lies off its
  /// triangle's centre by up to `reach` along every axis. An unbounded shape is asked in a box of 20 units.
  StressWorkload(const Shape& shape, std::size_t count, double reach, std::uint64_t seed);

  [[nodiscard]] const Tape& tape() const { return tape_; }
  [[nodiscard]] std::size_t count() const { return result_.status.size(); }
  [[nodiscard]] const std::vector<float>& points() const { return points_; }
  [[nodiscard]] float* values() { return result_.value.data(); }

  /// Each returns how often f was evaluated.
  std::uint64_t collide(std::size_t rows, const CollideOptions& options, const Execution& execution);
  std::uint64_t evaluate_values(std::size_t rows, const Execution& execution);
  std::uint64_t evaluate_gradients(std::size_t rows, Gradient strategy, const Execution& execution);

  /// Whether the scene has a gradient by this strategy: dichotomies are of the plane.
  [[nodiscard]] bool admits(Gradient strategy) const;

  /// Bytes read and written for one triangle with all columns, and for one value at a point.
  [[nodiscard]] std::size_t bytes_per_triangle() const;
  [[nodiscard]] std::size_t bytes_per_value() const;

 private:
  Tape tape_;
  std::vector<float> triangles_, points_, gradients_;
  CollideResult result_;
};

/// The length by which a triangle's vertices lie off its centre: 1/36 of the diagonal of the bounds, as in the thesis.
[[nodiscard]] double stress_reach(const Shape& shape);

/// `copies` of the shape on a square or cubic grid with a gap of a quarter, so that the density of what queries meet
/// stays; the shape itself for one copy. The bounds must be finite.
[[nodiscard]] Shape repeated(const Shape& shape, std::size_t copies);

/// Primitives below a shape, counted as often as they are used.
[[nodiscard]] std::size_t primitive_count(const Shape& shape);

}  // namespace thalweg::cli
