// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>

#include "formula/formula.h"

namespace thalweg::formula {
namespace {

/// The ops that rewriting knows.
struct Known {
  int coordinate = ops::find_function("coordinate");
  int constant = ops::find_function("constant");
  int neg = ops::find_function("neg");
  int abs = ops::find_function("abs");
  int square = ops::find_function("square");
  int sqrt = ops::find_function("sqrt");
  int add = ops::find_function("add");
  int sub = ops::find_function("sub");
  int mul = ops::find_function("mul");
  int div = ops::find_function("div");
  int pow = ops::find_function("pow");
};

const Known& known() {
  static const Known ops;
  return ops;
}

const ops::Entry& entry_of(int op) { return ops::registry()[static_cast<std::size_t>(op)]; }

/// Powers up to here are products.
constexpr double kMostPower = 16;

}  // namespace

bool Formula::uses(int axis) const {
  return std::ranges::any_of(steps, [&](const Step& step) { return step.axis == axis; });
}

bool Builder::is_constant(int step) const { return at(step).op == known().constant; }

bool Builder::is_number(int step, double value) const {
  return is_constant(step) && at(step).range.lo == value && at(step).range.hi == value;
}

int Builder::coordinate(int axis) { return add({.op = known().coordinate, .axis = axis}); }

int Builder::constant(double value) { return computed_constant(value, {value, value}); }

int Builder::computed_constant(double value, ops::Range64 range) {
  // One zero is enough: no function here tells its sign.
  return add({.op = known().constant, .value = value + 0.0, .range = range});
}

int Builder::add(const Step& step) {
  const Key key{step.op, step.a, step.axis >= 0 ? step.axis : step.b, std::bit_cast<std::uint64_t>(step.value)};
  const auto [found, is_new] = found_.try_emplace(key, static_cast<int>(steps_.size()));
  if (is_new) {
    steps_.push_back(step);
  } else if (step.op == known().constant) {
    // Two ways to compute one number: either real one lies in the wider interval.
    ops::Range64& range = steps_[static_cast<std::size_t>(found->second)].range;
    range = {std::min(range.lo, step.range.lo), std::max(range.hi, step.range.hi)};
  }
  return found->second;
}

int Builder::apply(int op, int a, int b) {
  int made = folded(op, a, b);
  if (made < 0 && b < 0) made = simpler_unary(op, a);
  if (made < 0 && b >= 0) made = simpler_sum(op, a, b);
  if (made < 0 && b >= 0) made = simpler_product(op, a, b);
  if (made >= 0) return made;
  if (entry_of(op).commutes && b < a) std::swap(a, b);
  return add({.op = op, .a = a, .b = b});
}

int Builder::folded(int op, int a, int b) {
  if (entry_of(op).selects && a == b) return a;
  if (!is_constant(a) || (b >= 0 && !is_constant(b))) return -1;
  const ops::Range64 range = entry_of(op).enclose(at(a).range, b < 0 ? ops::Range64{} : at(b).range);
  const double value = entry_of(op).evaluate(at(a).value, b < 0 ? 0 : at(b).value);
  // What is not defined, or overflows, stays to be found at every point.
  if (!(range.lo <= value && value <= range.hi) || !std::isfinite(range.lo) || !std::isfinite(range.hi)) return -1;
  return computed_constant(value, range);
}

int Builder::simpler_unary(int op, int a) {
  const Known& k = known();
  const Step of = at(a);
  if (op == k.neg && of.op == k.neg) return of.a;
  if (op == k.neg && of.op == k.sub) return apply(k.sub, of.b, of.a);
  // -(c + x) is (-c) - x
  if (op == k.neg && of.op == k.add && is_constant(of.a)) return apply(k.sub, apply(k.neg, of.a), of.b);
  if (op == k.neg && of.op == k.add && is_constant(of.b)) return apply(k.sub, apply(k.neg, of.b), of.a);
  if ((op == k.square || op == k.abs) && (of.op == k.neg || of.op == k.abs)) return apply(op, of.a);
  return -1;
}

int Builder::simpler_sum(int op, int a, int b) {
  const Known& k = known();
  if (op == k.add) {
    if (is(b, k.neg)) return apply(k.sub, a, at(b).a);
    if (is(a, k.neg)) return apply(k.sub, b, at(a).a);
    if (is_number(b, 0)) return a;
    if (is_number(a, 0)) return b;
  }
  if (op == k.sub) {
    if (is(b, k.neg)) return apply(k.add, a, at(b).a);
    if (is_number(b, 0)) return a;
    if (is_number(a, 0)) return apply(k.neg, b);
  }
  return -1;
}

int Builder::simpler_product(int op, int a, int b) {
  const Known& k = known();
  if (op == k.mul || op == k.div) {
    if (op == k.mul && a == b) return apply(k.square, a);
    if (is(a, k.neg) && is(b, k.neg)) return apply(op, at(a).a, at(b).a);
    if (is_number(b, 1)) return a;
    if (op == k.mul && is_number(a, 1)) return b;
  }
  if (op == k.div && is_constant(b)) {
    // Halves and their like have an exact reciprocal.
    int exponent = 0;
    const double divisor = at(b).value;
    const bool is_power = std::fabs(std::frexp(divisor, &exponent)) == 0.5 && std::abs(exponent) < 100;
    if (is_power && is_number(b, divisor)) return apply(k.mul, a, constant(1 / divisor));
  }
  if (op == k.pow && is_number(b, at(b).value)) return whole_power(a, at(b).value);
  return -1;
}

int Builder::whole_power(int a, double power) {
  const Known& k = known();
  if (power == 0.5) return apply(k.sqrt, a);
  if (power != std::floor(power) || power == 0 || std::fabs(power) > kMostPower) return -1;
  if (power < 0) return apply(k.div, constant(1), whole_power(a, -power));
  if (power == 1) return a;
  const int half = whole_power(a, std::floor(power / 2));
  const int square = apply(k.square, half);
  return std::fmod(power, 2) == 0 ? square : apply(k.mul, square, a);
}

Formula Builder::finish(int root) const {
  std::vector<int> index(static_cast<std::size_t>(root) + 1, -1);
  index.back() = 0;
  for (int i = root; i >= 0; --i) {
    if (index[static_cast<std::size_t>(i)] < 0) continue;
    for (const int operand : {at(i).a, at(i).b}) {
      if (operand >= 0) index[static_cast<std::size_t>(operand)] = 0;
    }
  }
  Formula formula;
  for (int i = 0; i <= root; ++i) {
    int& own = index[static_cast<std::size_t>(i)];
    if (own < 0) continue;
    own = static_cast<int>(formula.steps.size());
    Step step = at(i);
    if (step.a >= 0) step.a = index[static_cast<std::size_t>(step.a)];
    if (step.b >= 0) step.b = index[static_cast<std::size_t>(step.b)];
    formula.steps.push_back(step);
  }
  return formula;
}

}  // namespace thalweg::formula
