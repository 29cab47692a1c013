// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Points where formulas break, found from a shape's bounds and numbers.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "cases.h"
#include "kernels/kernels.h"
#include "random_queries.h"
#include "thalweg/op_table.h"

namespace thalweg::conformance {
namespace {

using oracle::Field;
using oracle::Random;
using oracle::Vec;

constexpr double kPi = std::numbers::pi;
constexpr double kLargest = 1e15;

const OpRow& row_of(const Shape& shape) { return op_table()[static_cast<std::size_t>(shape.op_index())]; }

/// Half the size of what there is to see: the farthest finite corner of the bounds.
double extent_of(const Shape& shape) {
  double most = 0;
  const Bounds bounds = shape.facts().bounds;
  for (int axis = 0; axis < shape.dimension(); ++axis) {
    if (std::isfinite(bounds.lo[axis])) most = std::max(most, std::fabs(bounds.lo[axis]));
    if (std::isfinite(bounds.hi[axis])) most = std::max(most, std::fabs(bounds.hi[axis]));
  }
  return most > 0 ? std::min(most, kLargest) : 1;
}

/// The centre, the axes at sizes from nothing to far away, and the diagonal.
void add_axes(Points& points, double extent) {
  for (const double size : {0.0, -0.0, 1e-42, 1e-30, 1e-22, 1e-18, 1e-7 * extent, 0.5 * extent, extent,
                            extent * (1 + 0x1p-23), 1.5 * extent, 2 * extent, 1e6 * extent, kLargest}) {
    for (const double x : {size, -size}) {
      points.add({x, 0, 0});
      points.add({0, x, 0});
      points.add({0, 0, x});
      points.add({x, x, x});
      points.add({x, -x, x / 3});
    }
  }
}

/// Corners, edge and face mid-points of the bounds.
void add_bounds(Points& points, const Shape& shape, double extent) {
  const Bounds bounds = shape.facts().bounds;
  const auto stop = [&](int axis, int which) {
    const double lo = std::isfinite(bounds.lo[axis]) ? bounds.lo[axis] : -extent;
    const double hi = std::isfinite(bounds.hi[axis]) ? bounds.hi[axis] : extent;
    return which == 0 ? lo : which == 1 ? (lo + hi) / 2 : hi;
  };
  for (int i = 0; i < (shape.dimension() == 2 ? 9 : 27); ++i) {
    const double z = shape.dimension() == 2 ? 0 : stop(2, i / 9);
    points.add({stop(0, i % 3), stop(1, i / 3 % 3), z});
  }
}

/// Angles of symmetry lines: what the shape's numbers say, and the common ones.
std::vector<double> angles_of(Random& random, const Shape& shape) {
  std::vector<double> angles(24);
  for (std::size_t k = 0; k < angles.size(); ++k) angles[k] = static_cast<double>(k) * kPi / 12;
  std::size_t at = 0;
  for (const OpParameter& p : row_of(shape).parameters) {
    if (p.arity == 0) break;
    const double number = shape.parameters()[at];
    if (p.quantity == Quantity::angle) {
      for (const double angle : {number, -number, kPi - number, kPi + number, number + kPi / 2})
        angles.push_back(angle);
    }
    if (p.quantity == Quantity::count) {
      for (int k = 0; k < 12; ++k) {
        angles.push_back(static_cast<double>(random.index(2 * static_cast<std::size_t>(number) + 1)) * kPi / number);
      }
    }
    at += static_cast<std::size_t>(p.arity);
  }
  return angles;
}

void add_sectors(Points& points, Random& random, const Shape& shape, double extent) {
  for (const double angle : angles_of(random, shape)) {
    for (const double radius : {extent, extent * random.uniform(0, 1.5), extent * random.spread(1e-6, 1e6)}) {
      const double s = radius * std::sin(angle), c = radius * std::cos(angle);
      points.add({s, c, 0});
      if (shape.dimension() == 3) {
        points.add({s, 0, c});
        points.add({0, s, c});
      }
    }
  }
}

/// Where the shape's numbers are points: those, between them and beyond them.
void add_corners(Points& points, Random& random, const Shape& shape) {
  std::vector<Vec> corners;
  std::size_t at = 0;
  for (const OpParameter& p : row_of(shape).parameters) {
    const auto count = p.arity == 0 ? shape.parameters().size() - at : static_cast<std::size_t>(p.arity);
    const auto d = static_cast<std::size_t>(shape.dimension());
    for (std::size_t i = at; p.quantity == Quantity::point && i + d <= at + count; i += d) {
      corners.push_back({shape.parameters()[i], shape.parameters()[i + 1], d == 3 ? shape.parameters()[i + 2] : 0});
    }
    at += count;
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(corners.size(), 24); ++i) {
    const Vec from = corners[i], to = corners[(i + 1) % corners.size()];
    points.add(from);
    for (const double t : {0.5, -0.5, 1.5, random.uniform(0, 1), random.uniform(-9, 9)})
      points.add(from + (to - from) * t);
  }
}

/// On the surface, some ulps of the coordinates beside it, and closer than anything else.
void add_surface(Points& points, Random& random, const Shape& shape, const Field& field) {
  const auto region = oracle::region_of(shape);
  const double size = length(region.hi - region.lo);
  if (!(size < 1e16)) return;
  for (int i = 0; i < 12; ++i) {
    const auto found = oracle::random_surface_point(random, field, region);
    if (!found.found) return;
    for (const double off : {0.0, 1e-7, -1e-7, 1e-4, -1e-4}) points.add(found.point + found.normal * (off * size));
  }
}

void add_random(Points& points, Random& random, const Shape& shape, double extent) {
  const auto region = oracle::region_of(shape);
  for (int i = 0; i < 64; ++i) points.add(oracle::point_in(random, region));
  for (int i = 0; i < 32; ++i) {
    const double size = std::min(extent * random.spread(1e-8, 1e6), kLargest);
    points.add({random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)});
  }
}

}  // namespace

void Points::add(Vec p) {
  const double at[3] = {p.x, p.y, p.z};
  for (int axis = 0; axis < dimension; ++axis) {
    column[axis].push_back(static_cast<float>(std::clamp(at[axis], -kLargest * (1 - 1e-7), kLargest * (1 - 1e-7))));
  }
  ++count;
}

Vec Points::at(std::size_t i) const { return {column[0][i], column[1][i], dimension == 3 ? column[2][i] : 0.0}; }

double Points::magnitude(std::size_t i) const {
  const Vec p = at(i);
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

void Points::pad() {
  for (int axis = 0; axis < dimension; ++axis) column[axis].resize(padded(count), 0);
}

Points spicy_points(Random& random, const Shape& shape, const Field& field) {
  Points points(shape.dimension());
  const double extent = extent_of(shape);
  add_axes(points, extent);
  add_bounds(points, shape, extent);
  add_sectors(points, random, shape, extent);
  add_corners(points, random, shape);
  add_surface(points, random, shape, field);
  add_random(points, random, shape, extent);
  points.pad();
  return points;
}

Points plain_points(Random& random, const Shape& shape, std::size_t count) {
  Points points(shape.dimension());
  const auto region = oracle::region_of(shape);
  for (std::size_t i = 0; i < count; ++i) points.add(oracle::point_in(random, region));
  points.pad();
  return points;
}

}  // namespace thalweg::conformance
