// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Grids have the bits of `evaluate` at their points, whatever was left out on the way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "random_shapes.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

using oracle::Random;

/// f at every point of a grid, one by one.
std::vector<float> plain_values(const Tape& tape, const Grid& grid) {
  const auto d = static_cast<std::size_t>(tape.dimension);
  std::vector<float> rows(grid.count() * d), value(grid.count());
  std::size_t at = 0;
  for (std::size_t k = 0; k < grid.size[2]; ++k) {
    for (std::size_t j = 0; j < grid.size[1]; ++j) {
      for (std::size_t i = 0; i < grid.size[0]; ++i, at += d) grid.point(i, j, k, tape.dimension, &rows[at]);
    }
  }
  // Short batches are evaluated by the tape as it is.
  for (std::size_t begin = 0; begin < grid.count(); begin += 256) {
    evaluate(tape, &rows[begin * d], std::min<std::size_t>(256, grid.count() - begin), &value[begin], nullptr);
  }
  return value;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

void expect_plain_answers(const Tape& tape, const Grid& grid, float band, const std::string& scene) {
  std::vector<float> expected = plain_values(tape, grid);
  std::vector<std::uint8_t> expected_inside;
  for (const float f : expected) expected_inside.push_back(f < 0 ? 1 : 0);
  std::vector<float> cut_off = expected;
  for (float& f : cut_off) f = std::isnan(f) ? f : std::clamp(f, -band, band);
  std::vector<float> value(grid.count());
  std::vector<std::uint8_t> inside(grid.count());
  for (const Execution& execution :
       {Execution{.threads = 1}, Execution{.threads = 2, .tile = 1}, Execution{.threads = 2, .tile = 40000}}) {
    for (const bool with_inside : {false, true}) {
      std::ranges::fill(value, 7.0F);
      ASSERT_TRUE(evaluate_grid(tape, grid, {.value = value.data(), .inside = with_inside ? inside.data() : nullptr},
                                execution));
      EXPECT_TRUE(same_bits(value, expected)) << scene;
    }
    EXPECT_EQ(inside, expected_inside) << scene;
    ASSERT_TRUE(evaluate_grid(tape, grid, {.value = value.data(), .inside = inside.data(), .band = band}, execution));
    EXPECT_TRUE(same_bits(value, cut_off)) << scene;
    EXPECT_EQ(inside, expected_inside) << scene;
    std::ranges::fill(inside, std::uint8_t{9});
    const auto summary = evaluate_grid(tape, grid, {.inside = inside.data()}, execution);
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->rows, grid.count());
    EXPECT_LE(summary->evaluations, grid.count());
    EXPECT_EQ(inside, expected_inside) << scene;
  }
}

