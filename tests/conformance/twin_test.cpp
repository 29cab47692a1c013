// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The twin of the kernels in double precision, which decides what float32 cannot: against the oracle to 1e-9 of the
// sizes at hand, and to the part of the slack that it is trusted with.
#include "kernels/twin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "comparison.h"
#include "random_shapes.h"

namespace thalweg::conformance {
namespace {

using oracle::describe;
using oracle::Field;
using oracle::Random;
using oracle::Vec;

class TwinOf : public testing::TestWithParam<int> {
 protected:
  static std::vector<Case> cases() {
    std::vector<Case> all = plain_cases(GetParam(), amount(20));
    for (Case& drawn : spicy_cases(GetParam(), amount(30))) all.push_back(std::move(drawn));
    return all;
  }
};

TEST_P(TwinOf, AgreesWithTheOracleWithinItsShareOfTheSlack) {
  for (const Case& drawn : cases()) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error());
    const Field field(drawn.shape);
    Random random(drawn.seed);
    const Points points = spicy_points(random, drawn.shape, field);
    Comparison found;
    for (std::size_t i = 0; i < points.count; ++i) {
      const Vec p = points.at(i);
      const double at[3] = {p.x, p.y, p.z};
      const double m = points.magnitude(i);
      const double f = evaluate_double(*tape, at, nullptr);
      found.add(f, field(p), tape->slack(m) * Twin::kSlackRatio, field.margin(m), p);
      // The slack's size is eps times all sizes at hand, so this is 1e-9 relative to them.
      const double sizes = tape->slack(m) * 0x1p24;
      ASSERT_NEAR(f, field(p), 1e-9 * sizes) << describe(drawn.shape, drawn.seed);
    }
    ASSERT_EQ(found.fault, "") << describe(drawn.shape, drawn.seed);
  }
}

TEST_P(TwinOf, GivesTheSameValueWithAndWithoutAGradient) {
  for (const Case& drawn : spicy_cases(GetParam(), 10)) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error());
    Twin twin(*tape);
    Random random(drawn.seed);
    const Points points = spicy_points(random, drawn.shape, Field(drawn.shape));
    for (std::size_t i = 0; i < points.count; ++i) {
      const Vec p = points.at(i);
      const double at[3] = {p.x, p.y, p.z};
      double gradient[3] = {};
      const double f = twin.gradient(at, gradient);
      ASSERT_EQ(f, twin.value(at)) << describe(drawn.shape, drawn.seed);
      ASSERT_LE(std::hypot(gradient[0], gradient[1], gradient[2]), tape->facts.lipschitz * (1 + 1e-12));
    }
  }
}

TEST_P(TwinOf, EnclosesItsFieldOverACell) {
  for (const Case& drawn : plain_cases(GetParam(), amount(10))) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error());
    Twin twin(*tape);
    const Field field(drawn.shape);
    Random random(drawn.seed);
    const auto d = static_cast<std::size_t>(tape->dimension);
    const Points centres = plain_points(random, drawn.shape, 24);
    for (std::size_t i = 0; i < centres.count; ++i) {
      const Vec c = centres.at(i);
      const double centre[3] = {c.x, c.y, c.z};
      Cell64 cell;
      cell.is_box = true;
      const double half = random.spread(1e-3, 1);
      for (std::size_t axis = 0; axis < d; ++axis) cell.edges[axis] = half;
      cell.reach = half * std::sqrt(static_cast<double>(d));
      const Enclosure64 found = twin.enclose(centre, cell);
      EXPECT_EQ(found.value, twin.value(centre));
      for (int k = 0; k < 24; ++k) {
        const double z = d == 3 ? random.uniform(-half, half) : 0;
        const double f = field(c + Vec{random.uniform(-half, half), random.uniform(-half, half), z});
        ASSERT_LE(found.lo, f + 1e-12) << describe(drawn.shape, drawn.seed);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ops, TwinOf, testing::ValuesIn(every_op()), [](const auto& op) { return label(op.param); });

}  // namespace
}  // namespace thalweg::conformance
