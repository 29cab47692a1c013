// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Queries that float32 cannot tell apart and that therefore end in the search in double precision. Their coordinates
// are float32, so it is the shape that is off by less than an ulp.
#include "solve/decide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

struct Answer {
  std::uint8_t status = 77, converged = 77;
  float value = 0, lower = 0, point[3] = {};
  std::uint32_t evaluations = 0;
  double exact = 0;  ///< f at `point` in double
};

Answer ask(const Shape& shape, const std::vector<float>& row, const CollideOptions& options = {}) {
  const Tape tape = std::move(compile(shape)).value();
  Answer answer;
  CollideColumns columns;
  columns.status = &answer.status, columns.converged = &answer.converged;
  columns.value = &answer.value, columns.lower = &answer.lower, columns.point = answer.point;
  columns.evaluations = &answer.evaluations;
  const bool is_ball = row.size() <= 4;
  const auto done = is_ball ? collide_circles(tape, {row.data(), 1}, options, columns)
                            : collide_triangles(tape, {row.data(), 1}, options, columns);
  EXPECT_TRUE(done);
  const double p[3] = {answer.point[0], answer.point[1], answer.point[2]};
  answer.exact = evaluate_double(tape, p, nullptr);
  return answer;
}

CollideOptions deepest(double tolerance) {
  CollideOptions options;
  options.goal = Goal::deepest, options.tolerance = tolerance;
  return options;
}

/// Stands on the point (0, 1).
const std::vector<float> kTip = {0, 1, -1, 3, 1, 3};

TEST(DecidedInDouble, IsATipThatMissesACircleByAMillionthOfAnUlp) {
  for (const double gap : {1e-8, 1e-10, 1e-12}) {
    const Answer answer = ask(circle(1 - gap), kTip);
    EXPECT_EQ(answer.status, 0) << gap;
    EXPECT_GT(answer.lower, 0) << gap;
    EXPECT_LE(answer.lower, gap) << gap;
    EXPECT_EQ(answer.converged, 1) << gap;
  }
}

TEST(DecidedInDouble, IsATipThatDipsIntoACircleByAMillionthOfAnUlp) {
  for (const double dip : {1e-8, 1e-10, 1e-12}) {
    const Answer answer = ask(circle(1 + dip), kTip);
    EXPECT_EQ(answer.status, 1) << dip;
    EXPECT_LT(answer.exact, 0) << dip;
    EXPECT_LE(answer.lower, -dip) << dip;
  }
}

TEST(DecidedInDouble, IsTouchingWhereATipTouchesExactly) {
  const Answer answer = ask(circle(1), kTip);
  EXPECT_EQ(answer.status, 2);
  EXPECT_LE(answer.lower, 0);
}

TEST(DecidedInDouble, IsATriangleFlushWithAFaceInSpace) {
  const std::vector<float> flush = {-3, 1, -2, 4, 1, -3, 1, 1, 5};
  EXPECT_EQ(ask(box(Vec3{8, 1 - 1e-11, 8}), flush).status, 0);
  EXPECT_EQ(ask(box(Vec3{8, 1 + 1e-11, 8}), flush).status, 1);
  EXPECT_EQ(ask(box(Vec3{8, 1, 8}), flush).status, 2);
}

TEST(DecidedInDouble, IsABallBesideTheCornerOfABox) {
  // From the corner (1, 1) to the centre (2.5, 3): exactly 2.5.
  EXPECT_EQ(ask(box(Vec2{1 - 1e-9, 1 - 1e-9}), {2.5F, 3, 2.5F}).status, 0);
  // A round region meets a corner at a point: the budget may end first, but not in an untruth.
  for (const double off : {1e-11, 1e-12}) EXPECT_NE(ask(box(Vec2{1 - off, 1 - off}), {2.5F, 3, 2.5F}).status, 1) << off;
  for (const double off : {1e-11, 1e-12}) EXPECT_NE(ask(box(Vec2{1 + off, 1 + off}), {2.5F, 3, 2.5F}).status, 0) << off;
  const Answer touching = ask(box(Vec2{1, 1}), {2.5F, 3, 2.5F});
  EXPECT_EQ(touching.status, 2);
  EXPECT_LE(touching.lower, 0);
}

TEST(DecidedInDouble, IsAPointThatIsNoTriangleAtAll) {
  const std::vector<float> point = {3, 4, 3, 4, 3, 4};
  EXPECT_EQ(ask(circle(5 - 1e-12), point).status, 0);
  EXPECT_EQ(ask(circle(5 + 1e-12), point).status, 1);
  EXPECT_EQ(ask(circle(5), point).status, 2);
}

TEST(DecidedInDouble, BracketsTheDeepestPointWithinATinyTolerance) {
  const Answer answer = ask(circle(1), {0, 0.25F, -1, 2.25F, 1, 2.25F}, deepest(1e-6));
  EXPECT_EQ(answer.status, 1);
  EXPECT_EQ(answer.converged, 1);
  EXPECT_NEAR(answer.value, -0.75, 2e-6);
  EXPECT_LE(answer.lower, -0.75F);
  EXPECT_NEAR(answer.exact, answer.value, 1e-6);
}

TEST(DecidedInDouble, KeepsToTheBudgetAndSaysWhatIsProven) {
  for (const std::uint32_t budget : {1U, 2U, 3U, 10U, 50U, 1000U}) {
    CollideOptions options = deepest(1e-9);
    options.budget = budget;
    const Answer answer = ask(star(1, 9, 4), kTip, options);
    EXPECT_LE(answer.evaluations, budget);
    EXPECT_LE(answer.lower, answer.value);
  }
}

}  // namespace
}  // namespace thalweg
