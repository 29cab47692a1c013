// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Exactness labels against a distance found by subdividing space around the point. The shapes and the points are
// few, for each distance costs many thousand evaluations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "oracle.h"
#include "random_queries.h"
#include "random_shapes.h"
#include "sampling.h"
#include "thalweg/ops.h"

namespace thalweg::property {
namespace {

using oracle::describe;
using oracle::Interval;
using oracle::point_in;
using oracle::Random;
using oracle::Region;
using oracle::Vec;

/// What is wrong with the label at `p`, or nothing.
std::string fault(const oracle::Field& field, const Facts& facts, Vec p, double resolution) {
  const double value = field(p);
  const Exactness label = value < 0 ? facts.inside : facts.outside;
  if (label == Exactness::sign_only) return "";
  const double claimed = std::abs(value);
  // Beyond this a zero would not change the verdict on either label.
  const double reach = claimed * 1.25 + 4 * resolution;
  const Interval found = oracle::brute_force_distance(field, p, reach, resolution);
  const auto text = [&](const char* what) {
    return std::string(what) + ": f = " + std::to_string(value) + ", distance in [" + std::to_string(found.lower) +
           ", " + std::to_string(found.upper) + "] at " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' +
           std::to_string(p.z);
  };
  if (claimed > found.upper + 2 * resolution) return text("|f| exceeds the distance");
  if (label == Exactness::exact && claimed < found.lower - 2 * resolution) return text("|f| is not the distance");
  return "";
}

/// Anywhere, or close to the surface, where thin parts are.
Vec probe(Random& random, const oracle::Field& field, const Region& region) {
  const Vec anywhere = point_in(random, region);
  if (random.chance(0.5)) return anywhere;
  const auto surface = oracle::random_surface_point(random, field, region);
  if (!surface.found) return anywhere;
  return surface.point + surface.normal * (random.uniform(-0.1, 0.1) * length(region.hi - region.lo));
}

void check(const std::vector<Drawn>& shapes, int points) {
  for (const Drawn& drawn : shapes) {
    const oracle::Field field(drawn.shape);
    const Region region = oracle::region_of(drawn.shape);
    const double resolution = (field.dimension() == 2 ? 1e-3 : 1e-2) * length(region.hi - region.lo);
    Random random(drawn.seed ^ 0xd157);
    for (int i = 0; i < points; ++i) {
      const std::string wrong = fault(field, drawn.shape.facts(), probe(random, field, region), resolution);
      ASSERT_TRUE(wrong.empty()) << wrong << "\n" << describe(drawn.shape, drawn.seed);
    }
  }
}

TEST(Exactness, OfPrimitivesIsWhatABruteForceDistanceFinds) { check(drawn_primitives(1'000, amount(20)), 24); }
TEST(Exactness, OfOperatorsIsWhatABruteForceDistanceFinds) { check(drawn_operators(2'000, amount(30)), 8); }
TEST(Exactness, OfTreesIsWhatABruteForceDistanceFinds) { check(drawn_trees(3'000, amount(60)), 8); }

// The check itself: a label that is too strong must be found out.
TEST(Exactness, OfAUnionsInsideIsRefusedWhenItClaimsTheDistance) {
  const Shape overlap = circle(1).translate(Vec2{-0.8, 0}) | circle(1).translate(Vec2{0.8, 0});
  Facts facts = overlap.facts();
  ASSERT_EQ(facts.inside, Exactness::lower_bound);
  EXPECT_EQ(fault(oracle::Field(overlap), facts, {0, 0.1, 0}, 1e-3), "");
  facts.inside = Exactness::exact;
  EXPECT_NE(fault(oracle::Field(overlap), facts, {0, 0.1, 0}, 1e-3), "");
}

}  // namespace
}  // namespace thalweg::property