/// About the shape, turned at random, with axes of the sizes given.
Grid random_grid(Random& random, int dimension, std::array<std::size_t, 3> size) {
  Grid grid;
  const bool straight = random.chance(0.5);
  for (std::size_t b = 0; b < 3; ++b) {
    grid.size[b] = size[b];
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
      if (straight && axis != b) continue;
      grid.step[b][axis] = random.uniform(-20, 20) / static_cast<double>(size[b]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.origin[axis] = random.uniform(-2, 2);
    for (std::size_t b = 0; b < 3; ++b) grid.origin[axis] -= 0.5 * static_cast<double>(size[b]) * grid.step[b][axis];
  }
  return grid;
}

class Grids : public testing::TestWithParam<int> {};

TEST_P(Grids, HaveTheBitsOfTheirPointsOneByOne) {
  const int dimension = GetParam();
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const Shape shape = oracle::random_shape(random, dimension, 8 + static_cast<int>(random.index(40)));
    const Tape tape = std::move(compile(shape)).value();
    const std::string scene = oracle::describe(shape, seed);
    for (const auto& size :
         {std::array<std::size_t, 3>{150, 131, 1}, {1, 40, 37}, {700, 1, 1}, {1, 1, 1}, {19, 17, 9}}) {
      expect_plain_answers(tape, random_grid(random, dimension, size), 0.5F, scene);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfBothDimensions, Grids, testing::Values(2, 3));

TEST(GridsOfFormulas, HaveTheBitsOfTheirPointsOneByOne) {
  const std::vector<Shape> shapes = {
      expression("min(max(sin(3*x) + y, x*x + y*y - 9), max(abs(x - 2), abs(y)) - 1)"),
      expression("max(sqrt(x - 1) - 2, min(log(y + 3), y - x*x))"),
      expression("min(sqrt(x*x + y*y + z*z) - 3, max(abs(x), max(abs(y), abs(z))) - 2)"),
      union_({expression("x / (y*y - 2) - 1").translate(Vec2{1, 0}).rotate(0.3), circle(2), box(Vec2{3, 0.5})}),
  };
  Random random(8);
  for (const Shape& shape : shapes) {
    const Tape tape = std::move(compile(shape)).value();
    const std::string scene = oracle::describe(shape, 0);
    expect_plain_answers(tape, random_grid(random, tape.dimension, {150, 131, 1}), 0.5F, scene);
    expect_plain_answers(tape, random_grid(random, tape.dimension, {19, 17, 9}), 0.5F, scene);
  }
}

TEST(GridsOfFormulas, CountWhereTheyAreUndefined) {
  const Tape tape = std::move(compile(expression("sqrt(x) - 1 + 0*y"))).value();
  const Grid grid{.origin = {-10, 0}, .step = {{1}, {0, 1}}, .size = {21, 5, 1}};
  std::vector<float> value(grid.count());
  const auto summary = evaluate_grid(tape, grid, {.value = value.data()});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->undefined_rows, 50U);
  EXPECT_EQ(summary->bad_rows, 0U);
}

Grid square_grid(std::size_t side, double from, double to) {
  const double step = (to - from) / static_cast<double>(side);
  return {.origin = {from, from}, .step = {{step, 0}, {0, step}}, .size = {side, side, 1}};
}

TEST(Grid, LeavesPlacesOfOneSignUnevaluated) {
  const Tape tape = std::move(compile(circle(0.4) | box(Vec2{0.1, 0.9}))).value();
  const Grid grid = square_grid(1024, -1, 1);
  std::vector<std::uint8_t> inside(grid.count());
  const auto signs = evaluate_grid(tape, grid, {.inside = inside.data()});
  ASSERT_TRUE(signs);
  EXPECT_EQ(signs->rows, grid.count());
  EXPECT_LT(signs->evaluations, grid.count() / 8);
  std::vector<float> value(grid.count());
  const auto values = evaluate_grid(tape, grid, {.value = value.data()});
  EXPECT_EQ(values->evaluations, grid.count());
}

TEST(Grid, HasNanWherePointsCannotBeAnswered) {
  const Tape tape = std::move(compile(circle(1))).value();
  const Grid grid{.origin = {-4e15, 0}, .step = {{1e15, 0}, {0, 1}}, .size = {9, 40, 1}};
  std::vector<float> value(grid.count());
  std::vector<std::uint8_t> inside(grid.count(), 9);
  const auto summary = evaluate_grid(tape, grid, {.value = value.data(), .inside = inside.data()});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->bad_rows, 6 * 40U);
  for (std::size_t i = 0; i < grid.count(); ++i) {
    EXPECT_EQ(std::isnan(value[i]), i % 9 < 3 || i % 9 > 5) << i;
    EXPECT_EQ(inside[i], i == 4 ? 1 : 0) << i;
  }
}

TEST(Grid, RefusesANegativeBand) {
  const Tape tape = std::move(compile(circle(1))).value();
  float value = 0;
  for (const float band : {-1.0F, std::nanf("")}) {
    EXPECT_FALSE(evaluate_grid(tape, square_grid(1, 0, 1), {.value = &value, .band = band}));
  }
}

TEST(Grid, WithoutPointsHasNoRows) {
  const Tape tape = std::move(compile(circle(1))).value();
  const auto summary = evaluate_grid(tape, square_grid(0, 0, 1), {});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->rows, 0U);
}

TEST(Grid, CountsPointsAndEndsWhenCancelled) {
  const Tape tape = std::move(compile(circle(1))).value();
  const Grid grid = square_grid(300, -2, 2);
  std::vector<std::uint8_t> inside(grid.count());
  std::atomic<std::size_t> done{0};
  ASSERT_TRUE(evaluate_grid(tape, grid, {.inside = inside.data()}, {.done = &done}));
  EXPECT_EQ(done, grid.count());
  const std::atomic<bool> cancelled{true};
  const auto summary = evaluate_grid(tape, grid, {.inside = inside.data()}, {.cancelled = &cancelled});
  ASSERT_TRUE(summary);
  EXPECT_TRUE(summary->cancelled);
  EXPECT_EQ(summary->rows, 0U);
}

}  // namespace
}  // namespace thalweg
