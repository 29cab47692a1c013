// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The printed form of a tape: one instruction a line, what it does to the accumulator, and its constants.
#include <cstdio>

#include "thalweg/op_table.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

std::string constants_text(const Tape& tape, const Instruction& in) {
  static constexpr std::uint32_t kShown = 8;
  std::string text;
  for (std::uint32_t i = 0; i < in.constant_count && i < kShown; ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.6g", i == 0 ? "" : " ", tape.constants64[in.constants + i]);
    text += number;
  }
  if (in.constant_count > kShown) text += " ... (" + std::to_string(in.constant_count) + ")";
  return text;
}

template <class... Parts>
std::string joined(const Parts&... parts) {
  std::string text;
  (text.append(parts), ...);
  return text;
}

std::string action(const Instruction& in) {
  const std::string operand = std::to_string(in.operand);
  if (in.op == Instruction::kLoad) return joined("acc = r", operand);
  if (in.op == Instruction::kKeep) return "acc";
  const OpRow& row = op_table()[in.op];
  switch (row.kind) {
    case OpKind::primitive:
      return joined("acc = ", row.name, (in.flags & Instruction::kTurned) != 0 ? "(turned p" : "(p", operand, ")");
    case OpKind::combine:
      return (in.flags & Instruction::kSwapped) != 0 ? joined("acc = ", row.name, "(acc, r", operand, ")")
                                                     : joined("acc = ", row.name, "(r", operand, ", acc)");
    case OpKind::map:
      return joined("acc = ", row.name, "(acc)");
    default:
      return joined("p", std::to_string(in.target), " = ", row.name, "(p", operand, ")");
  }
}

bool moves_position(const Instruction& in) {
  return in.op < Instruction::kKeep && op_table()[in.op].kind >= OpKind::place;
}

}  // namespace

std::string Tape::disassembly() const {
  std::string text = "; " + std::to_string(dimension) + "D, " + std::to_string(instructions.size()) +
                     " instructions, " + std::to_string(register_count) + " registers, " +
                     std::to_string(position_count) + " positions, " + std::to_string(constants.size()) +
                     " constants\n";
  for (std::size_t i = 0; i < instructions.size(); ++i) {
    const Instruction& in = instructions[i];
    const bool stores = in.target != Instruction::kNone && !moves_position(in);
    char line[160];
    std::snprintf(line, sizeof line, "%5zu  %-34s %-7s %s", i, action(in).c_str(),
                  stores ? ("-> r" + std::to_string(in.target)).c_str() : "",
                  (in.flags & Instruction::kSupport) != 0 ? "support " : "");
    text += line + constants_text(*this, in) + "\n";
  }
  return text;
}

}  // namespace thalweg
