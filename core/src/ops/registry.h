// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The declarations of all ops as run-time rows: what the shape, parser and compiler stages ask of an op.
#pragma once

#include <optional>
#include <span>

#include "ops/declaration.h"

namespace thalweg::ops {

/// From lo to hi.
struct Range64 {
  double lo = 0, hi = 0;
};

/// One op. Function pointers that do not apply to its kind are null.
struct Entry {
  OpRow row;
  bool absorbs_rotation = false;
  bool has_support = false;
  bool is_unsigned = false;
  std::optional<Complaint> (*check)(Numbers) = nullptr;
  void (*derive)(Numbers, Constants64&) = nullptr;

  PrimitiveFacts (*primitive_facts)(Numbers) = nullptr;
  Bounds (*primitive_bounds)(Numbers) = nullptr;

  JoinedFacts (*join)(const Facts&, const Facts&, Numbers) = nullptr;
  BoundsRule bounds_rule = BoundsRule::hull;
  double (*widening)(Numbers) = nullptr;
  bool idempotent = false;  ///< op(a, a) = a
  Selection selection = Selection::least;
  bool blends = false;        ///< the first derived constant is the blend's width
  bool second_falls = false;  ///< in the second operand

  JoinedFacts (*operand_facts)(const Facts&, Numbers) = nullptr;  ///< map and warp
  double (*operand_level)(double, Numbers) = nullptr;             ///< map

  Similarity (*similarity)(Numbers) = nullptr;
  void (*derive_placement)(const Similarity&, Constants64&) = nullptr;

  Bounds (*preimage)(Bounds, Numbers) = nullptr;
  double stretch = 1;  ///< Lipschitz constant of a warp

  // Scalar ops.
  std::string_view opcode;  ///< in `.vm` programs
  int operands = 0;
  int axis = -1;         ///< of the query point's coordinate
  bool selects = false;  ///< returns one of its operands, by `selection`
  bool commutes = false;
  bool is_brief = false;                           ///< instructions of value programs take operands in every form
  bool takes_squares = false;                      ///< and their squares
  bool internal = false;                           ///< not part of the language
  double (*evaluate)(double, double) = nullptr;    ///< on numbers; the second one is ignored where there is none
  Range64 (*enclose)(Range64, Range64) = nullptr;  ///< rounded outward; NaN where it may be undefined
};

[[nodiscard]] std::span<const Entry> registry();

/// How many numbers the parameters of a row flatten to; a list counts as none.
[[nodiscard]] std::size_t number_count(const OpRow& row);

/// Rows with this name that may stand in a scene of this dimension, in the order of declaration.
[[nodiscard]] std::vector<int> find_ops(std::string_view name, int dimension);

/// The scalar op of that name, or of that opcode in `.vm` programs; -1 where there is none.
[[nodiscard]] int find_function(std::string_view name);
[[nodiscard]] int find_opcode(std::string_view opcode);
/// The coordinate of the query point.
[[nodiscard]] int axis_op(int axis);

/// The op `rigid` of that dimension: the instruction for a placement that a primitive cannot absorb.
[[nodiscard]] int rigid_op(int dimension);

}  // namespace thalweg::ops
