// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What nodes claim of their fields, case by case. tests/property/ holds the claims against sampled fields; here they
// are held against what shapes.md promises, so that none gets weaker unnoticed.
#include <gtest/gtest.h>

#include <numbers>
#include <ostream>

#include "thalweg/ops.h"

namespace thalweg {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr auto kExact = Exactness::exact;
constexpr auto kBound = Exactness::lower_bound;

struct Claim {
  const char* name;
  Shape shape;
  Exactness outside, inside;
  bool convex;
};
std::ostream& operator<<(std::ostream& out, const Claim& claim) { return out << claim.name; }

std::vector<Claim> primitives() {
  const Vec2 square[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const Vec2 arrow[] = {{0, 0}, {2, 1}, {0, 2}, {0.5, 1}};
  return {
      {"circle", circle(1), kExact, kExact, true},
      {"box", box(Vec2{1, 2}), kExact, kExact, true},
      {"rounded_box", rounded_box(Vec2{1, 2}, {0.1, 0, 0.3, 1}), kExact, kExact, true},
      {"segment", segment(Vec2{0, 0}, Vec2{1, 0}), kExact, kExact, true},
      {"triangle", triangle(Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}), kExact, kExact, true},
      {"square_polygon", polygon(square), kExact, kExact, true},
      {"arrow_polygon", polygon(arrow), kExact, kExact, false},
      {"star", star(1, 5, 3), kExact, kExact, false},
      {"regular_star", star(1, 5, 2), kExact, kExact, true},
      {"narrow_pie", pie(1, 1), kExact, kExact, true},
      {"wide_pie", pie(2, 1), kExact, kExact, false},
      {"whole_pie", pie(kPi, 1), kExact, kExact, true},
      {"arc", arc(1, 2, 0.1), kExact, kExact, false},
      {"arc_whose_ends_overlap", arc(3.1, 2, 0.5), kExact, kBound, false},
      {"arc_thicker_than_its_radius", arc(1, 1, 1.5), kExact, kBound, false},
      {"ring", ring(1, 2, 0.1), kExact, kExact, false},
      {"moon", moon(1, 1, 0.8), kExact, kExact, false},
      {"cool_s", cool_s(), kExact, kExact, false},
      {"half_plane", half_plane(Vec2{1, 1}, 0), kExact, kExact, true},
      {"sphere", sphere(1), kExact, kExact, true},
      {"box_3d", box(Vec3{1, 2, 3}), kExact, kExact, true},
      {"torus", torus(2, 1), kExact, kExact, false},
      {"torus_that_overlaps_itself", torus(1, 2), kExact, kBound, false},
      {"capsule", capsule(Vec3{0, 0, 0}, Vec3{1, 0, 0}, 1), kExact, kExact, true},
      {"cylinder", cylinder(1, 2), kExact, kExact, true},
      {"plane", plane(Vec3{0, 1, 0}, 0), kExact, kExact, true},
  };
}

std::vector<Claim> operators() {
  const Shape disc = circle(1), slab = box(Vec2{2, 1}), spiky = star(1, 5, 3), line = segment(Vec2{0, 0}, Vec2{1, 0});
  const Shape apart = circle(1).translate(Vec2{3, 0});
  return {
      {"union", disc | slab, kExact, kBound, false},
      {"intersection", disc & slab, kBound, kExact, true},
      {"intersection_with_a_star", disc & spiky, kBound, kExact, false},
      {"subtraction", disc - slab, kBound, kExact, false},
      {"subtraction_of_a_union", disc - (slab | apart), kBound, kExact, false},
      {"subtraction_from_a_union", (slab | apart) - disc, kBound, kBound, false},
      {"smooth_union", smooth_union(0.1, {disc, slab}), kBound, kBound, false},
      {"smooth_intersection", smooth_intersection(0.1, {disc, slab}), kBound, kBound, true},
      {"smooth_subtraction", smooth_subtraction(0.1, {disc, slab}), kBound, kBound, false},
      {"round_of_a_convex_shape", round(slab, 0.5), kExact, kExact, true},
      {"round_of_a_star", round(spiky, 0.5), kExact, kBound, false},
      {"round_by_nothing", round(spiky, 0), kExact, kExact, false},
      {"round_of_an_intersection", round(disc & slab, 0.5), kBound, kExact, true},
      {"round_of_a_segment", round(line, 0.5), kExact, kExact, true},
      {"onion", onion(disc, 0.1), kExact, kBound, false},
      {"onion_of_a_segment", onion(line, 0.1), kExact, kExact, true},
      {"onion_of_a_union", onion(disc | slab, 0.1), kBound, kBound, false},
      {"translate", spiky.translate(Vec2{1, 2}), kExact, kExact, false},
      {"rotate", slab.rotate(1), kExact, kExact, true},
      {"scale", (disc | slab).scale(3), kExact, kBound, false},
      {"mirror_of_a_shape_clear_of_the_plane", mirror(apart, 0), kExact, kExact, false},
      {"mirror_of_a_shape_across_the_plane", mirror(disc.translate(Vec2{0.5, 0}), 0), kBound, kBound, false},
      {"mirror_of_a_shape_behind_the_plane", mirror(apart.rotate(kPi), 0), kBound, kBound, false},
  };
}

class Claims : public testing::TestWithParam<Claim> {};

TEST_P(Claims, AreThoseOfTheTable) {
  const Facts& facts = GetParam().shape.facts();
  EXPECT_EQ(name(facts.outside), name(GetParam().outside));
  EXPECT_EQ(name(facts.inside), name(GetParam().inside));
  EXPECT_EQ(facts.convex, GetParam().convex);
  // No op of this version stretches.
  EXPECT_EQ(facts.lipschitz, 1);
}

const auto kNameOf = [](const auto& claim) { return std::string(claim.param.name); };
INSTANTIATE_TEST_SUITE_P(Primitives, Claims, testing::ValuesIn(primitives()), kNameOf);
INSTANTIATE_TEST_SUITE_P(Operators, Claims, testing::ValuesIn(operators()), kNameOf);

TEST(UnsignedFact, HoldsOnlyWhileNoPointCanBeInside) {
  const Shape line = segment(Vec2{0, 0}, Vec2{1, 0}), disc = circle(1);
  EXPECT_TRUE(line.facts().is_unsigned);
  EXPECT_TRUE((line | line.rotate(1)).facts().is_unsigned);
  EXPECT_FALSE((line | disc).facts().is_unsigned);
  EXPECT_TRUE((line & disc).facts().is_unsigned);
  EXPECT_TRUE((line - disc).facts().is_unsigned);
  EXPECT_FALSE(round(line, 0.1).facts().is_unsigned);
  EXPECT_TRUE(round(line, 0).facts().is_unsigned);
  EXPECT_FALSE(onion(line, 0.1).facts().is_unsigned);
  EXPECT_FALSE(smooth_union(0.1, {line, line}).facts().is_unsigned);
}

void expect_bounds(const Bounds& bounds, std::vector<double> lo, std::vector<double> hi) {
  for (std::size_t axis = 0; axis < lo.size(); ++axis) {
    EXPECT_DOUBLE_EQ(bounds.lo[axis], lo[axis]) << axis;
    EXPECT_DOUBLE_EQ(bounds.hi[axis], hi[axis]) << axis;
  }
}

TEST(Bounds, OfPrimitivesAreTight) {
  expect_bounds(circle(2).facts().bounds, {-2, -2}, {2, 2});
  expect_bounds(box(Vec3{1, 2, 3}).facts().bounds, {-1, -2, -3}, {1, 2, 3});
  expect_bounds(triangle(Vec2{1, 0}, Vec2{4, 1}, Vec2{2, 5}).facts().bounds, {1, 0}, {4, 5});
  expect_bounds(capsule(Vec3{0, 0, 0}, Vec3{1, 2, -3}, 0.5).facts().bounds, {-0.5, -0.5, -3.5}, {1.5, 2.5, 0.5});
  expect_bounds(torus(3, 1).facts().bounds, {-4, -1, -4}, {4, 1, 4});
  expect_bounds(cylinder(1, 2).facts().bounds, {-2, -1, -2}, {2, 1, 2});
  expect_bounds(cool_s().scale(10).facts().bounds, {-4, -10}, {4, 10});
}

TEST(Bounds, OfHalfSpacesAreOpenUnlessTheyLieAlongAnAxis) {
  const double inf = Bounds::kInfinity;
  expect_bounds(half_plane(Vec2{0, 2}, 3).facts().bounds, {-inf, -inf}, {inf, 3});
  expect_bounds(half_plane(Vec2{-1, 0}, 3).facts().bounds, {-3, -inf}, {inf, inf});
  expect_bounds(half_plane(Vec2{1, 1}, 3).facts().bounds, {-inf, -inf}, {inf, inf});
  expect_bounds(plane(Vec3{0, 0, 1}, 3).facts().bounds, {-inf, -inf, -inf}, {inf, inf, 3});
  EXPECT_FALSE(half_plane(Vec2{0, 1}, 3).facts().bounds.finite(2));
}

TEST(Bounds, FollowPlacements) {
  expect_bounds(box(Vec2{2, 1}).translate(Vec2{10, 20}).scale(2).facts().bounds, {16, 38}, {24, 42});
  const Bounds turned = box(Vec2{2, 1}).rotate(kPi / 2).facts().bounds;
  EXPECT_NEAR(turned.hi[0], 1, 1e-12);
  EXPECT_NEAR(turned.hi[1], 2, 1e-12);
  EXPECT_NEAR(box(Vec2{1, 1}).rotate(kPi / 4).facts().bounds.hi[0], std::numbers::sqrt2, 1e-12);
  expect_bounds(mirror(circle(1).translate(Vec2{3, 0}), 0).facts().bounds, {-4, -1}, {4, 1});
}

TEST(Bounds, FollowOperators) {
  const Shape left = circle(1).translate(Vec2{-2, 0}), right = circle(1).translate(Vec2{2, 0});
  expect_bounds((left | right).facts().bounds, {-3, -1}, {3, 1});
  EXPECT_TRUE((left & right).facts().bounds.empty(2));
  expect_bounds((left - right).facts().bounds, {-3, -1}, {-1, 1});
  expect_bounds(round(left, 0.5).facts().bounds, {-3.5, -1.5}, {-0.5, 1.5});
  expect_bounds(onion(left, 0.5).facts().bounds, {-3.5, -1.5}, {-0.5, 1.5});
  // A blend of width k bulges out by at most k.
  expect_bounds(smooth_union(0.25, {left, right}).facts().bounds, {-3.25, -1.25}, {3.25, 1.25});
  expect_bounds(smooth_union(0, {left, right}).facts().bounds, {-3, -1}, {3, 1});
  expect_bounds(((left & right) | right).facts().bounds, {1, -1}, {3, 1});
}

TEST(Bounds, OfALevelGrowWithIt) {
  const Shape shape = circle(1).scale(2).translate(Vec2{1, 0});
  expect_bounds(shape.level_bounds(0), {-1, -2}, {3, 2});
  expect_bounds(shape.level_bounds(0.5), {-1.5, -2.5}, {3.5, 2.5});
  expect_bounds(round(shape, 1).level_bounds(0.5), {-2.5, -3.5}, {4.5, 3.5});
}

TEST(Bounds, KnowTheirDiagonal) {
  EXPECT_DOUBLE_EQ(box(Vec2{3, 4}).facts().bounds.diagonal(2), 10);
  EXPECT_EQ((circle(1) & circle(1).translate(Vec2{9, 0})).facts().bounds.diagonal(2), 0);
  EXPECT_EQ(half_plane(Vec2{0, 1}, 0).facts().bounds.diagonal(2), Bounds::kInfinity);
}

}  // namespace
}  // namespace thalweg
