// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Formulas among the other nodes: placed, warped, joined with primitives and blended. Their ranges hold the field and
// verdicts stand against samples of it in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "columns.h"
#include "compile/shorten.h"
#include "random_shapes.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg::formulas {
namespace {

using oracle::Random;

constexpr const char* kFormulas[] = {
    "x*y - 0.3",      "sqrt(x*x + y*y) - 0.8", "sin(3 * x) * cos(2 * y) - 0.2", "max(abs(x) - 0.6, abs(y) - 0.7)",
    "y - exp(x) + 1", "sqrt(x + 2) - 1.5",     "0.5 - mod(x, 0.7) * (1 + y)",   "100 * (x*x*x - y)"};

/// A random tree with formulas among its leaves.
Shape mixed(Random& random) {
  Shape all = oracle::random_shape(random, 2, 1 + static_cast<int>(random.index(8)));
  for (std::size_t i = 0; i < 1 + random.index(3); ++i) {
    Shape leaf = expression(kFormulas[random.index(std::size(kFormulas))], 2);
    if (random.chance(0.5)) leaf = leaf.rotate(random.uniform(-3, 3)).translate(Vec2{random.uniform(-1, 1), 0.3});
    if (random.chance(0.3)) leaf = leaf.scale(random.spread(0.3, 3));
    if (random.chance(0.3)) leaf = round(leaf, 0.1);
    if (random.chance(0.2)) leaf = onion(leaf, 0.1);
    if (random.chance(0.2)) leaf = mirror(leaf, 0).rotate(0.4);
    const std::vector<Shape> of = random.chance(0.5) ? std::vector<Shape>{all, leaf} : std::vector<Shape>{leaf, all};
    const Shape joined[] = {union_(of),
                            intersection(of),
                            subtraction(of),
                            smooth_union(0.1, of),
                            smooth_intersection(0.1, of),
                            smooth_subtraction(0.1, of)};
    all = joined[random.index(std::size(joined))];
  }
  return all;
}

TEST(MixedScenes, HaveRangesThatHoldTheirFields) {
  constexpr std::size_t kBoxes = 64;
  std::size_t known = 0;
  for (std::uint64_t seed = 0; seed < amount(150); ++seed) {
    Random random(seed);
    const Shape shape = mixed(random);
    const Tape tape = *compile(shape);
    Boxes boxes(kBoxes);
    for (std::size_t i = 0; i < kBoxes; ++i) {
      const bool degenerate = random.chance(0.25);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        boxes.centre[axis][i] = static_cast<float>(random.uniform(-2, 2));
        boxes.half[axis][i] = degenerate ? 0 : static_cast<float>(random.spread(1e-5, 1));
      }
    }
    boxes.bound(tape, targets()[seed % targets().size()]);
    for (std::size_t i = 0; i < kBoxes; ++i) {
      known += std::isfinite(boxes.lower[i]) ? 1 : 0;
      for (int k = 0; k < 8; ++k) {
        double at[2];
        double magnitude = 0;
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const auto h = static_cast<double>(boxes.half[axis][i]);
          at[axis] = static_cast<double>(boxes.centre[axis][i]) + random.uniform(-h, h);
          magnitude = std::max(magnitude, std::fabs(at[axis]));
        }
        const double f = evaluate_double(tape, at, nullptr);
        const double slack = tape.enclosure_slack(magnitude) + 1e-12;
        if (std::isnan(f)) {
          ASSERT_TRUE(std::isinf(boxes.lower[i]) && std::isinf(boxes.upper[i])) << oracle::describe(shape, seed);
          continue;
        }
        ASSERT_GE(f, static_cast<double>(boxes.lower[i]) - slack) << oracle::describe(shape, seed);
        ASSERT_LE(f, static_cast<double>(boxes.upper[i]) + slack) << oracle::describe(shape, seed);
      }
    }
  }
  EXPECT_GT(2 * known, amount(150) * kBoxes);
}

