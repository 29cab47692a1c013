// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Order of evaluation and registers of a tape.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "oracle.h"
#include "random_queries.h"
#include "random_shapes.h"
#include "thalweg/op_table.h"
#include "thalweg/ops.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

using oracle::Random;

Tape compiled(const Shape& shape) {
  auto tape = compile(shape);
  if (!tape) throw std::logic_error(to_string(tape.error()));
  return std::move(tape).value();
}

Shape disc(int i) { return circle(1).translate(Vec2{3.0 * i, 0}); }

TEST(Instruction, HasSixteenBytes) { EXPECT_EQ(sizeof(Instruction), 16U); }

TEST(RegisterAllocator, KeepsALeftFoldedUnionInOneRegister) {
  Shape all = disc(0);
  for (int i = 1; i < 100; ++i) all = all | disc(i);
  const Tape tape = compiled(all);
  EXPECT_EQ(tape.register_count, 1);
  EXPECT_EQ(tape.instructions.size(), 199U);
}

TEST(RegisterAllocator, KeepsARightNestedUnionInOneRegister) {
  Shape all = disc(0);
  for (int i = 1; i < 100; ++i) all = union_({disc(i), all});
  EXPECT_EQ(compiled(all).register_count, 1);
}

TEST(RegisterAllocator, NeedsOneRegisterPerLevelOfABalancedTree) {
  int next = 0;
  const auto tree = [&next](auto self, int levels) -> Shape {
    if (levels == 0) return disc(next++);
    const Shape left = self(self, levels - 1);
    return smooth_union(0.1, {left, self(self, levels - 1)});
  };
  for (int levels = 0; levels <= 8; ++levels) EXPECT_EQ(compiled(tree(tree, levels)).register_count, levels) << levels;
}

TEST(RegisterAllocator, ComputesTheOperandThatNeedsMoreFirst) {
  // The plain circle first would keep it in a register while the subtraction takes another.
  const Shape heavy = disc(1) - disc(2) - disc(3);
  for (const Shape& shape : {disc(0) - heavy, heavy - disc(0), smooth_union(1, {disc(0), heavy})}) {
    EXPECT_EQ(compiled(shape).register_count, 1);
  }
}

TEST(RegisterAllocator, NeedsNoRegisterForAChainOfMaps) {
  const Tape tape = compiled(round(onion(round(star(1, 5, 3), 0.1), 0.2), 0.3));
  EXPECT_EQ(tape.register_count, 0);
  EXPECT_EQ(tape.instructions.size(), 4U);
}

TEST(RegisterAllocator, KeepsAValueUsedTwiceUntilItsLastUse) {
  const Shape part = smooth_union(0.5, {disc(0), disc(1)});
  const Tape tape = compiled(onion(part, 0.1) | round(part, 0.2));
  EXPECT_LE(tape.register_count, 2);
  std::size_t loads = 0;
  for (const Instruction& in : tape.instructions) loads += in.op == Instruction::kLoad ? 1 : 0;
  EXPECT_EQ(loads, 1U);
}

TEST(PositionAllocator, ReusesThePositionsThatAreDone) {
  Shape all = mirror(box(Vec2{1, 2}), 0).rotate(0.1);
  for (int i = 2; i < 40; ++i) all = all | mirror(box(Vec2{1, 2}), 0).rotate(0.1 * i);
  EXPECT_EQ(compiled(all).position_count, 3);
}

TEST(PositionAllocator, KeepsTheParentOfAMirroredPosition) {
  const Shape turned = box(Vec2{1, 2}).rotate(0.1).translate(Vec2{4, 0});
  const Tape tape = compiled(mirror(turned | star(1, 5, 3).rotate(0.2), 0));
  const double p[2] = {-4, 0.5}, q[2] = {4, 0.5};
  EXPECT_DOUBLE_EQ(evaluate_double(tape, p, nullptr), evaluate_double(tape, q, nullptr));
}

/// Runs a tape on symbols: what each register holds as an expression, to catch a register overwritten too early.
class SymbolicMachine {
 public:
  explicit SymbolicMachine(const Tape& tape) : tape_(tape), positions_(static_cast<std::size_t>(tape.position_count)) {
    positions_[0] = "p";
    registers_.resize(static_cast<std::size_t>(tape.register_count), "nothing");
  }
  std::string run() {
    for (const Instruction& in : tape_.instructions) step(in);
    return acc_;
  }

