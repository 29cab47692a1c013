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
    evaluate(tape, p, 1, &value, nullptr, Gradient::autodiff, {.threads = 1, .target = &target});
    EXPECT_NEAR(value, expected, tape.slack(std::max(std::fabs(at.x), std::fabs(at.y)))) << target.name;
  }
}

TEST(Segment, ShorterThanTheSmallestLengthIsNoPoint) {
  expect_value(segment(Vec2{-1e-18, -1e-18}, Vec2{-1e-15, -1e-18}), {-5e-16, 0}, 1e-18);
}

TEST(Circle, HasNoGradientAboveOneNextToItsCentre) {
  const Tape tape = compiled(circle(1));
  for (const double r : {1e-15, 1e-18, 1e-19, 3e-20, 1e-21, 1e-22, 4e-23, 1e-24, 1e-30, 1e-42}) {
    const float p[2] = {static_cast<float>(r), 0};
    for (const Target& target : targets()) {
      float gradient[2] = {};
      evaluate(tape, p, 1, nullptr, gradient, Gradient::autodiff, {.threads = 1, .target = &target});
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

TEST(RoundAndOnion, StateARoundingThatCoversTheirConstantsOwn) {
  expect_value(onion(circle(1e-7), std::numbers::pi), {0, 0}, 1e-7 - std::numbers::pi);
  expect_value(round(circle(1e-7), 1e-3), {0, 0}, -1e-7 - 1e-3);
}

}  // namespace
}  // namespace thalweg
