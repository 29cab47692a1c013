// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What nodes claim of their fields, by random sampling of the field that core evaluates in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "oracle.h"
#include "random_queries.h"
#include "random_shapes.h"
#include "sampling.h"
#include "thalweg/tape.h"

namespace thalweg::property {
namespace {

using oracle::describe;
using oracle::point_in;
using oracle::Random;
using oracle::Region;
using oracle::Vec;

double core_value(const Tape& tape, Vec p) {
  const double point[3] = {p.x, p.y, p.z};
  return evaluate_double(tape, point, nullptr);
}

double magnitude(Vec p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

std::vector<Drawn> all_drawn(std::uint64_t seed) {
  std::vector<Drawn> drawn = drawn_primitives(seed, 4);
  for (Drawn& d : drawn_operators(seed + 1'000'000, 6)) drawn.push_back(std::move(d));
  for (Drawn& d : drawn_trees(seed + 2'000'000, amount(40))) drawn.push_back(std::move(d));
  return drawn;
}

using Check = std::function<void(const Drawn&, const Tape&, Random&)>;

void for_every_drawn_shape(std::uint64_t seed, const Check& check) {
  for (const Drawn& drawn : all_drawn(seed)) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error()) << "\n" << describe(drawn.shape, drawn.seed);
    Random random(drawn.seed ^ 0x5eed);
    check(drawn, *tape, random);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Field, IsTheOraclesWithinItsSlack) {
  for_every_drawn_shape(100, [](const Drawn& drawn, const Tape& tape, Random& random) {
    const oracle::Field field(drawn.shape);
    const Region region = oracle::region_of(drawn.shape);
    for (int i = 0; i < 200; ++i) {
      const Vec p = point_in(random, region);
      // In double the slack is 2^-29 of the float32 one; the oracle has a margin of its own.
      const double most = tape.slack(magnitude(p)) * 0x1p-29 + field.margin(magnitude(p));
      ASSERT_NEAR(core_value(tape, p), field(p), most) << "at " << p.x << ' ' << p.y << ' ' << p.z << "\n"
                                                       << describe(drawn.shape, drawn.seed);
    }
  });
}

TEST(Field, ChangesByAtMostItsLipschitzConstant) {
  for_every_drawn_shape(200, [](const Drawn& drawn, const Tape& tape, Random& random) {
    const double constant = tape.facts.lipschitz;
    if (!std::isfinite(constant)) return;
    const Region region = oracle::region_of(drawn.shape);
    const double size = length(region.hi - region.lo);
    for (int i = 0; i < 400; ++i) {
      const Vec p = point_in(random, region);
      Vec step = point_in(random, region) - p;
      step = step * (random.spread(1e-5, 1) * size / std::max(length(step), 1e-12));
      if (tape.dimension == 2) step.z = 0;
      const double change = std::abs(core_value(tape, p + step) - core_value(tape, p));
      const double rounding = 2 * tape.slack(2 * size + magnitude(p)) * 0x1p-29;
      ASSERT_LE(change, constant * length(step) + rounding)
          << "from " << p.x << ' ' << p.y << ' ' << p.z << " by " << step.x << ' ' << step.y << ' ' << step.z << "\n"
          << describe(drawn.shape, drawn.seed);
    }
  });
}

TEST(Field, IsConvexWhereItSaysSo) {
  std::size_t convex = 0;
  for_every_drawn_shape(300, [&convex](const Drawn& drawn, const Tape& tape, Random& random) {
    if (!tape.facts.convex) return;
    ++convex;
    const Region region = oracle::region_of(drawn.shape);
    for (int i = 0; i < 400; ++i) {
      const Vec a = point_in(random, region);
      const Vec b = random.chance(0.5) ? point_in(random, region) : a + (point_in(random, region) - a) * 1e-3;
      const double t = random.uniform(0, 1);
      const Vec between = a + (b - a) * t;
      const double chord = core_value(tape, a) * (1 - t) + core_value(tape, b) * t;
      const double rounding = 2 * tape.slack(magnitude(a) + magnitude(b)) * 0x1p-29;
      ASSERT_LE(core_value(tape, between), chord + rounding)
          << "between " << a.x << ' ' << a.y << ' ' << a.z << " and " << b.x << ' ' << b.y << ' ' << b.z << "\n"
          << describe(drawn.shape, drawn.seed);
    }
  });
  EXPECT_GT(convex, 20U);
}

bool inside(const Bounds& bounds, Vec p, int dimension, double by) {
  const double at[3] = {p.x, p.y, p.z};
  for (int axis = 0; axis < dimension; ++axis) {
    if (at[axis] < bounds.lo[axis] - by || at[axis] > bounds.hi[axis] + by) return false;
  }
  return true;
}

TEST(Bounds, HoldEveryPointWhereTheFieldIsAtMostTheLevel) {
  for_every_drawn_shape(400, [](const Drawn& drawn, const Tape& tape, Random& random) {
    const oracle::Field field(drawn.shape);
    const int dimension = tape.dimension;
    const Region near = oracle::region_of(drawn.shape);
    const Region far{Vec{-6, -6, dimension == 3 ? -6.0 : 0.0}, Vec{6, 6, dimension == 3 ? 6.0 : 0.0}};
    const double level = random.uniform(0, 1);
    const Bounds bounds = drawn.shape.facts().bounds;
    const Bounds level_bounds = drawn.shape.level_bounds(level);
    for (int i = 0; i < 600; ++i) {
      const Vec p = point_in(random, i % 2 == 0 ? near : far);
      const double f = field(p);
      const double margin = field.margin(magnitude(p));
      const auto message = [&] {
        return "f = " + std::to_string(f) + " at " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' +
               std::to_string(p.z) + "\n" + describe(drawn.shape, drawn.seed);
      };
      const bool held = f > -margin || inside(bounds, p, dimension, margin);
      const bool level_held = f > level - margin || inside(level_bounds, p, dimension, margin);
      ASSERT_TRUE(held) << message();
      ASSERT_TRUE(level_held) << "level " << level << ", " << message();
    }
  });
}

TEST(Field, IsNeverNegativeWhereItSaysUnsigned) {
  for_every_drawn_shape(500, [](const Drawn& drawn, const Tape& tape, Random& random) {
    if (!tape.facts.is_unsigned) return;
    const Region region = oracle::region_of(drawn.shape);
    for (int i = 0; i < 200; ++i) {
      ASSERT_GE(core_value(tape, point_in(random, region)), 0.0) << describe(drawn.shape, drawn.seed);
    }
  });
}

}  // namespace
}  // namespace thalweg::property
