// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Brackets of separation distances, against distances that are known and against points sampled inside both shapes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "asked_pairs.h"
#include "pair_oracle.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

using oracle::Vec;

struct AskedDistances {
  Tape a, b;
  std::size_t d, count;
  std::vector<std::uint8_t> status, converged;
  std::vector<float> distance, lower, point_a, point_b, normal;
  std::vector<std::uint32_t> evaluations;

  AskedDistances(const Shape& first, const Shape& second, const std::vector<float>& poses,
                 const DistanceOptions& options = {}, const Execution& execution = {})
      : a(*compile(first)), b(*compile(second)), d(static_cast<std::size_t>(first.dimension())) {
    count = poses.size() / (d == 2 ? 3 : 7);
    for (auto* bytes : {&status, &converged}) bytes->resize(count);
    for (auto* numbers : {&distance, &lower}) numbers->resize(count);
    for (auto* vectors : {&point_a, &point_b, &normal}) vectors->resize(count * d);
    evaluations.resize(count);
    const Tape* const shapes[] = {&a, &b};
    const auto summary =
        measure_distances({.shapes = shapes, .shape_count = 2, .poses = poses.data(), .count = count}, options,
                          {status.data(), distance.data(), lower.data(), point_a.data(), point_b.data(), normal.data(),
                           converged.data(), evaluations.data()},
                          execution);
    EXPECT_TRUE(summary) << to_string(summary.error());
  }
  [[nodiscard]] Status status_at(std::size_t row) const { return static_cast<Status>(status[row]); }
  [[nodiscard]] Vec at(const std::vector<float>& points, std::size_t row) const {
    return {points[row * d], points[row * d + 1], d == 3 ? points[row * d + 2] : 0};
  }
};

/// The bracket holds `truth` and is closed.
void expect_distance(const AskedDistances& asked, std::size_t row, double truth, double tolerance) {
  EXPECT_EQ(asked.status_at(row), Status::separated) << "row " << row;
  EXPECT_LE(asked.lower[row], truth * (1 + 1e-6)) << "row " << row;
  EXPECT_GE(asked.distance[row], truth * (1 - 1e-6)) << "row " << row;
  EXPECT_LE(asked.distance[row] - asked.lower[row], tolerance) << "row " << row;
  EXPECT_EQ(asked.converged[row], 1) << "row " << row;
  const Vec apart = asked.at(asked.point_b, row) - asked.at(asked.point_a, row);
  EXPECT_NEAR(std::sqrt(dot(apart, apart)), asked.distance[row], 1e-4) << "row " << row;
  EXPECT_NEAR(dot(asked.at(asked.normal, row), apart), std::sqrt(dot(apart, apart)), 1e-4) << "row " << row;
}

/// At (x, y, z), turned about the y axis.
std::vector<float> turned(double x, double y, double z, double angle) {
  const auto cosine = static_cast<float>(std::cos(angle / 2)), sine = static_cast<float>(std::sin(angle / 2));
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), cosine, 0, sine, 0};
}

TEST(Distance, OfDiscsIsThatOfTheirCentresLessTheirRadii) {
  const DistanceOptions options{.tolerance = 1e-3};
  const AskedDistances asked(circle(1), circle(0.5), {3, 0, 0, 3, 4, 1, 0, 1.50125F, 0}, options);
  expect_distance(asked, 0, 1.5, 1e-3);
  expect_distance(asked, 1, 3.5, 1e-3);
  expect_distance(asked, 2, 0.00125, 1e-3);
  EXPECT_NEAR(asked.point_a[0], 1, 1e-4);
  EXPECT_NEAR(asked.point_b[0], 2.5, 1e-4);
}

TEST(Distance, OfFacesThatAreParallelIsTheirGap) {
  const DistanceOptions options{.tolerance = 1e-3};
  const AskedDistances flat(box(Vec2{1, 1}), box(Vec2{1, 0.5}), {0.3F, 1.75F, 0, 2.5F, 0, 0, 2.5F, 2, 0}, options);
  expect_distance(flat, 0, 0.25, 1e-3);
  expect_distance(flat, 1, 0.5, 1e-3);
  expect_distance(flat, 2, std::hypot(0.5, 0.5), 1e-3);
  const AskedDistances solid(box(Vec3{1, 1, 1}), box(Vec3{1, 2, 1}), turned(0.25, 0.5, 2.25, 0), {.tolerance = 5e-3});
  expect_distance(solid, 0, 0.25, 5e-3);
}