TEST(MixedScenes, HaveVerdictsThatSamplesCannotRefute) {
  constexpr std::size_t kRows = 40;
  std::size_t decided = 0;
  for (std::uint64_t seed = 0; seed < amount(60); ++seed) {
    Random random(seed + 5000);
    const Shape shape = mixed(random);
    const Tape tape = *compile(shape);
    std::vector<float> rows(kRows * 3);
    for (std::size_t i = 0; i < kRows; ++i) {
      for (std::size_t k = 0; k < 2; ++k) rows[3 * i + k] = static_cast<float>(random.uniform(-2, 2));
      rows[3 * i + 2] = static_cast<float>(random.spread(1e-3, 0.5));
    }
    std::array<std::uint8_t, kRows> status{};
    std::array<float, kRows> lower{};
    std::array<float, 2 * kRows> point{};
    CollideColumns columns;
    columns.status = status.data();
    columns.lower = lower.data();
    columns.point = point.data();
    CollideOptions options;
    options.goal = seed % 2 == 0 ? Goal::verdict : Goal::deepest;
    ASSERT_TRUE(collide_circles(tape, {rows.data(), kRows}, options, columns));
    for (std::size_t i = 0; i < kRows; ++i) {
      decided += status[i] < 2 ? 1 : 0;
      for (int k = 0; k < 60; ++k) {
        const double angle = random.uniform(0, 7);
        const double r =
            static_cast<double>(rows[3 * i + 2]) * (k % 4 == 0 ? 1 - 1e-12 : std::sqrt(random.uniform(0, 1)));
        const double at[2] = {static_cast<double>(rows[3 * i]) + r * std::cos(angle),
                              static_cast<double>(rows[3 * i + 1]) + r * std::sin(angle)};
        const double f = evaluate_double(tape, at, nullptr);
        if (std::isnan(f)) {
          ASSERT_NE(status[i], 0) << "row " << i << "\n" << oracle::describe(shape, seed);
          continue;
        }
        ASSERT_GE(f, static_cast<double>(lower[i])) << "row " << i << "\n" << oracle::describe(shape, seed);
        if (status[i] == 0) {
          ASSERT_GT(f, 0) << "row " << i << "\n" << oracle::describe(shape, seed);
        }
      }
      if (status[i] == 1) {
        const double at[2] = {static_cast<double>(point[2 * i]), static_cast<double>(point[2 * i + 1])};
        ASSERT_LT(evaluate_double(tape, at, nullptr), 0) << "row " << i << "\n" << oracle::describe(shape, seed);
      }
    }
  }
  EXPECT_GT(10 * decided, 8 * amount(60) * kRows);
}

TEST(MixedScenes, AreShortenedToTheBitsOfTheFullTape) {
  constexpr std::size_t kPoints = 64;
  std::size_t shorter = 0;
  for (std::uint64_t seed = 0; seed < amount(150); ++seed) {
    Random random(seed + 9000);
    const Tape tape = *compile(mixed(random));
    Region region;
    for (std::size_t axis = 0; axis < 2; ++axis) region.centre[axis] = static_cast<float>(random.uniform(-2, 2));
    region.reach = static_cast<float>(random.spread(1e-3, 0.5));
    const Target& target = targets()[seed % targets().size()];
    Shortener shortener;
    shortener.begin(tape);
    shortener.analyse(tape, *target.kernels, {&region, 1});
    Tape shortened = tape;
    shortener.shorten(0, shortened);
    shorter += shortened.instructions.size() < tape.instructions.size() ? 1 : 0;
    std::array<Column, 3> points;
    for (std::size_t i = 0; i < kPoints; ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        points[axis].push_back(region.centre[axis] + region.reach * static_cast<float>(random.uniform(-0.7, 0.7)));
      }
    }
    const Fields full = fields_at(tape, target, points, kPoints);
    const Fields found = fields_at(shortened, target, points, kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      if (std::isnan(full.value[i])) {
        ASSERT_TRUE(std::isnan(found.value[i])) << "seed " << seed;
        continue;
      }
      ASSERT_EQ(full.value[i], found.value[i]) << "seed " << seed;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        ASSERT_EQ(full.gradient[axis][i], found.gradient[axis][i]) << "seed " << seed;
      }
    }
  }
  EXPECT_GT(shorter, amount(150) / 4);
}

}  // namespace
}  // namespace thalweg::formulas
