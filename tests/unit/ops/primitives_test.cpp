// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Single points of primitives' fields, each for a fault that was found there. The whole fields are held against the
// oracle in tests/conformance/.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "thalweg/batch.h"
#include "thalweg/ops.h"
#include "thalweg/simd.h"

namespace thalweg {
namespace {

Tape compiled(const Shape& shape) { return std::move(compile(shape)).value(); }

double in_double(const Tape& tape, double x, double y) {
  const double p[2] = {x, y};
  return evaluate_double(tape, p, nullptr);
}

/// On every target within the tape's slack of the value.
void expect_value(const Shape& shape, Vec2 at, double expected) {
  const Tape tape = compiled(shape);
  const float p[2] = {static_cast<float>(at.x), static_cast<float>(at.y)};
  for (const Target& target : targets()) {
    float value = 0;
    evaluate(tape, p, 1, &value, nullptr, {.threads = 1, .target = &target});
    EXPECT_NEAR(value, expected, tape.slack(std::max(std::fabs(at.x), std::fabs(at.y)))) << target.name;
  }
}

TEST(Segment, ShorterThanTheSmallestLengthIsNoPoint) {
  expect_value(segment(Vec2{-1e-18, -1e-18}, Vec2{-1e-15, -1e-18}), {-5e-16, 0}, 1e-18);
}

TEST(Segment, TooShortForFloat32KeepsItsLengthInDouble) {
  const Tape tape = compiled(segment(Vec2{-1e-22, -1e-22}, Vec2{1e-22, -1e-22}));
  EXPECT_NEAR(in_double(tape, 0, 0), 1e-22, 1e-34);
  EXPECT_NEAR(in_double(tape, 3e-22, 3e-22), std::hypot(2e-22, 4e-22), 1e-34);
}

TEST(Ring, WithoutAHolePointsAwayFromItsCentre) {
  // The end's inner corner and the circle of radius 0 are the same point: rounding decides which of them is nearest.
  const Tape tape = compiled(ring(std::numbers::pi - 1e-6, 0.5, 1));
  for (int i = 0; i < 1000; ++i) {
    const double angle = 0.0015 * i, r = 0.0004 * (i + 100);
    const float p[2] = {static_cast<float>(r * std::sin(angle)), static_cast<float>(r * std::cos(angle))};
    for (const Target& target : targets()) {
      float gradient[2] = {};
      evaluate(tape, p, 1, nullptr, gradient, {.threads = 1, .target = &target});
      EXPECT_NEAR(gradient[0], -p[0] / r, 1e-6) << i << ' ' << target.name;
      EXPECT_NEAR(gradient[1], -p[1] / r, 1e-6) << i << ' ' << target.name;
    }
  }
}

TEST(Circle, HasNoGradientAboveOneNextToItsCentre) {
  const Tape tape = compiled(circle(1));
  for (const double r : {1e-15, 1e-18, 1e-19, 3e-20, 1e-21, 1e-22, 4e-23, 1e-24, 1e-30, 1e-42}) {
    const float p[2] = {static_cast<float>(r), 0};
    for (const Target& target : targets()) {
      float gradient[2] = {};
      evaluate(tape, p, 1, nullptr, gradient, {.threads = 1, .target = &target});
      EXPECT_LE(std::hypot(gradient[0], gradient[1]), 1.00001F) << r << ' ' << target.name;
    }
  }
}

TEST(Moon, KeepsTheDigitsOfItsCornerForATinyBite) {
  // By 50 digits: the corner's height is 9.99999999999999329e-8.
  const Tape tape = compiled(moon(std::numbers::sqrt2, std::numbers::sqrt2, 1e-7));
  EXPECT_NEAR(in_double(tape, 1.4142137765884399, 0), 2.3640688539205261552e-07, 1e-14);
}

TEST(Moon, KeepsTheDigitsOfItsCornerForATinyOffset) {
  const double r = 1.0000001192092896;
  const Tape tape = compiled(moon(1e-15, r, r));
  EXPECT_NEAR(in_double(tape, 1.0000001537946446e-07, 0), std::hypot(1.0000001537946446e-07, r), 1e-14);
  const Tape wide = compiled(moon(1e-7, 0.5, 0.5));
  EXPECT_NEAR(in_double(wide, 0.25, 0), std::hypot(0.25 - 5e-8, std::sqrt(0.25 - 2.5e-15)), 1e-14);
}

TEST(Triangle, ThinnerThanFloat32CanTellIsOutsideBeyondItsTip) {
  for (const double width : {1e-6, 1e-8, 1e-10}) {
    const Shape needle = triangle(Vec2{0, 1.4142}, Vec2{-0.5, width}, Vec2{-0.5, -width});
    for (int i = 1; i < 200; ++i) {
      // On the needle's axis, rounded to float32.
      const float x = 0.01F * static_cast<float>(i), y = 1.4142F + 2.8284F * x;
      expect_value(needle, {x, y}, std::hypot(static_cast<double>(x), y - 1.4142));
    }
  }
}

TEST(Blend, StatesARoundingThatCoversItsWidthAroundSmallOperands) {
  const double k = 1.2751157890034408, radius = 0.058720422959304755;
  const Tape tape = compiled(smooth_subtraction(k, {sphere(radius), sphere(radius)}));
  const float p[3] = {0.023251527920365334F, -0.042133037000894547F, -0.028707548975944519F};
  const double at[3] = {p[0], p[1], p[2]};
  for (const Target& target : targets()) {
    float value = 0;
    evaluate(tape, p, 1, &value, nullptr, {.threads = 1, .target = &target});
    EXPECT_NEAR(value, evaluate_double(tape, at, nullptr), tape.slack(0.05)) << target.name;
  }
}

TEST(RoundAndOnion, StateARoundingThatCoversTheirConstantsOwn) {
  expect_value(onion(circle(1e-7), std::numbers::pi), {0, 0}, 1e-7 - std::numbers::pi);
  expect_value(round(circle(1e-7), 1e-3), {0, 0}, -1e-7 - 1e-3);
}

}  // namespace
}  // namespace thalweg
