// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The public batch queries: what each column holds, bad rows, empty batches, columns that nobody asked for.
#include "thalweg/batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "thalweg/method_table.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Tape tape_of(const Shape& shape) { return std::move(compile(shape)).value(); }

struct Columns {
  explicit Columns(std::size_t n, std::size_t d)
      : status(n, 77),
        converged(n, 77),
        claimed(n, 77),
        ambiguous(n, 77),
        stop(n, 77),
        starts(n, 77),
        iterations(n, 77),
        evaluations(n, 77),
        value(n, 77),
        lower(n, 77),
        point(n * d, 77),
        normal(n * d, 77),
        barycentric(3 * n, 77) {}
  CollideColumns all() {
    return {status.data(),      value.data(),       lower.data(),   converged.data(), point.data(),
            normal.data(),      barycentric.data(), claimed.data(), starts.data(),    iterations.data(),
            evaluations.data(), ambiguous.data(),   nullptr,        stop.data(),      {}};
  }
  std::vector<std::uint8_t> status, converged, claimed, ambiguous, stop;
  std::vector<std::uint32_t> starts, iterations, evaluations;
  std::vector<float> value, lower, point, normal, barycentric;
};

TEST(Batch, OfNoRowsSucceeds) {
  const Tape tape = tape_of(circle(1));
  const auto summary = collide_triangles(tape, {}, {}, {});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->rows, 0U);
  EXPECT_FALSE(summary->cancelled);
  EXPECT_EQ(evaluate(tape, nullptr, 0, nullptr, nullptr), 0U);
}

TEST(Batch, CountsWhatNobodyAskedFor) {
  const Tape tape = tape_of(circle(1));
  const std::vector<float> rows = {0, 0, 0.1F, 9, 9, 0.1F, 0, 0, kNan};
  const auto summary = collide_circles(tape, {rows.data(), 3}, {}, {});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->by_status[0], 1U);
  EXPECT_EQ(summary->by_status[1], 1U);
  EXPECT_EQ(summary->by_status[4], 1U);
  EXPECT_GE(summary->evaluations, 2U);
}

TEST(BadRow, HasNanInEveryFloatColumnAndStatus255WhileTheOthersAreAnswered) {
  const Tape tape = tape_of(circle(1));
  const float bad[] = {kNan, kInfinity, -kInfinity, 1.01e15F, -3e38F};
  for (const MethodRow& row_of_method : method_table()) {
    const Method method = row_of_method.method;
    if (!row_of_method.triangles) continue;
    std::vector<float> rows;
    for (std::size_t i = 0; i < 5; ++i) {
      std::vector<float> row = {0, 0, 0.1F, 0, 0, 0.1F};
      row[i] = bad[i];
      rows.insert(rows.end(), row.begin(), row.end());
      rows.insert(rows.end(), {0, 0, 0.1F, 0, 0, 0.1F});
    }
    Columns c(10, 2);
    CollideOptions options;
    options.method = method;
    const auto summary = collide_triangles(tape, {rows.data(), 10}, options, c.all());
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->by_status[4], 5U);
    for (std::size_t i = 0; i < 10; i += 2) {
      EXPECT_EQ(c.status[i], 255) << name(method);
      for (const float x : {c.value[i], c.lower[i], c.point[2 * i], c.point[2 * i + 1], c.normal[2 * i],
                            c.normal[2 * i + 1], c.barycentric[3 * i], c.barycentric[3 * i + 2]}) {
        EXPECT_TRUE(std::isnan(x)) << name(method) << ' ' << i;
      }
      EXPECT_EQ(c.converged[i], 0);
      EXPECT_EQ(c.claimed[i], 0);
      EXPECT_EQ(c.stop[i], 0);
      EXPECT_EQ(c.evaluations[i], 0U);
      EXPECT_EQ(c.status[i + 1], 1) << name(method);
      EXPECT_FALSE(std::isnan(c.value[i + 1]));
    }
  }
}

TEST(BadRow, IsACircleOfNegativeRadius) {
  const Tape tape = tape_of(circle(1));
  const std::vector<float> rows = {0, 0, -1, 0, 0, 0, 0, 0, -0.0F, 0, 0, 50, 0, 0, 1.1e15F};
  for (const Method method : {Method::certified, Method::published}) {
    Columns c(5, 2);
    CollideOptions options;
    options.method = method;
    ASSERT_TRUE(collide_circles(tape, {rows.data(), 5}, options, c.all()));
    EXPECT_EQ(c.status, (std::vector<std::uint8_t>{255, 1, 1, 1, 255})) << name(method);
  }
}

TEST(BadRow, OfPointsGivesNanAndIsCounted) {
  const Tape tape = tape_of(sphere(1));
  const std::vector<float> points = {0, 0, 0, kNan, 0, 0, 0, 0, 2, 0, 2e15F, 0};
  std::vector<float> value(4, 77), gradient(12, 77);
  EXPECT_EQ(evaluate(tape, points.data(), 4, value.data(), gradient.data()), 2U);
  EXPECT_EQ(value[0], -1);
  EXPECT_TRUE(std::isnan(value[1]) && std::isnan(gradient[3]) && std::isnan(gradient[5]));
  EXPECT_EQ(value[2], 1);
  EXPECT_EQ(gradient[8], 1);
  EXPECT_TRUE(std::isnan(value[3]));
}

TEST(Verdict, OfATriangleThatHoldsTheWholeShapeIsOverlapping) {
  const Tape tape = tape_of(circle(1e-3).translate(Vec2{0.3, 0.3}));
  const std::vector<float> rows = {-50, -40, 60, -50, 0, 80};
  Columns c(1, 2);
  ASSERT_TRUE(collide_triangles(tape, {rows.data(), 1}, {}, c.all()));
  EXPECT_EQ(c.status[0], 1);
  EXPECT_LT(std::hypot(c.point[0] - 0.3F, c.point[1] - 0.3F), 1e-3F);
}

