// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The reader of `.vm` programs: what it takes, and where it says a fault is.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "formula/formula.h"
#include "thalweg/scene.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

double value(std::string_view text, double x, double y) {
  const auto scene = parse_program(text, "test.vm");
  EXPECT_TRUE(scene) << to_string(scene.error());
  const double at[3] = {x, y, 0};
  return evaluate_double(*compile(scene->shape), at, nullptr);
}

std::string fault(std::string_view text) {
  const auto scene = parse_program(text, "test.vm");
  return scene ? "" : to_string(scene.error());
}

TEST(Program, IsReadLineByLine) {
  EXPECT_EQ(value("x var-x\n\n# a comment\n  y\tvar-y\r\nd sub x y", 5, 3), 2);
  EXPECT_EQ(value("c const -1.5e0\n", 5, 3), -1.5);
  EXPECT_EQ(value("x var-x\nu const 2\n+ add x u\nlast mul + +", 1, 0), 9);
}

TEST(Program, HasTheDimensionOfItsResult) {
  EXPECT_EQ(parse_program("z var-z\nx var-x", "")->dimension, 2) << "z is not needed";
  EXPECT_EQ(parse_program("x var-x\nz var-z\na add x z", "")->dimension, 3);
}

TEST(Program, FaultsNameTheirLineAndColumn) {
  EXPECT_EQ(fault(""), "test.vm: 1:1: expected at least one line with a name and an opcode, found none");
  EXPECT_EQ(fault("# nothing\n"), "test.vm: 2:1: expected at least one line with a name and an opcode, found none");
  EXPECT_EQ(fault("x var-x\ny"), "test.vm: 2:2: expected an opcode, found the end of the line");
  EXPECT_EQ(fault("x var-w"), "test.vm: 1:3: expected an opcode, found \"var-w\"");
  EXPECT_EQ(fault("x var-x\nr rand x"),
            "test.vm: 2:3: expected an opcode that is supported (mix and rand are not), found \"rand\"");
  EXPECT_EQ(fault("x var-x\n  m mix x x"),
            "test.vm: 2:5: expected an opcode that is supported (mix and rand are not), found \"mix\"");
  EXPECT_EQ(fault("x var-x\na add x"), "test.vm: 2:8: expected the name of a line above, found the end of the line");
  EXPECT_EQ(fault("x var-x\na add x b"), "test.vm: 2:9: expected the name of a line above, found \"b\"");
  EXPECT_EQ(fault("x var-x\na abs x x"), "test.vm: 2:9: expected the end of the line, found \"x\"");
  EXPECT_EQ(fault("x var-x x"), "test.vm: 1:9: expected the end of the line, found \"x\"");
  EXPECT_EQ(fault("x var-x\nx var-y"), "test.vm: 2:1: expected a name that no line above has, found \"x\"");
  for (const char* number : {"", "one", "1x", "inf", "nan", "1e39", "1e999", "0x10", "--1"}) {
    EXPECT_NE(fault("c const " + std::string(number)).find("1:"), std::string::npos) << number;
  }
  EXPECT_EQ(fault("c const 1 2"), "test.vm: 1:11: expected the end of the line, found \"2\"");
  EXPECT_NE(fault("x var-x\nb coordinate x").find("2:3"), std::string::npos) << "not an opcode of programs";
  EXPECT_NE(fault("x var-x\nb given x x").find("2:3"), std::string::npos) << "not an opcode of programs";
}

TEST(Program, TakesEveryOpcodeOfTheTable) {
  for (const FunctionRow& row : function_table()) {
    if (row.opcode.empty()) continue;
    const std::string text = "x var-x\nr " + std::string(row.opcode) + (row.operands == 1 ? " x" : " x x");
    EXPECT_EQ(fault(text), "") << row.opcode;
  }
}

// Flips, inserts, removes and doubles a few bytes.
std::string damaged(std::string text, std::mt19937_64& random) {
  const std::string likely = "0 _\n-#abc\t\r\xff";
  for (std::size_t i = 0; i < 1 + random() % 4 && !text.empty(); ++i) {
    const std::size_t at = random() % text.size();
    const char byte = random() % 2 == 0 ? likely[random() % likely.size()] : static_cast<char>(random());
    switch (random() % 5) {
      case 0:
        text[at] = byte;
        break;
      case 1:
        text.insert(at, 1, byte);
        break;
      case 2:
        text.erase(at, 1 + random() % 8);
        break;
      case 3:
        text.resize(at);
        break;
      default:
        text.insert(at, text.substr(at, 1 + random() % 16));
    }
  }
  return text;
}

TEST(Program, IsReadOrRefusedWhateverTheDamage) {
  const std::string whole =
      "# a disc with a bite\nx var-x\ny var-y\nx2 square x\ny2 square y\nr2 add x2 y2\nr sqrt r2\none const 1\n"
      "d sub r one\nt mul x y\ns sin t\nm max d s\n";
  ASSERT_EQ(fault(whole), "");
  std::mt19937_64 random(20250101);
  std::size_t refused = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string text = damaged(whole, random);
    const auto scene = parse_program(text, "test.vm");
    if (!scene) {
      ++refused;
      EXPECT_NE(scene.error().place.find(':'), std::string::npos) << text;
      continue;
    }
    ASSERT_TRUE(compile(scene->shape)) << text;
  }
  EXPECT_GT(refused, 1000U);
}

}  // namespace
}  // namespace thalweg
