// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Certified answers to pairs of shapes against what a dense grid and a branch and bound in double say of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include "asked_pairs.h"
#include "pair_oracle.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

using oracle::Vec;

/// The box that holds every common point, with some room.
oracle::Box common_box(const Tape& a) {
  const Bounds& bounds = a.facts.bounds;
  const bool flat = a.dimension == 2;
  return {{bounds.lo[0] - 0.01, bounds.lo[1] - 0.01, flat ? 0 : bounds.lo[2] - 0.01},
          {bounds.hi[0] + 0.01, bounds.hi[1] + 0.01, flat ? 0 : bounds.hi[2] + 0.01}};
}

struct Truth {
  oracle::PairField field;
  oracle::Box box;
  oracle::PairGrid grid;
  Truth(const Shape& a, const Shape& b, const float* pose, const oracle::Box& within, int count)
      : field(a, b, oracle::placement(pose, a.dimension())), box(within), grid(field, within, count) {}
};

void expect_verdict_holds(const Truth& truth, const AskedPairs& asked, std::size_t row) {
  const Status status = asked.status_at(row);
  const double value = asked.value[row], lower = asked.lower[row];
  EXPECT_LE(lower, truth.grid.least() + 1e-12);
  EXPECT_LE(lower, value);
  EXPECT_NEAR(value, truth.field(asked.point_at(row)), 1e-4);
  if (status == Status::overlapping) {
    EXPECT_LT(truth.field(asked.point_at(row)), 0);
  }
  if (status == Status::separated) {
    EXPECT_GT(truth.grid.least(), 0);
  }
  if (truth.grid.least() < -1e-3) {
    EXPECT_EQ(status, Status::overlapping);
  }
  if (truth.grid.least() > truth.grid.half_step() + 1e-3) {
    EXPECT_EQ(status, Status::separated);
  }
}

void expect_deepest_holds(const Truth& truth, const AskedPairs& asked, std::size_t row) {
  if (asked.status_at(row) != Status::overlapping || asked.converged[row] == 0) return;
  EXPECT_LE(asked.value[row], truth.grid.least() + asked.tolerance * 1.01);
  EXPECT_LE(asked.value[row] - asked.lower[row], asked.tolerance * 1.0001);
}

/// Regions that no path within {g <= e} joins are contacts of their own, and no component of {g <= -e} has two.
void expect_regions_hold(const Truth& truth, const AskedPairs& asked, std::size_t row) {
  const double e = asked.region, h = truth.grid.half_step();
  ASSERT_LT(h, e / 2) << "the grid is too coarse for the test";
  const std::vector<int> apart = truth.grid.components(e + h);
  const std::vector<int> whole = truth.grid.components(-e - h);
  std::set<int> deep;
  for (std::size_t i = 0; i < apart.size(); ++i) {
    if (truth.grid.values()[i] <= -e) deep.insert(apart[i]);
  }
  std::set<int> met, seen;
  for (std::size_t k = 0; k < asked.contacts_of(row); ++k) {
    const Vec p = asked.contact_at(row, k);
    EXPECT_LT(truth.field(p), 0);
    for (const int label : truth.grid.labels_near(apart, p)) met.insert(label);
    for (const int label : truth.grid.labels_near(whole, p)) {
      EXPECT_TRUE(seen.insert(label).second) << "two contacts in one component";
    }
  }
  for (const int label : deep) EXPECT_TRUE(met.count(label)) << "a component without a contact";
}

int rows_of_a_run(int quick, int full) { return std::getenv("THALWEG_FULL") == nullptr ? quick : full; }

TEST(CertifiedPairs, TorusPairsAreAnsweredAsTheGridSays) {
  const Shape shape = torus(0.35, 0.15);
  const AskedPairs asked(shape, shape, torus_poses(static_cast<std::size_t>(rows_of_a_run(60, 1000))), Goal::deepest);
  for (std::size_t row = 0; row < asked.count; ++row) {
    SCOPED_TRACE(row);
    const Truth truth(shape, shape, asked.pose_at(row), common_box(asked.a), 56);
    expect_verdict_holds(truth, asked, row);
    expect_deepest_holds(truth, asked, row);
    expect_regions_hold(truth, asked, row);
  }
}

