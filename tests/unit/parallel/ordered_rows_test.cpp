// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches against long tapes are answered in spatial order by shortened tapes: each row as if it were alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "order.h"
#include "random_shapes.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

using oracle::Random;

constexpr double kWorld = 1000;

Tape long_tape(int dimension, int groups = 40) {
  return std::move(compile(oracle::scattered_parts(dimension, groups))).value();
}

struct Answers {
  std::vector<std::uint8_t> status, converged, ambiguous;
  std::vector<float> value, lower, point, normal;
  std::vector<std::uint32_t> evaluations;

  Answers(std::size_t n, std::size_t d)
      : status(n), converged(n), ambiguous(n), value(n), lower(n), point(n * d), normal(n * d), evaluations(n) {}
  CollideColumns from(std::size_t row, std::size_t d) {
    CollideColumns columns;
    columns.status = &status[row];
    columns.converged = &converged[row];
    columns.ambiguous = &ambiguous[row];
    columns.value = &value[row];
    columns.lower = &lower[row];
    columns.point = &point[row * d];
    columns.normal = &normal[row * d];
    columns.evaluations = &evaluations[row];
    return columns;
  }
  bool operator==(const Answers&) const = default;
};

class OrderedRows : public testing::TestWithParam<std::tuple<int, Goal, Gradient>> {};

TEST_P(OrderedRows, AreAnsweredAsIfAlone) {
  const auto [dimension, goal, gradient] = GetParam();
  const auto d = static_cast<std::size_t>(dimension);
  const std::size_t count = goal == Goal::verdict ? 6000 : 1500;
  const Tape tape = long_tape(dimension);
  ASSERT_GT(tape.instructions.size(), 300U);
  Random random(9);
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    double centre[3];
    for (double& x : centre) x = random.uniform(0, kWorld);
    for (std::size_t k = 0; k < 3 * d; ++k) rows.push_back(static_cast<float>(centre[k % d] + random.uniform(-20, 20)));
  }
  CollideOptions options;
  options.goal = goal;
  // Probes leave the region that a shortened tape is for.
  options.gradient = gradient, options.gradient_given = true;
  options.gradient_offset.absolute = 30;
  Answers alone(count, d);
  for (std::size_t begin = 0; begin < count; begin += 250) {
    ASSERT_TRUE(collide_triangles(tape, {&rows[begin * 3 * d], 250}, options, alone.from(begin, d), {.threads = 1}));
  }
  for (const std::size_t tile : {0, 64, 700}) {
    Answers together(count, d);
    ASSERT_TRUE(
        collide_triangles(tape, {rows.data(), count}, options, together.from(0, d), {.threads = 2, .tile = tile}));
    EXPECT_TRUE(together == alone) << tile;
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, OrderedRows,
                         testing::Combine(testing::Values(2, 3), testing::Values(Goal::verdict, Goal::deepest),
                                          testing::Values(Gradient::autodiff, Gradient::central)));

/// Triangles of a few units over the whole world.
std::vector<float> scattered_triangles(std::size_t count, std::size_t d) {
  Random random(11);
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    double centre[3];
    for (double& x : centre) x = random.uniform(0, kWorld);
    for (std::size_t k = 0; k < 3 * d; ++k) rows.push_back(static_cast<float>(centre[k % d] + random.uniform(-20, 20)));
  }
  return rows;
}

class OrderedLocalMethods : public testing::TestWithParam<std::tuple<int, Method, Gradient>> {};

TEST_P(OrderedLocalMethods, AnswerAsIfAlone) {
  const auto [dimension, method, gradient] = GetParam();
  const auto d = static_cast<std::size_t>(dimension);
  const Tape tape = long_tape(dimension);
  constexpr std::size_t kCount = 700;
  const std::vector<float> rows = scattered_triangles(kCount, d);
  CollideOptions options;
  options.method = method;
  options.gradient = gradient, options.gradient_given = true;
  options.gradient_offset = {.absolute = 3, .of_value = 0.2, .of_scene = 0};
  Answers alone(kCount, d), together(kCount, d);
  for (std::size_t begin = 0; begin < kCount; begin += 100) {
    ASSERT_TRUE(collide_triangles(tape, {&rows[begin * 3 * d], 100}, options, alone.from(begin, d), {.threads = 1}));
  }
  ASSERT_TRUE(collide_triangles(tape, {rows.data(), kCount}, options, together.from(0, d), {.threads = 2}));
  EXPECT_TRUE(together == alone);
}

