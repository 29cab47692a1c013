// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What `thalweg stress` stands on: its timing, its fit, and the larger scenes that it makes.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "stress_timing.h"
#include "stress_workload.h"
#include "thalweg/ops.h"

namespace thalweg::cli {
namespace {

StressCase sleeping(std::chrono::microseconds each, std::size_t rows) {
  StressCase one;
  one.rows = rows;
  one.run = [each](std::size_t n) {
    std::this_thread::sleep_for(each * n);
    return 3 * n;
  };
  return one;
}

TEST(TimeByTurns, TellsHowFastEachCaseIs) {
  const auto points =
      time_by_turns({sleeping(std::chrono::microseconds(1000), 4), sleeping(std::chrono::microseconds(100), 40)}, 3);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_LE(points[0].queries_per_second, 1000);
  EXPECT_GT(points[0].queries_per_second, 10);
  EXPECT_GT(points[1].queries_per_second, points[0].queries_per_second);
  EXPECT_EQ(points[0].evaluations_per_query, 3);
  EXPECT_DOUBLE_EQ(points[1].evaluations_per_second(), 3 * points[1].queries_per_second);
}

TEST(TimeByTurns, TakesFewerRowsOfACaseThatMayShrink) {
  StressCase slow = sleeping(std::chrono::microseconds(500), 1'000'000);
  slow.may_shrink = true;
  const auto points = time_by_turns({slow}, 1);
  EXPECT_LT(points[0].rows, 1000U);
  EXPECT_GE(points[0].rows, 1U);
}

TEST(FittedExponent, IsThePowerOfAPowerLaw) {
  std::vector<double> x, y;
  for (const double at : {1.0, 7.0, 50.0, 1e4}) {
    x.push_back(at);
    y.push_back(3 * std::pow(at, 0.8));
  }
  EXPECT_NEAR(fitted_exponent(x, y), 0.8, 1e-12);
}

TEST(Repeated, HoldsACopyOfTheShapeInEveryCellOfItsGrid) {
  const Shape one = circle(2) | circle(1).translate(Vec2{4, 0});
  EXPECT_EQ(primitive_count(one), 2U);
  const Shape many = repeated(one, 6);
  EXPECT_EQ(primitive_count(many), 12U);
  const Bounds& before = one.facts().bounds;
  const Bounds& after = many.facts().bounds;
  EXPECT_NEAR(after.hi[0] - after.lo[0], 3.5 * (before.hi[0] - before.lo[0]), 1e-9);
  EXPECT_NEAR(after.hi[1] - after.lo[1], 2.25 * (before.hi[1] - before.lo[1]), 1e-9);
  const Shape cubes = repeated(sphere(1), 27);
  EXPECT_NEAR(cubes.facts().bounds.hi[2] - cubes.facts().bounds.lo[2], 7, 1e-9);
}

TEST(StressWorkload, AnswersWithEveryColumnWhateverTheDimension) {
  for (const Shape& shape : {circle(3) - circle(1), sphere(2) | plane({0, 0, 1}, -1)}) {
    StressWorkload work(shape, 500, stress_reach(shape), 1);
    EXPECT_GE(work.collide(500, {}, {.threads = 1}), 500U);
    EXPECT_EQ(work.evaluate_values(500, {}), 500U);
    EXPECT_GE(work.evaluate_gradients(500, Gradient::central, {}),
              500U * 2 * static_cast<std::size_t>(shape.dimension()));
    EXPECT_EQ(work.admits(Gradient::dichotomy), shape.dimension() == 2);
    const std::size_t d = static_cast<std::size_t>(shape.dimension());
    // Corners; status, converged, claimed, ambiguous, stop; value, lower, point, normal, barycentric; three counters.
    EXPECT_EQ(work.bytes_per_triangle(), 4 * 3 * d + 5 + 4 * (2 + 2 * d + 3) + 12);
  }
}

}  // namespace
}  // namespace thalweg::cli
