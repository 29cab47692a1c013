// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "stress_workload.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>

#include "failure.h"
#include "thalweg/ops.h"
#include "uniform.h"

namespace thalweg::cli {

namespace {

constexpr double kUnboundedSide = 20;

/// Where queries lie.
Bounds region_of(const Shape& shape) {
  const int d = shape.dimension();
  Bounds region = shape.facts().bounds;
  const bool bounded = region.finite(d) && region.diagonal(d) > 0;
  for (int axis = 0; axis < d; ++axis) {
    if (!bounded) region.lo[axis] = -kUnboundedSide / 2, region.hi[axis] = kUnboundedSide / 2;
    const double margin = bounded ? (region.hi[axis] - region.lo[axis]) / 8 : 0;
    region.lo[axis] -= margin;
    region.hi[axis] += margin;
  }
  return region;
}

std::vector<float> random_points(const Bounds& region, int dimension, std::size_t count, std::uint64_t seed) {
  Uniform uniform(seed);
  std::vector<float> rows;
  rows.reserve(count * static_cast<std::size_t>(dimension));
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < dimension; ++axis) {
      rows.push_back(static_cast<float>(region.lo[axis] + (region.hi[axis] - region.lo[axis]) * uniform()));
    }
  }
  return rows;
}

std::vector<float> random_triangles(const std::vector<float>& centres, int dimension, double reach,
                                    std::uint64_t seed) {
  Uniform uniform(seed ^ 0x7472);
  const auto d = static_cast<std::size_t>(dimension);
  std::vector<float> rows;
  rows.reserve(3 * centres.size());
  for (std::size_t i = 0; i < centres.size(); i += d) {
    for (std::size_t number = 0; number < 3 * d; ++number) {
      rows.push_back(centres[i + number % d] + static_cast<float>(reach * (2 * uniform() - 1)));
    }
  }
  return rows;
}

}  // namespace

StressWorkload::StressWorkload(const Shape& shape, std::size_t count, double reach, std::uint64_t seed)
    : tape_(unwrap(compile(shape), "stress", "/shape")),
      points_(random_points(region_of(shape), shape.dimension(), count, seed)),
      gradients_(points_.size()),
      result_(QueryKind::triangles, count, shape.dimension()) {
  triangles_ = random_triangles(points_, shape.dimension(), reach, seed);
}

std::uint64_t StressWorkload::collide(std::size_t rows, const CollideOptions& options, const Execution& execution) {
  return unwrap(collide_triangles(tape_, {triangles_.data(), rows}, options, result_.columns(), execution), "stress",
                "collide")
      .evaluations;
}

std::uint64_t StressWorkload::evaluate_values(std::size_t rows, const Execution& execution) {
  evaluate(tape_, points_.data(), rows, result_.value.data(), nullptr, execution);
  return rows;
}

std::uint64_t StressWorkload::evaluate_gradients(std::size_t rows, Gradient strategy, const Execution& execution) {
  const PointColumns columns{.value = result_.value.data(), .gradient = gradients_.data()};
  return unwrap(evaluate(tape_, {points_.data(), rows}, {.strategy = strategy}, columns, execution), "stress",
                "evaluate")
      .evaluations;
}

bool StressWorkload::admits(Gradient strategy) const {
  return static_cast<bool>(evaluate(tape_, Points{}, {.strategy = strategy}, PointColumns{}));
}

std::size_t StressWorkload::bytes_per_triangle() const {
  const auto d = static_cast<std::size_t>(tape_.dimension);
  std::size_t columns = 0;
  for (const Column& column : result_.list()) {
    std::size_t width = 1;
    for (std::size_t i = 1; i < column.shape.size(); ++i) width *= column.shape[i];
    columns += width * size_of(column.dtype);
  }
  return 3 * d * sizeof(float) + columns;
}

std::size_t StressWorkload::bytes_per_value() const {
  return (static_cast<std::size_t>(tape_.dimension) + 1) * sizeof(float);
}

double stress_reach(const Shape& shape) {
  const Bounds region = region_of(shape);
  return region.diagonal(shape.dimension()) / 1.25 / 36;
}

Shape repeated(const Shape& shape, std::size_t copies) {
  if (copies == 1) return shape;
  const int d = shape.dimension();
  const Bounds& bounds = shape.facts().bounds;
  const double root = d == 2 ? std::sqrt(static_cast<double>(copies)) : std::cbrt(static_cast<double>(copies));
  const auto side = static_cast<std::size_t>(std::ceil(root - 1e-9));
  double step[3] = {};
  for (int axis = 0; axis < d; ++axis) step[axis] = 1.25 * (bounds.hi[axis] - bounds.lo[axis]);
  std::vector<Shape> all;
  for (std::size_t i = 0; i < copies; ++i) {
    const auto x = static_cast<double>(i % side), y = static_cast<double>(i / side % side),
               z = static_cast<double>(i / (side * side));
    all.push_back(d == 2 ? shape.translate(Vec2{x * step[0], y * step[1]})
                         : shape.translate(Vec3{x * step[0], y * step[1], z * step[2]}));
  }
  return union_(std::move(all));
}

std::size_t primitive_count(const Shape& shape) {
  std::unordered_map<const void*, std::size_t> known;
  const std::function<std::size_t(const Shape&)> count = [&](const Shape& node) -> std::size_t {
    if (node.operands().empty()) return 1;
    if (const auto found = known.find(node.identity()); found != known.end()) return found->second;
    std::size_t sum = 0;
    for (const Shape& operand : node.operands()) sum += count(operand);
    return known[node.identity()] = sum;
  };
  return count(shape);
}

}  // namespace thalweg::cli
