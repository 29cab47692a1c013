// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The op table as data: names, parameters with units and ranges, dimension, exactness. The parser, the JSON schema,
// `thalweg ops` and the generated builder functions all read it; the rows come from the one declaration of each op.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace thalweg {

enum class OpKind : std::uint8_t {
  primitive,  ///< a field of its own
  formula,    ///< a field given by a text; compiled to scalar ops
  scalar,     ///< an operation on numbers, within a formula
  combine,    ///< folds the fields of several operands, left to right
  map,        ///< changes the value of one operand
  place,      ///< a similarity: moves, turns or scales one operand
  warp,       ///< any other change of the point at which one operand is evaluated
};

/// How a parameter behaves under a similarity, and with it its unit.
enum class Quantity : std::uint8_t {
  length,      ///< scene units, scales
  point,       ///< scene units, moves, turns and scales
  direction,   ///< unit vector after reading, turns
  vector,      ///< scene units, a displacement or a size per axis
  angle,       ///< radians
  number,      ///< pure number
  count,       ///< whole number
  choice,      ///< one of a few words, stored as its index
  quaternion,  ///< w, x, y, z; normalised on reading
  text,        ///< characters, kept by the node itself
};

struct OpParameter {
  std::string_view name;
  Quantity quantity = Quantity::length;
  int arity = 1;     ///< how many numbers; 0: a list of points of the op's dimension
  double least = 0;  ///< smallest accepted number
  double most = 0;   ///< largest accepted number
  std::string_view meaning;
  std::string_view choices;  ///< for choice: the words, separated by '|'
  bool optional = false;
  double fallback = 0;    ///< value of each number when absent and optional
  bool implicit = false;  ///< carried by the node but not part of the language
};

struct OpRow {
  std::string_view name;
  OpKind kind = OpKind::primitive;
  int dimension = 0;  ///< 2, 3, or 0: that of its operands
  std::span<const OpParameter> parameters;
  std::string_view exactness;  ///< in words, for people
  std::string_view note;
  double rounding = 0;  ///< proven |float32 value - real value| <= rounding * eps * (size of the operation)
};

/// Every op that a scene's node can have, in the order of the opcodes.
[[nodiscard]] std::span<const OpRow> op_table();

/// What a formula is made of.
struct FunctionRow {
  std::string_view name;    ///< in the text of an `expression`
  std::string_view opcode;  ///< in a `.vm` program; empty where it has none
  int operands = 0;
  std::string_view meaning;
  double ulps = 0;  ///< |float32 value - real value| is at most this many units in the last place
};
[[nodiscard]] std::span<const FunctionRow> function_table();
[[nodiscard]] std::string_view name(OpKind kind);
[[nodiscard]] std::string_view name(Quantity quantity);

/// The C++ header thalweg/ops.h, generated from the table.
[[nodiscard]] std::string ops_header();

}  // namespace thalweg
