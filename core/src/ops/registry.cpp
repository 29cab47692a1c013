// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Collects each op's declaration into a row, taking what the op offers and leaving the rest null.
#include "ops/registry.h"

#include <algorithm>
#include <string>

#include "ops/all.inl"

namespace thalweg {
namespace ops {
namespace {

template <class Op>
void fill_primitive(Entry& entry) {
  entry.derive = &Op::derive;
  entry.primitive_facts = &Op::facts;
  entry.primitive_bounds = &Op::bounds;
  using Lane = HWY_NAMESPACE::Real;
  using C = HWY_NAMESPACE::Constants<Lane>;
  if constexpr (Op::kDeclaration.dimension == 2) {
    entry.has_support = requires(HWY_NAMESPACE::Point<Lane, 2> u, C c) { Op::support(u, c); };
  } else {
    entry.has_support = requires(HWY_NAMESPACE::Point<Lane, 3> u, C c) { Op::support(u, c); };
  }
}

template <class Op>
void fill_operator(Entry& entry) {
  if constexpr (Op::kDeclaration.kind == OpKind::combine) {
    entry.derive = &Op::derive;
    entry.join = &Op::join;
    entry.bounds_rule = Op::kBounds;
    entry.widening = &Op::widening;
    entry.idempotent = Op::kIdempotent;
    entry.selection = Op::kSelection;
    entry.blends = Op::kBlends;
    entry.second_falls = Op::kTrend[1] < 0;
  } else if constexpr (Op::kDeclaration.kind == OpKind::map) {
    entry.derive = &Op::derive;
    entry.operand_facts = &Op::facts;
    entry.operand_level = &Op::operand_level;
  } else if constexpr (Op::kDeclaration.kind == OpKind::place) {
    entry.similarity = &Op::similarity;
    if constexpr (requires(Similarity s, Constants64 c) { Op::derive(s, c); }) entry.derive_placement = &Op::derive;
  } else {
    entry.derive = &Op::derive;
    entry.operand_facts = &Op::facts;
    entry.preimage = &Op::preimage;
    entry.stretch = Op::kStretch;
  }
}

template <class Op>
void fill_scalar(Entry& entry) {
  using HWY_NAMESPACE::Field;
  using HWY_NAMESPACE::Interval;
  using HWY_NAMESPACE::Real;
  entry.opcode = Op::kDeclaration.opcode;
  entry.operands = Op::kOperands;
  if constexpr (requires { Op::kOfAxis; }) entry.axis = Op::kOfAxis;
  entry.commutes = requires { Op::kCommutes; };
  entry.is_brief = Op::kIsBrief;
  entry.takes_squares = Op::kTakesSquares;
  entry.internal = Op::kOperands == 0 || requires { Op::kInternal; };
  if constexpr (requires { Op::kSelection; }) {
    entry.selects = true;
    entry.selection = Op::kSelection;
  }
  if constexpr (Op::kOperands == 1) {
    entry.evaluate = [](double a, double) { return Op::apply(Field<Real, 2>{{a}, {}}).value.v; };
    entry.enclose = [](Range64 a, Range64) {
      const Interval<Real> found = Op::enclose(Interval<Real>{{a.lo}, {a.hi}});
      return Range64{found.lo.v, found.hi.v};
    };
  } else if constexpr (Op::kOperands == 2) {
    entry.evaluate = [](double a, double b) {
      return Op::apply(Field<Real, 2>{{a}, {}}, Field<Real, 2>{{b}, {}}).value.v;
    };
    entry.enclose = [](Range64 a, Range64 b) {
      const Interval<Real> found = Op::enclose(Interval<Real>{{a.lo}, {a.hi}}, Interval<Real>{{b.lo}, {b.hi}});
      return Range64{found.lo.v, found.hi.v};
    };
  }
}

template <class Op>
Entry make_entry() {
  constexpr const Declaration& declared = Op::kDeclaration;
  Entry entry;
  entry.row = {.name = declared.name,
               .kind = declared.kind,
               .dimension = declared.dimension,
               .parameters = Op::kParameters,
               .exactness = declared.exactness,
               .note = declared.note,
               .rounding = declared.rounding};
  entry.absorbs_rotation = declared.absorbs_rotation;
  entry.is_unsigned = declared.is_unsigned;
  if constexpr (requires(Numbers p) { Op::check(p); }) entry.check = &Op::check;
  if constexpr (declared.kind == OpKind::primitive) {
    fill_primitive<Op>(entry);
  } else if constexpr (declared.kind == OpKind::scalar) {
    fill_scalar<Op>(entry);
  } else if constexpr (declared.kind != OpKind::formula) {
    fill_operator<Op>(entry);
  }
  return entry;
}

std::vector<Entry> make_registry() {
  std::vector<Entry> entries;
  HWY_NAMESPACE::for_each_op([&]<class Op>(int) { entries.push_back(make_entry<Op>()); });
  return entries;
}

}  // namespace

std::span<const Entry> registry() {
  static const std::vector<Entry> entries = make_registry();
  return entries;
}

std::size_t number_count(const OpRow& row) {
  std::size_t count = 0;
  for (const OpParameter& parameter : row.parameters) count += static_cast<std::size_t>(parameter.arity);
  return count;
}

std::vector<int> find_ops(std::string_view name, int dimension) {
  std::vector<int> found;
  int index = 0;
  for (const Entry& entry : registry()) {
    if (entry.row.kind != OpKind::scalar && entry.row.name == name &&
        (entry.row.dimension == 0 || entry.row.dimension == dimension)) {
      found.push_back(index);
    }
    ++index;
  }
  return found;
}

int find_function(std::string_view name) {
  const auto fits = [&](const Entry& entry) { return entry.row.kind == OpKind::scalar && entry.row.name == name; };
  const auto found = std::ranges::find_if(registry(), fits);
  return found == registry().end() ? -1 : static_cast<int>(found - registry().begin());
}

int find_opcode(std::string_view opcode) {
  const auto fits = [&](const Entry& entry) { return !opcode.empty() && entry.opcode == opcode; };
  const auto found = std::ranges::find_if(registry(), fits);
  return found == registry().end() ? -1 : static_cast<int>(found - registry().begin());
}

int axis_op(int axis) {
  static const int found[] = {find_function("x"), find_function("y"), find_function("z")};
  return found[axis];
}

int rigid_op(int dimension) {
  static const int found[] = {find_ops("rigid", 2).front(), find_ops("rigid", 3).front()};
  return found[dimension - 2];
}

}  // namespace ops

std::span<const OpRow> op_table() {
  static const std::vector<OpRow> rows = [] {
    std::vector<OpRow> all;
    for (const ops::Entry& entry : ops::registry()) {
      if (entry.row.kind != OpKind::scalar) all.push_back(entry.row);
    }
    return all;
  }();
  return rows;
}

std::span<const FunctionRow> function_table() {
  static const std::vector<FunctionRow> rows = [] {
    std::vector<FunctionRow> all;
    for (const ops::Entry& entry : ops::registry()) {
      if (entry.row.kind != OpKind::scalar || entry.internal) continue;
      all.push_back({entry.row.name, entry.opcode, entry.operands, entry.row.note, entry.row.rounding});
    }
    return all;
  }();
  return rows;
}

std::string_view name(OpKind kind) {
  static constexpr std::string_view kNames[] = {"primitive", "formula", "scalar", "combine", "map", "place", "warp"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string_view name(Quantity quantity) {
  static constexpr std::string_view kNames[] = {"length", "point", "direction", "vector",     "angle",
                                                "number", "count", "choice",    "quaternion", "text"};
  return kNames[static_cast<std::size_t>(quantity)];
}

}  // namespace thalweg
