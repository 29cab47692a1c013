// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "ops/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "random.h"

namespace thalweg::ops {
namespace {

using List = std::vector<double>;

List regular(int corners, double turn = 1) {
  List points;
  for (int i = 0; i < corners; ++i) {
    const double angle = turn * 2 * std::numbers::pi * i / corners;
    points.insert(points.end(), {std::cos(angle), std::sin(angle)});
  }
  return points;
}

TEST(SimplePolygon, IsATriangleEitherWayRound) {
  EXPECT_TRUE(is_simple_polygon(List{0, 0, 1, 0, 0, 1}));
  EXPECT_TRUE(is_simple_polygon(List{0, 0, 0, 1, 1, 0}));
}

TEST(SimplePolygon, IsARegularOneOfAnySize) {
  for (const int corners : {3, 4, 7, 100, 3000}) {
    EXPECT_TRUE(is_simple_polygon(regular(corners))) << corners;
    EXPECT_TRUE(is_simple_polygon(regular(corners, -1))) << corners;
  }
}

TEST(SimplePolygon, MayHaveStraightAngles) { EXPECT_TRUE(is_simple_polygon(List{0, 0, 1, 0, 2, 0, 2, 2, 0, 2})); }

TEST(SimplePolygon, MayBeAComb) {
  List points = {0, 0};
  for (int i = 0; i < 50; ++i) points.insert(points.end(), {i + 0.25, 5, i + 0.5, 1, i + 1.0, 1});
  points.insert(points.end(), {51, 0});
  EXPECT_TRUE(is_simple_polygon(points));
}

TEST(SimplePolygon, DoesNotCrossItself) {
  EXPECT_FALSE(is_simple_polygon(List{0, 0, 1, 1, 1, 0, 0, 1}));                        // a bow tie
  EXPECT_FALSE(is_simple_polygon(List{0, 0, 4, 0, 4, 4, 2, -1, 0, 4}));                 // a tip through an edge
  EXPECT_FALSE(is_simple_polygon(List{0, 1, 0.6, -0.8, -1, 0.3, 1, 0.3, -0.6, -0.8}));  // a pentagram
}

TEST(SimplePolygon, DoesNotTouchItself) {
  EXPECT_FALSE(is_simple_polygon(List{0, 0, 4, 0, 4, 4, 2, 0, 0, 4}));          // a corner on an edge
  EXPECT_FALSE(is_simple_polygon(List{0, 0, 2, 0, 2, 2, 0, 0, -2, 2, -2, 0}));  // a corner twice
  EXPECT_FALSE(is_simple_polygon(List{0, 0, 4, 0, 2, 0, 2, 3}));                // an edge back along another
  EXPECT_FALSE(is_simple_polygon(List{0, 0, 4, 0, 4, 1, 0, 0, 1, 0, 0, 3}));    // a corner on a vertex and an overlap
}

TEST(SimplePolygon, HasNoEdgeWithoutLength) {
  EXPECT_FALSE(is_simple_polygon(List{0, 0, 0, 0, 1, 0, 0, 1}));
  EXPECT_FALSE(is_simple_polygon(List{0, 0, 1, 0, 0, 1, 0, 0}));
  EXPECT_FALSE(is_simple_polygon(List{0, 0, 1e-16, 0, 1, 0, 0, 1}));
}

TEST(SimplePolygon, HasAnArea) { EXPECT_FALSE(is_simple_polygon(List{0, 0, 1, 0, 2, 0})); }

/// Every pair of edges by orientation tests, without the sweep.
bool crosses_by_brute_force(const List& p) {
  const std::size_t n = p.size() / 2;
  const auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
    a %= n, b %= n, c %= n;
    return (p[2 * b] - p[2 * a]) * (p[2 * c + 1] - p[2 * a + 1]) -
           (p[2 * b + 1] - p[2 * a + 1]) * (p[2 * c] - p[2 * a]);
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n && (i != 0 || j + 1 < n); ++j) {
      if (turn(i, i + 1, j) * turn(i, i + 1, j + 1) < 0 && turn(j, j + 1, i) * turn(j, j + 1, i + 1) < 0) return true;
    }
  }
  return false;
}

TEST(SimplePolygon, IsWhatComparingAllPairsOfEdgesSays) {
  oracle::Random random(3);
  std::size_t simple = 0;
  for (int i = 0; i < 2000; ++i) {
    List points;
    const std::size_t corners = 3 + random.index(6);
    for (std::size_t k = 0; k < 2 * corners; ++k) points.push_back(random.uniform(-1, 1));
    ASSERT_EQ(is_simple_polygon(points), !crosses_by_brute_force(points)) << i;
    simple += is_simple_polygon(points) ? 1 : 0;
  }
  EXPECT_GT(simple, 100U);
  EXPECT_LT(simple, 1900U);
}

TEST(PolygonArea, IsPositiveCounterClockwise) {
  EXPECT_DOUBLE_EQ(polygon_area(List{0, 0, 2, 0, 2, 3, 0, 3}), 6);
  EXPECT_DOUBLE_EQ(polygon_area(List{0, 0, 0, 3, 2, 3, 2, 0}), -6);
  EXPECT_NEAR(polygon_area(regular(1000)), std::numbers::pi, 1e-4);
}

TEST(ConvexPolygon, TurnsOneWay) {
  EXPECT_TRUE(is_convex_polygon(regular(9)));
  EXPECT_TRUE(is_convex_polygon(regular(9, -1)));
  EXPECT_TRUE(is_convex_polygon(List{0, 0, 1, 0, 2, 0, 2, 2, 0, 2}));
  EXPECT_FALSE(is_convex_polygon(List{0, 0, 2, 0, 0.5, 0.5, 0, 2}));
  EXPECT_FALSE(is_convex_polygon(List{0, 0, 0, 2, 0.5, 0.5, 2, 0}));
}

}  // namespace
}  // namespace thalweg::ops
