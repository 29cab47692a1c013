// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The op table: every declaration is complete, and each piece that its kind needs is there.
#include "ops/registry.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace thalweg::ops {
namespace {

TEST(OpTable, HoldsTheOpsOfThisVersion) {
  std::set<std::pair<std::string, int>> names;
  for (const OpRow& row : op_table()) names.emplace(row.name, row.dimension);
  for (const char* name : {"circle", "box", "rounded_box", "segment", "triangle", "polygon", "star", "pie", "arc",
                           "ring", "moon", "cool_s", "half_plane"}) {
    EXPECT_TRUE(names.contains({name, 2})) << name;
  }
  for (const char* name : {"sphere", "box", "torus", "capsule", "cylinder", "plane"}) {
    EXPECT_TRUE(names.contains({name, 3})) << name;
  }
  for (const char* name : {"union", "intersection", "subtraction", "smooth_union", "smooth_intersection",
                           "smooth_subtraction", "round", "onion", "translate", "rotate", "scale", "mirror"}) {
    EXPECT_FALSE(find_ops(name, 2).empty()) << name;
    EXPECT_FALSE(find_ops(name, 3).empty()) << name;
  }
}

TEST(OpTable, SaysWhatEveryOpAndParameterIs) {
  for (const OpRow& row : op_table()) {
    EXPECT_FALSE(row.name.empty());
    EXPECT_FALSE(row.exactness.empty()) << row.name;
    EXPECT_TRUE(row.dimension == 0 || row.dimension == 2 || row.dimension == 3) << row.name;
    EXPECT_GE(row.rounding, 0) << row.name;
    if (row.kind == OpKind::primitive) {
      EXPECT_NE(row.dimension, 0) << row.name;
    }
    std::set<std::string_view> parameters;
    for (const OpParameter& p : row.parameters) {
      EXPECT_TRUE(parameters.insert(p.name).second) << row.name << " has two parameters " << p.name;
      EXPECT_NE(p.name, "op");
      EXPECT_NE(p.name, "of");
      EXPECT_FALSE(p.meaning.empty()) << row.name << ' ' << p.name;
      EXPECT_EQ(p.quantity == Quantity::choice, !p.choices.empty()) << row.name << ' ' << p.name;
      if (p.quantity != Quantity::choice && p.quantity != Quantity::text) {
        EXPECT_LT(p.least, p.most) << row.name << ' ' << p.name;
      }
      // A list takes all numbers that are left, so it must be the last.
      if (p.arity == 0) {
        EXPECT_EQ(&p, &row.parameters.back()) << row.name;
      }
    }
  }
}

TEST(OpTable, KeepsRowsOfOneNameApartByTheirParameters) {
  std::set<std::tuple<std::string, int, std::string>> seen;
  for (const OpRow& row : op_table()) {
    std::string parameters;
    for (const OpParameter& p : row.parameters) parameters += std::string(p.name) + ",";
    EXPECT_TRUE(seen.emplace(row.name, row.dimension, parameters).second) << row.name;
  }
}

TEST(Registry, HasEveryPieceThatAKindNeeds) {
  for (const Entry& entry : registry()) {
    const auto name = entry.row.name;
    switch (entry.row.kind) {
      case OpKind::primitive:
        EXPECT_TRUE(entry.derive && entry.primitive_facts && entry.primitive_bounds) << name;
        break;
      case OpKind::formula:
        EXPECT_EQ(entry.row.parameters.front().quantity, Quantity::text) << name;
        break;
      case OpKind::scalar:
        EXPECT_EQ(entry.evaluate != nullptr && entry.enclose != nullptr, entry.operands > 0) << name;
        EXPECT_TRUE(entry.opcode.empty() || find_opcode(entry.opcode) >= 0) << name;
        break;
      case OpKind::combine:
        EXPECT_TRUE(entry.derive && entry.join && entry.widening) << name;
        break;
      case OpKind::map:
        EXPECT_TRUE(entry.derive && entry.operand_facts && entry.operand_level) << name;
        break;
      case OpKind::place:
        EXPECT_TRUE(entry.similarity) << name;
        EXPECT_EQ(entry.derive_placement != nullptr, name == "rigid") << name;
        break;
      case OpKind::warp:
        EXPECT_TRUE(entry.derive && entry.operand_facts && entry.preimage) << name;
        EXPECT_GT(entry.stretch, 0) << name;
        break;
    }
  }
}

TEST(Registry, HasASupportFunctionForEveryConvexPrimitiveWithoutCorners) {
  std::set<std::string> supported;
  for (const Entry& entry : registry()) {
    if (entry.has_support) supported.insert(std::string(entry.row.name));
    if (entry.has_support) {
      EXPECT_EQ(entry.row.kind, OpKind::primitive);
    }
  }
  EXPECT_EQ(supported, (std::set<std::string>{"box", "capsule", "circle", "cylinder", "half_plane", "pie", "plane",
                                              "polygon", "rounded_box", "segment", "sphere", "triangle"}));
}

TEST(Registry, FindsOpsByNameAndDimension) {
  EXPECT_EQ(find_ops("circle", 2).size(), 1U);
  EXPECT_TRUE(find_ops("circle", 3).empty());
  EXPECT_EQ(find_ops("rotate", 3).size(), 2U);
  EXPECT_EQ(find_ops("union", 2), find_ops("union", 3));
  EXPECT_NE(find_ops("box", 2), find_ops("box", 3));
  EXPECT_TRUE(find_ops("ref", 2).empty());
  EXPECT_TRUE(find_ops("", 2).empty());
  EXPECT_EQ(registry()[static_cast<std::size_t>(rigid_op(2))].row.dimension, 2);
  EXPECT_EQ(registry()[static_cast<std::size_t>(rigid_op(3))].row.dimension, 3);
}

TEST(Registry, CountsTheNumbersOfARow) {
  const auto count = [](std::string_view name, int dimension) {
    return number_count(registry()[static_cast<std::size_t>(find_ops(name, dimension).front())].row);
  };
  EXPECT_EQ(count("circle", 2), 1U);
  EXPECT_EQ(count("rounded_box", 2), 6U);
  EXPECT_EQ(count("capsule", 3), 7U);
  EXPECT_EQ(count("polygon", 2), 0U);
  EXPECT_EQ(count("union", 2), 0U);
}

}  // namespace
}  // namespace thalweg::ops
