// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Walks the shape with the similarity that places it. Equal operations at equal positions become one record, so a
// sub-shape that is used twice in the same place is computed once.
//
// Rounding (algorithms.md section 5): every record carries an affine bound, in the largest coordinate m of a query,
// on its float32 error. An operator that is 1-Lipschitz in its operands passes on the larger error and adds its own.
#include "compile/ssa.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "compile/formula.h"

namespace thalweg::compiler {
namespace {

using ops::Entry;
using ops::Similarity;

constexpr double kEps = 0x1p-24;
/// Squares below the smallest normal float32 vanish: an absolute error of its square root.
constexpr double kUnderflow = 0x1p-62;
/// Squares of lengths beyond this overflow float32.
constexpr double kMostExtent = 1e18;

const Entry& entry_of(int op) { return ops::registry()[static_cast<std::size_t>(op)]; }

Affine larger(Affine x, Affine y) { return {std::max(x.a, y.a), std::max(x.b, y.b)}; }
Affine plus(Affine x, Affine y) { return {x.a + y.a, x.b + y.b}; }
Affine times(double s, Affine x) { return {s * x.a, s * x.b}; }

/// See Declaration::rounding.
Affine combine_rounding(double rounding, Affine size, double extent) {
  return rounding == 0 ? Affine{} : plus(times(kEps, size), {rounding * kEps * extent, 0});
}

std::array<double, 3> rotated(const Similarity& s, const double* v, int dimension) {
  std::array<double, 3> out = {0, 0, 0};
  for (std::size_t row = 0; row < static_cast<std::size_t>(dimension); ++row) {
    for (std::size_t column = 0; column < static_cast<std::size_t>(dimension); ++column) {
      out[row] += s.rotation[3 * row + column] * v[column];
    }
  }
  return out;
}

/// outer after inner.
Similarity composed(const Similarity& outer, const Similarity& inner) {
  Similarity s;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      s.rotation[3 * row + column] = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        s.rotation[3 * row + column] += outer.rotation[3 * row + k] * inner.rotation[3 * k + column];
      }
    }
  }
  const auto turned = rotated(outer, inner.translation.data(), 3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    s.translation[axis] = outer.translation[axis] + outer.scale * turned[axis];
  }
  s.scale = outer.scale * inner.scale;
  return s;
}

bool rotates(const Similarity& s) { return s.rotation != Similarity().rotation; }
bool moves(const Similarity& s) { return rotates(s) || s.translation != Similarity().translation; }

double norm(std::span<const double> v) {
  double square = 0;
  for (const double x : v) square += x * x;
  return std::sqrt(square);
}

/// A primitive's numbers in the frame in which it is evaluated, and that frame's place.
struct Placed {
  std::vector<double> numbers;
  Similarity at;      ///< rotation left to do, translation of the frame's origin
  double extent = 0;  ///< size of the numbers, for rounding
};

class Flattener {
 public:
  explicit Flattener(int dimension) {
    ssa_.dimension = dimension;
    ssa_.positions.push_back({.op = -1,
                              .parent = -1,
                              .constants = {},
                              .rigid = true,
                              .reach = {0, std::sqrt(static_cast<double>(dimension))},
                              .error = {}});
  }

  Result<Ssa> run(const Shape& shape) {
    ssa_.root = walk(shape, {}, 0);
    if (hides_undefined_) guard_root();
    if (ssa_.values.size() >= kMostValues) {
      return Error{.file = "",
                   .place = "/shape",
                   .expected = "at most " + std::to_string(kMostValues) + " operations",
                   .found = "more"};
    }
    if (const double size = ssa_.values[static_cast<std::size_t>(ssa_.root)].size.a; !(size <= kMostExtent)) {
      return Error{.file = "",
                   .place = "/shape",
                   .expected = "sizes and places that add up to at most 1e18 once scaled",
                   .found = "more"};
    }
    return std::move(ssa_);
  }

 private:
  int walk(const Shape& shape, const Similarity& at, int position) {
    if (ssa_.values.size() >= kMostValues) return 0;
    std::array<double, 13> place{};
    std::copy(at.rotation.begin(), at.rotation.end(), place.begin());
    std::copy(at.translation.begin(), at.translation.end(), place.begin() + 9);
    place[12] = at.scale;
    const auto key = std::tuple(shape.identity(), place, position);
    if (const auto found = walked_.find(key); found != walked_.end()) return found->second;
    const int value = walk_new(shape, at, position);
    walked_.emplace(key, value);
    return value;
  }

  int walk_new(const Shape& shape, const Similarity& at, int position) {
    const Entry& entry = entry_of(shape.op_index());
    switch (entry.row.kind) {
      case OpKind::primitive:
        return primitive(shape, at, position);
      case OpKind::formula:
        return formula(shape, at, position);
      case OpKind::scalar:
        break;
      case OpKind::combine:
        return combine(shape, at, position);
      case OpKind::map:
        return map(shape, at, position);
      case OpKind::place:
        return walk(shape.operands()[0], composed(at, entry.similarity(shape.parameters())), position);
      case OpKind::warp: {
        const Similarity scale_left{.scale = at.scale};
        return walk(shape.operands()[0], scale_left, warp(shape, at, position));
      }
    }
    return -1;
  }

