// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Edges are sorted by their least x, so that only pairs whose x ranges overlap are compared.
#include "ops/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace thalweg::ops {
namespace {

struct Corner {
  double x, y;
};

Corner corner(Numbers points, std::size_t i) {
  const std::size_t n = points.size() / 2;
  return {points[2 * (i % n)], points[2 * (i % n) + 1]};
}

/// Twice the signed area of a, b, c.
double turn(Corner a, Corner b, Corner c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

bool on_segment(Corner a, Corner b, Corner p) {
  return turn(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool segments_meet(Corner a, Corner b, Corner c, Corner d) {
  const bool crosses = (turn(a, b, c) > 0) != (turn(a, b, d) > 0) && (turn(c, d, a) > 0) != (turn(c, d, b) > 0) &&
                       turn(a, b, c) != 0 && turn(a, b, d) != 0 && turn(c, d, a) != 0 && turn(c, d, b) != 0;
  return crosses || on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b);
}

/// Whether edges i and j (i before j in the polygon, by index) meet other than at a shared corner.
bool edges_clash(Numbers points, std::size_t i, std::size_t j) {
  const std::size_t n = points.size() / 2;
  const Corner a = corner(points, i), b = corner(points, i + 1), c = corner(points, j), d = corner(points, j + 1);
  if ((i + 1) % n == j) return on_segment(a, b, d) || on_segment(c, d, a);
  if ((j + 1) % n == i) return on_segment(a, b, c) || on_segment(c, d, b);
  return segments_meet(a, b, c, d);
}

}  // namespace

bool is_simple_polygon(Numbers points) {
  const std::size_t n = points.size() / 2;
  const auto least_x = [&](std::size_t i) { return std::min(corner(points, i).x, corner(points, i + 1).x); };
  const auto most_x = [&](std::size_t i) { return std::max(corner(points, i).x, corner(points, i + 1).x); };
  for (std::size_t i = 0; i < n; ++i) {
    const Corner a = corner(points, i), b = corner(points, i + 1);
    if (std::hypot(b.x - a.x, b.y - a.y) < kSmallest) return false;
  }
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return least_x(i) < least_x(j); });
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n && least_x(order[b]) <= most_x(order[a]); ++b) {
      if (edges_clash(points, order[a], order[b])) return false;
    }
  }
  return true;
}

double polygon_area(Numbers points) {
  const std::size_t n = points.size() / 2;
  double twice = 0;
  for (std::size_t i = 1; i + 1 < n; ++i) twice += turn(corner(points, 0), corner(points, i), corner(points, i + 1));
  return twice / 2;
}

bool is_convex_polygon(Numbers points) {
  const std::size_t n = points.size() / 2;
  bool left = false;
  bool right = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = turn(corner(points, i), corner(points, i + 1), corner(points, i + 2));
    left = left || t > 0;
    right = right || t < 0;
  }
  return !(left && right);
}

}  // namespace thalweg::ops
