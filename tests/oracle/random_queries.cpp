// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "random_queries.h"

#include <algorithm>
#include <cmath>

namespace thalweg::oracle {
namespace {

double extent(const Region& region) { return length(region.hi - region.lo); }

Vec offset(Random& random, double size, int dimension) {
  const double z = dimension == 3 ? random.uniform(-size, size) : 0;
  return {random.uniform(-size, size), random.uniform(-size, size), z};
}

Vec unit(Random& random, int dimension) {
  for (;;) {
    const Vec v = offset(random, 1, dimension);
    if (length(v) > 0.1 && length(v) <= 1) return v * (1 / length(v));
  }
}

/// A unit vector at right angles to n.
Vec tangent(Random& random, Vec n, int dimension) {
  if (dimension == 2) return random.chance(0.5) ? Vec{-n.y, n.x, 0} : Vec{n.y, -n.x, 0};
  for (;;) {
    const Vec v = unit(random, 3);
    const Vec t = v - n * dot(v, n);
    if (length(t) > 0.1) return t * (1 / length(t));
  }
}

/// Gaps at which a verdict is hard: none, a few float32 steps, and about the default tolerance; either sign.
double small_gap(Random& random, double size) {
  const double gaps[] = {0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3};
  return (random.chance(0.5) ? 1 : -1) * gaps[random.index(6)] * size;
}

std::array<Vec, 3> plain_triangle(Random& random, const Region& region, double size, int dimension) {
  const Vec centre = point_in(random, region);
  return {centre + offset(random, size, dimension), centre + offset(random, size, dimension),
          centre + offset(random, size, dimension)};
}

/// Flush: in the tangent plane (2D: an edge along it, the third corner away from the shape). Touching: one corner or
/// one point of an edge at the surface, the rest beyond it.
std::array<Vec, 3> surface_triangle(Random& random, const Field& field, const Region& region, bool flush) {
  const int dimension = field.dimension();
  const SurfacePoint at = random_surface_point(random, field, region);
  const double size = 0.1 * extent(region);
  if (!at.found) return plain_triangle(random, region, size, dimension);
  const Vec base = at.point + at.normal * small_gap(random, size);
  const Vec along = tangent(random, at.normal, dimension);
  const Vec a = base + along * (size * random.uniform(0, 1)), b = base - along * (size * random.uniform(0, 1));
  if (flush && dimension == 3) return {a, b, base + tangent(random, at.normal, 3) * size};
  if (flush) return {a, b, base + at.normal * size};
  const double lift = size * random.uniform(0.1, 1);
  return {base, base + at.normal * lift + along * size,
          base + at.normal * lift - along * (size * random.uniform(0, 1))};
}

std::array<Vec, 3> triangle_of(Random& random, const Field& field, const Region& region, QueryKind kind) {
  const int dimension = field.dimension();
  const double size = 0.1 * extent(region);
  auto t = plain_triangle(random, region, kind == QueryKind::tiny ? 1e-5 * size : size, dimension);
  switch (kind) {
    case QueryKind::sliver:
      t[2] = t[0] + (t[1] - t[0]) * random.uniform(0, 1) + offset(random, 1e-5 * size, dimension);
      break;
    case QueryKind::segment:
      t[2] = random.chance(0.5) ? t[0] : (t[0] + t[1]) * 0.5;
      break;
    case QueryKind::point:
      t[1] = t[2] = t[0];
      break;
    case QueryKind::flush:
      return surface_triangle(random, field, region, true);
    case QueryKind::touching:
      return surface_triangle(random, field, region, false);
    case QueryKind::huge:
      for (Vec& v : t) v = v + unit(random, dimension) * (random.spread(10, 1000) * extent(region));
      break;
    default:
      break;
  }
  return t;
}

void append(std::vector<float>& rows, Vec p, int dimension) {
  rows.push_back(static_cast<float>(p.x));
  rows.push_back(static_cast<float>(p.y));
  if (dimension == 3) rows.push_back(static_cast<float>(p.z));
}

void append_triangle(std::vector<float>& rows, Random& random, const Field& field, const Region& region,
                     QueryKind kind) {
  auto t = triangle_of(random, field, region, kind);
  std::swap(t[0], t[random.index(3)]);
  for (const Vec corner : t) append(rows, corner, field.dimension());
}

void append_circle(std::vector<float>& rows, Random& random, const Field& field, const Region& region, QueryKind kind) {
  const double size = 0.1 * extent(region);
  Vec centre = point_in(random, region);
  double radius = random.uniform(0, size);
  if (kind == QueryKind::point) radius = 0;
  if (kind == QueryKind::tiny) radius *= 1e-5;
  if (kind == QueryKind::huge) radius = random.spread(1, 1000) * extent(region);
  if (kind == QueryKind::flush || kind == QueryKind::touching) {
    const SurfacePoint at = random_surface_point(random, field, region);
    if (at.found) centre = at.point + at.normal * (radius + small_gap(random, size));
  }
  append(rows, centre, field.dimension());
  rows.push_back(static_cast<float>(radius));
}

QueryKind kind_in_turn(std::size_t i) {
  return i % 2 == 0 ? QueryKind::plain : kQueryKinds[(i / 2) % kQueryKinds.size()];
}

}  // namespace

std::string_view name(QueryKind kind) {
  constexpr std::string_view kNames[] = {"plain", "sliver", "segment", "point", "flush", "touching", "huge", "tiny"};
  return kNames[static_cast<std::size_t>(kind)];
}

Region region_of(const Shape& shape) {
  const Bounds bounds = shape.facts().bounds;
  const int dimension = shape.dimension();
  Region region{{-3, -3, dimension == 3 ? -3.0 : 0.0}, {3, 3, dimension == 3 ? 3.0 : 0.0}};
  if (bounds.empty(dimension) || !bounds.finite(dimension)) return region;
  const double grow = 0.25 * std::max(bounds.diagonal(dimension), 1e-6);
  region.lo = {bounds.lo[0] - grow, bounds.lo[1] - grow, dimension == 3 ? bounds.lo[2] - grow : 0};
  region.hi = {bounds.hi[0] + grow, bounds.hi[1] + grow, dimension == 3 ? bounds.hi[2] + grow : 0};
  return region;
}

Vec point_in(Random& random, const Region& region) {
  return {random.uniform(region.lo.x, region.hi.x), random.uniform(region.lo.y, region.hi.y),
          random.uniform(region.lo.z, region.hi.z)};
}

SurfacePoint random_surface_point(Random& random, const Field& field, const Region& region) {
  Vec inside, outside;
  bool has_inside = false, has_outside = false;
  for (int i = 0; i < 200 && !(has_inside && has_outside); ++i) {
    const Vec p = point_in(random, region);
    const bool negative = field(p) < 0;
    (negative ? inside : outside) = p;
    (negative ? has_inside : has_outside) = true;
  }
  if (!has_inside || !has_outside) return {};
  for (int i = 0; i < 60; ++i) {
    const Vec middle = (inside + outside) * 0.5;
    (field(middle) < 0 ? inside : outside) = middle;
  }
  const double h = 1e-6 * extent(region);
  const Vec p = outside;
  const auto slope = [&](Vec step) { return field(p + step) - field(p - step); };
  const Vec g{slope({h, 0, 0}), slope({0, h, 0}), field.dimension() == 3 ? slope({0, 0, h}) : 0};
  if (length(g) < h) return {};
  return {true, p, g * (1 / length(g))};
}

std::vector<float> random_triangles(Random& random, const Field& field, const Region& region, QueryKind kind,
                                    std::size_t count) {
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) append_triangle(rows, random, field, region, kind);
  return rows;
}

std::vector<float> random_circles(Random& random, const Field& field, const Region& region, QueryKind kind,
                                  std::size_t count) {
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) append_circle(rows, random, field, region, kind);
  return rows;
}

std::vector<float> mixed_triangles(Random& random, const Field& field, const Region& region, std::size_t count) {
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) append_triangle(rows, random, field, region, kind_in_turn(i));
  return rows;
}

std::vector<float> mixed_circles(Random& random, const Field& field, const Region& region, std::size_t count) {
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) append_circle(rows, random, field, region, kind_in_turn(i));
  return rows;
}

Vec point_at(const float* rows, std::size_t row, int dimension) {
  const float* p = rows + row * static_cast<std::size_t>(dimension);
  return {p[0], p[1], dimension == 3 ? p[2] : 0.0};
}

std::array<Vec, 3> triangle_at(const std::vector<float>& rows, std::size_t row, int dimension) {
  return {point_at(rows.data(), 3 * row, dimension), point_at(rows.data(), 3 * row + 1, dimension),
          point_at(rows.data(), 3 * row + 2, dimension)};
}

}  // namespace thalweg::oracle