  // --- numbers under a similarity ---------------------------------------------------------------------------------

  static std::vector<double> scaled_numbers(const Shape& shape, double scale) {
    std::vector<double> numbers(shape.parameters().begin(), shape.parameters().end());
    std::size_t at = 0;
    for (const OpParameter& p : entry_of(shape.op_index()).row.parameters) {
      const std::size_t count = p.arity == 0 ? numbers.size() - at : static_cast<std::size_t>(p.arity);
      const bool scales =
          p.quantity == Quantity::length || p.quantity == Quantity::vector || p.quantity == Quantity::point;
      for (std::size_t i = at; scales && i < at + count; ++i) numbers[i] *= scale;
      at += count;
    }
    return numbers;
  }

  /// Turns points and directions, and makes the first point the origin of the frame.
  static void absorb_rotation(const OpRow& row, Placed& placed) {
    const auto dimension = static_cast<std::size_t>(row.dimension);
    bool anchored = false;
    std::array<double, 3> anchor = {0, 0, 0};
    std::size_t at = 0;
    for (const OpParameter& p : row.parameters) {
      const std::size_t count = p.arity == 0 ? placed.numbers.size() - at : static_cast<std::size_t>(p.arity);
      const bool turns = p.quantity == Quantity::point || p.quantity == Quantity::direction;
      for (std::size_t i = at; turns && i < at + count; i += dimension) {
        auto v = rotated(placed.at, &placed.numbers[i], row.dimension);
        if (p.quantity == Quantity::point && !anchored) anchor = v;
        anchored = anchored || p.quantity == Quantity::point;
        for (std::size_t axis = 0; axis < dimension; ++axis) {
          placed.numbers[i + axis] = v[axis] - (p.quantity == Quantity::point ? anchor[axis] : 0);
        }
      }
      at += count;
    }
    placed.at.rotation = Similarity().rotation;
    for (std::size_t axis = 0; axis < 3; ++axis) placed.at.translation[axis] += anchor[axis];
  }

  /// Lengths add up; a list of points counts with its farthest.
  static double extent(const OpRow& row, std::span<const double> numbers) {
    double sum = 0;
    std::size_t at = 0;
    for (const OpParameter& p : row.parameters) {
      const std::size_t count = p.arity == 0 ? numbers.size() - at : static_cast<std::size_t>(p.arity);
      const auto own = numbers.subspan(at, count);
      if (p.arity == 0) {
        double most = 0;
        for (std::size_t i = 0; i < count; i += 2) most = std::max(most, norm(own.subspan(i, 2)));
        sum += most;
      } else if (p.quantity <= Quantity::vector && p.quantity != Quantity::direction) {
        sum += norm(own);
      }
      at += count;
    }
    return sum;
  }

  // --- records ----------------------------------------------------------------------------------------------------

  int primitive(const Shape& shape, const Similarity& at, int position) {
    const Entry& entry = entry_of(shape.op_index());
    Placed placed{.numbers = scaled_numbers(shape, at.scale), .at = at, .extent = 0};
    if (entry.absorbs_rotation) absorb_rotation(entry.row, placed);
    placed.extent = extent(entry.row, placed.numbers);
    const bool turned = rotates(placed.at);
    const auto dimension = static_cast<std::size_t>(entry.row.dimension);
    const Position& where = ssa_.positions[static_cast<std::size_t>(position)];
    Value value{.op = shape.op_index(),
                .a = -1,
                .b = -1,
                .position = position,
                .flags = 0,
                .constants = {},
                .size = {},
                .error = where.error};
    entry.derive(placed.numbers, value.constants);
    std::vector<double> frame(placed.at.translation.begin(),
                              placed.at.translation.begin() + static_cast<std::ptrdiff_t>(dimension));
    if (turned) entry_of(ops::rigid_op(ssa_.dimension)).derive_placement(placed.at, frame);
    value.constants.insert(value.constants.begin(), frame.begin(), frame.end());
    const ops::PrimitiveFacts facts = entry.primitive_facts(shape.parameters());
    if (position != 0) value.flags |= Instruction::kWarped;
    if (where.rigid && facts.convex && entry.has_support) value.flags |= Instruction::kSupport;
    if (where.rigid && facts.inside == Exactness::exact) value.flags |= Instruction::kDepth;
    const Affine reach = plus(where.reach, {norm(placed.at.translation), 0});
    if (turned) {
      value.flags |= Instruction::kTurned;
      value.error = plus(value.error, times(entry_of(ops::rigid_op(ssa_.dimension)).row.rounding * kEps, reach));
    }
    value.size = plus(reach, {placed.extent, 0});
    value.error = plus(plus(times(entry.row.rounding * kEps, value.size), value.error), {kUnderflow, 0});
    return add(std::move(value));
  }

  int formula(const Shape& shape, const Similarity& at, int position) {
    const Position where = ssa_.positions[static_cast<std::size_t>(position)];
    const int made = lower(*shape.formula(), {at, position, where, ssa_.dimension},
                           [&](Value value) { return ssa_.values.size() < kMostValues ? add(std::move(value)) : 0; });
    if (ssa_.values[static_cast<std::size_t>(made)].may_be_undefined) formulas_.insert(made);
    return made;
  }

