// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A constant becomes part of the instruction that uses it. The placement goes into the coordinates, each an affine row
// of its position, and into one product of the result with the scale.
//
// Rounding. A constant carries the interval that its real value lies in, {value, lo, hi}. A row carries what its
// enclosure owes (ops/scalar.inl): each of the D products and sums rounds once, the weights and the offset are rounded
// themselves, and the similarity that they come from was composed in double; kRowUnits of the unit roundoff cover all.
// The position's own error is affine in the largest coordinate m; enclosures widen places by a multiple of m
// (kPlaceRounding in kernels/kernels.h), and the row says how much wider still its position makes that.
#include "compile/formula.h"

#include <cmath>

#include "kernels/kernels.h"

namespace thalweg::compiler {
namespace {

using ops::Similarity;

constexpr double kRowUnits = 16;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

bool is_identity(const Similarity& s) {
  const Similarity none;
  return s.rotation == none.rotation && s.translation == none.translation && s.scale == 1;
}

class Lowering {
 public:
  Lowering(const formula::Formula& formula, const FormulaPlace& place, const std::function<int(Value)>& add)
      : steps_(formula.steps), place_(place), add_(add) {}

  int run() {
    for (const formula::Step& step : steps_) made_.push_back(value_of(step));
    if (made_.back() < 0) made_.back() = materialised(static_cast<int>(steps_.size()) - 1);
    if (place_.at.scale == 1) return made_.back();
    static const int kMul = ops::find_function("mul");
    // Composed scales have been rounded.
    const double scale = place_.at.scale;
    return add({.op = kMul,
                .a = made_.back(),
                .flags = Instruction::kImmediate | Instruction::kSwapped,
                .constants = {scale, scale * (1 - 0x1p-46), scale * (1 + 0x1p-46)}});
  }

 private:
  int add(Value value) {
    value.may_be_undefined = true;
    return add_(std::move(value));
  }

  [[nodiscard]] bool is_constant(int step) const { return steps_[index(step)].op == constant_op(); }
  static int constant_op() {
    static const int op = ops::find_function("constant");
    return op;
  }
  [[nodiscard]] std::vector<double> constants_of(int step) const {
    const formula::Step& of = steps_[index(step)];
    return {of.value, of.range.lo, of.range.hi};
  }

  /// The value's index; -1 for a constant, which is only written where an instruction cannot hold it.
  int value_of(const formula::Step& step) {
    if (step.op == constant_op()) return -1;
    if (step.axis >= 0) return coordinate(step);
    if (step.b >= 0 && is_constant(step.b)) {
      return add({.op = step.op,
                  .a = materialised(step.a),
                  .flags = Instruction::kImmediate | Instruction::kSwapped,
                  .constants = constants_of(step.b)});
    }
    if (step.b >= 0 && is_constant(step.a)) {
      return add({.op = step.op,
                  .a = made_[index(step.b)],
                  .flags = Instruction::kImmediate,
                  .constants = constants_of(step.a)});
    }
    return add({.op = step.op, .a = materialised(step.a), .b = step.b < 0 ? -1 : made_[index(step.b)]});
  }
  int materialised(int step) {
    int& made = made_[index(step)];
    if (made < 0) made = add({.op = constant_op(), .constants = constants_of(step)});
    return made;
  }

  /// q = R^T (p - t) / s, one row of it.
  int coordinate(const formula::Step& step) {
    const auto d = index(place_.dimension);
    const Similarity& at = place_.at;
    std::vector<double> row;
    double offset = 0;
    double size = 0;
    for (std::size_t axis = 0; axis < d; ++axis) {
      row.push_back(at.rotation[3 * axis + index(step.axis)] / at.scale);
      offset -= row.back() * at.translation[axis];
      size += std::fabs(at.translation[axis]) / at.scale;
    }
    const double units = is_identity(at) ? 0 : kRowUnits;
    const Affine& error = place_.made.error;
    double weight = 0;
    for (const double w : row) weight += std::fabs(w);
    const double owed = units * size + weight * error.a / kUnitRoundoff;
    row.insert(row.end(), {offset, units, owed, 1 + error.b / kPlaceRounding});
    const std::uint16_t flags = place_.position == 0 ? 0 : Instruction::kWarped;
    return add({.op = step.op, .position = place_.position, .flags = flags, .constants = std::move(row)});
  }

  const std::vector<formula::Step>& steps_;
  const FormulaPlace& place_;
  const std::function<int(Value)>& add_;
  std::vector<int> made_;  ///< per step: its value, -1 for constants not yet written
};

}  // namespace

int lower(const formula::Formula& formula, const FormulaPlace& place, const std::function<int(Value)>& add) {
  return Lowering(formula, place, add).run();
}

}  // namespace thalweg::compiler
