// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Random queries on random paths through random scenes, against points of theirs at many times in double; and the same
// bits however they are run.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <limits>

#include "asked_sweeps.h"
#include "oracle/random_shapes.h"
#include "thalweg/ops.h"
#include "thalweg/simd.h"

namespace thalweg {
namespace {

using oracle::Random;
using oracle::Vec;

constexpr std::uint64_t kSeed = 20261127;

/// Queries of some size near the scene, that move by a few units and turn by up to a radian.
AskedSweeps random_sweeps(Random& random, const Shape& shape, Moving kind, std::size_t count,
                          const Execution& execution = {}) {
  const auto d = static_cast<std::size_t>(shape.dimension());
  std::vector<float> rows, moves;
  for (std::size_t i = 0; i < count; ++i) {
    double centre[3], move[3];
    for (double& x : centre) x = random.uniform(-3, 3);
    for (double& x : move) x = random.uniform(-3, 3);
    const double size = random.spread(0.01, 1);
    if (kind == Moving::circles) {
      for (std::size_t axis = 0; axis < d; ++axis) rows.push_back(static_cast<float>(centre[axis]));
      rows.push_back(static_cast<float>(size));
    }
    for (std::size_t k = 0; kind != Moving::circles && k < 3 * d; ++k) {
      rows.push_back(static_cast<float>(centre[k % d] + random.uniform(-size, size)));
      if (kind == Moving::triangles_to_ends) {
        moves.push_back(static_cast<float>(rows.back() + move[k % d] + random.uniform(-size, size)));
      }
    }
    if (kind == Moving::triangles_to_ends) continue;
    for (std::size_t axis = 0; axis < d; ++axis) moves.push_back(static_cast<float>(move[axis]));
    if (d == 3) moves.push_back(static_cast<float>(random.uniform(-1, 1)));
    // Every third row does not turn.
    for (std::size_t k = 0; k < (d == 2 ? 1 : 3); ++k) {
      moves.push_back(static_cast<float>(i % 3 == 0 ? 0 : random.uniform(-1, 1)));
    }
  }
  return {shape, kind, std::move(rows), std::move(moves), {}, execution};
}

/// The first of many times at which one of many points of the query is inside; above 1 if none is.
double first_seen(const AskedSweeps& asked, const oracle::Field& field, std::size_t row, Random& random) {
  constexpr int kTimes = 200, kPoints = 24;
  for (int i = 0; i <= kTimes; ++i) {
    const double t = static_cast<double>(i) / kTimes;
    for (int k = 0; k < kPoints; ++k) {
      Vec at{random.uniform(0, 1), random.uniform(0, 1), 0};
      if (asked.kind == Moving::circles) {
        const Vec to{random.uniform(-1, 1), random.uniform(-1, 1), asked.d == 3 ? random.uniform(-1, 1) : 0};
        at = to * (0.999 / std::max(length(to), 1e-9));
      } else {
        if (at.x + at.y > 1) at = {1 - at.x, 1 - at.y, 0};
        at = k < 3 ? Vec{k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0} : Vec{1 - at.x - at.y, at.x, at.y};
      }
      if (field(asked.in_scene(row, asked.point_of(row, at, t), t)) < 0) return t;
    }
  }
  return 2;
}

/// The contact is of the query at its time, and inside.
void expect_witness(const AskedSweeps& asked, const oracle::Field& field, std::size_t row) {
  const double t = asked.upper[row];
  const Vec p = asked.vec(asked.point, row);
  EXPECT_LT(field(asked.in_scene(row, p, t)), 1e-5);
  EXPECT_NEAR(length(asked.vec(asked.normal, row)), 1, 1e-5);
  const float* const b = &asked.barycentric[3 * row];
  if (asked.kind == Moving::circles) {
    EXPECT_LE(distance(p, asked.point_of(row, {}, t)), asked.rows[row * asked.width + asked.d] + 1e-5);
  } else {
    EXPECT_LT(distance(p, asked.point_of(row, {b[0], b[1], b[2]}, t)), 1e-5);
  }
}

void check(const AskedSweeps& asked, const Shape& shape, Random& random) {
  const oracle::Field field(shape);
  for (std::size_t row = 0; row < asked.count; ++row) {
    SCOPED_TRACE("row " + std::to_string(row));
    ASSERT_LE(asked.lower[row], asked.upper[row]);
    ASSERT_LE(asked.upper[row], 1);
    const double seen = first_seen(asked, field, row, random);
    const Status status = asked.status_at(row);
    // A wrong `separated`, or a bound that is passed, is the worst that can be.
    ASSERT_GE(seen, status == Status::separated ? 1.5 : static_cast<double>(asked.lower[row])) << "seen inside";
    if (status == Status::overlapping) expect_witness(asked, field, row);
    if (asked.converged[row] != 0 && status == Status::overlapping) {
      EXPECT_LE(asked.upper[row] - asked.lower[row], asked.tolerance() * 1.001);
    }
  }
}

class RandomSweeps : public testing::TestWithParam<std::tuple<int, Moving>> {};

TEST_P(RandomSweeps, HoldAgainstManyPointsAtManyTimes) {
  const auto [dimension, kind] = GetParam();
  const bool full = std::getenv("THALWEG_FULL") != nullptr;
  std::size_t hits = 0, closed = 0;
  for (std::uint64_t scene = 0; scene < (full ? 200U : 12U); ++scene) {
    const std::uint64_t seed = kSeed + scene;
    Random random(seed);
    const Shape shape = oracle::random_shape(random, dimension, 8);
    SCOPED_TRACE(oracle::describe(shape, seed));
    const AskedSweeps asked = random_sweeps(random, shape, kind, 60);
    check(asked, shape, random);
    for (std::size_t row = 0; row < asked.count; ++row) {
      if (asked.status_at(row) != Status::overlapping) continue;
      ++hits;
      closed += asked.converged[row];
    }
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(hits, 50U);
  EXPECT_GT(closed, hits * 3 / 4);
}

TEST_P(RandomSweeps, HaveTheSameBitsHoweverTheyAreRun) {
  const auto [dimension, kind] = GetParam();
  const auto answers = [&](const Execution& execution) {
    Random random(kSeed);
    const Shape shape = oracle::random_shape(random, dimension, 12);
    return random_sweeps(random, shape, kind, 700, execution);
  };
  const AskedSweeps one = answers({.threads = 1, .tile = 1});
  for (const std::size_t tile : {0, 7, 100, 1000}) {
    EXPECT_TRUE(answers({.threads = 2, .tile = tile}).same_bits(one)) << tile;
  }
  const AskedSweeps own = answers({.threads = 1});
  for (const Target& target : targets()) {
    if (!target.fused_multiply_add || !default_target().fused_multiply_add) continue;
    EXPECT_TRUE(answers({.threads = 1, .target = &target}).same_bits(own)) << target.name;
  }
}

TEST_P(RandomSweeps, AreSoundOnEveryTarget) {
  const auto [dimension, kind] = GetParam();
  for (const Target& target : targets()) {
    SCOPED_TRACE(std::string(target.name));
    Random random(kSeed + 7);
    const Shape shape = oracle::random_shape(random, dimension, 6);
    check(random_sweeps(random, shape, kind, 40, {.target = &target}), shape, random);
  }
}

/// Many small parts over the cube of the queries.
Shape many_parts(int dimension) {
  Random random(kSeed);
  std::vector<Shape> parts;
  for (int i = 0; i < 240; ++i) {
    const double x = random.uniform(-3, 3), y = random.uniform(-3, 3), z = random.uniform(-3, 3);
    const Shape part = dimension == 2 ? (i % 2 == 0 ? circle(0.05) : star(0.1, 5, 3)).translate(Vec2{x, y})
                                      : (i % 2 == 0 ? sphere(0.2) : box(Vec3{0.2, 0.1, 0.1})).translate(Vec3{x, y, z});
    parts.push_back(part);
  }
  return union_(parts);
}

TEST_P(RandomSweeps, NearALongTapeAreAnsweredAsIfAlone) {
  const auto [dimension, kind] = GetParam();
  const Shape shape = many_parts(dimension);
  Random random(kSeed);
  AskedSweeps together = random_sweeps(random, shape, kind, 600, {.threads = 2});
  ASSERT_GT(together.tape.instructions.size(), 300U);
  together.moves[together.moves.size() / 2] = std::numeric_limits<float>::quiet_NaN();
  // So few rows at once are not ordered.
  constexpr std::size_t kFew = 50;
  const std::size_t width = together.moves.size() / together.count;
  const AskedSweeps all(shape, kind, together.rows, together.moves, {}, {.threads = 2});
  for (std::size_t row = 0; row < all.count; row += kFew) {
    const auto part = [&](const std::vector<float>& of, std::size_t numbers) {
      return std::vector<float>(of.begin() + static_cast<std::ptrdiff_t>(row * numbers),
                                of.begin() + static_cast<std::ptrdiff_t>((row + kFew) * numbers));
    };
    const AskedSweeps few(shape, kind, part(all.rows, all.width), part(all.moves, width));
    for (std::size_t i = 0; i < kFew; ++i) {
      ASSERT_EQ(few.status[i], all.status[row + i]) << row + i;
      ASSERT_EQ(few.evaluations[i], all.evaluations[row + i]) << row + i;
      ASSERT_EQ(std::memcmp(&few.lower[i], &all.lower[row + i], sizeof(float)), 0) << row + i;
      ASSERT_EQ(std::memcmp(&few.upper[i], &all.upper[row + i], sizeof(float)), 0) << row + i;
      ASSERT_EQ(std::memcmp(&few.point[few.d * i], &all.point[all.d * (row + i)], few.d * sizeof(float)), 0) << row + i;
    }
  }
  EXPECT_EQ(all.summary.by_status[4], 1U);
  EXPECT_GT(all.summary.by_status[1], 50U);
  EXPECT_GT(all.summary.by_status[0], 40U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, RandomSweeps,
                         testing::Combine(testing::Values(2, 3), testing::Values(Moving::triangles_to_ends,
                                                                                 Moving::triangles, Moving::circles)));

}  // namespace
}  // namespace thalweg
