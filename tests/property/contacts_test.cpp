// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Many contacts a triangle: against places known by construction, and against the local minima of a dense sampling that
// the oracle makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "oracle.h"
#include "random.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg::property {
namespace {

using oracle::Vec;

struct Contacts {
  std::size_t room = 0;
  std::vector<std::uint32_t> found, kept, evaluations;
  std::vector<float> value, point, normal, barycentric;
};

Contacts contacts_of(const Tape& tape, const std::vector<float>& rows, std::uint32_t most, double margin,
                     double feature = 0) {
  const auto d = static_cast<std::size_t>(tape.dimension);
  const std::size_t n = rows.size() / (3 * d);
  Contacts c;
  c.room = most;
  c.found.resize(n), c.kept.resize(n), c.evaluations.resize(n);
  c.value.resize(n * most), c.point.resize(n * most * d), c.normal.resize(n * most * d);
  c.barycentric.resize(n * most * 3);
  CollideOptions options;
  options.contacts = most, options.margin = margin, options.feature = feature;
  CollideColumns columns;
  columns.evaluations = c.evaluations.data();
  columns.contacts = {c.found.data(), c.kept.data(),   c.value.data(),
                      c.point.data(), c.normal.data(), c.barycentric.data()};
  const auto summary = collide_triangles(tape, {rows.data(), n}, options, columns);
  EXPECT_TRUE(summary);
  return c;
}

Tape tape_of(const Shape& shape) { return std::move(compile(shape)).value(); }

/// A comb: teeth of circles above y = 0 that hang down to y = 1 at x = 0, 4, 8, ..., the deeper the further right.
Shape comb(int teeth) {
  std::vector<Shape> of;
  for (int i = 0; i < teeth; ++i) of.push_back(circle(1).translate(Vec2{4.0 * i, 2 - 0.05 * i}));
  return union_(of);
}

TEST(Contacts, OfAnEdgeUnderACombAreItsTeeth) {
  const Tape tape = tape_of(comb(6));
  const std::vector<float> rows = {-2, 1.1F, 22, 1.1F, 10, -8};
  const Contacts c = contacts_of(tape, rows, 16, 0.05, 0.5);
  ASSERT_EQ(c.found[0], 6U);
  ASSERT_EQ(c.kept[0], 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    // Deepest first: the rightmost tooth is the lowest.
    const double depth = 0.1 + 0.05 * static_cast<double>(5 - i);
    EXPECT_NEAR(c.value[i], -depth, 1e-3);
    EXPECT_NEAR(c.point[2 * i], 4.0 * static_cast<double>(5 - i), 2e-2);
    EXPECT_NEAR(c.point[2 * i + 1], 1.1, 1e-3);
    EXPECT_NEAR(c.normal[2 * i + 1], -1, 1e-3);
  }
}

TEST(Contacts, AreCutToKByTheFarthestPointRuleAndCountedBefore) {
  const Tape tape = tape_of(comb(6));
  const std::vector<float> rows = {-2, 1.1F, 22, 1.1F, 10, -8};
  const Contacts c = contacts_of(tape, rows, 3, 0.05, 0.5);
  EXPECT_EQ(c.found[0], 6U);
  ASSERT_EQ(c.kept[0], 3U);
  // The deepest, at 20; the one furthest from it, at 0; then the middle, of the two at 8 and 12 the deeper.
  EXPECT_NEAR(c.point[0], 20, 2e-2);
  EXPECT_NEAR(c.point[2], 8, 4.1);
  EXPECT_NEAR(c.point[4], 0, 2e-2);
}

TEST(Contacts, ReachAsFarAsTheMargin) {
  const Tape tape = tape_of(comb(6));
  const std::vector<float> rows = {-2, 0.5F, 22, 0.5F, 10, -8};
  EXPECT_EQ(contacts_of(tape, rows, 8, 0, 0.5).found[0], 0U);
  EXPECT_EQ(contacts_of(tape, rows, 8, 0.37, 0.5).found[0], 3U);
  EXPECT_EQ(contacts_of(tape, rows, 8, 0.6, 0.5).found[0], 6U);
}

TEST(Contacts, OfATriangleFlushWithAFaceSpreadOverIt) {
  const Tape tape = tape_of(box(Vec3{10, 1, 10}));
  const std::vector<float> rows = {-4, 1, -4, 4, 1, -4, 0, 1, 4};
  const Contacts c = contacts_of(tape, rows, 3, 1e-3, 1);
  EXPECT_GT(c.found[0], 10U);
  ASSERT_EQ(c.kept[0], 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(c.value[i], 0, 1e-5);
    EXPECT_NEAR(c.normal[3 * i + 1], 1, 1e-5);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(std::hypot(c.point[3 * i] - c.point[3 * j], c.point[3 * i + 2] - c.point[3 * j + 2]), 4);
    }
  }
}

TEST(Contacts, OfDegenerateTrianglesAndBadRowsAreAnswered) {
  const Tape tape = tape_of(circle(2));
  const std::vector<float> rows = {1, 0, 1, 0, 1, 0, -3, 0, 3, 0, 0, 0, NAN, 0, 1, 0, 1, 1, 90, 0, 91, 0, 90, 1};
  const Contacts c = contacts_of(tape, rows, 4, 0);
  EXPECT_EQ(c.found, (std::vector<std::uint32_t>{1, 1, 0, 0}));
  EXPECT_NEAR(c.value[0], -1, 1e-5);
  EXPECT_NEAR(c.value[4], -2, 1e-3);
  EXPECT_EQ(c.evaluations[2], 0U);
}

