// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// To find a scalar instruction and to bring its operands costs about as much as what it does. So what is a constant
// away from a coordinate, or from another value that is kept, is no instruction of its own: those that use it take w r
// + c for it, or the square of that. The bits stay the same: w is 1 or -1, or c is the zero that changes nothing.
#include <optional>
#include <utility>
#include <vector>

#include "compile/ssa.h"

namespace thalweg::compiler {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }
const ops::Entry& entry_of(int op) { return ops::registry()[at(op)]; }

struct KnownOps {
  int add = ops::find_function("add"), sub = ops::find_function("sub"), mul = ops::find_function("mul");
  int neg = ops::find_function("neg"), square = ops::find_function("square");
  int least = ops::find_function("least"), greatest = ops::find_function("greatest");
};
const KnownOps& known() {
  static const KnownOps ops;
  return ops;
}

/// A value r as it is, as w r + c, or as the square of either.
struct Taken {
  int value = -1;
  double w = 1, c = -0.0;
  bool is_affine = false, is_squared = false;
  [[nodiscard]] bool is_changed() const { return is_affine || is_squared; }
};

/// What the value is of another one by a constant.
std::optional<Taken> affine_of(const Value& v) {
  const auto of = [&](double w, double c) { return Taken{.value = v.a, .w = w, .c = c, .is_affine = true}; };
  if (v.op == known().neg) return of(-1, -0.0);
  if ((v.flags & Instruction::kImmediate) == 0) return std::nullopt;
  const double constant = v.constants[0];
  if (v.op == known().add) return of(1, constant);
  if (v.op == known().mul) return of(constant, -0.0);
  if (v.op != known().sub) return std::nullopt;
  return (v.flags & Instruction::kSwapped) != 0 ? of(1, -constant) : of(-1, constant);
}

/// max(max(a, b), c) as max(a, max(b, c)), and min alike, where a and b are there without being computed but c is not:
/// no intermediate result waits for c then. Ties give the same operand.
class Postponement {
 public:
  explicit Postponement(const Ssa& from) : from_(from), uses_(from.values.size(), 0) {
    for (const Value& v : from.values) {
      for (const int operand : {v.a, v.b}) {
        if (operand >= 0) ++uses_[at(operand)];
      }
    }
  }

  Ssa run() {
    to_.dimension = from_.dimension;
    to_.positions = from_.positions;
    for (const Value& v : from_.values) made_.push_back(add(v));
    to_.root = made_[at(from_.root)];
    return std::move(to_);
  }

 private:
  [[nodiscard]] const Value& value(int i) const { return from_.values[at(i)]; }
  [[nodiscard]] bool is_there(int i) const {
    if (entry_of(value(i).op).axis >= 0) return true;
    const auto affine = affine_of(value(i));
    return affine && (entry_of(value(affine->value).op).axis >= 0 || uses_[at(affine->value)] > 1);
  }
  static bool is_choice(const Value& v) { return v.b >= 0 && (v.op == known().least || v.op == known().greatest); }
  /// Whether it is a choice by that op among what is there.
  [[nodiscard]] bool is_among_there(int i, int op) const {
    for (; !is_there(i); i = value(i).a) {
      const Value& v = value(i);
      if (v.op != op || v.b < 0 || uses_[at(i)] != 1 || !is_there(v.b)) return false;
    }
    return true;
  }

  int add(const Value& v) {
    Value made = v;
    made.a = v.a < 0 ? -1 : made_[at(v.a)];
    made.b = v.b < 0 ? -1 : made_[at(v.b)];
    if (is_choice(v) && !is_there(v.b) && is_among_there(v.a, v.op)) {
      int left = v.a;
      for (; !is_there(left); left = value(left).a) {
        made.b = push({.op = v.op, .a = made_[at(value(left).b)], .b = made.b});
      }
      made.a = made_[at(left)];
    }
    return push(std::move(made));
  }
  int push(Value v) {
    to_.values.push_back(std::move(v));
    return static_cast<int>(to_.values.size()) - 1;
  }

  const Ssa& from_;
  std::vector<int> uses_;
  std::vector<int> made_;
  Ssa to_;
};

class Fusion {
 public:
  explicit Fusion(Ssa from) : from_(std::move(from)), of_(from_.values.size()) {}

