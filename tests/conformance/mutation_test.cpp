// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The tests bite. Each mutation breaks one thing that the others rely on, on a batch built to show it, and must be
// found out; the same batch unbroken must pass.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "comparison.h"
#include "random_queries.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg::conformance {
namespace {

using oracle::Bracket;
using oracle::Field;
using oracle::Random;
using oracle::Vec;
using oracle::Verdict;

Tape compiled(const Shape& shape) {
  auto tape = compile(shape);
  EXPECT_TRUE(tape);
  return std::move(tape).value();
}

/// The scene that the mutations act on: flat and round surfaces, hard and smooth operators.
Shape scene() {
  const Shape parts =
      star(300, 12, 4).translate(Vec2{1000, 550}) | box(Vec2{80, 40}).rotate(0.4).translate(Vec2{300, 200});
  return smooth_union(1, {parts, circle(200).translate(Vec2{750, 400})});
}

// --- a lane --------------------------------------------------------------------------------------------------------

TEST(PerturbedLane, IsFoundByTheComparisonOfValues) {
  const Shape shape = scene();
  const Tape tape = compiled(shape);
  const Field field(shape);
  Random random(11);
  const Points points = plain_points(random, shape, 1000);
  for (const Target& target : targets()) {
    const std::vector<float> value = run_value(tape, target, points).value;
    ASSERT_EQ(compare_values(tape, field, points, value).fault, "") << target.name;
    for (int i = 0; i < 50; ++i) {
      std::vector<float> mutated = value;
      const std::size_t lane = random.index(points.count);
      const double slack = tape.slack(points.magnitude(lane));
      const double perturbations[] = {2.1 * slack, -2.1 * slack, 1.0, std::nan("")};
      mutated[lane] += static_cast<float>(perturbations[random.index(4)]);
      ASSERT_NE(compare_values(tape, field, points, mutated).fault, "") << target.name << ", lane " << lane;
    }
    std::vector<float> swapped = value;
    std::swap(swapped[3], swapped[4]);
    EXPECT_NE(compare_values(tape, field, points, swapped).fault, "") << target.name << ", two lanes swapped";
  }
}

// --- verdicts ------------------------------------------------------------------------------------------------------

/// Rows of triangles or of discs with their answers.
struct Batch {
  bool discs = false;
  std::vector<float> rows;
  [[nodiscard]] std::size_t count() const { return rows.size() / (discs ? 3 : 6); }
};

/// What the oracle says of each row.
std::vector<Verdict> truths(const Field& field, const Batch& batch) {
  std::vector<Verdict> all;
  const oracle::Limits limits{.verdict_only = true, .width = 0, .cap = 500};
  for (std::size_t i = 0; i < batch.count(); ++i) {
    const float* row = batch.rows.data() + i * (batch.discs ? 3 : 6);
    const Bracket found = batch.discs ? minimum_over_ball(field, {row[0], row[1], 0}, row[2], limits)
                                      : minimum_over_triangle(field, oracle::triangle_at(batch.rows, i, 2), limits);
    all.push_back(verdict(field, found, 4e4));
  }
  return all;
}

/// How many verdicts of a tape the oracle refutes: separated where it has a negative point, or overlapping where it
/// proved the query apart.
std::size_t refuted(const Tape& tape, const Batch& batch, const std::vector<Verdict>& truth, const Target& target) {
  std::vector<std::uint8_t> status(batch.count());
  CollideColumns columns;
  columns.status = status.data();
  const Queries queries{batch.rows.data(), batch.count()};
  const Execution execution{.threads = 1, .target = &target};
  const auto done = batch.discs ? collide_circles(tape, queries, {}, columns, execution)
                                : collide_triangles(tape, queries, {}, columns, execution);
  EXPECT_TRUE(done);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < batch.count(); ++i) {
    wrong += status[i] == 0 && truth[i] == Verdict::overlapping ? 1 : 0;
    wrong += status[i] == 1 && truth[i] == Verdict::separated ? 1 : 0;
  }
  return wrong;
}

void add(Batch& batch, Vec p) {
  batch.rows.push_back(static_cast<float>(p.x));
  batch.rows.push_back(static_cast<float>(p.y));
}

/// Triangles that dip one corner into the surface by a few hundredths of their size, the rest being outside: the bound
/// f(centre) - L reach is just below zero.
Batch grazing(const Field& field, const Shape& shape, std::size_t count) {
  Random random(12);
  Batch batch;
  const auto region = oracle::region_of(shape);
  while (batch.count() < count) {
    const auto at = oracle::random_surface_point(random, field, region);
    if (!at.found) continue;
    const double size = random.uniform(5, 40);
    const Vec t{-at.normal.y, at.normal.x, 0};
    add(batch, at.point - at.normal * (size * 0.03));
    add(batch, at.point + at.normal * size + t * (0.2 * size));
    add(batch, at.point + at.normal * size - t * (0.2 * size));
  }
  return batch;
}

