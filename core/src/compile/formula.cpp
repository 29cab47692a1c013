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
#include <limits>

#include "kernels/kernels.h"

namespace thalweg::compiler {
namespace {

using ops::Similarity;

constexpr double kRowUnits = 16;
/// Wherever a query may be, with room for what it looks at around itself.
constexpr double kAnywhere = 16 * static_cast<double>(kLargestCoordinate);
/// Between these no operation on two numbers overflows but their product, which is beyond these then.
constexpr double kMostNumber = 1e38;

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
    for (const formula::Step& step : steps_) {
      range_.push_back(range_of(step));
      made_.push_back(value_of(step));
    }
    if (made_.back() < 0) made_.back() = materialised(static_cast<int>(steps_.size()) - 1);
    if (place_.at.scale == 1) return made_.back();
    static const int kMul = ops::find_function("mul");
    // Composed scales have been rounded.
    const double scale = place_.at.scale;
    range_.push_back({scale * range_.back().lo, scale * range_.back().hi});
    return add({.op = kMul,
                .a = made_.back(),
                .flags = Instruction::kImmediate | Instruction::kSwapped,
                .constants = {scale, scale * (1 - 0x1p-46), scale * (1 + 0x1p-46)}});
  }

 private:
  int add(Value value) {
    value.may_be_undefined = !is_number(range_.back());
    return add_(std::move(value));
  }

  /// Of what float32 computes for it wherever a query may be; NaN where that may be no number.
  [[nodiscard]] ops::Range64 range_of(const formula::Step& step) const {
    if (step.op == constant_op()) return step.range;
    if (step.axis >= 0) {
      const auto [weight, size] = row_sizes(step.axis);
      const double most = 2 * (weight * (kAnywhere + place_.made.reach(kAnywhere)) + size);
      return {-most, most};
    }
    const ops::Range64 a = range_[index(step.a)], b = range_[index(step.b < 0 ? step.a : step.b)];
    const ops::Range64 range = ops::registry()[index(step.op)].enclose(a, b);
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    return is_number(a) && is_number(b) && is_number(range) ? range : ops::Range64{kNan, kNan};
  }
  static bool is_number(const ops::Range64& range) { return -kMostNumber <= range.lo && range.hi <= kMostNumber; }

  /// The op that computes the step: a choice between numbers need not ask whether they are.
  [[nodiscard]] int op_of(const formula::Step& step) const {
    static const int kMin = ops::find_function("min"), kMax = ops::find_function("max");
    static const int kLeast = ops::find_function("least"), kGreatest = ops::find_function("greatest");
    if (step.b < 0 || !is_number(range_[index(step.a)]) || !is_number(range_[index(step.b)])) return step.op;
    return step.op == kMin ? kLeast : step.op == kMax ? kGreatest : step.op;
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
    const int op = op_of(step);
    if (step.b >= 0 && is_constant(step.b)) {
      return add({.op = op,
                  .a = materialised(step.a),
                  .flags = Instruction::kImmediate | Instruction::kSwapped,
                  .constants = constants_of(step.b)});
    }
    if (step.b >= 0 && is_constant(step.a)) {
      const std::uint8_t swapped = ops::registry()[index(op)].commutes ? Instruction::kSwapped : 0;
      return add({.op = op,
                  .a = made_[index(step.b)],
                  .flags = static_cast<std::uint8_t>(Instruction::kImmediate | swapped),
                  .constants = constants_of(step.a)});
    }
    return add({.op = op, .a = materialised(step.a), .b = step.b < 0 ? -1 : made_[index(step.b)]});
  }
  int materialised(int step) {
    int& made = made_[index(step)];
    if (made < 0) made = add({.op = constant_op(), .constants = constants_of(step)});
    return made;
  }

  struct RowSizes {
    double weight, size;  ///< sums of the magnitudes of the weights, and of the translation over the scale
  };
  [[nodiscard]] RowSizes row_sizes(int of) const {
    RowSizes sizes{};
    for (std::size_t axis = 0; axis < index(place_.dimension); ++axis) {
      sizes.weight += std::fabs(place_.at.rotation[3 * axis + index(of)] / place_.at.scale);
      sizes.size += std::fabs(place_.at.translation[axis]) / place_.at.scale;
    }
    return sizes;
  }

  /// q = R^T (p - t) / s, one row of it.
  int coordinate(const formula::Step& step) {
    if (is_identity(place_.at) && place_.position == 0) return add({.op = ops::axis_op(step.axis), .position = 0});
    const auto d = index(place_.dimension);
    const Similarity& at = place_.at;
    std::vector<double> row;
    double offset = 0;
    for (std::size_t axis = 0; axis < d; ++axis) {
      row.push_back(at.rotation[3 * axis + index(step.axis)] / at.scale);
      offset -= row.back() * at.translation[axis];
    }
    const auto [weight, size] = row_sizes(step.axis);
    const double units = is_identity(at) ? 0 : kRowUnits;
    const Affine& error = place_.made.error;
    const double owed = units * size + weight * error.a / kUnitRoundoff;
    row.insert(row.end(), {offset, units, owed, 1 + error.b / kPlaceRounding});
    const std::uint8_t flags = place_.position == 0 ? 0 : Instruction::kWarped;
    return add({.op = step.op, .position = place_.position, .flags = flags, .constants = std::move(row)});
  }

  const std::vector<formula::Step>& steps_;
  const FormulaPlace& place_;
  const std::function<int(Value)>& add_;
  std::vector<ops::Range64> range_;  ///< per step
  std::vector<int> made_;            ///< per step: its value, -1 for constants not yet written
};

}  // namespace

int lower(const formula::Formula& formula, const FormulaPlace& place, const std::function<int(Value)>& add) {
  return Lowering(formula, place, add).run();
}

}  // namespace thalweg::compiler