TEST(CertifiedPairs, VerdictsAreThoseOfABranchAndBoundInDouble) {
  const Shape shape = torus(0.35, 0.15);
  const AskedPairs asked(shape, shape, torus_poses(static_cast<std::size_t>(rows_of_a_run(400, 20000))), Goal::verdict);
  std::size_t decided = 0, touching = 0;
  for (std::size_t row = 0; row < asked.count; ++row) {
    const oracle::PairField field(shape, shape, oracle::placement(asked.pose_at(row), 3));
    const oracle::Verdict truth = oracle::pair_verdict(field, common_box(asked.a), 60000);
    if (truth == oracle::Verdict::cannot_tell) continue;
    ++decided;
    // An overlap thinner than double's slack is proven to touch and no more.
    touching += asked.status_at(row) == Status::touching ? 1 : 0;
    if (asked.status_at(row) == Status::touching) continue;
    const bool overlaps = truth == oracle::Verdict::overlapping;
    EXPECT_EQ(asked.status_at(row), overlaps ? Status::overlapping : Status::separated) << "row " << row;
  }
  EXPECT_GT(decided * 10, asked.count * 9);
  EXPECT_LE(touching, 1 + asked.count / 5000);
}

TEST(CertifiedPairs, SpheresInABowlTouchIt) {
  const Shape bowl = subtraction({sphere(1.0), sphere(0.8), box({2, 2, 2}).translate(Vec3{0, 2, 0})});
  const Shape ball = sphere(0.2);
  std::vector<float> poses;
  for (int k = 0; k < 24; ++k) {
    const auto turn = static_cast<float>(k) * 0.26F;
    const float out = 0.5F + 0.02F * static_cast<float>(k % 8);
    for (const float x : {out * std::cos(turn), -0.3F, out * std::sin(turn), 1.0F, 0.0F, 0.0F, 0.0F})
      poses.push_back(x);
  }
  const AskedPairs asked(bowl, ball, poses, Goal::deepest);
  for (std::size_t row = 0; row < asked.count; ++row) {
    SCOPED_TRACE(row);
    const float* pose = asked.pose_at(row);
    const oracle::Box around{{pose[0] - 0.25, pose[1] - 0.25, pose[2] - 0.25},
                             {pose[0] + 0.25, pose[1] + 0.25, pose[2] + 0.25}};
    const Truth truth(bowl, ball, pose, around, 48);
    expect_verdict_holds(truth, asked, row);
    expect_deepest_holds(truth, asked, row);
  }
}

TEST(CertifiedPairs, RandomScenesHoldOnTheGrid) {
  oracle::Random random(20260722);
  const int rows = rows_of_a_run(60, 1500);
  int overlapping = 0;
  for (int row = 0; row < rows; ++row) {
    const int d = row % 2 == 0 ? 2 : 3;
    const RandomPair pair(random, d, 1 + row % 12);
    SCOPED_TRACE(pair.describe());
    const AskedPairs asked(pair.a, pair.b, pair.pose, Goal::deepest);
    const Truth truth(pair.a, pair.b, pair.pose.data(), common_box(asked.a), d == 2 ? 160 : 40);
    const double size = asked.size;
    EXPECT_LE(asked.lower[0], truth.grid.least() + 1e-6 * size);
    const Status status = asked.status_at(0);
    if (status == Status::overlapping) {
      EXPECT_LT(truth.field(asked.point_at(0)), 0);
    }
    if (status == Status::separated) {
      EXPECT_GT(truth.grid.least(), 0);
    }
    if (asked.converged[0] != 0 && status == Status::overlapping) {
      EXPECT_LE(asked.value[0], truth.grid.least() + 1.01 * asked.tolerance);
    }
    overlapping += status == Status::overlapping ? 1 : 0;
  }
  EXPECT_GT(overlapping, rows / 8);
}

TEST(CertifiedPairs, FlushFacesTouch) {
  const Shape cube = box({1, 1, 1});
  const AskedPairs asked(cube, cube, {2, 0.25F, 0, 1, 0, 0, 0}, Goal::verdict);
  EXPECT_EQ(asked.status_at(0), Status::touching);
}

TEST(CertifiedPairs, CoincidentSurfacesStayWithinTheBudget) {
  const Shape shape = torus(0.35, 0.15);
  const AskedPairs asked(shape, shape, {0, 0, 0, 1, 0, 0, 0}, Goal::deepest);
  EXPECT_EQ(asked.status_at(0), Status::overlapping);
  EXPECT_LE(asked.evaluations[0], 4096U + 16 * 64);
  EXPECT_LE(asked.lower[0], -0.15F);
}

