// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A formula: scalar ops on coordinates and constants, each on what stands before it. It is simplified as it is built,
// where that changes no real value: operations on constants are done, equal ones shared, x x is a square, and signs
// are moved into sums. A constant that was computed keeps the interval that the real one lies in.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>
#include <vector>

#include "ops/registry.h"
#include "thalweg/result.h"

namespace thalweg::formula {

/// One operation. Operands are indices of earlier steps, -1 where there is none.
struct Step {
  int op = -1;  ///< row of the registry, of kind scalar
  int a = -1;
  int b = -1;
  int axis = -1;         ///< coordinates
  double value = 0;      ///< constants
  ops::Range64 range{};  ///< constants: holds the real one
};

/// The last step is the result; every step is needed for it.
struct Formula {
  std::vector<Step> steps;

  [[nodiscard]] bool uses(int axis) const;
};

/// At most this many steps; a text that needs more is refused.
inline constexpr std::size_t kMostSteps = 200'000;

class Builder {
 public:
  int coordinate(int axis);
  int constant(double value);
  /// `b` is -1 for an op of one operand.
  int apply(int op, int a, int b = -1);
  [[nodiscard]] std::size_t size() const { return steps_.size(); }
  [[nodiscard]] Formula finish(int root) const;

 private:
  using Key = std::tuple<int, int, int, std::uint64_t>;

  int add(const Step& step);
  int computed_constant(double value, ops::Range64 range);
  /// What the operation is known to be without being done; -1: nothing.
  int folded(int op, int a, int b);
  int simpler_unary(int op, int a);
  int simpler_sum(int op, int a, int b);
  int simpler_product(int op, int a, int b);
  int whole_power(int a, double power);

  [[nodiscard]] const Step& at(int step) const { return steps_[static_cast<std::size_t>(step)]; }
  [[nodiscard]] bool is(int step, int op) const { return at(step).op == op; }
  [[nodiscard]] bool is_constant(int step) const;
  [[nodiscard]] bool is_number(int step, double value) const;

  std::vector<Step> steps_;
  std::map<Key, int> found_;
};

/// An expression over x, y and z: + - * / and the functions of the op table. Errors have line:column as their place.
[[nodiscard]] Result<Formula> parse_expression(std::string_view text);

/// A program in the form of `.vm` files: `NAME OPCODE ARGUMENTS`, one a line; the last one is the result.
[[nodiscard]] Result<Formula> parse_program(std::string_view text);

}  // namespace thalweg::formula