  Ssa run() {
    to_.dimension = from_.dimension;
    to_.positions = from_.positions;
    to_.has_points_in_registers = true;
    find_uses();
    // Users come after what they use.
    for (int i = from_.root; i >= 0; --i) {
      if (of_[at(i)].uses > 0) decide(i);
    }
    for (int i = 0; i <= from_.root; ++i) {
      if (of_[at(i)].uses == 0 || of_[at(i)].left_out) continue;
      of_[at(i)].made = static_cast<int>(to_.values.size());
      to_.values.push_back(fused(from_.values[at(i)]));
    }
    to_.root = of_[at(from_.root)].made;
    return std::move(to_);
  }

 private:
  /// What is known of a value.
  struct Known {
    int uses = 0;
    bool must_stand = false;      ///< some user wants it as it is
    bool is_not_squared = false;  ///< some user cannot take squares
    bool left_out = false;        ///< its users compute it
    int made = -1;                ///< its index in the result
  };

  [[nodiscard]] const Value& value(int i) const { return from_.values[at(i)]; }
  [[nodiscard]] bool is_coordinate(int i) const { return entry_of(value(i).op).axis >= 0; }
  /// Whether it lies in a register whatever becomes of its users.
  [[nodiscard]] bool is_kept(int i) const { return is_coordinate(i) || of_[at(i)].uses > 1; }

  void find_uses() {
    of_[at(from_.root)].uses = 1;
    of_[at(from_.root)].must_stand = true;
    for (int i = from_.root; i >= 0; --i) {
      if (of_[at(i)].uses == 0) continue;
      for (const int operand : {value(i).a, value(i).b}) {
        if (operand >= 0) ++of_[at(operand)].uses;
      }
    }
  }

  /// Whether users compute the value, and what follows for its operands.
  void decide(int i) {
    const Value& v = value(i);
    Known& own = of_[at(i)];
    const auto affine = affine_of(v);
    const bool is_square = v.op == known().square;
    if (is_square) {
      const auto inner = affine_of(value(v.a));
      own.left_out = !own.must_stand && !own.is_not_squared && (is_kept(v.a) || (inner && is_kept(inner->value)));
    } else {
      own.left_out = !own.must_stand && affine && is_kept(affine->value);
    }
    const bool takes_affine = own.left_out ? is_square : entry_of(v.op).is_brief;
    const bool takes_squares = !own.left_out && entry_of(v.op).takes_squares;
    for (const int operand : {v.a, v.b}) {
      if (operand < 0) continue;
      if (!takes_affine) of_[at(operand)].must_stand = true;
      if (!takes_squares) of_[at(operand)].is_not_squared = true;
    }
  }

  /// How a user takes a value.
  [[nodiscard]] Taken taken(int i) const {
    if (!of_[at(i)].left_out) return {.value = of_[at(i)].made};
    const Value& v = value(i);
    if (v.op != known().square) {
      Taken affine = *affine_of(v);
      affine.value = of_[at(affine.value)].made;
      return affine;
    }
    Taken square = taken(v.a);
    square.is_squared = true;
    return square;
  }

  [[nodiscard]] Value fused(const Value& v) const {
    Value made{.op = v.op, .position = v.position, .flags = v.flags};
    if (v.b >= 0) {
      fuse_binary(v, made);
    } else {
      made.constants = v.constants;
      if (v.a >= 0) take_first(taken(v.a), made);
    }
    return made;
  }

  /// Where one operand is taken as it is, that one is in the accumulator.
  void fuse_binary(const Value& v, Value& made) const {
    Taken first = taken(v.a), other = taken(v.b);
    if (!first.is_changed() && !other.is_changed()) {
      made.a = first.value;
      made.b = other.value;
      return;
    }
    made.flags = Instruction::kSwapped;
    if (first.is_changed() && !other.is_changed()) {
      std::swap(first, other);
      if (!entry_of(v.op).commutes) made.flags = 0;
    }
    made.b = other.value;
    if (other.is_affine) made.flags |= Instruction::kAffineOther;
    if (other.is_squared) made.flags |= Instruction::kSquaredOther;
    made.constants = {other.w, other.c};
    take_first(first, made);
  }

  static void take_first(const Taken& first, Value& made) {
    made.a = first.value;
    if (!first.is_changed()) return;
    if (first.is_affine) made.flags |= Instruction::kAffineFirst;
    if (first.is_squared) made.flags |= Instruction::kSquaredFirst;
    made.constants.resize(2);
    made.constants.insert(made.constants.end(), {first.w, first.c});
  }

  const Ssa from_;
  std::vector<Known> of_;
  Ssa to_;
};

}  // namespace

Ssa fuse(const Ssa& ssa) { return Fusion(Postponement(ssa).run()).run(); }

}  // namespace thalweg::compiler
