// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The bound from one value at a far point, where its second-order term decides. In a round hole f = R - |x| falls away
// from every cell's linear model, by |w|^2 / (2 |x|): what that model says of a triangle is above the truth, which is
// known without any search.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "random.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg::property {
namespace {

using oracle::Random;

struct Answers {
  std::vector<float> rows, value, lower;
  std::vector<std::uint8_t> converged;
  std::vector<std::uint32_t> evaluations;

  [[nodiscard]] double mean_evaluations() const {
    double sum = 0;
    for (const std::uint32_t n : evaluations) sum += n;
    return sum / static_cast<double>(evaluations.size());
  }
};

/// Where triangles lie: the coordinates of their middles, and their corners' about those, are at most so large.
struct Spread {
  double middle, size;
};

/// Deepest points of `count` triangles.
Answers ask(const Shape& shape, Spread spread, double tolerance, std::size_t count) {
  const auto tape = compile(shape);
  EXPECT_TRUE(tape);
  Random random(31);
  const auto d = static_cast<std::size_t>(shape.dimension());
  Answers answers;
  for (std::size_t i = 0; i < count; ++i) {
    double middle[3] = {};
    for (double& x : middle) x = random.uniform(-spread.middle, spread.middle);
    for (std::size_t k = 0; k < 3 * d; ++k) {
      answers.rows.push_back(static_cast<float>(middle[k % d] + random.uniform(-spread.size, spread.size)));
    }
  }
  answers.value.resize(count), answers.lower.resize(count), answers.converged.resize(count);
  answers.evaluations.resize(count);
  CollideColumns columns;
  columns.value = answers.value.data(), columns.lower = answers.lower.data();
  columns.converged = answers.converged.data(), columns.evaluations = answers.evaluations.data();
  CollideOptions options;
  options.goal = Goal::deepest, options.tolerance = tolerance;
  EXPECT_TRUE(collide_triangles(*tape, {answers.rows.data(), count}, options, columns));
  return answers;
}

/// The greatest distance of a corner of row `row` from the origin.
double furthest_corner(const std::vector<float>& rows, std::size_t row, std::size_t d) {
  double most = 0;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    double square = 0;
    for (std::size_t axis = 0; axis < d; ++axis) {
      const double x = rows[(3 * row + corner) * d + axis];
      square += x * x;
    }
    most = std::max(most, std::sqrt(square));
  }
  return most;
}

TEST(FarPoint, NeverBoundsATriangleInARoundHoleAboveItsLowestCorner) {
  const Shape holes[] = {box(Vec2{400, 400}) - circle(100), box(Vec3{400, 400, 400}) - sphere(100)};
  for (const Shape& hole : holes) {
    const auto d = static_cast<std::size_t>(hole.dimension());
    // f = 100 - |x| in the hole, and so beyond its edge, where the box is far deeper.
    const Answers answers = ask(hole, {55, 55}, 0.01, 4000);
    for (std::size_t row = 0; row < answers.value.size(); ++row) {
      const double truth = 100 - furthest_corner(answers.rows, row, d);
      ASSERT_LE(static_cast<double>(answers.lower[row]), truth + 1e-9) << "row " << row << " in " << d << "D";
      ASSERT_NEAR(static_cast<double>(answers.value[row]), truth, 0.0101) << "row " << row << " in " << d << "D";
      ASSERT_EQ(answers.converged[row], 1) << "row " << row << " in " << d << "D";
    }
  }
}

TEST(FarPoint, LeavesFewEvaluationsForADeepestPoint) {
  // Without it the tolerance is the size of a cell: hundreds of evaluations.
  const Shape spikes = star(100, 7, 3);
  EXPECT_LT(ask(spikes, {250, 20}, 0.02, 2000).mean_evaluations(), 25);
}

}  // namespace
}  // namespace thalweg::property
