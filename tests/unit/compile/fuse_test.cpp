// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Value programs: what they leave out, and that they ask for no more memory than there is. Their bits are held against
// those of the tape by tests/formula/wide_chunks_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "compile/shorten.h"
#include "kernels/kernels.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

Tape compiled(std::string_view text) {
  auto tape = compile(expression(text));
  if (!tape) throw std::logic_error(to_string(tape.error()));
  return std::move(tape).value();
}
std::size_t length_of(std::string_view text) { return compiled(text).values.instructions.size(); }

std::size_t stores_of(const Tape& tape) {
  return static_cast<std::size_t>(std::ranges::count_if(
      tape.values.instructions, [](const Instruction& in) { return in.target != Instruction::kNone; }));
}

TEST(ValueProgram, DoesNotComputeWhatIsAConstantAwayFromACoordinate) {
  EXPECT_EQ(length_of("max(max(x - 1, 2 - x), max(-y, y * 3))"), 3U);
  EXPECT_EQ(length_of("sqrt(square(x - 1) + square(y - 2)) - 3"), 3U);
  EXPECT_EQ(length_of("abs(x - 1) + y"), 2U);
}

TEST(ValueProgram, ComputesOnceWhatIsFarFromItsUsers) {
  // 10 x is kept, and each user is a constant away from it.
  EXPECT_EQ(length_of("max(max(10 * x - 1, 2 - 10 * x), 10 * x + y)"), 4U);
}

TEST(ValueProgram, IsNotMadeOfWhatFewInstructionsCanTake) {
  EXPECT_EQ(length_of("sin(x - 1)"), 2U) << "functions take operands as they are";
  EXPECT_EQ(length_of("(x - 1) / (y - 2)"), 3U) << "and so do quotients";
}

TEST(ValueProgram, KeepsNothingThatCanWait) {
  EXPECT_EQ(stores_of(compiled("max(max(y, x), square(x) + square(y) - 0.5)")), 0U);
  EXPECT_EQ(stores_of(compiled("max(max(max(y, x), x - 2), sqrt(abs(x * y)))")), 0U);
}

TEST(ValueProgram, RoundsAsOftenAsTheTape) {
  const Tape tape = compiled("x * 3 - 1.1");
  ASSERT_EQ(tape.values.instructions.size(), 1U);
  std::vector<float> rows(200), value(100);
  for (std::size_t i = 0; i < 100; ++i) rows[2 * i] = 0.37F + static_cast<float>(i) / 7;
  evaluate(tape, rows.data(), 100, value.data(), nullptr, {.threads = 1});
  bool differs_from_fused = false;
  for (std::size_t i = 0; i < 100; ++i) {
    const volatile float product = rows[2 * i] * 3.0F;
    EXPECT_EQ(value[i], product - 1.1F) << rows[2 * i];
    differs_from_fused = differs_from_fused || value[i] != std::fma(rows[2 * i], 3.0F, -1.1F);
  }
  EXPECT_TRUE(differs_from_fused) << "or the test tells nothing";
}

TEST(ValueProgram, IsForScalarTapesAtTheQueryPoint) {
  EXPECT_TRUE((*compile(circle(1))).values.instructions.empty());
  EXPECT_TRUE((*compile(mirror(expression("x + y * 2"), 0))).values.instructions.empty());
  EXPECT_TRUE(compiled("x").values.instructions.empty()) << "there is nothing to do";
  EXPECT_FALSE((*compile(expression("x + y * 2").translate(Vec2{1, 2}))).values.instructions.empty());
}

TEST(ValueProgram, GoesWithTheTapeThatItIsOf) {
  Tape tape = compiled("min(x - 1, square(y))");
  ASSERT_FALSE(tape.values.instructions.empty());
  tape.shorten_to(std::vector<Instruction>(tape.instructions.begin(), tape.instructions.begin() + 1));
  EXPECT_TRUE(tape.values.instructions.empty());
}

/// Squares that are read from registers would all be kept before the first sum.
std::string sum_of_quartics(int terms) {
  std::string text = "x";
  for (int i = 0; i < terms; ++i) {
    const std::string square = "square((x - " + std::to_string(i) + ") * y)";
    text += " + square(" + square + ") - 5 * " + square;
  }
  return text;
}

TEST(ValueProgram, HasRoomForItsRegisters) {
  bool has_more_than_the_tape = false;
  for (int terms = 1; terms < 40; ++terms) {
    const Tape tape = compiled(sum_of_quartics(terms));
    const auto registers = static_cast<std::size_t>(tape.values.register_count);
    EXPECT_GE(scratch_floats(tape), registers * kMostChunkLanes + definition_floats(tape)) << terms;
    EXPECT_LE(registers, 24U) << terms;
    has_more_than_the_tape = has_more_than_the_tape || tape.values.register_count > 2 + 2 * tape.register_count;
  }
  EXPECT_TRUE(has_more_than_the_tape) << "or the test tells nothing";
}

}  // namespace
}  // namespace thalweg