TEST(Distance, OfACornerToAFaceIsExact) {
  const double half_diagonal = std::numbers::sqrt2;
  const AskedDistances asked(box(Vec3{1, 1, 1}), box(Vec3{1, 1, 1}), turned(3, 0, 0, std::numbers::pi / 4),
                             {.tolerance = 1e-2, .budget = 40'000});
  expect_distance(asked, 0, 2 - half_diagonal, 1e-2);
}

TEST(Distance, OfTorusPairsIsBracketedByTheDefaults) {
  const Shape ring = torus(0.35, 0.15);
  std::vector<float> poses;
  for (std::size_t i = 0; i < 40; ++i) {
    const std::vector<float> pose = turned(1.1 + 0.01 * static_cast<double>(i), 0.1, 0.2, 0.1 * static_cast<double>(i));
    poses.insert(poses.end(), pose.begin(), pose.end());
  }
  const AskedDistances asked(ring, ring, poses);
  for (std::size_t i = 0; i < asked.count; ++i) {
    // Both axes are y: the tori are nearest where their centre circles are.
    const double apart = std::hypot(1.1 + 0.01 * static_cast<double>(i), 0.2) - 0.7;
    expect_distance(asked, i, std::hypot(apart, 0.1) - 0.3, 1e-2 * std::hypot(1.0, 1.0, 0.3));
  }
}

TEST(Distance, IsZeroWhereShapesOverlap) {
  const AskedDistances asked(circle(1), box(Vec2{1, 1}), {1.5F, 0, 0.3F});
  EXPECT_EQ(asked.status_at(0), Status::overlapping);
  EXPECT_EQ(asked.distance[0], 0);
  EXPECT_EQ(asked.lower[0], 0);
  EXPECT_EQ(asked.converged[0], 1);
  const oracle::PairField field(circle(1), box(Vec2{1, 1}),
                                oracle::placement(std::vector<float>{1.5F, 0, 0.3F}.data(), 2));
  EXPECT_LT(field(asked.at(asked.point_a, 0)), 0);
}

TEST(Distance, ReachesAShapeWithoutBounds) {
  const AskedDistances asked(half_plane(Vec2{0, 1}, 0), circle(0.5), {7, 2, 0}, {.tolerance = 1e-3});
  expect_distance(asked, 0, 1.5, 1e-3);
}

TEST(Distance, ReachesACurveWithoutAnInside) {
  const AskedDistances asked(segment(Vec2{-1, 0}, Vec2{1, 0}), circle(0.5), {0.25F, 2, 0}, {.tolerance = 1e-3});
  expect_distance(asked, 0, 1.5, 1e-3);
}

TEST(Distance, TellsBadPosesAndEmptyShapes) {
  const AskedDistances bad(circle(1), circle(1), {std::nanf(""), 0, 0});
  EXPECT_EQ(bad.status_at(0), Status::bad_row);
  EXPECT_TRUE(std::isnan(bad.distance[0]));
  EXPECT_TRUE(std::isnan(bad.lower[0]));
  EXPECT_TRUE(std::isnan(bad.point_a[0]));
  const Shape nothing = circle(1).translate(Vec2{9, 0}) & circle(1);
  const AskedDistances empty(nothing, circle(1), {0, 0, 0});
  EXPECT_EQ(empty.status_at(0), Status::separated);
  EXPECT_TRUE(std::isinf(empty.distance[0]));
}

TEST(Distance, RefusesFormulasAndTwoShapesWithoutBounds) {
  const float pose[] = {0, 0, 0};
  const Tape half = *compile(half_plane(Vec2{0, 1}, 0));
  const Tape* const halves[] = {&half, &half};
  EXPECT_FALSE(measure_distances({.shapes = halves, .shape_count = 2, .poses = pose, .count = 1}, {}, {}));
  const Tape formula = *compile(expression("x*x + y*y - 1")), disc = *compile(circle(1));
  const Tape* const mixed[] = {&formula, &disc};
  EXPECT_FALSE(measure_distances({.shapes = mixed, .shape_count = 2, .poses = pose, .count = 1}, {}, {}));
}

/// Points of a shape, in A's frame, on a grid over its bounds.
std::vector<Vec> points_inside(const Shape& shape, const oracle::Placement& at, int count) {
  const oracle::Field field(shape);
  const Bounds& bounds = shape.facts().bounds;
  const int depth = shape.dimension() == 3 ? count : 1;
  std::vector<Vec> points;
  for (int k = 0; k < depth; ++k) {
    for (int j = 0; j < count; ++j) {
      for (int i = 0; i < count; ++i) {
        const auto along = [&](int axis, int index) {
          return bounds.lo[axis] + (bounds.hi[axis] - bounds.lo[axis]) * (index + 0.5) / count;
        };
        const Vec p{along(0, i), along(1, j), depth > 1 ? along(2, k) : 0};
        if (!(field(p) <= 0)) continue;
        const auto& m = at.turn;
        points.push_back(Vec{m[0] * p.x + m[1] * p.y + m[2] * p.z, m[3] * p.x + m[4] * p.y + m[5] * p.z,
                             m[6] * p.x + m[7] * p.y + m[8] * p.z} +
                         at.offset);
      }
    }
  }
  return points;
}

/// No two sampled points may be nearer than `lower`, and the witnesses must be of the shapes.
TEST(Distance, HoldsForRandomShapes) {
  std::size_t separated = 0, converged = 0, both = 0;
  for (std::size_t seed = 1; seed <= 60; ++seed) {
    oracle::Random random(seed);
    const int dimension = seed % 3 == 0 ? 3 : 2;
    RandomPair pair(random, dimension, 6);
    // Further apart than for overlaps.
    for (int axis = 0; axis < dimension; ++axis) pair.pose[static_cast<std::size_t>(axis)] *= 2.5F;
    const AskedDistances asked(pair.a, pair.b, pair.pose);
    const oracle::Placement at = oracle::placement(pair.pose.data(), dimension);
    const oracle::PairField field(pair.a, pair.b, at);
    const oracle::Field a(pair.a);
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + pair.describe());
    const auto near_a = points_inside(pair.a, {}, dimension == 2 ? 60 : 16);
    const auto near_b = points_inside(pair.b, at, dimension == 2 ? 60 : 16);
    for (const Vec& p : near_a) {
      for (const Vec& q : near_b) ASSERT_LE(asked.lower[0], std::sqrt(dot(p - q, p - q)) * (1 + 1e-6));
    }
    ASSERT_LE(asked.lower[0], asked.distance[0]);
    if (asked.status_at(0) == Status::separated) {
      ++separated;
      converged += asked.converged[0];
      for (const Vec& p : near_a) ASSERT_GT(field(p), 0);
    }
    const bool has_points = !near_a.empty() && !near_b.empty();
    if (has_points) {
      ++both;
      EXPECT_TRUE(std::isfinite(asked.distance[0]));
    }
    if (std::isfinite(asked.distance[0])) {
      EXPECT_LE(a(asked.at(asked.point_a, 0)), 1e-4 * pair.a.facts().bounds.diagonal(dimension));
      const Vec apart = asked.at(asked.point_b, 0) - asked.at(asked.point_a, 0);
      EXPECT_GE(asked.distance[0] + 1e-4 * asked.distance[0] + 1e-4, std::sqrt(dot(apart, apart)));
    }
  }
  EXPECT_GT(separated, 20U);
  EXPECT_GT(both, 25U);
  RecordProperty("converged", static_cast<int>(converged));
}

TEST(Distance, HasTheSameBitsForAnyThreadsTilesAndFusedTarget) {
  const std::vector<float> poses = torus_poses(64);
  const Shape ring = torus(0.2, 0.05);
  const AskedDistances one(ring, ring, poses, {}, {.threads = 1});
  std::vector<Execution> others = {{.threads = 2}, {.threads = 1, .tile = 3}};
  for (const Target& target : targets()) {
    if (target.fused_multiply_add) others.push_back({.threads = 1, .target = &target});
  }
  for (const Execution& execution : others) {
    const AskedDistances other(ring, ring, poses, {}, execution);
    EXPECT_EQ(one.status, other.status);
    EXPECT_EQ(one.evaluations, other.evaluations);
    for (const auto& [x, y] : {std::pair{&one.distance, &other.distance}, std::pair{&one.lower, &other.lower},
                               std::pair{&one.point_a, &other.point_a}, std::pair{&one.normal, &other.normal}}) {
      EXPECT_EQ(std::memcmp(x->data(), y->data(), x->size() * sizeof(float)), 0);
    }
  }
}

}  // namespace
}  // namespace thalweg