INSTANTIATE_TEST_SUITE_P(Methods, OrderedLocalMethods,
                         testing::Combine(testing::Values(2, 3),
                                          testing::Values(Method::accelerated, Method::thesis, Method::thesis_fixed,
                                                          Method::projected, Method::frank_wolfe,
                                                          Method::frank_wolfe_search, Method::golden_section,
                                                          Method::distance_step),
                                          testing::Values(Gradient::autodiff, Gradient::central, Gradient::simplex)));

/// With room for some contacts a row, which begins with what no contact has.
struct Contacts {
  static constexpr std::uint32_t kMost = 5;
  std::vector<std::uint32_t> found, kept, evaluations;
  std::vector<float> value, point, normal, barycentric;

  Contacts(std::size_t n, std::size_t d)
      : found(n),
        kept(n),
        evaluations(n),
        value(n * kMost, -7),
        point(n * kMost * d, -7),
        normal(point),
        barycentric(n * kMost * 3, -7) {}
  CollideColumns from(std::size_t row, std::size_t d) {
    CollideColumns columns;
    columns.evaluations = &evaluations[row];
    columns.contacts = {.found = &found[row],
                        .kept = &kept[row],
                        .value = &value[row * kMost],
                        .point = &point[row * kMost * d],
                        .normal = &normal[row * kMost * d],
                        .barycentric = &barycentric[row * kMost * 3]};
    return columns;
  }
  bool operator==(const Contacts&) const = default;
};

TEST(OrderedRowsWithContacts, HaveThoseOfRowsAlone) {
  for (const std::size_t d : {2U, 3U}) {
    const Tape tape = long_tape(static_cast<int>(d));
    constexpr std::size_t kCount = 2000;
    const std::vector<float> rows = scattered_triangles(kCount, d);
    CollideOptions options;
    options.contacts = Contacts::kMost;
    options.margin = 8;
    options.feature = 4;
    Contacts alone(kCount, d);
    for (std::size_t begin = 0; begin < kCount; begin += 250) {
      ASSERT_TRUE(collide_triangles(tape, {&rows[begin * 3 * d], 250}, options, alone.from(begin, d), {.threads = 1}));
    }
    ASSERT_GT(std::ranges::count_if(alone.kept, [](std::uint32_t kept) { return kept > 1; }), 20);
    Contacts together(kCount, d);
    ASSERT_TRUE(collide_triangles(tape, {rows.data(), kCount}, options, together.from(0, d), {.threads = 2}));
    EXPECT_TRUE(together == alone) << d;
    // A caller who does not ask how many there are finds them all the same.
    Contacts uncounted(kCount, d);
    CollideColumns columns = uncounted.from(0, d);
    columns.contacts.kept = columns.contacts.found = nullptr;
    ASSERT_TRUE(collide_triangles(tape, {rows.data(), kCount}, options, columns, {.threads = 2}));
    EXPECT_EQ(uncounted.value, alone.value) << d;
  }
}

