// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Expressions: precedence, functions, faults, and the node in a scene.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "thalweg/op_table.h"
#include "thalweg/ops.h"
#include "thalweg/scene.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

double value(const Shape& shape, double x, double y, double z = 0) {
  const double at[3] = {x, y, z};
  return evaluate_double(*compile(shape), at, nullptr);
}
double value(std::string_view text, double x, double y, double z = 0) { return value(expression(text), x, y, z); }

std::string fault(std::string_view text) {
  const auto shape = Shape::formula("expression", 2, text);
  return shape ? "" : to_string(shape.error());
}

TEST(Expression, FollowsTheUsualPrecedence) {
  EXPECT_EQ(value("1 + 2 * x - y / 4", 5, 8), 9);
  EXPECT_EQ(value("(1 + 2) * (x - y) / 4", 12, 8), 3);
  EXPECT_EQ(value("2 - 3 - x", 4, 0), -5);
  EXPECT_EQ(value("16 / x / 2", 4, 0), 2);
  EXPECT_EQ(value("-x * -y", 3, 4), 12);
  EXPECT_EQ(value("--x - +y", 3, 4), -1);
  EXPECT_EQ(value("1.5e1 + .5", 0, 0), 15.5);
  EXPECT_DOUBLE_EQ(value("sqrt(x*x + y*y) - 1", 3, 4), 4);
  EXPECT_EQ(value("max(x, min(y,\n z))", 1, 5, 3), 3);
}

TEST(Expression, HasEveryFunctionOfTheTable) {
  for (const FunctionRow& row : function_table()) {
    EXPECT_EQ(fault(std::string(row.name) + (row.operands == 1 ? "(x)" : "(x, y)")), "") << row.name;
  }
}