TEST(Verdict, OfUnsignedShapesIsNeverOverlapping) {
  const Tape tape = tape_of(segment(Vec2{-1, 0}, Vec2{1, 0}));
  const std::vector<float> rows = {-0.5F, -0.5F, 0.5F, -0.5F, 0, 0.5F, 0, 0, 0, 0, 0, 0, 0, 2, 1, 2, 0, 3};
  Columns c(3, 2);
  ASSERT_TRUE(collide_triangles(tape, {rows.data(), 3}, {}, c.all()));
  EXPECT_EQ(c.status, (std::vector<std::uint8_t>{2, 2, 0}));
}

TEST(DeepestPoint, OfADiscInABoxIsTheFarthestFromItsFaces) {
  const Tape tape = tape_of(box(Vec2{2, 2}));
  const std::vector<float> rows = {1.5F, 0, 0.25F};
  Columns c(1, 2);
  CollideOptions options;
  options.goal = Goal::deepest, options.tolerance = 1e-4;
  ASSERT_TRUE(collide_circles(tape, {rows.data(), 1}, options, c.all()));
  EXPECT_EQ(c.status[0], 1);
  EXPECT_EQ(c.converged[0], 1);
  EXPECT_NEAR(c.value[0], -0.75F, 1e-4F);
  EXPECT_LE(c.lower[0], -0.75F);
  EXPECT_NEAR(c.point[0], 1.25F, 2e-4F);
  EXPECT_EQ(c.normal[0], 1);
}

TEST(Normal, IsAFixedUnitVectorMarkedAmbiguousWhereTheGradientVanishes) {
  const Tape tape = tape_of(circle(1));
  const std::vector<float> rows = {0, 0, 0, 0, 0, 0};
  Columns c(1, 2);
  ASSERT_TRUE(collide_triangles(tape, {rows.data(), 1}, {}, c.all()));
  EXPECT_EQ(c.status[0], 1);
  EXPECT_EQ(c.ambiguous[0], 1);
  EXPECT_EQ(c.normal[0], 0);
  EXPECT_EQ(c.normal[1], 1);
}

TEST(LocalMethods, ProveNothingApartButSayTheirOpinion) {
  const Tape tape = tape_of(circle(1));
  const std::vector<float> rows = {3, 0, 4, 0, 3, 1, 0, 0, 0.1F, 0, 0, 0.1F};
  for (const MethodRow& row : method_table()) {
    const Method method = row.method;
    if (row.proves || !row.triangles) continue;
    Columns c(2, 2);
    CollideOptions options;
    options.method = method;
    // A verdict asks for no more than its own certainty.
    options.goal = Goal::deepest;
    if (method == Method::thesis_scaled) options.step = 0.5;
    ASSERT_TRUE(collide_triangles(tape, {rows.data(), 2}, options, c.all()));
    EXPECT_EQ(c.status, (std::vector<std::uint8_t>{3, 1})) << name(method);
    EXPECT_EQ(c.claimed, (std::vector<std::uint8_t>{0, 1})) << name(method);
    EXPECT_EQ(c.lower[0], -kInfinity);
    EXPECT_NEAR(c.value[0], 2, 1e-2) << name(method);
  }
}

TEST(ThesisMethod, TakesSixtyFourIterationsOfThirteenEvaluationsAndOneToEnd) {
  const Tape tape = tape_of(star(3, 5, 3));
  const std::vector<float> rows = {3, 0, 4, 0, 3, 1};
  Columns c(1, 2);
  CollideOptions options;
  options.method = Method::thesis;
  ASSERT_TRUE(collide_triangles(tape, {rows.data(), 1}, options, c.all()));
  EXPECT_EQ(c.iterations[0], 64U);
  EXPECT_GE(c.evaluations[0], 832U);
  EXPECT_LE(c.evaluations[0], 834U);
  EXPECT_EQ(c.starts[0], 1U);
}

TEST(PublishedMethod, ClaimsWhatACentreAndARadiusSay) {
  // Behind a lower bound (the far side of a smooth blend) the published test over-reports.
  const Tape tape = tape_of(box(Vec2{1, 1}) - circle(1).translate(Vec2{1, 1}));
  const std::vector<float> rows = {0.9F, 0.9F, 0.25F, -3, 0, 1.5F, -3, 0, 2.5F};
  Columns c(3, 2);
  CollideOptions options;
  options.method = Method::published;
  ASSERT_TRUE(collide_circles(tape, {rows.data(), 3}, options, c.all()));
  EXPECT_EQ(c.claimed, (std::vector<std::uint8_t>{0, 0, 1}));
  EXPECT_EQ(c.status, (std::vector<std::uint8_t>{0, 0, 1}));
  EXPECT_EQ(c.evaluations[0], 2U);
}

TEST(Budget, OfOneEvaluationStillAnswersTruthfully) {
  const Tape tape = tape_of(circle(1));
  const std::vector<float> rows = {9, 0, 9.5F, 0, 9, 1, 0, 0, 0.1F, 0, 0, 0.1F, 0.9F, 0.9F, 3, 0.5F, 0.5F, 3};
  Columns c(3, 2);
  CollideOptions options;
  options.budget = 1;
  ASSERT_TRUE(collide_triangles(tape, {rows.data(), 3}, options, c.all()));
  EXPECT_EQ(c.status, (std::vector<std::uint8_t>{0, 1, 3}));
  for (const std::uint32_t evaluations : c.evaluations) EXPECT_LE(evaluations, 1U);
  EXPECT_EQ(c.converged[2], 0);
}

}  // namespace
}  // namespace thalweg
