// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// SSA to the accumulator machine. Of two operands the one that needs more registers is computed first (Sethi and
// Ullman 1970), so that few registers are live; registers and positions are then given out by a linear scan, lowest
// free number first.
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "compile/ssa.h"
#include "kernels/kernels.h"

namespace thalweg::compiler {
namespace {

using Free = std::priority_queue<std::uint16_t, std::vector<std::uint16_t>, std::greater<>>;

/// A chunk's registers, 512 bytes each with AVX-512, leave room in the first-level cache.
constexpr int kManyRegisters = 24;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// Whether it is a coordinate that lies in a register from the start.
bool is_given(const Ssa& ssa, std::size_t value) {
  return ssa.has_points_in_registers && ops::registry()[at(ssa.values[value].op)].axis >= 0;
}

/// Values in the order in which they are computed. What an instruction reads from a register comes before what it finds
/// in the accumulator, where registers are no object.
std::vector<int> computed_order(const Ssa& ssa, bool spares_registers = true) {
  // Operands have lower indices, so one pass gives the registers that each value needs.
  std::vector<int> need(ssa.values.size(), 0);
  for (std::size_t i = 0; i < ssa.values.size(); ++i) {
    const Value& v = ssa.values[i];
    if (v.a >= 0 && v.b < 0) need[i] = need[at(v.a)];
    if (v.b >= 0) {
      const auto [less, more] = std::minmax(need[at(v.a)], need[at(v.b)]);
      need[i] = std::max(more, less + 1);
    }
  }
  std::vector<int> order;
  std::vector<char> done(ssa.values.size(), 0);
  for (std::size_t i = 0; i < ssa.values.size(); ++i) done[i] = is_given(ssa, i) ? 1 : 0;
  std::vector<int> open = {ssa.root};
  while (!open.empty()) {
    const int next = open.back();
    const Value& v = ssa.values[at(next)];
    int first = v.a;
    int second = v.b;
    const bool from_register = !spares_registers && (v.flags & Instruction::kChangesOther) != 0;
    if (second >= 0 && (from_register || need[at(second)] > need[at(first)])) std::swap(first, second);
    if (done[at(next)] != 0) {
      open.pop_back();
    } else if (first >= 0 && done[at(first)] == 0) {
      open.push_back(first);
    } else if (second >= 0 && done[at(second)] == 0) {
      open.push_back(second);
    } else {
      done[at(next)] = 1;
      order.push_back(next);
      open.pop_back();
    }
  }
  return order;
}

/// Where numbered things live: a slot is taken at the definition and given back after the last use.
class Slots {
 public:
  explicit Slots(std::uint16_t first) : next_(first) {}
  std::uint16_t take() {
    if (free_.empty()) return next_ == Instruction::kNone - 2 ? overflow() : next_++;
    const std::uint16_t slot = free_.top();
    free_.pop();
    return slot;
  }
  void give_back(std::uint16_t slot) { free_.push(slot); }
  [[nodiscard]] int count() const { return next_; }
  [[nodiscard]] bool overflowed() const { return overflowed_; }

 private:
  std::uint16_t overflow() {
    overflowed_ = true;
    return 0;
  }
  Free free_;
  std::uint16_t next_;
  bool overflowed_ = false;
};

class Writer {
 public:
  Writer(const Ssa& ssa, std::vector<int> order) : ssa_(ssa), order_(std::move(order)) {
    if (ssa.has_points_in_registers) registers_ = Slots(static_cast<std::uint16_t>(ssa.dimension));
  }

  ValueProgram run_values() {
    write_all();
    if (registers_.overflowed()) return {};
    return {.instructions = std::move(tape_.instructions),
            .constants = {tape_.constants64.begin(), tape_.constants64.end()},
            .register_count = registers_.count()};
  }

  Result<Tape> run(const Facts& facts) {
    tape_.only_scalars = true;
    write_all();
    if (registers_.overflowed() || positions_.overflowed()) {
      return Error{.file = "", .place = "/shape", .expected = "fewer values alive at once", .found = "too many"};
    }
    tape_.dimension = ssa_.dimension;
    tape_.register_count = registers_.count();
    tape_.position_count = positions_.count();
    tape_.facts = facts;
    set_slack(ssa_.values[at(ssa_.root)].error);
    tape_.constants.assign(tape_.constants64.begin(), tape_.constants64.end());
    for (const Instruction& in : tape_.instructions) round_outward(in);
    return std::move(tape_);
  }

