// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Times of impact that are known, what cannot be answered, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "asked_sweeps.h"
#include "thalweg/ops.h"
#include "thalweg/simd.h"

namespace thalweg {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The bracket holds the time and is closed.
void expect_impact(const AskedSweeps& asked, std::size_t row, double time) {
  EXPECT_EQ(asked.status_at(row), Status::overlapping) << "row " << row;
  EXPECT_LE(asked.lower[row], time + 1e-6) << "row " << row;
  EXPECT_GE(asked.upper[row], time - 1e-6) << "row " << row;
  EXPECT_LE(asked.upper[row] - asked.lower[row], asked.tolerance() * 1.001) << "row " << row;
  EXPECT_EQ(asked.converged[row], 1) << "row " << row;
}

TEST(Sweep, OfADiscTowardADiscTakesTheGapOverTheSpeed) {
  // The scene comes from x = 0 by 4 and by -4, to discs at 3 and at -3 of radius 0.5.
  const AskedSweeps asked(circle(1), Moving::circles, {3, 0, 0.5F, -3, 0, 0.5F, 3, 0, 0.5F},
                          {4, 0, 0, -4, 0, 0, 1, 0, 0});
  expect_impact(asked, 0, 1.5 / 4);
  expect_impact(asked, 1, 1.5 / 4);
  EXPECT_EQ(asked.status_at(2), Status::separated);
  EXPECT_EQ(asked.lower[2], 1);
  EXPECT_EQ(asked.upper[2], 1);
  EXPECT_TRUE(std::isnan(asked.point[4]) && std::isnan(asked.normal[4]) && std::isnan(asked.value[2]));
  EXPECT_NEAR(asked.point[0], 2.5, 1e-2);
  EXPECT_NEAR(asked.normal[0], 1, 1e-3);
  EXPECT_NEAR(asked.normal[2], -1, 1e-3);
  EXPECT_LT(asked.value[0], 0);
}

TEST(Sweep, OfATriangleIsThatOfTheCornerThatArrivesFirst) {
  // To the left by 10; the corner (5, 0) meets the disc at x = 1.
  const AskedSweeps asked(circle(1), Moving::triangles_to_ends, {5, 0, 8, 3, 8, -3}, {-5, 0, -2, 3, -2, -3});
  expect_impact(asked, 0, 0.4);
  EXPECT_NEAR(asked.barycentric[0], 1, 1e-2);
  EXPECT_NEAR(asked.point[0], 1, 2e-2);
}

TEST(Sweep, OfAnEdgeFlushWithAFaceIsThatOfBoth) {
  const AskedSweeps asked(box(Vec2{2, 1}), Moving::triangles_to_ends, {-1, 4, 1, 4, 0, 6}, {-1, 0, 1, 0, 0, 2});
  expect_impact(asked, 0, 0.75);
  EXPECT_NEAR(asked.normal[1], 1, 1e-5);
  const AskedSweeps solid(box(Vec3{2, 1, 2}), Moving::triangles, {-1, 4, 0, 1, 4, 1, 0, 4, -1}, {0, 4, 0, 1, 0, 0, 0});
  expect_impact(solid, 0, 0.75);
}

TEST(Sweep, OfATurningSceneFollowsItsTurn) {
  // A bar turns by 1 radian toward a point at radius 1.5 and angle 0.5: its upper edge is 0.1 from its middle line.
  const auto x = static_cast<float>(1.5 * std::cos(0.5)), y = static_cast<float>(1.5 * std::sin(0.5));
  const double angle = 0.5 - std::asin(0.1 / 1.5);
  const AskedSweeps flat(box(Vec2{2, 0.1}), Moving::triangles, {x, y, x, y, x, y}, {0, 0, 1});
  expect_impact(flat, 0, angle);
  EXPECT_NEAR(flat.point[0], x, 1e-5);
  EXPECT_NEAR(flat.normal[0], -std::sin(angle), 2e-3);
  EXPECT_NEAR(flat.normal[1], std::cos(angle), 2e-3);
  const auto cosine = static_cast<float>(std::cos(0.5)), sine = static_cast<float>(std::sin(0.5));
  const AskedSweeps solid(box(Vec3{2, 0.1, 1}), Moving::triangles,
                          {x, y, 0, x, y, 0, x, y, 0, x, y, 0, x, y, 0, x, y, 0},
                          // The same turn, and by its quaternion's negative.
                          {0, 0, 0, cosine, 0, 0, sine, 0, 0, 0, -cosine, 0, 0, -sine});
  expect_impact(solid, 0, angle);
  expect_impact(solid, 1, angle);
}

TEST(Sweep, DoesNotTunnel) {
  // A wall that the triangle crosses in a thousandth of the time.
  const AskedSweeps asked(box(Vec2{0.05, 10}), Moving::triangles_to_ends, {-50, 0, -49, 1, -49, -1},
                          {51, 0, 52, 1, 52, -1}, {.tolerance = 1e-4});
  expect_impact(asked, 0, (49 - 0.05) / 101);
}

TEST(Sweep, ThatGrazesLeavesTheTimeOpen) {
  // The corner's path along y = 1 touches the disc at x = 0 and never enters it.
  const AskedSweeps asked(circle(1), Moving::triangles_to_ends, {-2, 1, -2, 2, -3, 2}, {2, 1, 2, 2, 1, 2});
  EXPECT_EQ(asked.status_at(0), Status::touching);
  EXPECT_LE(asked.lower[0], 0.5);
  EXPECT_GE(asked.upper[0], 0.5);
  EXPECT_LT(asked.upper[0] - asked.lower[0], 0.05);
}

TEST(Sweep, OfWhatOverlapsAtFirstIsAtTimeZero) {
  const AskedSweeps asked(circle(1), Moving::triangles_to_ends, {0, 0, 3, 0, 0, 3}, {5, 5, 8, 5, 5, 8});
  expect_impact(asked, 0, 0);
  EXPECT_EQ(asked.lower[0], 0);
}

TEST(Sweep, WithoutMotionIsAVerdict) {
  const AskedSweeps asked(circle(1), Moving::circles, {3, 0, 1, 1.5F, 0, 1}, {0, 0, 0, 0, 0, 0});
  EXPECT_EQ(asked.status_at(0), Status::separated);
  EXPECT_EQ(asked.status_at(1), Status::overlapping);
  EXPECT_EQ(asked.lower[1], 0);
}

TEST(Sweep, GivesBadRowsNothing) {
  const AskedSweeps flat(circle(1), Moving::circles, {3, 0, 0.5F, kNan, 0, 1, 3, 0, -1, 3, 0, 1, 3, 0, 1, 1e16F, 0, 1},
                         {4, 0, 0, 1, 0, 0, 1, 0, 0, 1, kNan, 0, 1, 0, 2e4F, 0, 0, 0});
  expect_impact(flat, 0, 1.5 / 4);
  for (std::size_t row = 1; row < 6; ++row) {
    EXPECT_EQ(flat.status_at(row), Status::bad_row) << row;
    EXPECT_TRUE(std::isnan(flat.lower[row]) && std::isnan(flat.upper[row]) && std::isnan(flat.point[2 * row])) << row;
    EXPECT_EQ(flat.converged[row], 0) << row;
    EXPECT_EQ(flat.evaluations[row], 0U) << row;
  }
  EXPECT_EQ(flat.summary.by_status[4], 5U);
  const AskedSweeps solid(sphere(1), Moving::circles, {3, 0, 0, 1}, {1, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(solid.status_at(0), Status::bad_row);
  const AskedSweeps ends(circle(1), Moving::triangles_to_ends, {3, 0, 4, 0, 3, 1}, {3, 0, kNan, 0, 3, 1});
  EXPECT_EQ(ends.status_at(0), Status::bad_row);
}

TEST(Sweep, OfNoRowsIsNothing) {
  const AskedSweeps none(circle(1), Moving::triangles_to_ends, {}, {});
  EXPECT_EQ(none.summary.rows, 0U);
}

TEST(Sweep, WithASmallBudgetIsUndecidedAndSoundAllTheSame) {
  const std::vector<float> from = {5, 0.3F, 8, 3, 8, -3}, to = {-5, 0.3F, -2, 3, -2, -3};
  const AskedSweeps whole(circle(1), Moving::triangles_to_ends, from, to);
  const AskedSweeps asked(circle(1), Moving::triangles_to_ends, from, to, {.budget = 6});
  EXPECT_EQ(asked.converged[0], 0);
  EXPECT_LE(asked.lower[0], whole.upper[0]);
  EXPECT_GE(asked.upper[0], whole.lower[0]);
  EXPECT_LE(asked.evaluations[0], 6U);
}

TEST(Sweep, RefusesWhatItCannotAnswer) {
  const Tape tape = std::move(compile(circle(1))).value();
  const float rows[6] = {}, motion[3] = {};
  const auto refused = [&](const SweepQueries& queries, const SweepOptions& options) {
    const auto answer = sweep_triangles(tape, queries, options, {});
    return answer ? std::string("answered") : answer.error().place;
  };
  EXPECT_EQ(refused({.rows = rows, .ends = rows, .motions = motion, .count = 1}, {}), "--motions");
  EXPECT_EQ(refused({.rows = rows, .count = 1}, {}), "--motions");
  EXPECT_EQ(refused({.rows = rows, .ends = rows, .count = 1}, {.tolerance = 1e-6}), "--tolerance");
  EXPECT_EQ(refused({.rows = rows, .ends = rows, .count = 1}, {.tolerance = std::nan("")}), "--tolerance");
  EXPECT_EQ(refused({.rows = rows, .ends = rows, .count = 1}, {.budget = 5}), "--budget");
  EXPECT_EQ(refused({.rows = rows, .ends = rows, .count = 1}, {}), "answered");
  EXPECT_FALSE(sweep_circles(tape, {.rows = rows, .ends = rows, .count = 1}, {}, {}));
}

}  // namespace
}  // namespace thalweg
