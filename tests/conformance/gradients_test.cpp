// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The gradient kernel: the value kernel's own bits, the slope of the oracle's field where that has one, and never
// steeper than the Lipschitz constant.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <optional>

#include "comparison.h"
#include "random_shapes.h"

namespace thalweg::conformance {
namespace {

using oracle::describe;
using oracle::Field;
using oracle::Random;
using oracle::Vec;

class Gradients : public testing::TestWithParam<OnTarget> {};

std::string text(Vec p) { return std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z); }

Vec gradient_at(const Columns& columns, std::size_t i, int dimension) {
  return {columns.gradient[0][i], columns.gradient[1][i], dimension == 3 ? columns.gradient[2][i] : 0.0};
}

/// Central differences with step h, or nothing where a kink or a bend lies within about h of p.
std::optional<Vec> slope(const Field& field, Vec p, double h) {
  const double here = field(p);
  const auto along = [&](Vec step) -> std::optional<double> {
    const double ahead = field(p + step), behind = field(p - step);
    if (std::fabs(ahead - 2 * here + behind) > 1e-3 * h) return std::nullopt;
    return (ahead - behind) / (2 * h);
  };
  const auto x = along({h, 0, 0}), y = along({0, h, 0});
  const auto z = field.dimension() == 3 ? along({0, 0, h}) : std::optional(0.0);
  if (!x || !y || !z) return std::nullopt;
  return Vec{*x, *y, *z};
}

TEST_P(Gradients, AreTheSlopesOfTheOraclesFieldAwayFromKinks) {
  std::size_t smooth = 0, all = 0;
  for (const Case& drawn : plain_cases(GetParam().op, amount(20))) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error());
    const Field field(drawn.shape);
    Random random(drawn.seed);
    const Points points = plain_points(random, drawn.shape, 128);
    const Columns found = run_gradient(*tape, *GetParam().target, points);
    for (std::size_t i = 0; i < points.count; ++i) {
      ++all;
      // Far wider than the rounding of a position, so that no kink hides between the two.
      const auto expected = slope(field, points.at(i), 1e-4 + 256 * tape->slack(points.magnitude(i)));
      if (!expected) continue;
      ++smooth;
      const Vec g = gradient_at(found, i, tape->dimension);
      ASSERT_LT(distance(g, *expected), 4e-3)
          << "found " << text(g) << ", expected " << text(*expected) << " at " << text(points.at(i)) << "\n"
          << describe(drawn.shape, drawn.seed);
    }
  }
  EXPECT_GT(4 * smooth, all) << "the test skips too much";
}

TEST_P(Gradients, AreNoSteeperThanTheLipschitzConstantAndLeaveTheValuesBitsAlone) {
  for (const Case& drawn : spicy_cases(GetParam().op, amount(30))) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error());
    Random random(drawn.seed);
    const Points points = spicy_points(random, drawn.shape, Field(drawn.shape));
    const Columns values = run_value(*tape, *GetParam().target, points);
    const Columns found = run_gradient(*tape, *GetParam().target, points);
    for (std::size_t i = 0; i < points.count; ++i) {
      const Vec g = gradient_at(found, i, tape->dimension);
      const auto place = [&] { return " at " + text(points.at(i)) + "\n" + describe(drawn.shape, drawn.seed); };
      ASSERT_EQ(std::bit_cast<std::uint32_t>(found.value[i]), std::bit_cast<std::uint32_t>(values.value[i])) << place();
      ASSERT_LE(length(g), tape->facts.lipschitz * (1 + 1e-5)) << text(g) << place();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ops, Gradients, testing::ValuesIn(every_op_on_every_target()),
                         [](const auto& on) { return label(on.param); });

// The direction given where none is defined is documented: the first operand's at a tie, none at a centre.
TEST(GradientTies, OfAUnionGoToTheFirstOperand) {
  const Shape left = *Shape::make("circle", 2, std::array{1.0});
  const Shape pair = left.translate(Vec2{-2, 0}) | left.translate(Vec2{2, 0});
  const auto tape = compile(pair);
  ASSERT_TRUE(tape);
  Points points(2);
  points.add({0, 0, 0});
  points.pad();
  for (const Target& target : targets()) {
    const Columns found = run_gradient(*tape, target, points);
    EXPECT_EQ(found.gradient[0][0], 1) << target.name;
    EXPECT_EQ(found.gradient[1][0], 0) << target.name;
  }
}

TEST(GradientTies, VanishAtTheCentreOfACircle) {
  const auto tape = compile(*Shape::make("circle", 2, std::array{1.0}));
  ASSERT_TRUE(tape);
  Points points(2);
  points.add({0, 0, 0});
  points.pad();
  for (const Target& target : targets()) {
    const Columns found = run_gradient(*tape, target, points);
    EXPECT_EQ(found.gradient[0][0], 0) << target.name;
    EXPECT_EQ(found.gradient[1][0], 0) << target.name;
  }
}

}  // namespace
}  // namespace thalweg::conformance