  int combine(const Shape& shape, const Similarity& at, int position) {
    const Entry& entry = entry_of(shape.op_index());
    const std::vector<double> numbers = scaled_numbers(shape, at.scale);
    std::vector<double> constants;
    entry.derive(numbers, constants);
    const double extent_here = extent(entry.row, numbers);
    int folded = walk(shape.operands()[0], at, position);
    for (std::size_t i = 1; i < shape.operands().size(); ++i) {
      const int next = walk(shape.operands()[i], at, position);
      if (entry.idempotent && next == folded) continue;
      const Value& a = ssa_.values[static_cast<std::size_t>(folded)];
      const Value& b = ssa_.values[static_cast<std::size_t>(next)];
      Value value{.op = shape.op_index(),
                  .a = folded,
                  .b = next,
                  .position = -1,
                  .flags = 0,
                  .constants = constants,
                  .size = plus(larger(a.size, b.size), {extent_here, 0}),
                  .error = {}};
      value.error = plus(larger(a.error, b.error), combine_rounding(entry.row.rounding, value.size, extent_here));
      value.may_be_undefined = a.may_be_undefined || b.may_be_undefined;
      hides_undefined_ = hides_undefined_ || value.may_be_undefined;
      folded = add(std::move(value));
    }
    return folded;
  }

  /// Comparisons of operators pass over what is undefined: the result asks for every formula once more.
  void guard_root() {
    static const int kGiven = ops::find_function("given");
    for (const int formula : formulas_) {
      const Value& of = ssa_.values[static_cast<std::size_t>(ssa_.root)];
      ssa_.root = add({.op = kGiven, .a = formula, .b = ssa_.root, .size = of.size, .error = of.error});
    }
  }

  int map(const Shape& shape, const Similarity& at, int position) {
    const Entry& entry = entry_of(shape.op_index());
    const std::vector<double> numbers = scaled_numbers(shape, at.scale);
    const int operand = walk(shape.operands()[0], at, position);
    const Value& a = ssa_.values[static_cast<std::size_t>(operand)];
    Value value{.op = shape.op_index(),
                .a = operand,
                .b = -1,
                .position = -1,
                .flags = 0,
                .may_be_undefined = a.may_be_undefined,
                .constants = {},
                .size = plus(a.size, {extent(entry.row, numbers), 0}),
                .error = {}};
    value.error = plus(a.error, times(entry.row.rounding * kEps, value.size));
    entry.derive(numbers, value.constants);
    return add(std::move(value));
  }

  int rigid(const Similarity& at, int position) {
    const int op = ops::rigid_op(ssa_.dimension);
    const Position& parent = ssa_.positions[static_cast<std::size_t>(position)];
    Position made{.op = op, .parent = position, .constants = {}, .rigid = parent.rigid, .reach = {}, .error = {}};
    entry_of(op).derive_placement(at, made.constants);
    made.reach = plus(parent.reach, {norm(at.translation), 0});
    made.error = plus(parent.error, times(entry_of(op).row.rounding * kEps, made.reach));
    return add(std::move(made));
  }

  int warp(const Shape& shape, const Similarity& at, int position) {
    if (moves(at)) position = rigid(at, position);
    const Entry& entry = entry_of(shape.op_index());
    const Position& parent = ssa_.positions[static_cast<std::size_t>(position)];
    Position made{.op = shape.op_index(),
                  .parent = position,
                  .constants = {},
                  .rigid = false,
                  .reach = times(entry.stretch, parent.reach),
                  .error = times(entry.stretch, parent.error)};
    made.error = plus(made.error, times(entry.row.rounding * kEps, made.reach));
    entry.derive(scaled_numbers(shape, at.scale), made.constants);
    return add(std::move(made));
  }

  int add(Position position) {
    auto key = std::tuple(position.op, position.parent, position.constants);
    const auto [found, is_new] = position_of_.try_emplace(std::move(key), static_cast<int>(ssa_.positions.size()));
    if (is_new) ssa_.positions.push_back(std::move(position));
    return found->second;
  }

  int add(Value value) {
    auto key = std::tuple(value.op, value.a, value.b, value.position, value.flags, value.constants);
    const auto [found, is_new] = value_of_.try_emplace(std::move(key), static_cast<int>(ssa_.values.size()));
    if (is_new) ssa_.values.push_back(std::move(value));
    return found->second;
  }

  Ssa ssa_;
  std::set<int> formulas_;
  bool hides_undefined_ = false;  ///< some operator takes a formula among its operands
  std::map<std::tuple<const void*, std::array<double, 13>, int>, int> walked_;
  std::map<std::tuple<int, int, std::vector<double>>, int> position_of_;
  std::map<std::tuple<int, int, int, int, std::uint8_t, std::vector<double>>, int> value_of_;
};

}  // namespace

Result<Ssa> to_ssa(const Shape& shape) { return Flattener(shape.dimension()).run(shape); }

}  // namespace thalweg::compiler
