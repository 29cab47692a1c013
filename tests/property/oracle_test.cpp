// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The oracle against things known without it: other formulas, dense samples, distances in closed form.
#include "oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "random_queries.h"
#include "random_shapes.h"
#include "sampling.h"
#include "thalweg/ops.h"

namespace thalweg::property {
namespace {

using oracle::describe;
using oracle::Field;
using oracle::Interval;
using oracle::point_in;
using oracle::Random;
using oracle::Region;
using oracle::Vec;

TEST(Oracle, StarIsThePolygonThroughItsTipsAndNotches) {
  const double pi = std::numbers::pi;
  for (const auto& [points, sharpness] : {std::pair{5, 2.7}, {12, 4.0}, {7, 2.0}, {3, 2.9}}) {
    const double sector = pi / points;
    const double notch = std::cos(sector) - std::sin(sector) / std::tan(pi / sharpness);
    std::vector<Vec2> corners;
    for (int i = 0; i < 2 * points; ++i) {
      const double radius = i % 2 == 0 ? 1.0 : notch;
      corners.push_back({radius * std::sin(i * sector), radius * std::cos(i * sector)});
    }
    const Field folded(star(1, points, sharpness)), drawn(polygon(corners));
    Random random(static_cast<std::uint64_t>(points));
    for (int i = 0; i < 2000; ++i) {
      const Vec p = point_in(random, {{-2, -2, 0}, {2, 2, 0}});
      ASSERT_NEAR(folded(p), drawn(p), 1e-12) << points << " points at " << p.x << ' ' << p.y;
    }
  }
}

TEST(Oracle, BracketsTheMinimumOfDenseSamples) {
  for (const Drawn& drawn : drawn_trees(50, 40)) {
    const Field field(drawn.shape);
    const Region region = oracle::region_of(drawn.shape);
    Random random(drawn.seed);
    const auto rows = random_triangles(random, field, region, oracle::QueryKind::plain, 4);
    for (std::size_t row = 0; row < 4; ++row) {
      const auto t = oracle::triangle_at(rows, row, field.dimension());
      const double width = 1e-3 * length(region.hi - region.lo);
      const auto found = minimum_over_triangle(field, t, {.width = width, .cap = 100'000});
      EXPECT_TRUE(found.decided) << describe(drawn.shape, drawn.seed);
      double least = found.upper;
      for (int i = 0; i < 2000; ++i) {
        double u = random.uniform(0, 1), v = random.uniform(0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        least = std::min(least, field(t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v));
      }
      EXPECT_GE(least, found.lower - 1e-12) << describe(drawn.shape, drawn.seed);
      EXPECT_NEAR(field(found.witness), found.upper, 1e-12);
    }
  }
}

TEST(Oracle, EnclosuresHoldEverySample) {
  for (const Drawn& drawn : drawn_trees(60, 200)) {
    const Field field(drawn.shape);
    const Region region = oracle::region_of(drawn.shape);
    Random random(drawn.seed);
    for (int cell = 0; cell < 20; ++cell) {
      const Vec a = point_in(random, region);
      const double size = random.spread(0.01, 2);
      std::array<Vec, 3> t;
      for (Vec& corner : t) corner = a + (point_in(random, region) - a) * (size / length(region.hi - region.lo));
      const Interval all = field.enclose((t[0] + t[1] + t[2]) * (1.0 / 3), t.data(), 3);
      for (int i = 0; i < 50; ++i) {
        double u = random.uniform(0, 1), v = random.uniform(0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const double f = field(t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v);
        ASSERT_GE(f, all.lower - 1e-12) << describe(drawn.shape, drawn.seed);
        ASSERT_LE(f, all.upper + 1e-12) << describe(drawn.shape, drawn.seed);
      }
    }
  }
}

TEST(Oracle, BallMinimumIsTheCentresValueLessTheRadiusAwayFromAnExactShape) {
  const Field field(box(Vec3{1, 2, 3}));
  const auto found = minimum_over_ball(field, {4, 0, 0}, 1.5, {.width = 1e-3});
  EXPECT_TRUE(found.decided);
  EXPECT_NEAR(found.upper, 1.5, 1e-3);
  EXPECT_LE(found.lower, 1.5);
}

TEST(Oracle, ATriangleFlushWithAFaceTakesFewEvaluations) {
  const Field field(box(Vec3{10, 1, 10}));
  const auto found = minimum_over_triangle(field, {Vec{-5, 1.000001, -5}, Vec{6, 1.000001, -4}, Vec{0, 1.000001, 7}},
                                           {.verdict_only = true});
  EXPECT_EQ(verdict(field, found, 10), oracle::Verdict::separated);
  EXPECT_LT(found.evaluations, 50U);
}

TEST(BruteForceDistance, BracketsTheDistanceToACircleABoxAndTheLinesOfACoolS) {
  const auto near = [](const Shape& shape, Vec p, double expected) {
    const Interval found = oracle::brute_force_distance(shape, p, 4, 1e-3);
    EXPECT_LE(found.lower, expected + 1e-3);
    EXPECT_GE(found.upper, expected);
    EXPECT_LE(found.upper - found.lower, 3e-3);
  };
  near(circle(1), {0.3, 0.4, 0}, 0.5);
  near(circle(1), {3, 0, 0}, 2);
  near(box(Vec2{1, 1}), {2, 2, 0}, std::numbers::sqrt2);
  near(cool_s(), {0.2, 0.45, 0}, 0.2);
  near(segment({0, 0}, {1, 0}), {0.5, 0.25, 0}, 0.25);
}

}  // namespace
}  // namespace thalweg::property
