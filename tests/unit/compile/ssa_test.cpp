// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the compiler folds away, and the rounding bounds that it carries.
#include "compile/ssa.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "thalweg/op_table.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

Tape compiled(const Shape& shape) {
  auto tape = compile(shape);
  if (!tape) throw std::logic_error(to_string(tape.error()));
  return std::move(tape).value();
}

std::string op_of(const Instruction& in) {
  return in.op == Instruction::kLoad ? "load" : std::string(op_table()[in.op].name);
}

std::vector<std::string> ops_of(const Tape& tape) {
  std::vector<std::string> names;
  for (const Instruction& in : tape.instructions) names.push_back(op_of(in));
  return names;
}

using Names = std::vector<std::string>;
using Numbers = std::vector<double>;

double value(const Tape& tape, double x, double y, double z = 0) {
  const double p[3] = {x, y, z};
  return evaluate_double(tape, p, nullptr);
}

TEST(Compiler, FoldsATranslationIntoConstants) {
  const Tape tape = compiled(circle(2).translate(Vec2{3, 4}));
  EXPECT_EQ(ops_of(tape), Names{"circle"});
  EXPECT_EQ(tape.constants64, (Numbers{3, 4, 2}));
  EXPECT_EQ(tape.position_count, 1);
  EXPECT_EQ(tape.register_count, 0);
}

TEST(Compiler, AddsUpNestedTranslations) {
  const Tape tape = compiled(box(Vec2{1, 2}).translate(Vec2{3, 4}).translate(Vec2{-1, 0.5}));
  EXPECT_EQ(ops_of(tape), Names{"box"});
  EXPECT_EQ(tape.constants64, (Numbers{2, 4.5, 1, 2}));
}

TEST(Compiler, RoundsConstantsOnceToFloat32) {
  const Tape tape = compiled(circle(0.1).translate(Vec2{1.0 / 3, 1e-3}));
  ASSERT_EQ(tape.constants.size(), tape.constants64.size());
  for (std::size_t i = 0; i < tape.constants.size(); ++i) {
    EXPECT_EQ(tape.constants[i], static_cast<float>(tape.constants64[i]));
  }
}

TEST(Compiler, PushesAScaleIntoLengths) {
  const Tape tape = compiled(box(Vec2{1, 2}).translate(Vec2{5, 0}).scale(3).translate(Vec2{0, 1}));
  EXPECT_EQ(ops_of(tape), Names{"box"});
  EXPECT_EQ(tape.constants64, (Numbers{15, 1, 3, 6}));
}

TEST(Compiler, PushesAScaleIntoTheLengthsOfOperators) {
  const Shape pair = smooth_union(0.5, {circle(1), round(box(Vec2{1, 1}).translate(Vec2{2, 0}), 0.25)});
  const Tape scaled = compiled(pair.scale(4)), plain = compiled(pair);
  EXPECT_EQ(ops_of(scaled), ops_of(plain));
  for (const double x : {-3.0, 0.7, 1.1, 1.5, 5.0})
    EXPECT_NEAR(value(scaled, 4 * x, 2), 4 * value(plain, x, 0.5), 1e-12);
}

TEST(Compiler, LeavesNothingOfARotationThatAPrimitiveAbsorbs) {
  const Vec2 corners[] = {{0, 0}, {2, 0}, {1, 1}};
  const Shape flat[] = {circle(1), segment(Vec2{0, 0}, Vec2{1, 2}), triangle(corners[0], corners[1], corners[2]),
                        polygon(corners), half_plane(Vec2{0, 1}, 2)};
  for (const Shape& shape : flat) {
    const Tape tape = compiled(shape.rotate(0.5).translate(Vec2{3, 1}));
    EXPECT_EQ(ops_of(tape), Names{std::string(shape.op())});
    EXPECT_EQ(tape.position_count, 1);
    const double c = std::cos(0.5), s = std::sin(0.5);
    // The point (1.5, 0.2) of the shape's own frame.
    EXPECT_NEAR(value(tape, 3 + c * 1.5 - s * 0.2, 1 + s * 1.5 + c * 0.2), value(compiled(shape), 1.5, 0.2), 1e-12);
  }
  for (const Shape& shape : {sphere(1), capsule(Vec3{0, 0, 0}, Vec3{1, 2, 3}, 1), plane(Vec3{0, 1, 0}, 2)}) {
    EXPECT_EQ(ops_of(compiled(shape.rotate(Vec3{1, 1, 0}, 0.5))), Names{std::string(shape.op())});
  }
}

TEST(Compiler, TurnsARotatedBoxWithinItsInstruction) {
  const Shape shape = box(Vec2{1, 2}).rotate(0.3).translate(Vec2{1, 0}).rotate(0.4).scale(2);
  const Tape tape = compiled(shape);
  EXPECT_EQ(ops_of(tape), Names{"box"});
  EXPECT_EQ(tape.position_count, 1);
  EXPECT_NE(tape.instructions[0].flags & Instruction::kTurned, 0);
  // Half sizes of 2 and 4, turned by 0.7; this point is 0.5 beyond the middle of a long side.
  const double x = 2 * std::cos(0.4) + 2.5 * std::cos(0.7), y = 2 * std::sin(0.4) + 2.5 * std::sin(0.7);
  EXPECT_NEAR(value(tape, x, y), 0.5, 1e-12);
}

TEST(Compiler, SharesARigidInstructionBetweenWarpsAtTheSamePlace) {
  const Tape tape = compiled((mirror(box(Vec2{1, 2}), 0) | mirror(circle(1), 1)).rotate(0.3));
  std::size_t rigid = 0;
  for (const Instruction& in : tape.instructions) rigid += op_of(in) == "rigid" ? 1 : 0;
  EXPECT_EQ(rigid, 1U);
}