TEST(Contacts, OfCirclesAreRefused) {
  const Tape tape = tape_of(circle(2));
  const float row[] = {0, 0, 1};
  CollideOptions options;
  options.contacts = 2;
  const auto refused = collide_circles(tape, {row, 1}, options, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().place, "--contacts");
}

/// A local minimum of the oracle's field over a dense lattice of the triangle.
struct Minimum {
  Vec point;
  double value;
};

Vec place(const std::array<Vec, 3>& t, int i, int j, int n) {
  const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
  return t[0] * (1 - u - v) + t[1] * u + t[2] * v;
}

std::vector<Minimum> dense_minima(const oracle::Field& field, const std::array<Vec, 3>& t, int n, double margin) {
  const auto at = [&](int i, int j) {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(n + 1) + static_cast<std::size_t>(j);
  };
  std::vector<double> value(static_cast<std::size_t>((n + 1) * (n + 1)), 1e30);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) value[at(i, j)] = field(place(t, i, j, n));
  }
  std::vector<Minimum> minima;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      bool lowest = value[at(i, j)] <= margin;
      // Two rings, so that the lattice's own grain makes no minima.
      for (int k = std::max(0, i - 2); k <= std::min(n, i + 2) && lowest; ++k) {
        for (int l = std::max(0, j - 2); l <= std::min(n - k, j + 2); ++l) {
          lowest = lowest && value[at(k, l)] >= value[at(i, j)];
        }
      }
      if (lowest) minima.push_back({place(t, i, j, n), value[at(i, j)]});
    }
  }
  return minima;
}

/// Circles or spheres at random, none near another.
Shape scattered(oracle::Random& random, int dimension) {
  std::vector<Vec> centres;
  std::vector<Shape> of;
  while (of.size() < 9) {
    const Vec c{random.uniform(-8, 8), random.uniform(-8, 8), dimension == 3 ? random.uniform(-1, 1) : 0};
    if (std::any_of(centres.begin(), centres.end(), [&](Vec o) { return distance(o, c) < 4; })) continue;
    centres.push_back(c);
    const double radius = random.uniform(0.6, 1.2);
    of.push_back(dimension == 2 ? circle(radius).translate(Vec2{c.x, c.y})
                                : sphere(radius).translate(Vec3{c.x, c.y, c.z}));
  }
  return union_(of);
}

class ContactsOracle : public testing::TestWithParam<int> {};

TEST_P(ContactsOracle, EveryLocalMinimumOfADenseSamplingIsAContactAndNoOther) {
  const int d = GetParam();
  oracle::Random random(77);
  std::size_t seen = 0;
  for (int scene = 0; scene < 12; ++scene) {
    const Shape shape = scattered(random, d);
    const oracle::Field field(shape);
    const Tape tape = tape_of(shape);
    for (int round = 0; round < 6; ++round) {
      std::vector<float> row;
      std::array<Vec, 3> t;
      for (Vec& corner : t) {
        const float x = static_cast<float>(random.uniform(-9, 9)), y = static_cast<float>(random.uniform(-9, 9));
        const float z = static_cast<float>(random.uniform(-1, 1));
        corner = {x, y, d == 3 ? static_cast<double>(z) : 0.0};
        row.insert(row.end(), {x, y});
        if (d == 3) row.push_back(z);
      }
      const Contacts c = contacts_of(tape, row, 64, 0.2, 0.7);
      const auto minima = dense_minima(field, t, 150, 0.18);
      for (const Minimum& minimum : minima) {
        double nearest = 1e30;
        for (std::size_t i = 0; i < c.kept[0]; ++i) {
          const float* p = c.point.data() + i * static_cast<std::size_t>(d);
          const Vec at{p[0], p[1], d == 3 ? static_cast<double>(p[2]) : 0.0};
          // The contact that stands for it is close, and at least as deep.
          if (c.value[i] <= minimum.value + 0.02) nearest = std::min(nearest, distance(at, minimum.point));
        }
        ++seen;
        ASSERT_LT(nearest, 0.8) << "scene " << scene << " round " << round << " value " << minimum.value;
      }
      for (std::size_t i = 0; i < c.kept[0]; ++i) {
        const float* p = c.point.data() + i * static_cast<std::size_t>(d);
        const Vec at{p[0], p[1], d == 3 ? static_cast<double>(p[2]) : 0.0};
        ASSERT_NEAR(field(at), c.value[i], 1e-4);
        // Nothing around is clearly lower: it is a local minimum.
        const double weights[3] = {c.barycentric[3 * i], c.barycentric[3 * i + 1], c.barycentric[3 * i + 2]};
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec towards = at + (t[k] - at) * (0.01 / std::max(1.0, distance(t[k], at)));
          ASSERT_GT(field(towards), c.value[i] - 1e-4) << weights[k];
        }
        ASSERT_GE(c.value[i], c.value[i > 0 ? i - 1 : 0]);
      }
    }
  }
  EXPECT_GT(seen, 60U);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, ContactsOracle, testing::Values(2, 3),
                         [](const auto& d) { return std::to_string(d.param) + "D"; });

}  // namespace
}  // namespace thalweg::property
