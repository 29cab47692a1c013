// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Pairs with a long tape are answered in spatial order by shortened tapes, and pairs of the same shapes together: each
// row as if it were alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "ordered_pairs.h"
#include "random_shapes.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

using oracle::Random;

constexpr double kWorld = 1000;
/// So few rows at once are not ordered.
constexpr std::size_t kFew = 20;

Shape many_parts(int dimension) { return oracle::scattered_parts(dimension, 60); }

Shape body(int dimension) {
  if (dimension == 2) return box(Vec2{25, 6}) | circle(9).translate(Vec2{25, 0});
  return torus(30, 8) | box(Vec3{5, 5, 30});
}

/// Every column of one batch, of collisions or of distances.
struct Answers {
  static constexpr std::size_t kContacts = 4;

  Answers(std::size_t n, std::size_t d)
      : bytes(3 * n), numbers(3 * n), floats(2 * n + 3 * n * d), contacts(n * kContacts * (2 * d + 2)), n_(n), d_(d) {}

  [[nodiscard]] CollideColumns columns(std::size_t row) {
    CollideColumns all;
    all.status = byte(0, row), all.converged = byte(1, row), all.ambiguous = byte(2, row);
    all.evaluations = number(0, row), all.iterations = number(1, row);
    all.value = scalar(0, row), all.lower = scalar(1, row);
    all.point = vector(0, row), all.normal = vector(1, row);
    return all;
  }
  [[nodiscard]] PairContacts contact_columns(std::size_t row) {
    const auto at = [&](std::size_t column, std::size_t width) {
      return &contacts[kContacts * (n_ * column + row * width)];
    };
    PairContacts all;
    all.capacity = kContacts;
    all.found = number(2, row);
    all.value = at(0, 1), all.lower = at(1, 1);
    all.point = at(2, d_), all.normal = at(2 + d_, d_);
    return all;
  }
  [[nodiscard]] DistanceColumns distances(std::size_t row) {
    return {.status = byte(0, row),
            .distance = scalar(0, row),
            .lower = scalar(1, row),
            .point_a = vector(0, row),
            .point_b = vector(1, row),
            .normal = vector(2, row),
            .converged = byte(1, row),
            .evaluations = number(0, row)};
  }
  [[nodiscard]] std::size_t of(Status status) const {
    return static_cast<std::size_t>(
        std::count(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n_), static_cast<std::uint8_t>(status)));
  }
  /// NaN and all.
  [[nodiscard]] bool same_bits(const Answers& other) const {
    const auto same = [](const auto& a, const auto& b) {
      return std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
    };
    return same(bytes, other.bytes) && same(numbers, other.numbers) && same(floats, other.floats) &&
           same(contacts, other.contacts);
  }

  std::vector<std::uint8_t> bytes;
  std::vector<std::uint32_t> numbers;
  std::vector<float> floats, contacts;

 private:
  std::uint8_t* byte(std::size_t column, std::size_t row) { return &bytes[column * n_ + row]; }
  std::uint32_t* number(std::size_t column, std::size_t row) { return &numbers[column * n_ + row]; }
  float* scalar(std::size_t column, std::size_t row) { return &floats[column * n_ + row]; }
  float* vector(std::size_t column, std::size_t row) { return &floats[2 * n_ + column * n_ * d_ + row * d_]; }
  std::size_t n_, d_;
};

/// Two tapes and poses that bring the second, small, to places all over the first; or the other way round.
struct Meeting {
  Meeting(int dimension, bool long_first, std::size_t count, Shape many)
      : d(static_cast<std::size_t>(dimension)), width(d == 2 ? 3 : 7) {
    tapes[long_first ? 0 : 1] = std::move(compile(many)).value();
    tapes[long_first ? 1 : 0] = std::move(compile(body(dimension))).value();
    Random random(9);
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = random.uniform(-3, 3), side = long_first ? 1 : -1;
      double at[3] = {};
      for (double& x : at) x = random.uniform(-50, kWorld + 50);
      const double turn[4] = {std::cos(angle / 2), 0, 0, side * std::sin(angle / 2)};
      if (!long_first) {
        const double x = at[0], y = at[1];
        at[0] = -(std::cos(angle) * x + std::sin(angle) * y);
        at[1] = std::sin(angle) * x - std::cos(angle) * y;
        at[2] = -at[2];
      }
      for (std::size_t axis = 0; axis < d; ++axis) poses.push_back(static_cast<float>(at[axis]));
      if (d == 2) poses.push_back(static_cast<float>(side * angle));
      for (std::size_t k = 0; d == 3 && k < 4; ++k) poses.push_back(static_cast<float>(turn[k]));
    }
    poses[5 * width] = std::numeric_limits<float>::quiet_NaN();
    poses[6 * width] = 1e9F;
  }
  [[nodiscard]] std::size_t count() const { return poses.size() / width; }
  [[nodiscard]] PairQueries queries(std::size_t row, std::size_t rows) const {
    return {.shapes = shapes, .shape_count = 2, .poses = &poses[row * width], .count = rows};
  }

  std::size_t d, width;
  Tape tapes[2];
  const Tape* shapes[2] = {&tapes[0], &tapes[1]};
  std::vector<float> poses;
};