TEST(Compiler, ForgetsARotationByNothing) { EXPECT_EQ(ops_of(compiled(box(Vec2{1, 2}).rotate(0))), Names{"box"}); }

TEST(Compiler, ComputesEqualNodesOnce) {
  // Built twice, so nothing is shared by identity.
  const auto disc = [] { return circle(1).translate(Vec2{2, 0}); };
  const Tape tape = compiled(smooth_union(1, {disc(), disc().translate(Vec2{0, 0})}));
  EXPECT_EQ(ops_of(tape), (Names{"circle", "smooth_union"}));
}

TEST(Compiler, ComputesASharedSubtreeOnceAtOnePlaceAndAgainAtAnother) {
  const Shape part = smooth_union(0.1, {circle(1), box(Vec2{2, 0.5})});
  const Tape here = compiled((part | circle(3)) - round(part, 0.2));
  std::size_t boxes = 0;
  for (const auto& name : ops_of(here)) boxes += name == "box" ? 1 : 0;
  EXPECT_EQ(boxes, 1U);
  EXPECT_EQ(ops_of(compiled(part | part.translate(Vec2{9, 0}))).size(), 2 * ops_of(compiled(part)).size() + 1);
}

TEST(Compiler, FoldsTheUnionAndTheIntersectionOfAThingWithItself) {
  const Shape disc = circle(1);
  EXPECT_EQ(ops_of(compiled(disc | disc)), Names{"circle"});
  EXPECT_EQ(ops_of(compiled((disc & disc) | disc)), Names{"circle"});
  EXPECT_EQ(ops_of(compiled(union_({disc, disc, box(Vec2{1, 1})}))), (Names{"circle", "box", "union"}));
  // A smooth union of a thing with itself is not the thing.
  EXPECT_EQ(ops_of(compiled(smooth_union(1, {disc, disc}))).size(), 2U);
  EXPECT_EQ(ops_of(compiled(disc - disc)).size(), 2U);
}

TEST(Compiler, TakesAnOperatorOfOneOperandForTheOperand) {
  EXPECT_EQ(ops_of(compiled(union_({circle(1)}))), Names{"circle"});
  EXPECT_EQ(ops_of(compiled(smooth_union(3, {circle(1)}))), Names{"circle"});
}

TEST(Compiler, KeepsAMirrorAsAnInstructionOnPositions) {
  const Tape tape = compiled(mirror(circle(1).translate(Vec2{2, 0}), 0).translate(Vec2{5, 0}));
  EXPECT_EQ(ops_of(tape), (Names{"rigid", "mirror", "circle"}));
  EXPECT_DOUBLE_EQ(value(tape, 3, 0), -1);
  EXPECT_DOUBLE_EQ(value(tape, 7, 0), -1);
  EXPECT_DOUBLE_EQ(value(tape, 5, 0), 1);
}

TEST(Compiler, MarksSupportOnlyWhereOnlyRigidMotionsLieBetween) {
  const auto last = [](const Shape& shape) { return compiled(shape).instructions.back().flags; };
  EXPECT_TRUE(last(box(Vec2{1, 1}).rotate(0.3).scale(2)) & Instruction::kSupport);
  EXPECT_FALSE(last(mirror(box(Vec2{1, 1}), 0)) & Instruction::kSupport);
  EXPECT_FALSE(last(cool_s()) & Instruction::kSupport);
  EXPECT_FALSE(last(pie(2, 1)) & Instruction::kSupport) << "a pie of more than half a disc is not convex";
  EXPECT_TRUE(last(pie(1, 1)) & Instruction::kSupport);
}

TEST(Compiler, RefusesLengthsThatAScaleMakesTooLarge) {
  const auto is_refused = [](double size, double factor) {
    const auto scaled = Shape::make("scale", 2, std::array{factor}, {segment(Vec2{0, 0}, Vec2{size, size})});
    return !scaled || !compile(*scaled);
  };
  EXPECT_TRUE(is_refused(1e15, 1e15));
  EXPECT_FALSE(is_refused(1, 1e14));
  EXPECT_FALSE(is_refused(1e15, 1e-15));
  EXPECT_FALSE(is_refused(1e-15, 1e15));
}

TEST(RoundingBound, GrowsWithTheQuerysMagnitudeAndWithSizes) {
  const Tape tape = compiled(circle(2).translate(Vec2{3, 4}));
  EXPECT_GT(tape.slack(0), 0);
  EXPECT_GT(tape.slack(1e3), tape.slack(0));
  EXPECT_GT(compiled(circle(200)).slack(0), compiled(circle(2)).slack(0));
  EXPECT_GT(compiled(circle(2).translate(Vec2{1e4, 0})).slack(0), tape.slack(0));
  // Of the order of one rounding of the sizes at hand.
  EXPECT_LT(tape.slack(10), 100 * 0x1p-24 * 30);
  EXPECT_GE(tape.search_slack(10), tape.slack(10));
}

TEST(RoundingBound, OfAUnionIsThatOfItsWorstOperand) {
  const Shape near = circle(1), far = circle(50).translate(Vec2{1e4, 0});
  const Tape both = compiled(near | far);
  EXPECT_DOUBLE_EQ(both.slack.a, compiled(far).slack.a);
  EXPECT_DOUBLE_EQ(both.slack.b, std::max(compiled(near).slack.b, compiled(far).slack.b));
}

}  // namespace
}  // namespace thalweg