TEST(Expression, FaultsNameTheirLineAndColumn) {
  EXPECT_EQ(fault(""), "1:1: expected a number, a coordinate or a function, found the end");
  EXPECT_EQ(fault("x +"), "1:4: expected a number, a coordinate or a function, found the end");
  EXPECT_EQ(fault("x y"), "1:3: expected an operator or the end, found \"y\"");
  EXPECT_EQ(fault("(x"), "1:3: expected \")\" or an operator, found the end");
  EXPECT_EQ(fault("x\n+ foo(y)"), "2:3: expected x, y, z or a function, found \"foo\"");
  EXPECT_EQ(fault("given(x, y)"), "1:1: expected x, y, z or a function, found \"given\"");
  EXPECT_EQ(fault("constant"), "1:1: expected x, y, z or a function, found \"constant\"");
  EXPECT_EQ(fault("sin x"), "1:5: expected \"(\" after sin, found \"x\"");
  EXPECT_EQ(fault("min(x)"), "1:6: expected \",\": min has two arguments, found \")\"");
  EXPECT_EQ(fault("sin(x, y)"), "1:6: expected \")\" after the last argument of sin, found \",\"");
  EXPECT_EQ(fault("1e999"), "1:1: expected a number that float32 can hold, found \"1e999\"");
  EXPECT_EQ(fault("x ^ 2"), "1:3: expected an operator or the end, found \"^\"");
  EXPECT_EQ(fault("x + z"), "expected a formula of x and y in a scene of dimension 2, found z");
  EXPECT_NE(fault(std::string(100'000, '(')), "");
  EXPECT_EQ(fault(std::string(100'000, '-') + "x"), "");
}

TEST(Expression, IsANodeOfAScene) {
  const std::string text =
      R"({"thalweg": 1, "dimension": 2, "shape": {"op": "union", "of": [
        {"op": "circle", "radius": 1}, {"op": "expression", "text": "x - 3"}]}})";
  const auto scene = parse_scene(text, "scene.json");
  ASSERT_TRUE(scene) << to_string(scene.error());
  EXPECT_EQ(value(scene->shape, 2, 0), -1);
  const auto again = parse_scene(scene_text(scene->shape), "scene.json");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_EQ(value(again->shape, 2.5, 0), -0.5);
}

TEST(Expression, FaultsInASceneNameTheNode) {
  const auto refused = [](const std::string& node) {
    const auto scene = parse_scene(R"({"thalweg": 1, "dimension": 2, "shape": )" + node + "}", "s.json");
    return scene ? "" : to_string(scene.error());
  };
  EXPECT_EQ(refused(R"({"op": "expression", "text": "x +* y"})"),
            "s.json: /shape/text:1:4: expected a number, a coordinate or a function, found \"*\"");
  EXPECT_EQ(refused(R"({"op": "expression", "text": "z"})"),
            "s.json: /shape/text: expected a formula of x and y in a scene of dimension 2, found z");
  EXPECT_EQ(refused(R"({"op": "expression"})"), "s.json: /shape: expected the key \"text\", found none");
  EXPECT_EQ(refused(R"({"op": "expression", "text": 1})"), "s.json: /shape/text: expected a string, found 1");
  EXPECT_EQ(refused(R"({"op": "expression", "file": "a"})"),
            "s.json: /shape/file: expected one of op, text, found \"file\"");
  EXPECT_EQ(refused(R"({"op": "vm"})"), "s.json: /shape: expected the key \"text\" or \"file\", found none");
  EXPECT_EQ(refused(R"({"op": "vm", "text": "a const 1", "file": "b"})"),
            "s.json: /shape/file: expected only one of \"text\" or \"file\", found both");
  EXPECT_EQ(refused(R"({"op": "vm", "text": "a const 1\nb neg c"})"),
            "s.json: /shape/text:2:7: expected the name of a line above, found \"c\"");
  EXPECT_EQ(refused(R"({"op": "vm", "file": "b"})"),
            "s.json: /shape/file: expected the program itself, as \"text\", found a file");
}

TEST(Expression, ReadsFilesThroughTheCallersHands) {
  const ReadText read = [](const std::string& path) -> Result<std::string> {
    if (path == "half.vm") return std::string("x var-x\n");
    return Error{.file = "", .place = "", .expected = "a readable file", .found = "no such file"};
  };
  const auto scene_of = [&](const std::string& file) {
    return parse_scene(R"({"thalweg": 1, "dimension": 3, "shape": {"op": "vm", "file": ")" + file + "\"}}", "s.json",
                       read);
  };
  const auto scene = scene_of("half.vm");
  ASSERT_TRUE(scene) << to_string(scene.error());
  EXPECT_EQ(scene->shape.dimension(), 3);
  EXPECT_EQ(scene->shape.text(), "x var-x\n");
  EXPECT_EQ(to_string(scene_of("none.vm").error()),
            "s.json: /shape/file: expected a readable file, found no such file");
}

TEST(Expression, HasNoFactsButItsSign) {
  const Shape shape = expression("x + z");
  EXPECT_EQ(shape.dimension(), 3);
  EXPECT_EQ(expression("x").dimension(), 2);
  EXPECT_EQ(expression("x", 3).dimension(), 3);
  EXPECT_EQ(shape.facts().outside, Exactness::sign_only);
  EXPECT_EQ(shape.facts().inside, Exactness::sign_only);
  EXPECT_TRUE(std::isinf(shape.facts().lipschitz));
  EXPECT_FALSE(shape.facts().convex);
  EXPECT_FALSE(shape.facts().bounds.finite(3));
  EXPECT_TRUE((sphere(1) & shape).facts().bounds.finite(3)) << "a finite operand bounds an intersection";
}

TEST(Expression, IsPlacedByItsCoordinates) {
  const Shape shape = expression("x + 10 * y - 1");
  EXPECT_DOUBLE_EQ(value(shape.translate(Vec2{2, 3}), 5, 4), value("x + 10 * y - 1", 3, 1));
  EXPECT_NEAR(value(shape.rotate(std::acos(-1.0) / 2), -1, 3), value("x + 10 * y - 1", 3, 1), 1e-12);
  // A scaled field is as much larger as its shape.
  EXPECT_DOUBLE_EQ(value(shape.scale(2), 6, 2), 2 * value("x + 10 * y - 1", 3, 1));
  const Shape turned = expression("x*y + z*z*z").rotate(Vec3{0, 0, 1}, std::acos(-1.0) / 2).translate(Vec3{1, 2, 3});
  EXPECT_NEAR(value(turned, 1 - 0.5, 2 + 0.25, 3 + 2), 0.25 * 0.5 + 8, 1e-12);
}

TEST(Expression, IsUndefinedWhereAPartOfItIs) {
  for (const char* text :
       {"sqrt(x)", "log(x)", "1 / (x - x)", "asin(x - 2)", "min(sqrt(x), 1)", "max(1, log(x))", "pow(x, 0.3)",
        "mod(y, x - x)", "compare(sqrt(x), 2)", "not(log(x))", "or(1, sqrt(x) + 1) * sqrt(x)"}) {
    EXPECT_TRUE(std::isnan(value(text, -1, 2))) << text;
  }
  EXPECT_TRUE(std::isnan(value(circle(1) | expression("sqrt(x)"), -5, 0)));
  EXPECT_TRUE(std::isnan(value(expression("sqrt(x)") | circle(1), -5, 0)));
  EXPECT_TRUE(std::isnan(value(smooth_union(0.1, {expression("sqrt(x)"), circle(1)}), -5, 0)));
  EXPECT_EQ(value(expression("sqrt(x)") | circle(1), 9, 0), 3);
}

}  // namespace
}  // namespace thalweg