TEST(LipschitzConstantTimesNineTenths, GivesVerdictsThatTheOracleRefutes) {
  const Shape shape = scene();
  const Field field(shape);
  const Batch batch = grazing(field, shape, 1000);
  const std::vector<Verdict> truth = truths(field, batch);
  const Tape tape = compiled(shape);
  Tape mutated = tape;
  mutated.facts.lipschitz *= 0.9;
  for (const Target& target : targets()) {
    EXPECT_EQ(refuted(tape, batch, truth, target), 0U) << target.name;
    EXPECT_GT(refuted(mutated, batch, truth, target), 100U) << target.name;
  }
}

/// How many lower bounds of deepest points are above a value that the oracle found.
std::size_t overstated(const Tape& tape, const Batch& batch, const std::vector<Bracket>& truth, const Target& target) {
  std::vector<float> lower(batch.count());
  CollideColumns columns;
  columns.lower = lower.data();
  CollideOptions options;
  options.goal = Goal::deepest;
  const Queries queries{batch.rows.data(), batch.count()};
  EXPECT_TRUE(collide_triangles(tape, queries, options, columns, {.threads = 1, .target = &target}));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < batch.count(); ++i) wrong += static_cast<double>(lower[i]) > truth[i].upper ? 1 : 0;
  return wrong;
}

TEST(LipschitzConstantTimesNineTenths, GivesLowerBoundsOfDeepestPointsThatTheOracleRefutes) {
  const Shape shape = scene();
  const Field field(shape);
  // Large enough to lie about spikes, in notches and across the blend: wherever a centre or a corner is not the answer.
  Random random(15);
  Batch batch;
  while (batch.count() < 1000) {
    const Vec middle{random.uniform(550, 1300), random.uniform(200, 850), 0};
    for (int k = 0; k < 3; ++k) add(batch, middle + Vec{random.uniform(-100, 100), random.uniform(-100, 100), 0});
  }
  std::vector<Bracket> truth;
  for (std::size_t i = 0; i < batch.count(); ++i) {
    truth.push_back(minimum_over_triangle(field, oracle::triangle_at(batch.rows, i, 2),
                                          {.verdict_only = false, .width = 0.01, .cap = 20'000}));
  }
  const Tape tape = compiled(shape);
  Tape mutated = tape;
  mutated.facts.lipschitz *= 0.9;
  for (const Target& target : targets()) {
    EXPECT_EQ(overstated(tape, batch, truth, target), 0U) << target.name;
    EXPECT_GT(overstated(mutated, batch, truth, target), 30U) << target.name;
  }
}

/// Far from the origin, where one ulp of a coordinate is 1/512, and at an angle so that nothing is exact.
Shape far_scene() {
  const Shape parts = circle(200).translate(Vec2{300, 0}) | box(Vec2{150, 90}).rotate(0.7);
  return parts.translate(Vec2{20000.3, 17000.7});
}

/// Points, needles and discs whose distance to the surface is a fraction of the float32 slack.
Batch nearly_touching(const Field& field, const Shape& shape, const Tape& tape, bool discs, std::size_t count) {
  Random random(13);
  Batch batch;
  batch.discs = discs;
  const auto region = oracle::region_of(shape);
  const double slack = tape.slack(2e4);
  while (batch.count() < count) {
    const auto at = oracle::random_surface_point(random, field, region);
    if (!at.found) continue;
    const double gap = random.uniform(-0.3, 0.3) * slack;
    if (discs) {
      const auto radius = static_cast<float>(random.uniform(1, 50));
      add(batch, at.point + at.normal * (radius + gap));
      batch.rows.push_back(radius);
      continue;
    }
    const Vec tip = at.point + at.normal * gap;
    const double size = random.chance(0.5) ? 0 : random.uniform(0, 0.1);
    add(batch, tip);
    add(batch, tip + at.normal * size);
    add(batch, tip + at.normal * (2 * size));
  }
  return batch;
}

TEST(NoSlack, GivesVerdictsThatTheOracleRefutes) {
  const Shape shape = far_scene();
  const Field field(shape);
  const Tape tape = compiled(shape);
  Tape mutated = tape;
  mutated.slack = mutated.search_slack = {0, 0};
  for (const bool discs : {false, true}) {
    const Batch batch = nearly_touching(field, shape, tape, discs, 2000);
    const std::vector<Verdict> truth = truths(field, batch);
    for (const Target& target : targets()) {
      EXPECT_EQ(refuted(tape, batch, truth, target), 0U) << target.name << (discs ? ", discs" : ", triangles");
      EXPECT_GT(refuted(mutated, batch, truth, target), 20U) << target.name << (discs ? ", discs" : ", triangles");
    }
  }
}

// --- the oracle's own claims that the comparison leans on
// ----------------------------------------------------------------

TEST(SlackOfATape, IsWhatFloat32NeedsAndNotFarMore) {
  // If slacks were generous, no comparison within them would find anything.
  const Shape shape = scene();
  const Tape tape = compiled(shape);
  const Field field(shape);
  Random random(14);
  const Points points = plain_points(random, shape, 20'000);
  const Comparison found = compare_values(tape, field, points, run_value(tape, targets().front(), points).value);
  EXPECT_EQ(found.fault, "");
  EXPECT_GT(found.worst, 0.01);
}

}  // namespace
}  // namespace thalweg::conformance
