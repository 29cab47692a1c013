// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The printed form of a tape: one instruction a line, what it does to the accumulator, and its constants.
#include <algorithm>
#include <cmath>
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

// --- value programs: constants stand where they are used ---

std::string number_text(const char* format, float number) {
  char text[32];
  std::snprintf(text, sizeof text, format, static_cast<double>(number));
  return text;
}

/// A register as the instruction takes it; `c` has w and c.
std::string taken_text(std::uint16_t from, const float* c, bool is_affine, bool is_squared) {
  std::string text = joined("r", std::to_string(from));
  if (is_affine) {
    if (c[0] != 1) text = c[0] == -1 ? joined("-", text) : joined(number_text("%.6g ", c[0]), text);
    if (c[1] != 0) text += number_text(c[1] < 0 ? " - %.6g" : " + %.6g", std::fabs(c[1]));
  }
  return is_squared ? joined("square(", text, ")") : text;
}

std::string value_action(const ValueProgram& program, const Instruction& in) {
  const ops::Entry& op = ops::registry()[in.op];
  const float* const c = program.constants.data() + in.constants;
  const auto has = [&](std::uint8_t flag) { return (in.flags & flag) != 0; };
  if (op.operands == 0) return scalar_action(op, in);
  const std::string first = !has(Instruction::kLoads) ? "acc"
                                                      : taken_text(in.first, c + 2, has(Instruction::kAffineFirst),
                                                                   has(Instruction::kSquaredFirst));
  if (op.operands == 1) return joined("acc = ", op.row.name, "(", first, ")");
  const std::string other = has(Instruction::kImmediate) ? number_text("%.6g", c[0])
                                                         : taken_text(in.operand, c, has(Instruction::kAffineOther),
                                                                      has(Instruction::kSquaredOther));
  return has(Instruction::kSwapped) ? joined("acc = ", op.row.name, "(", first, ", ", other, ")")
                                    : joined("acc = ", op.row.name, "(", other, ", ", first, ")");
}

std::string value_text(const ValueProgram& program) {
  if (program.instructions.empty()) return "";
  std::string text = "; values: " + std::to_string(program.instructions.size()) + " instructions, " +
                     std::to_string(program.register_count) + " registers, the first with the coordinates\n";
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    const Instruction& in = program.instructions[i];
    const std::string target = in.target == Instruction::kNone ? "" : joined(" -> r", std::to_string(in.target));
    char index[32];
    std::snprintf(index, sizeof index, "%5zu  ", i);
    text += joined(index, value_action(program, in), target, "\n");
  }
  return text;
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
  return text + value_text(values);
}

}  // namespace thalweg