 private:
  void write_all() {
    find_last_uses();
    for (std::size_t step = 0; step < order_.size(); ++step) write(step);
  }

  void set_slack(const Affine& error) {
    // Half as much again for the arithmetic of bounds, and 16 eps L m for the rounding of centres and reaches.
    const auto for_search = [&](double lipschitz) {
      return Affine{.a = 1.5 * error.a, .b = 1.5 * error.b + kPlaceRounding * lipschitz};
    };
    if (tape_.has_formulas) {
      // No multiple of m bounds the rounding of a formula, nor its slope; primitives beside it have both.
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      tape_.slack = tape_.search_slack = {.a = kInfinity, .b = 0};
      tape_.enclosure_slack = for_search(1);
    } else {
      tape_.slack = error;
      tape_.search_slack = tape_.enclosure_slack = for_search(tape_.facts.lipschitz);
    }
  }

  /// A formula's constants {value, lo, hi}: lo and hi hold the real one in float32 too.
  void round_outward(const Instruction& in) {
    const bool is_constant = in.op == constant_op_ || (in.flags & Instruction::kImmediate) != 0;
    if (!is_constant) return;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    tape_.constants[in.constants] = static_cast<float>(tape_.constants64[in.constants]);
    for (const std::uint32_t end : {1U, 2U}) {
      const double exact = tape_.constants64[in.constants + end];
      float& rounded = tape_.constants[in.constants + end];
      rounded = static_cast<float>(exact);
      const bool inward = end == 1 ? static_cast<double>(rounded) > exact : static_cast<double>(rounded) < exact;
      if (inward) rounded = std::nextafter(rounded, end == 1 ? -kInfinity : kInfinity);
    }
  }

  void find_last_uses() {
    last_use_.assign(ssa_.values.size(), 0);
    position_last_use_.assign(ssa_.positions.size(), 0);
    uses_left_.assign(ssa_.values.size(), 0);
    for (std::size_t step = 0; step < order_.size(); ++step) {
      const Value& v = ssa_.values[at(order_[step])];
      for (const int operand : {v.a, v.b}) {
        if (operand >= 0) {
          last_use_[at(operand)] = step;
          ++uses_left_[at(operand)];
        }
      }
      for (int p = v.position; p >= 0; p = ssa_.positions[at(p)].parent) position_last_use_[at(p)] = step;
    }
    register_of_.assign(ssa_.values.size(), Instruction::kNone);
    position_slot_.assign(ssa_.positions.size(), Instruction::kNone);
    position_slot_[0] = 0;
    for (std::size_t i = 0; i < ssa_.values.size(); ++i) {
      if (!is_given(ssa_, i)) continue;
      register_of_[i] = static_cast<std::uint16_t>(ops::registry()[at(ssa_.values[i].op)].axis);
      last_use_[i] = order_.size();
    }
  }

  /// Whether the value that was computed last can be an operand as it is.
  static bool takes_accumulator(const Value& v, int last) {
    return (v.a == last && (v.flags & Instruction::kChangesFirst) == 0) ||
           (v.b == last && (v.flags & Instruction::kChangesOther) == 0);
  }

  /// A value needs a register unless its one use is the next step, which finds it in the accumulator.
  [[nodiscard]] bool needs_register(std::size_t step) const {
    const int value = order_[step];
    if (step + 1 == order_.size()) return false;
    return uses_left_[at(value)] != 1 || !takes_accumulator(ssa_.values[at(order_[step + 1])], value);
  }