TEST(OrderedPoints, HaveTheColumnsOfEveryStrategyAsIfAlone) {
  const Tape tape = long_tape(2, 160);
  Random random(3);
  constexpr std::size_t kCount = 2000;
  std::vector<float> rows(2 * kCount);
  for (float& x : rows) x = static_cast<float>(random.uniform(-100, kWorld + 100));
  for (const Gradient strategy :
       {Gradient::autodiff, Gradient::forward, Gradient::dichotomy, Gradient::closest_point}) {
    const GradientOptions options{.strategy = strategy, .offset = {.absolute = 2, .of_value = 0.3, .of_scene = 0}};
    struct Columns {
      std::vector<float> value = std::vector<float>(kCount), gradient = std::vector<float>(2 * kCount),
                         one_sided = std::vector<float>(4 * kCount);
      std::vector<std::uint32_t> evaluations = std::vector<std::uint32_t>(kCount);
      std::vector<std::uint8_t> ambiguous = std::vector<std::uint8_t>(kCount);
      bool operator==(const Columns&) const = default;
      PointColumns from(std::size_t row) {
        return {.value = &value[row],
                .gradient = &gradient[2 * row],
                .evaluations = &evaluations[row],
                .ambiguous = &ambiguous[row],
                .one_sided = &one_sided[4 * row]};
      }
    } together, alone;
    ASSERT_TRUE(evaluate(tape, Points{rows.data(), kCount}, options, together.from(0)));
    for (std::size_t i = 0; i < kCount; i += 200) {
      ASSERT_TRUE(evaluate(tape, Points{&rows[2 * i], 200}, options, alone.from(i)));
    }
    EXPECT_TRUE(together == alone) << name(strategy);
  }
}

TEST(OrderedPoints, HaveTheValuesAndGradientsOfTheFullTape) {
  for (const int dimension : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimension);
    const Tape tape = long_tape(dimension, 160);
    ASSERT_GT(tape.instructions.size(), 512U);
    Random random(2);
    std::vector<float> rows(4000 * d);
    for (float& x : rows) x = static_cast<float>(random.uniform(-100, kWorld + 100));
    rows[5 * d] = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> value(4000), alone(4000), gradient(rows.size()), gradient_alone(rows.size());
    EXPECT_EQ(evaluate(tape, rows.data(), 4000, value.data(), gradient.data()), 1U);
    for (std::size_t i = 0; i < 4000; i += 250) {
      evaluate(tape, &rows[i * d], 250, &alone[i], &gradient_alone[i * d]);
    }
    EXPECT_EQ(std::memcmp(value.data(), alone.data(), value.size() * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(gradient.data(), gradient_alone.data(), gradient.size() * sizeof(float)), 0);
  }
}

TEST(OrderedRowsInOnePlace, AreAnsweredAsIfAlone) {
  const Tape tape = long_tape(2);
  constexpr std::size_t kCount = 9000;
  Random random(4);
  std::vector<float> rows;
  // All but a few far ones share a cell of the curve.
  for (std::size_t i = 0; i < kCount; ++i) {
    const double place = i % 1000 == 0 ? random.uniform(-1e6, 1e6) : 500;
    for (std::size_t k = 0; k < 6; ++k) rows.push_back(static_cast<float>(place + random.uniform(-30, 30)));
  }
  Answers alone(kCount, 2), together(kCount, 2);
  for (std::size_t begin = 0; begin < kCount; begin += 100) {
    ASSERT_TRUE(collide_triangles(tape, {&rows[begin * 6], 100}, {}, alone.from(begin, 2), {.threads = 1}));
  }
  ASSERT_TRUE(collide_triangles(tape, {rows.data(), kCount}, {}, together.from(0, 2), {.threads = 2}));
  EXPECT_TRUE(together == alone);
}

/// A hundred discs whose rims are waves, as one formula.
Tape long_formula() {
  Random random(6);
  std::string text = "10";
  for (int i = 0; i < 100; ++i) {
    const std::string x = "(x-" + std::to_string(random.uniform(0, kWorld)) + ")";
    const std::string y = "(y-" + std::to_string(random.uniform(0, kWorld)) + ")";
    std::string disc = "sqrt(" + x + "*" + x + "+" + y + "*" + y + ")";
    disc.append("-20-sin(").append(x).append(")");
    // Some are cut out of all before them, so that maxima decide too.
    text = i % 5 == 4 ? "max(" + text + ",20-" + disc + ")" : "min(" + text + "," + disc + ")";
  }
  return std::move(compile(expression(text))).value();
}