/// Fills `together` with all rows at once on two threads, and `alone` a few rows at a time.
void collide(const Meeting& meeting, const PairOptions& options, std::size_t tile, Answers& together, Answers* alone) {
  const auto ask = [&](Answers& answers, std::size_t row, std::size_t rows, const Execution& execution) {
    const PairContacts contacts = options.goal == Goal::deepest ? answers.contact_columns(row) : PairContacts{};
    const auto done = collide_pairs(meeting.queries(row, rows), options, answers.columns(row), contacts, execution);
    ASSERT_TRUE(done) << to_string(done.error());
  };
  ask(together, 0, meeting.count(), {.threads = 2, .tile = tile});
  for (std::size_t row = 0; alone != nullptr && row < meeting.count(); row += kFew) {
    ask(*alone, row, std::min(kFew, meeting.count() - row), {.threads = 1});
  }
}

/// Whether rows of a meeting are answered in spatial order.
bool is_ordered(const Meeting& meeting, const PairOptions& options) {
  struct Batch final : PairBatch {
    void answer(const PairTile&, PairScratch&) const override {}
  } batch;
  const PairQueries queries = meeting.queries(0, meeting.count());
  batch.all.queries = &queries;
  batch.all.options = &options;
  const std::vector<std::uint32_t> rows(meeting.count());
  PairMemory memory;
  return OrderedPairs(batch, {}, rows, memory).pays();
}

class OrderedPairRows : public testing::TestWithParam<std::tuple<int, bool, Goal, Method, Gradient>> {};

TEST_P(OrderedPairRows, AreAnsweredAsIfAlone) {
  const auto [dimension, long_first, goal, method, gradient] = GetParam();
  const Meeting meeting(dimension, long_first, 300, many_parts(dimension));
  PairOptions options;
  options.goal = goal, options.method = method;
  options.tolerance = 0.1;
  // Probes leave the region that a shortened tape is for.
  options.gradient = gradient, options.gradient_given = true;
  options.gradient_offset.absolute = 30;
  ASSERT_EQ(is_ordered(meeting, options), gradient != Gradient::closest_point);
  Answers alone(meeting.count(), meeting.d), together(meeting.count(), meeting.d);
  collide(meeting, options, 0, together, &alone);
  EXPECT_TRUE(together.same_bits(alone));
  EXPECT_EQ(alone.of(Status::bad_row), 1U);
  EXPECT_GT(alone.of(Status::overlapping), 20U);
  Answers in_tiles(meeting.count(), meeting.d);
  collide(meeting, options, 7, in_tiles, nullptr);
  EXPECT_TRUE(in_tiles.same_bits(alone));
}

INSTANTIATE_TEST_SUITE_P(
    Certified, OrderedPairRows,
    testing::Combine(testing::Values(2, 3), testing::Bool(), testing::Values(Goal::verdict, Goal::deepest),
                     testing::Values(Method::certified),
                     testing::Values(Gradient::autodiff, Gradient::central, Gradient::closest_point)));
INSTANTIATE_TEST_SUITE_P(Local, OrderedPairRows,
                         testing::Combine(testing::Values(2, 3), testing::Bool(), testing::Values(Goal::deepest),
                                          testing::Values(Method::thesis, Method::midsurface),
                                          testing::Values(Gradient::autodiff, Gradient::simplex)));

