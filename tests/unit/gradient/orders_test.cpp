// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The error of each strategy on exact fields against what analysis says of it. Around a circle the gradient turns by
// o / r over the probe distance o, and the leading terms are known in closed form; along a plane there is nothing but
// rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "asked.h"
#include "gradient/strategies.h"
#include "random.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

using testing_gradients::angle_between;
using testing_gradients::ask;
using testing_gradients::Asked;
using testing_gradients::compiled;

constexpr ProbeOffset fixed(double offset) { return {.absolute = offset, .of_value = 0, .of_scene = 0}; }

std::vector<float> ring(std::size_t dimension, std::size_t count) {
  oracle::Random random(11);
  std::vector<float> points;
  while (points.size() < count * dimension) {
    double p[3], square = 0;
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      p[axis] = random.uniform(-4, 4);
      square += p[axis] * p[axis];
    }
    if (square < 4 || square > 16) continue;
    for (std::size_t axis = 0; axis < dimension; ++axis) points.push_back(static_cast<float>(p[axis]));
  }
  return points;
}

/// Angles between the gradients and the way out of the centre.
std::vector<double> errors(const Tape& tape, Gradient strategy, double offset) {
  const Asked asked = ask(tape, ring(static_cast<std::size_t>(tape.dimension), 500), {strategy, fixed(offset)});
  std::vector<double> angles;
  for (std::size_t i = 0; i < asked.count(); ++i) {
    angles.push_back(angle_between(asked.direction(i), asked.point(i), asked.dimension));
  }
  return angles;
}

double mean(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double x : numbers) sum += x;
  return sum / static_cast<double>(numbers.size());
}

struct Order {
  Gradient strategy;
  double factor;  ///< by which the error falls when o is halved
};

TEST(ErrorOnACurvedField, FallsWithTheOrderOfTheStrategy) {
  for (const Shape& shape : {circle(1), sphere(1)}) {
    const Tape tape = compiled(shape);
    for (const Order order : {Order{Gradient::forward, 2}, Order{Gradient::simplex, 2}, Order{Gradient::central, 4}}) {
      const double wide = mean(errors(tape, order.strategy, 0.4));
      const double half = mean(errors(tape, order.strategy, 0.2));
      const double quarter = mean(errors(tape, order.strategy, 0.1));
      EXPECT_NEAR(wide / half, order.factor, 0.15 * order.factor) << name(order.strategy) << tape.dimension;
      EXPECT_NEAR(half / quarter, order.factor, 0.15 * order.factor) << name(order.strategy) << tape.dimension;
    }
  }
}

TEST(ErrorOfForwardDifferences, IsTheTaylorTerm) {
  // f(P + o e) - f(P) = o g + o^2 / 2 (e . H e): across the gradient that leaves o / (2 r) (cos^3 - sin^3).
  const Tape tape = compiled(circle(1));
  const double offset = 0.05;
  const Asked asked = ask(tape, ring(2, 500), {Gradient::forward, fixed(offset)});
  for (std::size_t i = 0; i < asked.count(); ++i) {
    const double x = static_cast<double>(asked.point(i)[0]), y = static_cast<double>(asked.point(i)[1]);
    const double r = std::hypot(x, y);
    const double expected = std::fabs(offset / (2 * r) * (std::pow(x / r, 3) - std::pow(y / r, 3)));
    EXPECT_NEAR(angle_between(asked.direction(i), asked.point(i), 2), expected, 0.1 * offset / r) << x << ' ' << y;
  }
}

TEST(ErrorOfTheDichotomies, IsLessThanTheLastHalving) {
  const double sector = 2 * std::numbers::pi / 3;
  const Tape tape = compiled(circle(1));
  for (const Gradient strategy : {Gradient::dichotomy, Gradient::dichotomy_verbatim}) {
    for (const double offset : {0.5, 0.1}) {
      const std::vector<double> angles = errors(tape, strategy, offset);
      EXPECT_LE(*std::max_element(angles.begin(), angles.end()), sector / 256) << name(strategy) << ' ' << offset;
      // It is a search with so many steps: a smaller offset gives no better angle.
      EXPECT_GT(mean(angles), sector / 2048) << name(strategy);
    }
  }
}

TEST(ErrorOfDichotomy, GrowsWithTheRootOfRoundingOverTheOffset) {
  // Near its maximum the circle of values is flat: rounding of size e hides angles up to sqrt(2 e / o).
  const Tape tape = compiled(circle(1));
  const double rounding = 16 * 0x1p-24;
  for (const double offset : {1e-3, 1e-4, 1e-5}) {
    const std::vector<double> angles = errors(tape, Gradient::dichotomy, offset);
    const double hidden = 2 * std::sqrt(2 * rounding / offset);
    EXPECT_LE(mean(angles), hidden + 2 * std::numbers::pi / 3 / 256) << offset;
  }
  EXPECT_GT(mean(errors(tape, Gradient::dichotomy, 1e-5)), 10 * mean(errors(tape, Gradient::dichotomy, 0.1)));
}