 private:
  void step(const Instruction& in) {
    if (in.op == Instruction::kLoad) {
      acc_ = registers_.at(in.operand);
    } else {
      const OpRow& row = op_table()[in.op];
      const std::string head = std::string(row.name) + constants(in);
      switch (row.kind) {
        case OpKind::primitive:
          acc_ = head + "(" + positions_.at(in.operand) + ")";
          break;
        case OpKind::combine:
          acc_ = in.flags & Instruction::kSwapped ? head + "(" + acc_ + "," + registers_.at(in.operand) + ")"
                                                  : head + "(" + registers_.at(in.operand) + "," + acc_ + ")";
          break;
        case OpKind::map:
          acc_ = head + "(" + acc_ + ")";
          break;
        default:
          positions_.at(in.target) = head + "(" + positions_.at(in.operand) + ")";
          return;
      }
    }
    if (in.target != Instruction::kNone) registers_.at(in.target) = acc_;
  }
  [[nodiscard]] std::string constants(const Instruction& in) const {
    std::string text = "[";
    for (std::uint32_t i = 0; i < in.constant_count; ++i)
      text += std::to_string(tape_.constants64.at(in.constants + i)) + " ";
    return text + "]";
  }

  const Tape& tape_;
  std::vector<std::string> registers_;
  std::vector<std::string> positions_;
  std::string acc_ = "nothing";
};

TEST(SymbolicTape, OfASubtractionNamesItsOperandsInOrder) {
  EXPECT_EQ(SymbolicMachine(compiled(disc(1) - disc(2))).run(),
            "subtraction[](circle[3.000000 0.000000 1.000000 ](p),circle[6.000000 0.000000 1.000000 ](p))");
}

TEST(RegisterAllocator, NeverReadsARegisterBeforeItIsWritten) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const Shape shape = oracle::random_shape(random, seed % 2 == 0 ? 2 : 3, 30);
    EXPECT_EQ(SymbolicMachine(compiled(shape)).run().find("nothing"), std::string::npos)
        << oracle::describe(shape, seed);
  }
}

/// A DAG in which every level uses the one before it several times, so that values live long and die in any order.
Shape tangled(Random& random, int levels) {
  std::vector<Shape> pool = {disc(0), disc(1), box(Vec2{1, 2}).rotate(0.3), star(1, 5, 3).translate(Vec2{0, 2})};
  for (int i = 0; i < levels; ++i) {
    const Shape a = pool[random.index(pool.size())], b = pool[random.index(pool.size())];
    switch (random.index(4)) {
      case 0:
        pool.push_back(a - b);
        break;
      case 1:
        pool.push_back(smooth_union(0.2, {a, b}));
        break;
      case 2:
        pool.push_back(onion(a, 0.1) | b);
        break;
      default:
        pool.push_back(round(a, 0.1) & b);
    }
  }
  return union_({pool.end()[-1], pool.end()[-2], pool.end()[-3]});
}

TEST(RegisterAllocator, KeepsTheMeaningOfATangledDag) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const Shape shape = tangled(random, 25);
    const Tape tape = compiled(shape);
    ASSERT_EQ(SymbolicMachine(tape).run().find("nothing"), std::string::npos);
    const oracle::Field field(shape);
    for (int i = 0; i < 40; ++i) {
      const double p[2] = {random.uniform(-4, 8), random.uniform(-4, 4)};
      ASSERT_NEAR(evaluate_double(tape, p, nullptr), field({p[0], p[1], 0}), 1e-12) << oracle::describe(shape, seed);
    }
  }
}

TEST(Tape, IsTheSameForTheSameShape) {
  Random a(5), b(5);
  const Tape one = compiled(oracle::random_shape(a, 3, 30)), two = compiled(oracle::random_shape(b, 3, 30));
  EXPECT_EQ(one.disassembly(), two.disassembly());
  EXPECT_EQ(one.constants64, two.constants64);
}

}  // namespace
}  // namespace thalweg
