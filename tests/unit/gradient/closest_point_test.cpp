// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The field of nearest surface points, against surfaces whose nearest points are known, or found by brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "asked.h"
#include "random.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

using testing_gradients::angle_between;
using testing_gradients::ask;
using testing_gradients::Asked;
using testing_gradients::compiled;

constexpr GradientOptions kClosest{Gradient::closest_point, {}};

double distance_to(const float* a, const float* b, std::size_t dimension) {
  double square = 0;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const double x = static_cast<double>(a[axis]) - static_cast<double>(b[axis]);
    square += x * x;
  }
  return std::sqrt(square);
}

TEST(ClosestPoint, TakesOneEvaluationWhereTheFieldIsADistance) {
  const Tape tape = compiled(circle(5));
  const Asked asked = ask(tape, {6, 8, -3, 0, 0, 4.5F}, kClosest);
  const float expected[] = {3, 4, -5, 0, 0, 5};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(asked.evaluations[i], 1U);
    EXPECT_LT(distance_to(asked.witness.data() + 2 * i, expected + 2 * i, 2), 1e-5) << i;
    EXPECT_LT(angle_between(asked.direction(i), asked.point(i), 2), 1e-5) << i;
  }
}

TEST(ClosestPoint, FindsTheCornerThatAnIntersectionsFieldDoesNotKnow) {
  // max(x, y): outside the corner f is a bound, and its gradient an axis.
  const Tape tape = compiled(half_plane(Vec2{1, 0}, 0) & half_plane(Vec2{0, 1}, 0));
  const Asked asked = ask(tape, {3, 4, 0.5F, 0.25F, 40, 3}, kClosest);
  for (std::size_t i = 0; i < asked.count(); ++i) {
    EXPECT_LT(std::hypot(asked.witness[2 * i], asked.witness[2 * i + 1]), 2e-2F) << i;
    EXPECT_LT(angle_between(asked.direction(i), asked.point(i), 2), 1e-2) << i;
    EXPECT_GT(asked.evaluations[i], 1U) << i;
  }
}

struct Surface {
  const char* name;
  Shape shape;
  double within;  ///< share of points whose nearest point must be found
};

/// Points of the surface by bisection along rays from an inner point of a shape that is star-shaped around it.
std::vector<float> surface_points(const Tape& tape, std::size_t count) {
  std::vector<float> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    double lo = 0, hi = 10;
    for (int step = 0; step < 48; ++step) {
      const double r = (lo + hi) / 2, p[2] = {r * std::cos(turn), r * std::sin(turn)};
      (evaluate_double(tape, p, nullptr) < 0 ? lo : hi) = r;
    }
    points.push_back(static_cast<float>(lo * std::cos(turn)));
    points.push_back(static_cast<float>(lo * std::sin(turn)));
  }
  return points;
}

TEST(ClosestPoint, IsOnTheSurfaceAndMostlyTheNearest) {
  const Surface surfaces[] = {
      {"smooth union", smooth_union(0.2, {circle(1).translate({-0.6, 0}), circle(0.8).translate({0.6, 0.1})}), 0.97},
      {"union from inside", circle(1).translate({-0.5, 0}) | circle(1).translate({0.5, 0}), 0.97},
      {"intersection", circle(1.5).translate({-0.5, 0}) & box(Vec2{1, 1}), 0.97},
      {"rounded corners", round(box(Vec2{1, 0.4}) & circle(0.9), 0.1), 0.97}};
  for (const Surface& surface : surfaces) {
    const Tape tape = compiled(surface.shape);
    const std::vector<float> boundary = surface_points(tape, 4000);
    oracle::Random random(29);
    std::vector<float> points;
    for (int i = 0; i < 600; ++i) points.push_back(static_cast<float>(random.uniform(-2, 2)));
    const Asked asked = ask(tape, points, kClosest);
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < asked.count(); ++i) {
      const float* witness = asked.witness.data() + 2 * i;
      double least = 1e9;
      for (std::size_t j = 0; j < boundary.size(); j += 2) {
        least = std::min(least, distance_to(asked.point(i), boundary.data() + j, 2));
      }
      const double found = distance_to(asked.point(i), witness, 2);
      const double p[2] = {static_cast<double>(witness[0]), static_cast<double>(witness[1])};
      // f is 1-Lipschitz, so |f| at the witness says how far off the surface it may seem.
      EXPECT_LE(std::fabs(evaluate_double(tape, p, nullptr)), 1e-3 * found + 1e-5) << surface.name << ' ' << i;
      EXPECT_GE(found, least - 2e-3) << surface.name << ' ' << i;
      nearest += found <= 1.01 * least + 2e-3 ? 1 : 0;
      ASSERT_LE(asked.evaluations[i], 48U);
    }
    EXPECT_GE(static_cast<double>(nearest), surface.within * static_cast<double>(asked.count())) << surface.name;
  }
}

TEST(ClosestPoint, WorksInSpace) {
  const Tape tape = compiled(sphere(1) & box(Vec3{0.7, 0.7, 0.7}));
  // Outside a face the nearest point is on the face, outside an edge of the box on that edge.
  const Asked asked = ask(tape, {2, 0.1F, 0.2F, 1.2F, 1.7F, 0}, kClosest);
  const float expected[] = {0.7F, 0.1F, 0.2F, 0.7F, 0.7F, 0};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(distance_to(asked.witness.data() + 3 * i, expected + 3 * i, 3), 0.02) << i;
  }
}

TEST(Witnesses, AreGivenByClosestPointAlone) {
  const Tape tape = compiled(circle(1));
  const float point[2] = {2, 0};
  float gradient[2], witness[2];
  const auto refused = evaluate(tape, Points{point, 1}, {Gradient::central, {}},
                                {.gradient = gradient, .witness = witness}, {.threads = 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().place, "--gradient");
}

}  // namespace
}  // namespace thalweg
