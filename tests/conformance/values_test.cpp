// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// f from the float32 kernels against the oracle, for every op on every SIMD target. The allowance is the slack that the
// tape itself documents; how much of it is used is printed, which backs the constant `rounding` of each declaration.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "comparison.h"
#include "random_shapes.h"
#include "thalweg/op_table.h"

namespace thalweg::conformance {
namespace {

using oracle::describe;
using oracle::Field;
using oracle::Random;

class Values : public testing::TestWithParam<OnTarget> {
 protected:
  struct Worst {
    double ratio = 0;
    std::size_t count = 0;
  };
  static std::map<int, Worst>& worst() {
    static std::map<int, Worst> all;
    return all;
  }
  static void TearDownTestSuite() {
    std::printf("%-24s %8s %10s %12s\n", "op", "rounding", "values", "worst/slack");
    for (const auto& [op, found] : worst()) {
      std::printf("%-24s %8g %10zu %12.3f\n", label(op).c_str(), op_table()[static_cast<std::size_t>(op)].rounding,
                  found.count, found.ratio);
    }
  }

  /// Compares one shape's values on the parameter's target; false after a fault.
  static bool agree(const Case& drawn, const Points& points) {
    const auto tape = compile(drawn.shape);
    EXPECT_TRUE(tape) << to_string(tape.error()) << "\n" << describe(drawn.shape, drawn.seed);
    if (!tape) return false;
    const Field field(drawn.shape);
    const Comparison found = compare_values(*tape, field, points, run_value(*tape, *GetParam().target, points).value);
    Worst& so_far = worst()[GetParam().op];
    so_far.ratio = std::max(so_far.ratio, found.worst);
    so_far.count += found.count;
    EXPECT_EQ(found.fault, "") << describe(drawn.shape, drawn.seed);
    return found.fault.empty();
  }
};

TEST_P(Values, AgreeWithTheOracleWithinTheTapesSlack) {
  for (const Case& drawn : plain_cases(GetParam().op, amount(20))) {
    Random random(drawn.seed);
    if (!agree(drawn, plain_points(random, drawn.shape, 256))) return;
  }
  for (const Case& drawn : spicy_cases(GetParam().op, amount(30))) {
    Random random(drawn.seed);
    if (!agree(drawn, spicy_points(random, drawn.shape, Field(drawn.shape)))) return;
  }
}

TEST_P(Values, AreFiniteForEveryFiniteInput) {
  for (const Case& drawn : spicy_cases(GetParam().op, amount(20))) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error());
    Random random(drawn.seed);
    Points points(drawn.shape.dimension());
    static constexpr double kCoordinates[] = {0, -0.0, 1e-45, -1e-38, 1e-20, 1, -1, 1e7, -1e15, 1e15};
    for (int i = 0; i < 200; ++i) {
      const auto any = [&] { return kCoordinates[random.index(std::size(kCoordinates))]; };
      points.add({any(), any(), any()});
    }
    points.pad();
    const Columns found = run_gradient(*tape, *GetParam().target, points);
    for (std::size_t i = 0; i < points.count; ++i) {
      bool finite = std::isfinite(found.value[i]);
      for (int axis = 0; axis < tape->dimension; ++axis) finite = finite && std::isfinite(found.gradient[axis][i]);
      ASSERT_TRUE(finite) << "at " << points.at(i).x << ' ' << points.at(i).y << ' ' << points.at(i).z << "\n"
                          << describe(drawn.shape, drawn.seed);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ops, Values, testing::ValuesIn(every_op_on_every_target()),
                         [](const auto& on) { return label(on.param); });

TEST(Conformance, HasACaseForEveryOpOfTheTable) {
  for (const int op : every_op()) {
    for (const auto& cases : {plain_cases(op, 3), spicy_cases(op, 3)}) {
      ASSERT_EQ(cases.size(), 3U) << label(op);
      for (const Case& drawn : cases) {
        EXPECT_EQ(drawn.shape.op_index(), op) << label(op);
        EXPECT_NO_THROW(Field{drawn.shape}) << label(op) << " is unknown to the oracle";
      }
    }
  }
}

}  // namespace
}  // namespace thalweg::conformance