TEST(CertifiedPairs, CoincidentCurvesWithoutAnInsideTouch) {
  // Both fields are 0 on the same segment and positive beside it.
  const Shape line = segment({-1, 0}, {1, 0});
  const AskedPairs asked(line, line, {0, 0, 0}, Goal::verdict);
  EXPECT_EQ(asked.status_at(0), Status::touching);
  EXPECT_LE(asked.evaluations[0], 4096U);
}

TEST(CertifiedPairs, BadPosesAreMarked) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const AskedPairs asked(sphere(1), sphere(1), {0, 0, 0, 0, 0, 0, 0, nan, 0, 0, 1, 0, 0, 0, 0.5F, 0, 0, 2, 0, 0, 0},
                         Goal::deepest);
  EXPECT_EQ(asked.status_at(0), Status::bad_row);
  EXPECT_EQ(asked.status_at(1), Status::bad_row);
  EXPECT_TRUE(std::isnan(asked.value[0]));
  EXPECT_EQ(asked.contacts_of(1), 0U);
  // A quaternion of length 2 is the same rotation.
  EXPECT_EQ(asked.status_at(2), Status::overlapping);
  EXPECT_NEAR(asked.value[2], -0.75, 1e-3);
}

TEST(CertifiedPairs, RefusesTwoUnboundedShapes) {
  const Tape plane = std::move(compile(half_plane({0, 1}, 0))).value();
  const Tape* shapes[2] = {&plane, &plane};
  const float pose[3] = {};
  PairQueries queries;
  queries.shapes = shapes;
  queries.shape_count = 2;
  queries.poses = pose;
  queries.count = 1;
  const auto refused = collide_pairs(queries, {}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().found, "two unbounded shapes");
}

/// Discs here and there: two such shapes overlap in several places.
Shape scattered_discs(oracle::Random& random) {
  const auto disc = [&] {
    return circle(random.uniform(0.2, 0.6)).translate(Vec2{random.uniform(-2, 2), random.uniform(-2, 2)});
  };
  return disc() | disc() | disc() | disc() | disc() | disc();
}

TEST(CertifiedPairs, RegionsOfRandomScenesHoldOnTheGrid) {
  oracle::Random random(20261125);
  const int rows = rows_of_a_run(60, 900);
  int checked = 0, several = 0;
  for (int row = 0; row < rows; ++row) {
    RandomPair pair(random, 2, 1 + row % 12);
    if (row % 2 == 0) {
      pair.a = scattered_discs(random);
      pair.b = scattered_discs(random);
      pair.pose = {static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-1, 1)), 0.3F};
    }
    SCOPED_TRACE(pair.describe());
    const AskedPairs asked(pair.a, pair.b, pair.pose, Goal::deepest);
    const oracle::Box box = common_box(asked.a);
    const double longest = std::max(box.hi.x - box.lo.x, box.hi.y - box.lo.y);
    const int count = static_cast<int>(2.5 * longest / asked.region) + 2;
    if (count > 400 || asked.converged[0] == 0 || asked.found[0] > AskedPairs::kContacts) continue;
    const Truth truth(pair.a, pair.b, pair.pose.data(), box, count);
    expect_regions_hold(truth, asked, 0);
    ++checked;
    several += asked.found[0] > 1 ? 1 : 0;
  }
  EXPECT_GT(checked, rows / 2);
  EXPECT_GT(several, rows / 8);
}

TEST(CertifiedPairs, EqualOverlapsShallowerThanTheRegionAreContactsEach) {
  // A bar that rests on two discs, far less deep in them than --region.
  const Shape discs = circle(1).translate(Vec2{-2, 0}) | circle(1).translate(Vec2{2, 0});
  const AskedPairs asked(discs, box({2.5, 0.3}), {0, 1.29F, 0, 0, 1.29F, 0.001F}, Goal::deepest);
  for (std::size_t row = 0; row < asked.count; ++row) {
    ASSERT_EQ(asked.contacts_of(row), 2U);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(std::fabs(asked.contact_at(row, k).x), 2, 0.1);
  }
}