TEST(ErrorAlongAPlane, IsRoundingOverTheOffset) {
  for (const Shape& shape : {half_plane(Vec2{0.6, 0.8}, 0.3), plane(Vec3{0.48, 0.64, 0.6}, 0.3)}) {
    const Tape tape = compiled(shape);
    const auto d = static_cast<std::size_t>(tape.dimension);
    const double normal[3] = {d == 2 ? 0.6 : 0.48, d == 2 ? 0.8 : 0.64, 0.6};
    for (const Gradient strategy : {Gradient::central, Gradient::forward, Gradient::simplex}) {
      double last = 0;
      for (const double offset : {0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        const Asked asked = ask(tape, ring(d, 500), {strategy, fixed(offset)});
        std::vector<double> angles;
        for (std::size_t i = 0; i < asked.count(); ++i) angles.push_back(angle_between(asked.direction(i), normal, d));
        // Positions and values of size 4 are rounded to 2^-24 of it, each probe on its own.
        const double floor = 4 * 0x1p-24 / offset;
        EXPECT_LE(mean(angles), 4 * floor) << name(strategy) << ' ' << offset;
        EXPECT_GT(mean(angles), last) << name(strategy) << ' ' << offset;
        last = mean(angles);
      }
      EXPECT_GT(last, 3e-3) << "rounding must have shown";
    }
  }
}

TEST(Offsets, BelowTheSpacingOfFloatsGiveNoDirection) {
  const Tape tape = compiled(circle(1).translate({1e6, 0}));
  const Asked asked = ask(tape, {1e6F + 8, 3}, {Gradient::central, fixed(1e-9)});
  EXPECT_EQ(asked.gradient[0], 0);
  EXPECT_EQ(asked.gradient[1], 0);
}

TEST(Offsets, MayBeRelativeToTheScene) {
  // The diagonal of the bounds of a circle of radius 1 is 2 sqrt(2).
  const Tape tape = compiled(circle(1));
  const std::vector<float> points = ring(2, 100);
  const Asked of_scene = ask(tape, points, {Gradient::forward, {.absolute = 0, .of_value = 0, .of_scene = 0.05}});
  const Asked absolute = ask(tape, points, {Gradient::forward, fixed(0.05 * 2 * std::numbers::sqrt2)});
  EXPECT_EQ(of_scene.gradient, absolute.gradient);
}

TEST(Autodiff, AgreesWithCentralDifferencesInDoubleAwayFromKinks) {
  const Shape shapes[] = {
      smooth_union(1.0, {star(300, 12, 4).translate({1000, 550}), circle(200).translate({750, 400})}),
      smooth_union(0.3, {box(Vec3{1, 2, 1}).rotate(Vec3{1, 2, 3}, 0.7), torus(2, 0.5)}) - sphere(0.9)};
  for (const Shape& shape : shapes) {
    const Tape tape = compiled(shape);
    const auto d = static_cast<std::size_t>(tape.dimension);
    oracle::Random random(3);
    std::vector<float> points;
    const Bounds& bounds = tape.facts.bounds;
    for (std::size_t i = 0; i < 2000 * d; ++i) {
      points.push_back(static_cast<float>(random.uniform(bounds.lo[i % d], bounds.hi[i % d])));
    }
    const double diagonal = bounds.diagonal(tape.dimension), h = 1e-6 * diagonal;
    const Asked asked = ask(tape, points, {Gradient::autodiff, {}});
    std::size_t smooth = 0;
    for (std::size_t i = 0; i < asked.count(); ++i) {
      double p[3] = {}, slope[3] = {}, bend = 0, gradient[3] = {};
      for (std::size_t axis = 0; axis < d; ++axis) p[axis] = static_cast<double>(asked.point(i)[axis]);
      const double here = evaluate_double(tape, p, gradient);
      for (std::size_t axis = 0; axis < d; ++axis) {
        const double at = p[axis];
        p[axis] = at + h;
        const double ahead = evaluate_double(tape, p, nullptr);
        p[axis] = at - h;
        const double behind = evaluate_double(tape, p, nullptr);
        p[axis] = at;
        slope[axis] = (ahead - behind) / (2 * h);
        bend = std::max(bend, std::fabs(ahead - 2 * here + behind) / h);
      }
      // A kink, or a bend within a thousandth of the scene: no order of differences holds there.
      if (bend > 1e-3) continue;
      ++smooth;
      for (std::size_t axis = 0; axis < d; ++axis) {
        ASSERT_NEAR(gradient[axis], slope[axis], 1e-6) << "in double, at " << p[0] << ' ' << p[1] << ' ' << p[2];
        ASSERT_NEAR(static_cast<double>(asked.direction(i)[axis]), gradient[axis], 1e-3) << p[0] << ' ' << p[1];
      }
    }
    EXPECT_GT(smooth, asked.count() * 9 / 10);
  }
}

}  // namespace
}  // namespace thalweg
