// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "gradient/strategies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "random.h"
#include "solve/arena.h"
#include "thalweg/ops.h"
#include "thalweg/simd.h"

namespace thalweg {
namespace {

constexpr Gradient kAll[] = {Gradient::autodiff,     Gradient::central,   Gradient::forward,
                             Gradient::simplex,      Gradient::dichotomy, Gradient::dichotomy_verbatim,
                             Gradient::closest_point};

struct Point {
  float x, y, z;
};
struct Answer {
  float value, gradient[3];
};

std::vector<Answer> ask(const Shape& shape, Gradient strategy, const std::vector<Point>& at, ProbeOffset offset = {}) {
  const Tape tape = std::move(compile(shape)).value();
  Arena arena;
  const std::size_t room = padded(at.size());
  float* points[3] = {arena.take<float>(room), arena.take<float>(room), arena.take<float>(room)};
  float* gradient[3] = {arena.take<float>(room), arena.take<float>(room), arena.take<float>(room)};
  float* value = arena.take<float>(room);
  for (std::size_t i = 0; i < at.size(); ++i) points[0][i] = at[i].x, points[1][i] = at[i].y, points[2][i] = at[i].z;
  evaluate_gradient(rule_of(tape, strategy, offset), tape, *default_target().kernels,
                    {.points = points, .count = at.size(), .value = value, .gradient = gradient},
                    arena.take<float>(scratch_floats(tape)));
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < at.size(); ++i) {
    answers.push_back({value[i], {gradient[0][i], gradient[1][i], tape.dimension == 3 ? gradient[2][i] : 0}});
  }
  return answers;
}

TEST(GradientStrategies, PointOutOfACircle) {
  const std::vector<Point> at = {{6, 8, 0}, {-0.3F, 0.4F, 0}, {5.5F, 0, 0}, {0, -2, 0}};
  for (const Gradient strategy : kAll) {
    const auto answers = ask(circle(5), strategy, at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const float r = std::hypot(at[i].x, at[i].y);
      EXPECT_NEAR(answers[i].value, r - 5, 1e-5) << name(strategy);
      EXPECT_NEAR(answers[i].gradient[0], at[i].x / r, 0.02) << name(strategy) << ' ' << i;
      EXPECT_NEAR(answers[i].gradient[1], at[i].y / r, 0.02) << name(strategy) << ' ' << i;
    }
  }
}

TEST(GradientStrategies, AgreeInSpace) {
  const Shape shape = smooth_union(0.3, {box(Vec3{1, 2, 1}).rotate(Vec3{1, 2, 3}, 0.7), torus(2, 0.5)});
  const std::vector<Point> at = {{3, 1, 2}, {-2, 0.3F, 1}, {0.1F, 3, 0.4F}, {4, -4, 4}};
  const auto exact = ask(shape, Gradient::autodiff, at);
  for (const Gradient strategy : {Gradient::central, Gradient::forward, Gradient::simplex}) {
    const auto answers = ask(shape, strategy, at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      float square = 0, along = 0, own = 0;
      for (int axis = 0; axis < 3; ++axis) {
        square += answers[i].gradient[axis] * answers[i].gradient[axis];
        own += exact[i].gradient[axis] * exact[i].gradient[axis];
        along += answers[i].gradient[axis] * exact[i].gradient[axis];
      }
      EXPECT_NEAR(square, 1, 1e-5) << name(strategy);
      EXPECT_NEAR(along / std::sqrt(own), 1, 1e-3) << name(strategy) << ' ' << i;
    }
  }
}

TEST(Dichotomy, TurnsWithTheGradientAllTheWayRound) {
  // Directions near the ends of the first thirds, where the angle wraps, among them.
  std::vector<Point> at;
  for (int i = 0; i < 360; ++i) {
    const float angle = static_cast<float>(i) * 0.01745329F;
    at.push_back({7 * std::cos(angle), 7 * std::sin(angle), 0});
  }
  for (const Gradient strategy : {Gradient::dichotomy, Gradient::dichotomy_verbatim}) {
    const auto answers = ask(circle(5), strategy, at, {.absolute = 0.5, .of_value = 0});
    for (std::size_t i = 0; i < at.size(); ++i) {
      const float along = (answers[i].gradient[0] * at[i].x + answers[i].gradient[1] * at[i].y) / 7;
      // A third of a turn halved eight times.
      EXPECT_GT(along, std::cos(2.0944F / 256)) << name(strategy) << " at " << i << " degrees";
    }
  }
}

TEST(Differences, GiveZeroAtTheCentreOfACircle) {
  for (const Gradient strategy : {Gradient::central, Gradient::simplex}) {
    const auto answer = ask(circle(5), strategy, {{0, 0, 0}}).front();
    EXPECT_LT(std::hypot(answer.gradient[0], answer.gradient[1]), 1.001F);
    EXPECT_FALSE(std::isnan(answer.gradient[0]));
  }
}

TEST(ProbeOffset, GrowsWithTheFieldWhereItIsRelative) {
  // Over a kink at distance 1: a small offset sees one face of the box, a large one its corner.
  const std::vector<Point> at = {{4, 1.9F, 0}};
  const auto close = ask(box(Vec2{2, 2}), Gradient::central, at, {.absolute = 0.001, .of_value = 0}).front();
  const auto wide = ask(box(Vec2{2, 2}), Gradient::central, at, {.absolute = 0.001, .of_value = 0.5}).front();
  EXPECT_NEAR(close.gradient[1], 0, 1e-3);
  EXPECT_GT(wide.gradient[1], 0.05F);
}

TEST(EvaluationsOfAGradient, AreThoseOfTheTable) {
  const Tape flat = std::move(compile(circle(1))).value();
  const Tape solid = std::move(compile(sphere(1))).value();
  const ProbeOffset fixed{.absolute = 0.01, .of_value = 0};
  const std::pair<Gradient, std::uint32_t> counts[] = {{Gradient::autodiff, 1},     {Gradient::central, 4},
                                                       {Gradient::forward, 3},      {Gradient::simplex, 3},
                                                       {Gradient::dichotomy, 12},   {Gradient::dichotomy_verbatim, 12},
                                                       {Gradient::closest_point, 1}};
  for (const auto& [strategy, count] : counts) {
    EXPECT_EQ(evaluations_of(rule_of(flat, strategy, fixed), 2, false), count) << name(strategy);
  }
  EXPECT_EQ(evaluations_of(rule_of(solid, Gradient::central, fixed), 3, false), 6U);
  EXPECT_EQ(evaluations_of(rule_of(solid, Gradient::simplex, fixed), 3, false), 4U);
  // The one at the point: where the caller wants it, or an offset relative to it.
  EXPECT_EQ(evaluations_of(rule_of(flat, Gradient::central, fixed), 2, true), 5U);
  EXPECT_EQ(evaluations_of(rule_of(flat, Gradient::central, {}), 2, false), 5U);
  EXPECT_EQ(evaluations_of(rule_of(flat, Gradient::forward, {}), 2, true), 3U);
}

}  // namespace
}  // namespace thalweg
