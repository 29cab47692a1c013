// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Collects each op's declaration into a row, taking what the op offers and leaving the rest null.
#include "ops/registry.h"

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
  } else {
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
    if (entry.row.name == name && (entry.row.dimension == 0 || entry.row.dimension == dimension)) {
      found.push_back(index);
    }
    ++index;
  }
  return found;
}

int rigid_op(int dimension) {
  static const int found[] = {find_ops("rigid", 2).front(), find_ops("rigid", 3).front()};
  return found[dimension - 2];
}

}  // namespace ops

std::span<const OpRow> op_table() {
  static const std::vector<OpRow> rows = [] {
    std::vector<OpRow> all;
    for (const ops::Entry& entry : ops::registry()) all.push_back(entry.row);
    return all;
  }();
  return rows;
}

std::string_view name(OpKind kind) {
  static constexpr std::string_view kNames[] = {"primitive", "combine", "map", "place", "warp"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string_view name(Quantity quantity) {
  static constexpr std::string_view kNames[] = {"length", "point", "direction", "vector",    "angle",
                                                "number", "count", "choice",    "quaternion"};
  return kNames[static_cast<std::size_t>(quantity)];
}

}  // namespace thalweg
