// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What a formula is simplified to, and that each step of it is needed.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "formula/formula.h"
#include "thalweg/ops.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

/// The steps in prefix form.
std::string form(const formula::Formula& formula, int step) {
  const formula::Step& s = formula.steps[static_cast<std::size_t>(step)];
  if (s.axis >= 0) return std::string(1, "xyz"[s.axis]);
  const std::string name(ops::registry()[static_cast<std::size_t>(s.op)].row.name);
  if (name == "constant") {
    std::string number = std::to_string(s.value);
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
    return number;
  }
  return "(" + name + " " + form(formula, s.a) + (s.b < 0 ? "" : " " + form(formula, s.b)) + ")";
}
std::string form(std::string_view text) {
  const auto formula = formula::parse_expression(text);
  EXPECT_TRUE(formula) << to_string(formula.error());
  return form(*formula, static_cast<int>(formula->steps.size()) - 1);
}

TEST(FormulaBuilder, DoesWhatConstantsAllow) {
  EXPECT_EQ(form("1 + 2 * 3"), "7");
  EXPECT_EQ(form("sqrt(4) + x"), form("2 + x"));
  EXPECT_EQ(form("max(2, 3) - min(2, 3)"), "1");
  EXPECT_EQ(form("sqrt(0 - 1)"), "(sqrt -1)") << "undefined: to be found at every point";
  EXPECT_EQ(form("1 / 0"), "(div 1 0)");
}

TEST(FormulaBuilder, KeepsTheRealNumberOfAComputedConstantWithinItsRange) {
  const auto formula = formula::parse_expression("0.1 + 0.2");
  ASSERT_TRUE(formula);
  const formula::Step& sum = formula->steps.back();
  EXPECT_LT(sum.range.lo, sum.value);
  EXPECT_GT(sum.range.hi, sum.value);
  EXPECT_LT(sum.range.hi - sum.range.lo, 1e-15);
}

TEST(FormulaBuilder, SharesAndDropsSteps) {
  EXPECT_EQ(form("(x + y) * (y + x)"), "(square (add x y))");
  EXPECT_EQ(formula::parse_program("x var-x\nu var-y\nv neg u\nw abs x")->steps.size(), 2U);
}

TEST(FormulaBuilder, MovesSignsIntoSums) {
  EXPECT_EQ(form("--x"), "x");
  EXPECT_EQ(form("-(x - y)"), "(sub y x)");
  EXPECT_EQ(form("x + -y"), "(sub x y)");
  EXPECT_EQ(form("-x + y"), "(sub y x)");
  EXPECT_EQ(form("x - -y"), "(add x y)");
  EXPECT_EQ(form("-(3 + x)"), "(sub -3 x)");
  EXPECT_EQ(form("square(-x)"), "(square x)");
  EXPECT_EQ(form("abs(-x)"), "(abs x)");
  EXPECT_EQ(form("-x * -y"), "(mul x y)");
  EXPECT_EQ(form("0 - x"), "(neg x)");
}

TEST(FormulaBuilder, KnowsNeutralNumbersAndPowers) {
  EXPECT_EQ(form("x + 0"), "x");
  EXPECT_EQ(form("x * 1"), "x");
  EXPECT_EQ(form("x / 1"), "x");
  EXPECT_EQ(form("x / 4"), "(mul x 0.25)");
  EXPECT_EQ(form("x / 3"), "(div x 3)") << "1/3 is not a float";
  EXPECT_EQ(form("x * x"), "(square x)");
  EXPECT_EQ(form("pow(x, 2)"), "(square x)");
  EXPECT_EQ(form("pow(x, 3)"), "(mul x (square x))");
  EXPECT_EQ(form("pow(x, -1)"), "(div 1 x)");
  EXPECT_EQ(form("pow(x, 0.5)"), "(sqrt x)");
  EXPECT_EQ(form("pow(x, 1.5)"), "(pow x 1.5)");
  EXPECT_EQ(form("min(x, x)"), "x");
}

TEST(FormulaTape, HoldsConstantsInInstructions) {
  const Tape tape = *compile(expression("max(x - 0.5, 2 - x) * 3"));
  EXPECT_EQ(tape.instructions.size(), 5U) << tape.disassembly();
  EXPECT_TRUE(tape.has_formulas);
  EXPECT_TRUE(tape.only_scalars);
  EXPECT_NE(tape.disassembly().find("acc = sub(c, r0)"), std::string::npos) << tape.disassembly();
  EXPECT_NE(tape.disassembly().find("acc = mul(acc, c)"), std::string::npos) << tape.disassembly();
}

/// The op of a program's last instruction.
std::string last_op(const char* text) {
  const Tape tape = *compile(expression(text));
  return std::string(ops::registry()[tape.instructions.back().op].row.name);
}

TEST(FormulaTape, ChoosesBetweenNumbersWithoutAskingWhetherTheyAre) {
  EXPECT_EQ(last_op("min(x, y)"), "least");
  EXPECT_EQ(last_op("max(x * x - 2, sqrt(abs(y)))"), "greatest");
  EXPECT_EQ(last_op("max(1 / (1 + x * x), y)"), "greatest");
}

TEST(FormulaTape, AsksOfWhatMayBeUndefinedSomewhere) {
  EXPECT_EQ(last_op("min(sqrt(x), y)"), "min");
  EXPECT_EQ(last_op("max(y, 1 / x)"), "max");
  EXPECT_EQ(last_op("max(y, log(x * x))"), "max");
  // Beyond what float32 can hold, far out, where an infinity less another is no number.
  EXPECT_EQ(last_op("min(x * x * x - y * y * y, x)"), "min");
}

TEST(FormulaTape, IsOfScalarsAloneWhereNoFieldIsJoinedToIt) {
  const Tape joined = *compile(expression("x - 1") | circle(1));
  EXPECT_TRUE(joined.has_formulas);
  EXPECT_FALSE(joined.only_scalars);
  EXPECT_FALSE((*compile(circle(1))).only_scalars);
}

TEST(FormulaTape, HoldsWhatFloat32CannotBetweenItsNeighbours) {
  const Tape tape = *compile(expression("x - 0.1"));
  const Instruction& in = tape.instructions.back();
  ASSERT_NE(in.flags & Instruction::kImmediate, 0);
  const float* const c = &tape.constants[in.constants];
  EXPECT_LT(static_cast<double>(c[1]), 0.1);
  EXPECT_GT(static_cast<double>(c[2]), 0.1);
  EXPECT_EQ(c[0], 0.1F);
  const Tape exact = *compile(expression("x - 0.5"));
  const float* const e = &exact.constants[exact.instructions.back().constants];
  EXPECT_EQ(e[1], 0.5F);
  EXPECT_EQ(e[2], 0.5F);
}

TEST(FormulaTape, ProvesNothingByMultiplesOfACoordinate) {
  const Tape tape = *compile(expression("x - 0.1") | circle(1));
  EXPECT_TRUE(std::isinf(tape.slack(1)));
  EXPECT_TRUE(std::isinf(tape.search_slack(0)));
  EXPECT_TRUE(std::isfinite(tape.enclosure_slack(1)));
}

}  // namespace
}  // namespace thalweg
