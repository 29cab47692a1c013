// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Making shapes in C++: what is accepted, what is refused and how, and the fluent forms.
#include "thalweg/shape.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <stdexcept>

#include "thalweg/ops.h"
#include "thalweg/scene.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Error* error_of(const Result<Shape>& made) { return made ? nullptr : &made.error(); }

TEST(ShapeMake, SaysWhichParameterIsWrong) {
  const auto made = Shape::make("circle", 2, std::array{-1.0});
  ASSERT_NE(error_of(made), nullptr);
  EXPECT_EQ(made.error().place, "radius");
  EXPECT_EQ(made.error().found, "-1");
  const auto boxed = Shape::make("box", 3, std::array{1.0, 0.0, 1.0});
  ASSERT_NE(error_of(boxed), nullptr);
  EXPECT_EQ(boxed.error().place, "half_size/1");
}

TEST(ShapeMake, RefusesNumbersThatAreNotFinite) {
  for (const double number : {kNan, Bounds::kInfinity, -Bounds::kInfinity}) {
    EXPECT_FALSE(Shape::make("circle", 2, std::array{number}));
    EXPECT_FALSE(Shape::make("translate", 2, std::array{0.0, number}, {circle(1)}));
    EXPECT_FALSE(Shape::make("half_plane", 2, std::array{1.0, number, 0.0}));
    EXPECT_FALSE(Shape::make("star", 2, std::array{1.0, number, 2.0}));
    EXPECT_FALSE(Shape::make("mirror", 2, std::array{number}, {circle(1)}));
  }
}

TEST(ShapeMake, RefusesAWrongCountOfNumbersAndOfOperands) {
  EXPECT_FALSE(Shape::make("circle", 2, std::span<const double>{}));
  EXPECT_FALSE(Shape::make("circle", 2, std::array{1.0, 2.0}));
  EXPECT_FALSE(Shape::make("polygon", 2, std::array{0.0, 0.0, 1.0, 0.0, 0.0}));
  EXPECT_FALSE(Shape::make("circle", 2, std::array{1.0}, {circle(1)}));
  EXPECT_FALSE(Shape::make("union", 2, {}, {}));
  EXPECT_FALSE(Shape::make("round", 2, std::array{1.0}, {}));
  EXPECT_FALSE(Shape::make("round", 2, std::array{1.0}, {circle(1), circle(2)}));
}

TEST(ShapeMake, RefusesOperandsOfAnotherDimension) {
  const auto made = Shape::make("union", 2, {}, {circle(1), circle(2), sphere(1)});
  ASSERT_NE(error_of(made), nullptr);
  EXPECT_EQ(made.error().place, "of/2");
  EXPECT_FALSE(Shape::make("translate", 2, std::array{1.0, 2.0}, {sphere(1)}));
  EXPECT_TRUE(Shape::make("round", 3, std::array{1.0}, {sphere(1)}));
}

TEST(ShapeMake, RefusesAnUnknownOpAndAVariantThatThereIsNot) {
  EXPECT_FALSE(Shape::make("blob", 2, {}));
  EXPECT_FALSE(Shape::make("sphere", 2, std::array{1.0}));
  EXPECT_FALSE(Shape::make("circle", 2, std::array{1.0}, {}, 1));
  EXPECT_TRUE(Shape::make("rotate", 3, std::array{1.0, 0.0, 0.0, 0.0}, {sphere(1)}, 1));
}

TEST(ShapeMake, NormalisesDirectionsOfAnySize) {
  for (const double size : {1e-15, 1e-3, 1.0, 1e14}) {
    const Shape made = half_plane(Vec2{3 * size, 4 * size}, 1);
    EXPECT_DOUBLE_EQ(made.parameters()[0], 0.6);
    EXPECT_DOUBLE_EQ(made.parameters()[1], 0.8);
  }
  EXPECT_DOUBLE_EQ(half_plane(Vec2{1e-300, 0}, 1).parameters()[0], 1);
}

TEST(ShapeMake, RefusesNodesThatAreNestedTooDeep) {
  Shape shape = circle(1);
  for (int i = 1; i < Shape::kDeepest; ++i) shape = round(shape, 0);
  EXPECT_FALSE(Shape::make("round", 2, std::array{0.0}, {shape}));
  EXPECT_TRUE(compile(shape));
}

TEST(Builder, ThrowsTheErrorsText) {
  try {
    (void)circle(-1);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("radius: expected a length"), std::string::npos) << e.what();
  }
}

TEST(Builder, ReadsLikeTheMathematics) {
  const Shape scene = smooth_union(1.0, {star(300, 12, 4).translate({1000, 550}), circle(200).translate({750, 400})});
  EXPECT_EQ(scene.op(), "smooth_union");
  EXPECT_EQ(scene.operands()[1].op(), "translate");
  EXPECT_EQ(scene.dimension(), 2);
}

TEST(Builder, TakesTheDimensionOfItsOperands) {
  EXPECT_EQ(union_({sphere(1), box(Vec3{1, 1, 1})}).dimension(), 3);
  EXPECT_EQ(smooth_subtraction(1, {sphere(2), sphere(1)}).dimension(), 3);
  EXPECT_EQ(onion(sphere(2), 0.1).dimension(), 3);
  EXPECT_EQ(sphere(1).scale(2).dimension(), 3);
  EXPECT_EQ(mirror(sphere(1).translate({1, 2, 3}), 2).dimension(), 3);
}

TEST(Operators, ContinueTheListOfTheirFirstOperand) {
  const Shape a = circle(1), b = circle(2), c = circle(3);
  EXPECT_EQ((a | b | c).operands().size(), 3U);
  EXPECT_EQ((a | (b | c)).operands().size(), 2U);
  EXPECT_EQ((a - b - c).operands().size(), 3U);
  EXPECT_EQ((a - (b - c)).operands().size(), 2U);
  EXPECT_EQ(((a | b) & c).op(), "intersection");
}

TEST(NodeCount, CountsASharedNodeOnce) {
  const Shape part = circle(1);
  EXPECT_EQ(node_count(part), 1U);
  EXPECT_EQ(node_count(part | part), 2U);
  EXPECT_EQ(node_count(part | circle(1)), 3U);
}

TEST(ToJson, IsTheNodesText) {
  EXPECT_EQ(circle(2).translate(Vec2{1, 0.5}).to_json(),
            R"({"op":"translate","by":[1.0,0.5],"of":{"op":"circle","radius":2.0}})");
  EXPECT_EQ(mirror(cool_s(), 1).to_json(), R"({"op":"mirror","axis":"y","of":{"op":"cool_s"}})");
}

TEST(ErrorText, IsOneLineWithoutTheEmptyParts) {
  EXPECT_EQ(to_string(Error{"a.json", "/shape", "a node", "3"}), "a.json: /shape: expected a node, found 3");
  EXPECT_EQ(to_string(Error{"", "", "a node", "3"}), "expected a node, found 3");
}

}  // namespace
}  // namespace thalweg