class OrderedDistances : public testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(OrderedDistances, AreMeasuredAsIfAlone) {
  const auto [dimension, long_first] = GetParam();
  const Meeting meeting(dimension, long_first, 300, many_parts(dimension));
  Answers alone(meeting.count(), meeting.d), together(meeting.count(), meeting.d);
  const auto ask = [&](Answers& answers, std::size_t row, std::size_t rows, const Execution& execution) {
    ASSERT_TRUE(measure_distances(meeting.queries(row, rows), {}, answers.distances(row), execution));
  };
  for (std::size_t row = 0; row < meeting.count(); row += kFew) ask(alone, row, kFew, {.threads = 1});
  ask(together, 0, meeting.count(), {.threads = 2});
  EXPECT_TRUE(together.same_bits(alone));
  EXPECT_GT(alone.of(Status::separated), 20U);
  EXPECT_GT(alone.of(Status::overlapping), 20U);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, OrderedDistances, testing::Combine(testing::Values(2, 3), testing::Bool()));

TEST(OrderedPairRowsOfAShapeWithoutEnd, AreAnsweredAsIfAlone) {
  const Meeting meeting(2, true, 200, many_parts(2) | half_plane(Vec2{0.6, 0.8}, -300));
  ASSERT_FALSE(meeting.tapes[0].facts.bounds.finite(2));
  PairOptions options;
  ASSERT_TRUE(is_ordered(meeting, options));
  options.goal = Goal::deepest;
  options.tolerance = 0.1;
  Answers alone(meeting.count(), 2), together(meeting.count(), 2);
  collide(meeting, options, 0, together, &alone);
  EXPECT_TRUE(together.same_bits(alone));
}

TEST(PairRowsOfSeveralShapes, AreAnsweredAsIfAlone) {
  const Tape tapes[] = {*compile(many_parts(2)), *compile(body(2)), *compile(star(40, 5, 3)), *compile(circle(20))};
  const Tape* const shapes[] = {&tapes[0], &tapes[1], &tapes[2], &tapes[3]};
  constexpr std::size_t kCount = 600;
  Random random(4);
  std::vector<float> poses;
  std::vector<std::uint32_t> pairs;
  for (std::size_t i = 0; i < kCount; ++i) {
    pairs.push_back(static_cast<std::uint32_t>(random.uniform(0, 3.999)));
    pairs.push_back(static_cast<std::uint32_t>(random.uniform(0, 3.999)));
    const double reach = pairs[2 * i] == 0 ? kWorld : 50;
    for (int k = 0; k < 3; ++k) poses.push_back(static_cast<float>(random.uniform(0, k == 2 ? 3 : reach)));
  }
  PairOptions options;
  options.goal = Goal::deepest;
  options.tolerance = 0.1;
  Answers alone(kCount, 2), together(kCount, 2);
  const auto ask = [&](Answers& answers, std::size_t row, std::size_t rows) {
    ASSERT_TRUE(collide_pairs({shapes, 4, &poses[3 * row], &pairs[2 * row], rows}, options, answers.columns(row),
                              answers.contact_columns(row)));
  };
  for (std::size_t row = 0; row < kCount; ++row) ask(alone, row, 1);
  ask(together, 0, kCount);
  EXPECT_TRUE(together.same_bits(alone));
  EXPECT_GT(alone.of(Status::overlapping), 100U);
}

TEST(OrderedPairBatch, CountsItsRowsAndCanBeCancelled) {
  const Meeting meeting(2, true, 200, many_parts(2));
  Answers answers(200, 2);
  std::atomic<std::size_t> done{0};
  std::atomic<bool> cancelled{false};
  const Execution execution{.threads = 2, .done = &done, .cancelled = &cancelled};
  auto summary = collide_pairs(meeting.queries(0, 200), {}, answers.columns(0), {}, execution);
  ASSERT_TRUE(summary);
  EXPECT_EQ(done, 200U);
  EXPECT_EQ(summary->by_status[4], 1U);
  EXPECT_FALSE(summary->cancelled);
  cancelled = true;
  summary = collide_pairs(meeting.queries(0, 200), {}, answers.columns(0), {}, execution);
  ASSERT_TRUE(summary);
  EXPECT_TRUE(summary->cancelled);
  EXPECT_EQ(done, 200U);
}

}  // namespace
}  // namespace thalweg