  void write(std::size_t step) {
    const int index = order_[step];
    const Value& v = ssa_.values[at(index)];
    const bool is_scalar = ops::registry()[at(v.op)].row.kind == OpKind::scalar;
    tape_.has_formulas = tape_.has_formulas || is_scalar;
    tape_.only_scalars = tape_.only_scalars && is_scalar;
    const int previous = step == 0 ? -1 : order_[step - 1];
    Instruction instruction;
    instruction.op = static_cast<std::uint8_t>(v.op);
    if (v.position >= 0) {
      instruction.operand = slot_of(v.position);
      instruction.flags = v.flags;
      tape_.has_support = tape_.has_support || (v.flags & Instruction::kSupport) != 0;
    } else if (v.b < 0 || (v.flags & Instruction::kChangesOther) != 0) {
      instruction.flags = v.flags;
      const bool is_read = (v.flags & Instruction::kChangesFirst) != 0;
      if (v.a >= 0 && (is_read || previous != v.a)) load(v.a, is_scalar, instruction);
      if (v.b >= 0) instruction.operand = register_of_[at(v.b)];
    } else {
      if (previous != v.a && previous != v.b) load(v.b, is_scalar, instruction);
      // With both in registers b was just loaded; with a in the accumulator the operator is written swapped. So is
      // what commutes: processors read a second operand from memory within the operation.
      const bool has_a = previous == v.a && v.a != v.b;
      instruction.operand = register_of_[at(has_a ? v.b : v.a)];
      if (has_a || ops::registry()[at(v.op)].commutes) instruction.flags |= Instruction::kSwapped;
    }
    store_constants(v.constants, instruction);
    release(v, step);
    if (needs_register(step)) instruction.target = register_of_[at(index)] = registers_.take();
    tape_.instructions.push_back(instruction);
  }

  /// A value that the instruction wants in the accumulator.
  void load(int value, bool is_scalar, Instruction& instruction) {
    const std::uint16_t from = register_of_[at(value)];
    if (is_scalar) {
      instruction.flags |= Instruction::kLoads;
      instruction.first = from;
    } else {
      tape_.instructions.push_back({.op = Instruction::kLoad, .operand = from});
    }
  }

  void release(const Value& v, std::size_t step) {
    for (const int operand : {v.a, v.b == v.a ? -1 : v.b}) {
      if (operand < 0 || last_use_[at(operand)] != step) continue;
      if (register_of_[at(operand)] != Instruction::kNone) registers_.give_back(register_of_[at(operand)]);
    }
    for (int p = v.position; p > 0; p = ssa_.positions[at(p)].parent) {
      if (position_last_use_[at(p)] == step) positions_.give_back(position_slot_[at(p)]);
    }
  }

  /// The slot of a position, writing the instructions that make it on first use.
  std::uint16_t slot_of(int position) {
    std::vector<int> missing;
    for (int p = position; position_slot_[at(p)] == Instruction::kNone; p = ssa_.positions[at(p)].parent) {
      missing.push_back(p);
    }
    for (auto p = missing.rbegin(); p != missing.rend(); ++p) {
      const Position& made = ssa_.positions[at(*p)];
      Instruction instruction;
      instruction.op = static_cast<std::uint8_t>(made.op);
      instruction.operand = position_slot_[at(made.parent)];
      instruction.target = position_slot_[at(*p)] = positions_.take();
      store_constants(made.constants, instruction);
      tape_.instructions.push_back(instruction);
      tape_.only_scalars = false;
    }
    return position_slot_[at(position)];
  }

  void store_constants(const std::vector<double>& constants, Instruction& instruction) {
    instruction.constants = static_cast<std::uint32_t>(tape_.constants64.size());
    instruction.constant_count = static_cast<std::uint32_t>(constants.size());
    tape_.constants64.insert(tape_.constants64.end(), constants.begin(), constants.end());
  }

  const Ssa& ssa_;
  const int constant_op_ = ops::find_function("constant");
  std::vector<int> order_;
  std::vector<std::size_t> last_use_;
  std::vector<std::size_t> position_last_use_;
  std::vector<int> uses_left_;
  std::vector<std::uint16_t> register_of_;
  std::vector<std::uint16_t> position_slot_;
  Slots registers_{0};
  Slots positions_{1};
  Tape tape_;
};

}  // namespace

Result<Tape> to_tape(const Ssa& ssa, const Facts& facts) { return Writer(ssa, computed_order(ssa)).run(facts); }

ValueProgram to_value_program(const Ssa& fused) {
  ValueProgram program = Writer(fused, computed_order(fused, false)).run_values();
  if (!program.instructions.empty() && program.register_count <= kManyRegisters) return program;
  return Writer(fused, computed_order(fused)).run_values();
}

}  // namespace thalweg::compiler

namespace thalweg {

Result<Tape> compile(const Shape& shape) {
  auto ssa = compiler::to_ssa(shape);
  if (!ssa) return ssa.error();
  auto made = compiler::to_tape(*ssa, shape.facts());
  if (!made || !made->only_scalars) return made;
  Tape tape = std::move(made).value();
  tape.values = compiler::to_value_program(compiler::fuse(*ssa));
  return tape;
}

}  // namespace thalweg
