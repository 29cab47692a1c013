// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Shapes far thinner than float32 can tell, seen from afar and along their axis: never inside out, and as far away as
// they are.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "comparison.h"
#include "thalweg/ops.h"

namespace thalweg::conformance {
namespace {

using oracle::Field;
using oracle::Random;
using oracle::Vec;

constexpr double kWidths[] = {1e-2, 1e-4, 1e-6, 1e-7, 1e-8, 1e-10};

/// Points on the axis from `from` towards `to` and beyond both, on it and a little beside it.
Points along_axis(Random& random, Vec from, Vec to) {
  Points points(2);
  const Vec axis = to - from, aside{-axis.y, axis.x, 0};
  for (int i = 0; i < 2000; ++i) {
    const double beside = random.chance(0.5) ? 0 : random.spread(1e-9, 1e-1) * (random.chance(0.5) ? 1 : -1);
    points.add(from + axis * random.uniform(-3, 4) + aside * beside);
  }
  points.pad();
  return points;
}

void expect_the_oracles_field(const Shape& shape, const Points& points) {
  const auto tape = compile(shape);
  ASSERT_TRUE(tape) << to_string(tape.error());
  const Field field(shape);
  for (const Target& target : targets()) {
    const Comparison found = compare_values(*tape, field, points, run_value(*tape, target, points).value);
    EXPECT_EQ(found.fault, "") << target.name << "\n" << shape.to_json();
  }
}

TEST(NeedleTriangle, IsAsFarAwayAsItIs) {
  Random random(1);
  for (const double width : kWidths) {
    for (int i = 0; i < 8; ++i) {
      const Vec tip{random.uniform(-1, 1), random.uniform(-1, 1), 0},
          end{random.uniform(-1, 1), random.uniform(-1, 1), 0};
      const Vec aside = Vec{tip.y - end.y, end.x - tip.x, 0} * width;
      const Vec b = end + aside, c = end - aside;
      expect_the_oracles_field(triangle(Vec2{tip.x, tip.y}, Vec2{b.x, b.y}, Vec2{c.x, c.y}),
                               along_axis(random, tip, end));
    }
  }
}

TEST(NeedlePolygon, IsAsFarAwayAsItIs) {
  Random random(2);
  for (const double width : kWidths) {
    for (int i = 0; i < 8; ++i) {
      const Vec tip{random.uniform(-1, 1), random.uniform(-1, 1), 0},
          end{random.uniform(-1, 1), random.uniform(-1, 1), 0};
      const Vec aside = Vec{tip.y - end.y, end.x - tip.x, 0} * width, middle = (tip + end) * 0.5;
      const Vec corners[] = {tip, middle + aside, end, middle - aside};
      std::vector<Vec2> points;
      for (const Vec corner : corners) points.push_back({corner.x, corner.y});
      const auto made = Shape::make("polygon", 2,
                                    std::array{points[0].x, points[0].y, points[1].x, points[1].y, points[2].x,
                                               points[2].y, points[3].x, points[3].y});
      // Widths of a rounding of the corners may cross; that is refused, not answered.
      if (made) expect_the_oracles_field(*made, along_axis(random, tip, end));
    }
  }
}

TEST(NeedlePie, IsAsFarAwayAsItIs) {
  Random random(3);
  for (const double aperture : {1e-2, 1e-4, 1e-6}) {
    expect_the_oracles_field(pie(aperture, 1), along_axis(random, {0, 0, 0}, {0, 1, 0}));
    const Vec end{std::sin(0.4), std::cos(0.4), 0};
    expect_the_oracles_field(pie(aperture, 1).rotate(-0.4), along_axis(random, {0, 0, 0}, end));
  }
}

TEST(SlitPieAndRing, AreOpenOnlyInTheirSlit) {
  Random random(4);
  for (const double slit : {1e-2, 1e-4, 1e-6}) {
    const double aperture = std::numbers::pi - slit;
    for (const Shape& shape : {pie(aperture, 1), ring(aperture, 1, 0.3), arc(aperture, 1, 0.1)}) {
      expect_the_oracles_field(shape, along_axis(random, {0, 0, 0}, {0, -1, 0}));
    }
  }
}

TEST(NeedleStar, IsAsFarAwayAsItIs) {
  Random random(5);
  for (const double off : {1e-2, 1e-4, 1e-6, 0.0}) {
    for (const double points : {3.0, 5.0, 12.0, 1000.0}) {
      // Along a tip and along a notch.
      const double angle = std::numbers::pi / points;
      expect_the_oracles_field(star(1, points, points - off), along_axis(random, {0, 0, 0}, {0, 1, 0}));
      expect_the_oracles_field(star(1, points, points - off),
                               along_axis(random, {0, 0, 0}, {std::sin(angle), std::cos(angle), 0}));
    }
  }
}

TEST(ThinMoon, IsAsFarAwayAsItIs) {
  Random random(6);
  for (const double width : {1e-2, 1e-4, 1e-6}) {
    expect_the_oracles_field(moon(width, 1, 1), along_axis(random, {-1, 0, 0}, {1, 0, 0}));
    expect_the_oracles_field(moon(width, 1, 1 - width / 4), along_axis(random, {0, -1, 0}, {0, 1, 0}));
  }
}

}  // namespace
}  // namespace thalweg::conformance
