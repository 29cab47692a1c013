// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Scenes that are read, and scene text that is written: what is written reads back as the same field.
#include <gtest/gtest.h>

#include <cmath>

#include "oracle.h"
#include "random_queries.h"
#include "random_shapes.h"
#include "thalweg/op_table.h"
#include "thalweg/ops.h"
#include "thalweg/scene.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

using oracle::Random;
using oracle::Vec;

Shape parsed(const std::string& text) {
  auto scene = parse_scene(text, "test");
  if (!scene) throw std::invalid_argument(to_string(scene.error()));
  return scene->shape;
}

double value(const Tape& tape, Vec p) {
  const double point[3] = {p.x, p.y, p.z};
  return evaluate_double(tape, point, nullptr);
}

Tape compiled(const Shape& shape) { return std::move(compile(shape)).value(); }

void expect_same_field(const Shape& a, const Shape& b, std::uint64_t seed) {
  ASSERT_EQ(a.dimension(), b.dimension());
  const Tape tape_a = compiled(a), tape_b = compiled(b);
  Random random(seed);
  const auto region = oracle::region_of(a);
  for (int i = 0; i < 20; ++i) {
    const Vec p = oracle::point_in(random, region);
    // Normals are normalised once more on reading, which may cost an ulp.
    ASSERT_NEAR(value(tape_a, p), value(tape_b, p), 1e-13 * (1 + length(p))) << scene_text(a);
  }
}

TEST(SceneText, OfEveryOpReadsBackAsTheSameField) {
  for (int op = 0; op < static_cast<int>(op_table().size()); ++op) {
    const OpRow& row = op_table()[static_cast<std::size_t>(op)];
    if (row.kind == OpKind::formula) continue;
    for (std::uint64_t i = 0; i < 10; ++i) {
      Random random(1000 * static_cast<std::uint64_t>(op) + i);
      const int dimension = row.dimension != 0 ? row.dimension : 2 + static_cast<int>(i % 2);
      const Shape a = oracle::random_primitive_of(random, dimension),
                  b = oracle::random_primitive_of(random, dimension);
      const Shape shape = row.kind == OpKind::primitive ? oracle::random_primitive(random, op)
                                                        : oracle::random_operator(random, op, a, b);
      ASSERT_EQ(shape.op_index(), op);
      const Shape again = parsed(scene_text(shape));
      EXPECT_EQ(again.op_index(), op) << scene_text(shape);
      expect_same_field(shape, again, i);
    }
  }
}

TEST(SceneText, OfRandomTreesReadsBackAsTheSameField) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const Shape shape = oracle::random_shape(random, seed % 2 == 0 ? 2 : 3, 25);
    expect_same_field(shape, parsed(scene_text(shape)), seed);
  }
}

TEST(SceneText, IsAFixedPointOfReadingAndWritingWhereNothingIsNormalised) {
  const Shape shape =
      smooth_union(0.1, {circle(0.3).translate(Vec2{1.0 / 3, 1e-15}), box(Vec2{1e15, 0.1}).rotate(0.7)});
  const std::string text = scene_text(shape);
  EXPECT_EQ(scene_text(parsed(text)), text);
}

TEST(Scene, OfTheContractIsRead) {
  const Shape shape = parsed(R"({
    "thalweg": 1,
    "dimension": 2,
    "shape": {"op": "smooth_union", "k": 1.0, "of": [
      {"op": "translate", "by": [1000, 550], "of": {"op": "star", "radius": 300, "points": 12, "sharpness": 4.0}},
      {"op": "translate", "by": [750, 400],  "of": {"op": "circle", "radius": 200}}
    ]},
    "define": {"wheel": {"op": "circle", "radius": 3}}
  })");
  EXPECT_EQ(shape.op(), "smooth_union");
  EXPECT_EQ(shape.operands().size(), 2U);
  EXPECT_DOUBLE_EQ(value(compiled(shape), {750, 400, 0}), -200);
}

TEST(Scene, TakesKeysInAnyOrderAndOneOperandWithOrWithoutAnArray) {
  const Shape a = parsed(R"({"shape": {"of": [{"radius": 2, "op": "circle"}], "by": [1, 0], "op": "translate"},
                             "dimension": 2, "thalweg": 1})");
  const Shape b = parsed(R"({"thalweg": 1, "dimension": 2,
                             "shape": {"op": "translate", "by": [1, 0], "of": {"op": "circle", "radius": 2}}})");
  EXPECT_EQ(scene_text(a), scene_text(b));
}

TEST(Scene, SharesWhatItRefersTo) {
  const Shape shape = parsed(R"({"thalweg": 1, "dimension": 2, "shape": {"op": "union", "of": [
      {"op": "ref", "name": "wheel"}, {"op": "translate", "by": [9, 0], "of": {"op": "ref", "name": "wheel"}}]},
      "define": {"wheel": {"op": "ref", "name": "disc"}, "disc": {"op": "circle", "radius": 3}}})");
  EXPECT_EQ(shape.operands()[0].identity(), shape.operands()[1].operands()[0].identity());
  EXPECT_EQ(node_count(shape), 3U);
}

TEST(Scene, ReadsRotationsByAxisAndByQuaternion) {
  const Shape by_axis = parsed(R"({"thalweg": 1, "dimension": 3, "shape": {"op": "rotate", "axis": [0, 0, 2],
      "angle": 1.5707963267948966, "of": {"op": "box", "half_size": [3, 1, 1]}}})");
  const Shape by_quaternion = parsed(R"({"thalweg": 1, "dimension": 3, "shape": {"op": "rotate",
      "quaternion": [5, 0, 0, 5], "of": {"op": "box", "half_size": [3, 1, 1]}}})");
  expect_same_field(by_axis, by_quaternion, 1);
  EXPECT_NEAR(value(compiled(by_axis), {0, 4, 0}), 1, 1e-12);
}

TEST(Scene, ReadsNumbersToTheLastBit) {
  const Shape shape = parsed(R"({"thalweg": 1.0, "dimension": 2, "shape": {"op": "circle",
      "radius": 0.1000000000000000055511151231257827021181583404541015625}})");
  EXPECT_EQ(shape.parameters()[0], 0.1);
  EXPECT_EQ(parsed(scene_text(circle(0x1.fffffffffffffp-3))).parameters()[0], 0x1.fffffffffffffp-3);
}

}  // namespace
}  // namespace thalweg