TEST(OrderedRowsOfFormulas, AreAnsweredAsIfAlone) {
  const Tape tape = long_formula();
  ASSERT_GT(tape.instructions.size(), 500U);
  constexpr std::size_t kCount = 3000;
  const std::vector<float> rows = scattered_triangles(kCount, 2);
  for (const Goal goal : {Goal::verdict, Goal::deepest}) {
    CollideOptions options;
    options.goal = goal;
    options.budget = 512;
    Answers alone(kCount, 2), together(kCount, 2);
    for (std::size_t begin = 0; begin < kCount; begin += 100) {
      ASSERT_TRUE(collide_triangles(tape, {&rows[begin * 6], 100}, options, alone.from(begin, 2), {.threads = 1}));
    }
    ASSERT_TRUE(collide_triangles(tape, {rows.data(), kCount}, options, together.from(0, 2), {.threads = 2}));
    EXPECT_TRUE(together == alone);
    EXPECT_GT(std::ranges::count(together.status, std::uint8_t{1}), 100);
  }
}

TEST(RowsInOrder, AreCountedAndEndWhenCancelled) {
  const Tape tape = long_tape(2);
  constexpr std::size_t kCount = 5000;
  const std::vector<float> rows = scattered_triangles(kCount, 2);
  for (const int threads : {1, 2}) {
    std::atomic<std::size_t> done{0};
    const auto all = collide_triangles(tape, {rows.data(), kCount}, {}, {}, {.threads = threads, .done = &done});
    ASSERT_TRUE(all);
    EXPECT_FALSE(all->cancelled);
    EXPECT_EQ(all->rows, kCount);
    EXPECT_EQ(done, kCount);
    const std::atomic<bool> cancelled{true};
    const auto none =
        collide_triangles(tape, {rows.data(), kCount}, {}, {}, {.threads = threads, .cancelled = &cancelled});
    ASSERT_TRUE(none);
    EXPECT_TRUE(none->cancelled);
    EXPECT_EQ(none->rows, 0U);
  }
}

TEST(OrderedRowsOfCircles, KeepBadRowsInTheirPlaces) {
  const Tape tape = long_tape(2);
  Random random(3);
  std::vector<float> rows;
  for (std::size_t i = 0; i < 3000; ++i) {
    for (int k = 0; k < 2; ++k) rows.push_back(static_cast<float>(random.uniform(0, kWorld)));
    rows.push_back(i % 5 == 0 ? std::numeric_limits<float>::quiet_NaN() : 7.0F);
  }
  Answers found(3000, 2);
  const auto summary = collide_circles(tape, {rows.data(), 3000}, {}, found.from(0, 2));
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->by_status[4], 600U);
  for (std::size_t i = 0; i < 3000; ++i) EXPECT_EQ(found.status[i] == 255, i % 5 == 0) << i;
}

TEST(SpatialOrder, IsAPermutationThatKeepsNeighboursTogether) {
  Random random(1);
  std::vector<float> rows(2 * 10000);
  for (float& x : rows) x = static_cast<float>(random.uniform(-5, 5));
  rows[17] = std::numeric_limits<float>::infinity();
  SpatialOrder spatial;
  spatial.sort({.dimension = 2}, rows.data(), 10000, {});
  const auto& order = spatial.rows();
  std::vector<int> seen(10000, 0);
  for (const std::uint32_t i : order) ++seen[i];
  EXPECT_EQ(seen, std::vector<int>(10000, 1));
  double total = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (order[i] == 8 || order[i - 1] == 8) continue;
    total += std::hypot(static_cast<double>(rows[2 * order[i]] - rows[2 * order[i - 1]]),
                        static_cast<double>(rows[2 * order[i] + 1] - rows[2 * order[i - 1] + 1]));
  }
  // Uniform points lie 5 apart on average; on the curve a few cells of 10 / 256.
  EXPECT_LT(total / 10000, 0.3);
}

}  // namespace
}  // namespace thalweg
