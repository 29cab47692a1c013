// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The compiler's first form: one record per distinct operation, in single static assignment. Placements are gone:
// they have been composed and folded into the primitives' constants or into the positions that primitives read.
#pragma once

#include <vector>

#include "ops/registry.h"
#include "thalweg/tape.h"

namespace thalweg::compiler {

/// A point at which primitives are evaluated; 0 is the query point.
struct Position {
  int op = -1;      ///< the place or warp that makes it, -1 for the query point
  int parent = -1;  ///< the position it is made from
  std::vector<double> constants;
  bool rigid = true;  ///< only rigid motions lie between it and the query point
  Affine reach;       ///< |point| <= reach(m)
  Affine error;       ///< rounding error of its float32 coordinates
};

/// A value of the field. Operands are indices of earlier records, -1 where there is none.
struct Value {
  int op = -1;
  int a = -1;
  int b = -1;                     ///< scalar ops with a constant operand have it among the constants
  int position = -1;              ///< primitives and coordinates
  std::uint8_t flags = 0;         ///< kSupport and kDepth of the instruction; kImmediate and kSwapped of a scalar one
  bool may_be_undefined = false;  ///< a formula has to do with it
  std::vector<double> constants = {};
  Affine size = {};   ///< |value| <= size(m), but for formulas
  Affine error = {};  ///< |float32 value - real value| <= error(m), but for the rounding of formulas
};

struct Ssa {
  int dimension = 2;
  std::vector<Position> positions;
  std::vector<Value> values;
  int root = -1;
  bool has_points_in_registers = false;  ///< a value program: the query point's coordinates are registers 0 to d - 1
};

/// At most this many operations; a scene that needs more is refused.
inline constexpr std::size_t kMostValues = 250'000;

[[nodiscard]] Result<Ssa> to_ssa(const Shape& shape);

/// Orders the operations, allocates registers and writes the tape.
[[nodiscard]] Result<Tape> to_tape(const Ssa& ssa, const Facts& facts);

/// The same values by fewer operations, all scalar and at the query point.
[[nodiscard]] Ssa fuse(const Ssa& ssa);
/// The program of what `fuse` returns; empty if it needs too many registers.
[[nodiscard]] ValueProgram to_value_program(const Ssa& fused);

}  // namespace thalweg::compiler
