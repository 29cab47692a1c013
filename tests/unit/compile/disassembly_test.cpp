// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "thalweg/ops.h"
#include "thalweg/scene.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

TEST(Disassembly, OfTheContractsExampleScene) {
  const auto scene = parse_scene(R"({
    "thalweg": 1, "dimension": 2,
    "shape": {"op": "smooth_union", "k": 1.0, "of": [
      {"op": "translate", "by": [1000, 550], "of": {"op": "star", "radius": 300, "points": 12, "sharpness": 4.0}},
      {"op": "translate", "by": [750, 400],  "of": {"op": "circle", "radius": 200}}
    ]}})",
                                 "scene.json");
  ASSERT_TRUE(scene);
  const auto tape = compile(scene->shape);
  ASSERT_TRUE(tape);
  EXPECT_EQ(tape->disassembly(),
            "; 2D, 3 instructions, 1 registers, 1 positions, 33 constants\n"
            "    0  acc = star(p0)                     -> r0   1000 550 300 -0.866025 0.5 109.808 0.5 0.866025 "
            "... (28)\n"
            "    1  acc = circle(p0)                           support 750 400 200\n"
            "    2  acc = smooth_union(r0, acc)                4 0.25\n");
}

TEST(Disassembly, ShowsPositionsRegistersSwapsAndSupport) {
  const Shape part = smooth_union(0.5, {box(Vec2{1, 2}).rotate(0.25), circle(1)});
  const auto tape = compile(circle(3) - (onion(part, 0.1) | part));
  ASSERT_TRUE(tape);
  EXPECT_EQ(tape->disassembly(),
            "; 2D, 7 instructions, 1 registers, 1 positions, 15 constants\n"
            "    0  acc = box(turned p0)               -> r0   support 0 0 0.968912 0.247404 1 2\n"
            "    1  acc = circle(p0)                           support 0 0 1\n"
            "    2  acc = smooth_union(r0, acc)        -> r0   2 0.5\n"
            "    3  acc = onion(acc)                           0.1\n"
            "    4  acc = union(acc, r0)               -> r0   \n"
            "    5  acc = circle(p0)                           support 0 0 3\n"
            "    6  acc = subtraction(acc, r0)                 \n");
}

TEST(Disassembly, ShowsValueProgramsWithTheirConstantsInPlace) {
  const auto tape = compile(expression("min(sqrt(square(x - 1) + square(y)) - 3, max(2 - 4 * x, abs(-y)) / 2)"));
  ASSERT_TRUE(tape);
  const std::string text = tape->disassembly();
  EXPECT_EQ(text.substr(text.find("; values")),
            "; values: 8 instructions, 4 registers, the first with the coordinates\n"
            "    0  acc = add(square(r0 - 1), square(r1))\n"
            "    1  acc = sqrt(acc)\n"
            "    2  acc = sub(acc, 3) -> r2\n"
            "    3  acc = sub(2, 4 r0) -> r3\n"
            "    4  acc = abs(r1)\n"
            "    5  acc = greatest(r3, acc)\n"
            "    6  acc = mul(acc, 0.5)\n"
            "    7  acc = least(r2, acc)\n");
}

TEST(Disassembly, ShowsTheLoadOfAValueUsedAgain) {
  const Shape part = smooth_union(0.5, {circle(2), circle(1)});
  const auto tape = compile(round(part, 0.25) - onion(part, 0.125));
  ASSERT_TRUE(tape);
  EXPECT_NE(tape->disassembly().find("acc = r"), std::string::npos) << tape->disassembly();
}

}  // namespace
}  // namespace thalweg
