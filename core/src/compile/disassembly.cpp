// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The printed form of a tape: one instruction a line, what it does to the accumulator, and its constants.
#include <algorithm>
#include <cstdio>

#include "ops/registry.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

std::string constants_text(const Tape& tape, const Instruction& in) {
  static constexpr std::uint32_t kShown = 8;
  // Of a formula's constant the value; its bounds follow.
  const ops::Entry* const op = in.op < Instruction::kKeep ? &ops::registry()[in.op] : nullptr;
  const bool is_constant =
      op != nullptr && op->row.kind == OpKind::scalar && (op->operands > 0 || op->row.name == "constant");
  const std::uint32_t count = is_constant ? std::min(in.constant_count, 1U) : in.constant_count;
  std::string text;
  for (std::uint32_t i = 0; i < count && i < kShown; ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.6g", i == 0 ? "" : " ", tape.constants64[in.constants + i]);
    text += number;
  }
  if (count > kShown) text += " ... (" + std::to_string(in.constant_count) + ")";
  return text;
}

template <class... Parts>
std::string joined(const Parts&... parts) {
  std::string text;
  (text.append(parts), ...);
  return text;
}

std::string scalar_action(const ops::Entry& op, const Instruction& in) {
  const std::string operand = std::to_string(in.operand);
  const bool is_immediate = (in.flags & Instruction::kImmediate) != 0;
  const std::string other = is_immediate ? "c" : "r" + operand;
  const std::string own = (in.flags & Instruction::kLoads) != 0 ? "r" + std::to_string(in.first) : "acc";
  if (op.operands == 0)
    return op.row.name == "constant" ? "acc = c" : joined("acc = ", op.row.name, "(p", operand, ")");
  if (op.operands == 1) return joined("acc = ", op.row.name, "(", own, ")");
  return (in.flags & Instruction::kSwapped) != 0 ? joined("acc = ", op.row.name, "(", own, ", ", other, ")")
                                                 : joined("acc = ", op.row.name, "(", other, ", ", own, ")");
}

std::string action(const Instruction& in) {
  const std::string operand = std::to_string(in.operand);
  if (in.op == Instruction::kLoad) return joined("acc = r", operand);
  if (in.op == Instruction::kKeep) return "acc";
  const OpRow& row = ops::registry()[in.op].row;
  switch (row.kind) {
    case OpKind::primitive:
      return joined("acc = ", row.name, (in.flags & Instruction::kTurned) != 0 ? "(turned p" : "(p", operand, ")");
    case OpKind::scalar:
      return scalar_action(ops::registry()[in.op], in);
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
  return in.op < Instruction::kKeep && ops::registry()[in.op].row.kind >= OpKind::place;
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
