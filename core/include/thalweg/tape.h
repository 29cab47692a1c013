// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A compiled shape: an immutable program for an accumulator machine. Each instruction leaves its result in the
// accumulator and, when a later one needs it, in a register. A tape may be shared by any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "thalweg/shape.h"

namespace thalweg {

/// One step of a tape.
///   primitive  acc = field of op at position[operand], moved and, when kTurned is set, turned
///   combine    acc = op(register[operand], acc), the other way round when kSwapped is set
///   map        acc = op(acc)
///   scalar     acc = op(acc), op(register[operand], acc) as combine, op(constant, acc) when kImmediate is set, each
///              with register[first] for acc when kLoads is set; or a coordinate of position[operand], or a constant
///   load       acc = register[operand]
///   keep       leaves the accumulator as it is; in shortened tapes, where it is stored
///   warp       position[target] = op(position[operand]); the accumulator is left alone
struct Instruction {
  static constexpr std::uint16_t kNone = 0xffff;

  std::uint8_t op = 0;           ///< row of the op table, kLoad or kKeep
  std::uint8_t flags = 0;        ///< see the constants below
  std::uint16_t operand = 0;     ///< register or position read
  std::uint16_t first = 0;       ///< register read in place of the accumulator when kLoads is set
  std::uint16_t target = kNone;  ///< register or position written; kNone: the accumulator alone
  std::uint32_t constants = 0;   ///< first derived constant in the pools
  std::uint32_t constant_count = 0;

  static constexpr std::uint8_t kLoad = 0xfe;
  static constexpr std::uint8_t kKeep = 0xfd;
  static constexpr std::uint8_t kLoads = 1;      ///< the accumulator is first loaded from a register
  static constexpr std::uint8_t kSwapped = 2;    ///< the accumulator is the first operand
  static constexpr std::uint8_t kImmediate = 4;  ///< the other operand is the first constant, not a register
  static constexpr std::uint8_t kTurned =
      8;  ///< a primitive's constants begin with those of `rigid`, not a translation
  static constexpr std::uint8_t kWarped = 16;   ///< a primitive at a position other than the query point
  static constexpr std::uint8_t kSupport = 32;  ///< convex primitive with a support function, reached rigidly
  static constexpr std::uint8_t kDepth = 64;    ///< primitive of exact inside, reached rigidly

  // Of scalar instructions in a value program.
  static constexpr std::uint8_t kAffineFirst = 8;    ///< register[first] counts as w r + c: the third, fourth constant
  static constexpr std::uint8_t kAffineOther = 16;   ///< register[operand] does: the first, second
  static constexpr std::uint8_t kSquaredFirst = 32;  ///< and then as its square
  static constexpr std::uint8_t kSquaredOther = 64;
  static constexpr std::uint8_t kChangesFirst = kAffineFirst | kSquaredFirst;
  static constexpr std::uint8_t kChangesOther = kAffineOther | kSquaredOther;
};
static_assert(sizeof(Instruction) == 16);

/// What scalar tapes run for values alone: the same bits by fewer instructions (compile/fuse.cpp). Registers 0 to d - 1
/// are the coordinates of the query point. Empty where there is none.
struct ValueProgram {
  std::vector<Instruction> instructions;
  std::vector<float> constants;
  int register_count = 0;
};

/// a + b * m, where m is the largest coordinate magnitude of a query's region, in scene units.
struct Affine {
  double a = 0, b = 0;
  [[nodiscard]] double operator()(double m) const { return a + b * m; }
};

struct Tape {
  int dimension = 2;
  std::vector<Instruction> instructions;
  std::vector<float> constants;     ///< derived once from the parameters, in double, then rounded
  std::vector<double> constants64;  ///< the same before rounding, for evaluation in double
  int register_count = 0;
  int position_count = 1;     ///< position 0 is the query point
  Facts facts;                ///< of the root
  Affine slack;               ///< |float32 value - f| <= slack(m); f in double has 2^-29 of it; infinite with formulas
  Affine search_slack;        ///< the same for bounds over cells: value, centre, reach and their arithmetic
  Affine enclosure_slack;     ///< the same for intervals, which carry a formula's own rounding: finite
  bool has_formulas = false;  ///< there are scalar instructions: only intervals prove anything
  bool only_scalars = false;  ///< every instruction is scalar, a load or a keep
  bool has_support = false;   ///< some primitive has a support function, so enclosures beat f - L r
  ValueProgram values;

  /// The program, one instruction a line.
  [[nodiscard]] std::string disassembly() const;

  /// Takes a program that was shortened from its own.
  void shorten_to(std::span<const Instruction> program) {
    instructions.assign(program.begin(), program.end());
    values.instructions.clear();
  }
};

/// Compiles a shape: shares equal nodes, folds placements into primitives, orders operands, allocates registers.
[[nodiscard]] Result<Tape> compile(const Shape& shape);

/// f at one point in double precision by the twin of the float32 kernels; `gradient` (d numbers) may be null.
double evaluate_double(const Tape& tape, const double* point, double* gradient);

}  // namespace thalweg
