// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What an op declares of itself besides its mathematics. An op is one `THALWEG_OP` block in one of the .inl files of
// this folder; everything else (table, parser, schema, builder, compiler, kernels, tests) reads that block.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "thalweg/op_table.h"
#include "thalweg/shape.h"

namespace thalweg::ops {

/// Lengths stay within [1e-15, 1e15] so that no square over- or underflows float32 beyond what the slack covers.
inline constexpr double kSmallest = 1e-15;
inline constexpr double kLargest = 1e15;

/// The flattened numbers of one node, in the order of its declared parameters.
using Numbers = std::span<const double>;

/// Why a set of parameters is refused although each number is in range.
struct Complaint {
  std::string_view parameter;
  std::string_view expected;
};

/// Facts of a primitive that may depend on its parameters.
struct PrimitiveFacts {
  Exactness outside = Exactness::exact;
  Exactness inside = Exactness::exact;
  bool convex = false;
};

/// Facts that an operator derives from its operands; dimension, bounds and Lipschitz constant are derived for it.
struct JoinedFacts {
  Exactness outside = Exactness::exact;
  Exactness inside = Exactness::exact;
  bool convex = false;
  bool is_unsigned = false;
};

constexpr Exactness weaker(Exactness a, Exactness b) { return a < b ? b : a; }

/// How the level box of a combining op follows from those of its operands.
enum class BoundsRule : std::uint8_t { hull, meet, first };

/// The one operand that a combining op returns, bit for bit, where its operands (the second one negated if the op falls
/// in it) are further apart than the blend's width, which is the first derived constant where the op blends.
enum class Selection : std::uint8_t { least, greatest };

/// x -> rotation (x scale) + translation; rotation is row-major, orthonormal with determinant 1.
struct Similarity {
  std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> translation = {0, 0, 0};
  double scale = 1;
};

struct Declaration {
  std::string_view name;
  OpKind kind = OpKind::primitive;
  int dimension = 0;
  std::string_view exactness;
  std::string_view note = "";
  /// Rounding error of one float32 evaluation in units of eps * (|local point| + |translation| + sizes), for map
  /// operators of eps * (|operand value| + sizes), for combining ones of eps * sizes beside one rounding of the result,
  /// and 0 for a mere choice; for scalar ops in units in the last place. Held against the oracle by the conformance
  /// tests.
  double rounding = 8;
  /// The parameters describe the op in any orientation (points, directions, or full symmetry): rotations need no
  /// instruction of their own.
  bool absorbs_rotation = false;
  bool is_unsigned = false;  ///< a primitive whose f is never negative
  /// Scalar ops: the name in `.vm` programs, empty for those that have none.
  std::string_view opcode = "";
};

consteval OpParameter size(std::string_view name, std::string_view meaning, int arity = 1) {
  return {.name = name,
          .quantity = arity == 1 ? Quantity::length : Quantity::vector,
          .arity = arity,
          .least = kSmallest,
          .most = kLargest,
          .meaning = meaning,
          .choices = ""};
}

consteval OpParameter size_or_zero(std::string_view name, std::string_view meaning, int arity = 1) {
  return {.name = name,
          .quantity = arity == 1 ? Quantity::length : Quantity::vector,
          .arity = arity,
          .least = 0,
          .most = kLargest,
          .meaning = meaning,
          .choices = ""};
}

consteval OpParameter signed_length(std::string_view name, std::string_view meaning) {
  return {.name = name,
          .quantity = Quantity::length,
          .arity = 1,
          .least = -kLargest,
          .most = kLargest,
          .meaning = meaning,
          .choices = ""};
}

consteval OpParameter point(std::string_view name, std::string_view meaning, int arity) {
  return {.name = name,
          .quantity = Quantity::point,
          .arity = arity,
          .least = -kLargest,
          .most = kLargest,
          .meaning = meaning,
          .choices = ""};
}

consteval OpParameter ranged(std::string_view name, Quantity quantity, double least, double most,
                             std::string_view meaning) {
  return {
      .name = name, .quantity = quantity, .arity = 1, .least = least, .most = most, .meaning = meaning, .choices = ""};
}

consteval OpParameter direction(std::string_view name, std::string_view meaning, int arity) {
  return {.name = name,
          .quantity = Quantity::direction,
          .arity = arity,
          .least = -kLargest,
          .most = kLargest,
          .meaning = meaning,
          .choices = ""};
}

/// Derived constants are appended here once per placed node.
using Constants64 = std::vector<double>;

inline Bounds box_bounds(std::initializer_list<double> lo, std::initializer_list<double> hi) {
  Bounds bounds;
  std::size_t i = 0;
  for (const double v : lo) bounds.lo[i++] = v;
  i = 0;
  for (const double v : hi) bounds.hi[i++] = v;
  return bounds;
}

/// The smallest box around points stored x, y(, z), x, y(, z), ...
inline Bounds point_bounds(Numbers points, int dimension) {
  Bounds bounds;
  for (int axis = 0; axis < dimension; ++axis) {
    bounds.lo[axis] = Bounds::kInfinity;
    bounds.hi[axis] = -Bounds::kInfinity;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto axis = i % static_cast<std::size_t>(dimension);
    if (points[i] < bounds.lo[axis]) bounds.lo[axis] = points[i];
    if (points[i] > bounds.hi[axis]) bounds.hi[axis] = points[i];
  }
  return bounds;
}

inline Bounds grown(Bounds bounds, int dimension, double by) {
  for (int axis = 0; axis < dimension; ++axis) {
    bounds.lo[axis] -= by;
    bounds.hi[axis] += by;
  }
  return bounds;
}

}  // namespace thalweg::ops