TEST(CertifiedPairs, ARowThatNeedsMoreThanItsBudgetSaysSo) {
  // The rings' circles cross nowhere and run along each other: a long flat valley.
  const Shape shape = torus(0.35, 0.15);
  const AskedPairs asked(shape, shape, {0.001F, 0.05F, 0, 1, 0, 0, 0}, Goal::deepest);
  EXPECT_EQ(asked.status_at(0), Status::overlapping);
  EXPECT_EQ(asked.converged[0], 0);
  EXPECT_LE(asked.evaluations[0], 4096U);
  EXPECT_GT(asked.value[0] - asked.lower[0], asked.tolerance);
  const Truth truth(shape, shape, asked.pose_at(0), common_box(asked.a), 56);
  expect_verdict_holds(truth, asked, 0);
}

/// The thesis' figure 6: two overlaps, and a descent that can end in one of them only.
TEST(LocalPairs, ASingleStartMissesAnOverlapThatCertifiedReports) {
  const Shape discs = circle(1).translate(Vec2{-2, 0}) | circle(1).translate(Vec2{2, 0});
  const Shape bar = box({2.5, 0.3});
  const std::vector<float> pose = {0.1F, 0, 0.05F};
  const AskedPairs certified(discs, bar, pose, Goal::deepest);
  EXPECT_EQ(certified.contacts_of(0), 2U);
  const AskedPairs one(discs, bar, pose, Goal::deepest, Method::thesis, 1);
  EXPECT_EQ(one.contacts_of(0), 1U);
  const AskedPairs many(discs, bar, pose, Goal::deepest, Method::midsurface, 40);
  EXPECT_EQ(many.status_at(0), Status::overlapping);
}

TEST(LocalPairs, WhatTheyCallOverlappingOverlaps) {
  const Shape shape = torus(0.35, 0.15);
  for (const Method method : {Method::thesis, Method::midsurface}) {
    const AskedPairs asked(shape, shape, torus_poses(200), Goal::deepest, method);
    std::size_t hits = 0;
    for (std::size_t row = 0; row < asked.count; ++row) {
      const oracle::PairField field(shape, shape, oracle::placement(asked.pose_at(row), 3));
      EXPECT_NE(asked.status_at(row), Status::separated);
      EXPECT_EQ(asked.lower[row], -std::numeric_limits<float>::infinity());
      EXPECT_NEAR(asked.value[row], field(asked.point_at(row)), 1e-4);
      if (asked.status_at(row) != Status::overlapping) continue;
      ++hits;
      EXPECT_LT(field(asked.point_at(row)), 0);
    }
    EXPECT_GT(hits, 150U) << name(method);
  }
}

TEST(PairBatches, EveryColumnIsTheSameForAnyThreadCountTileAndTarget) {
  const Shape shape = torus(0.35, 0.15);
  for (const Method method : {Method::certified, Method::thesis, Method::midsurface}) {
    const std::vector<float> poses = torus_poses(static_cast<std::size_t>(rows_of_a_run(300, 4000)));
    const AskedPairs one(shape, shape, poses, Goal::deepest, method);
    for (const Target& target : targets()) {
      if (!target.fused_multiply_add) continue;
      for (const auto& [threads, tile] : {std::pair{1, 7}, std::pair{2, 1}, std::pair{5, 64}}) {
        Execution execution;
        execution.threads = threads;
        execution.tile = static_cast<std::size_t>(tile);
        execution.target = &target;
        const AskedPairs other(shape, shape, poses, Goal::deepest, method, 0, execution);
        EXPECT_TRUE(one.same_bits(other)) << name(method) << ' ' << target.name << ' ' << threads << ' ' << tile;
      }
    }
  }
}

TEST(PairBatches, RowsMayNameTheirShapes) {
  const Tape ball = std::move(compile(sphere(1))).value();
  const Tape cube = std::move(compile(box({1, 1, 1}))).value();
  const Tape* shapes[2] = {&ball, &cube};
  const std::uint32_t pairs[] = {0, 0, 0, 1, 1, 0, 1, 1};
  std::vector<float> poses;
  for (int row = 0; row < 4; ++row) {
    for (const float x : {1.9F, 1.9F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F}) poses.push_back(x);
  }
  PairQueries queries{shapes, 2, poses.data(), pairs, 4};
  std::uint8_t status[4];
  CollideColumns columns;
  columns.status = status;
  ASSERT_TRUE(collide_pairs(queries, {}, columns));
  EXPECT_EQ(status[0], 0);
  EXPECT_EQ(status[1], 0);
  EXPECT_EQ(status[2], 0);
  EXPECT_EQ(status[3], 1);
}

}  // namespace
}  // namespace thalweg
