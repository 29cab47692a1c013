// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Bounds are found per level t, {f <= t}: a smooth or rounded node at level 0 asks its operands for a higher one.
#include "shape/facts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "ops/registry.h"

namespace thalweg::shape {
namespace {

using ops::BoundsRule;
using ops::Entry;

const Entry& entry_of(const Shape& shape) { return ops::registry()[static_cast<std::size_t>(shape.op_index())]; }

Bounds joined(Bounds a, const Bounds& b, BoundsRule rule, int dimension) {
  if (rule == BoundsRule::first) return a;
  if (rule == BoundsRule::hull && a.empty(dimension)) return b;
  if (rule == BoundsRule::hull && b.empty(dimension)) return a;
  for (int axis = 0; axis < dimension; ++axis) {
    const bool hull = rule == BoundsRule::hull;
    a.lo[axis] = hull ? std::min(a.lo[axis], b.lo[axis]) : std::max(a.lo[axis], b.lo[axis]);
    a.hi[axis] = hull ? std::max(a.hi[axis], b.hi[axis]) : std::min(a.hi[axis], b.hi[axis]);
  }
  return a;
}

class LevelBounds {
 public:
  Bounds operator()(const Shape& shape, double level) {
    const auto key = std::pair(shape.identity(), level);
    if (const auto found = memo_.find(key); found != memo_.end()) return found->second;
    return memo_[key] = compute(shape, level);
  }

 private:
  /// Facts of operands are complete, so their level 0 is at hand.
  Bounds operand(const Shape& shape, double level) { return level == 0 ? shape.facts().bounds : (*this)(shape, level); }

  Bounds compute(const Shape& shape, double level) {
    const Entry& entry = entry_of(shape);
    if (entry.row.kind == OpKind::formula) return {};
    const int dimension = entry.row.kind == OpKind::primitive ? entry.row.dimension : shape.operands()[0].dimension();
    switch (entry.row.kind) {
      case OpKind::primitive:
        return ops::grown(entry.primitive_bounds(shape.parameters()), dimension, std::max(level, 0.0));
      case OpKind::combine:
        return fold(shape, entry, level, dimension);
      case OpKind::map:
        return operand(shape.operands()[0], entry.operand_level(level, shape.parameters()));
      case OpKind::place: {
        const ops::Similarity by = entry.similarity(shape.parameters());
        return image(operand(shape.operands()[0], level / by.scale), by, dimension);
      }
      case OpKind::warp:
        return entry.preimage(operand(shape.operands()[0], level), shape.parameters());
      case OpKind::formula:
      case OpKind::scalar:
        break;
    }
    return {};
  }

  /// The fold a, b, c, ... widens the level of earlier operands once per later operator.
  Bounds fold(const Shape& shape, const Entry& entry, double level, int dimension) {
    const auto of = shape.operands();
    const double widening = entry.widening(shape.parameters());
    Bounds all = operand(of[0], level + widening * static_cast<double>(of.size() - 1));
    for (std::size_t i = 1; i < of.size(); ++i) {
      const double at = level + widening * static_cast<double>(of.size() - i);
      all =
          joined(all, entry.bounds_rule == BoundsRule::first ? all : operand(of[i], at), entry.bounds_rule, dimension);
    }
    return all;
  }

  std::map<std::pair<const void*, double>, Bounds> memo_;
};

ops::JoinedFacts own_facts(const Shape& shape, const Entry& entry) {
  const auto of = shape.operands();
  const auto numbers = shape.parameters();
  if (entry.row.kind == OpKind::place) {
    const Facts& a = of[0].facts();
    return {a.outside, a.inside, a.convex, a.is_unsigned};
  }
  if (entry.row.kind != OpKind::combine) return entry.operand_facts(of[0].facts(), numbers);
  Facts folded = of[0].facts();
  for (std::size_t i = 1; i < of.size(); ++i) {
    const ops::JoinedFacts joined = entry.join(folded, of[i].facts(), numbers);
    folded.outside = joined.outside;
    folded.inside = joined.inside;
    folded.convex = joined.convex;
    folded.is_unsigned = joined.is_unsigned;
  }
  return {folded.outside, folded.inside, folded.convex, folded.is_unsigned};
}

}  // namespace

Bounds image(const Bounds& box, const ops::Similarity& by, int dimension) {
  if (box.empty(dimension)) return box;
  Bounds result;
  for (std::size_t row = 0; row < static_cast<std::size_t>(dimension); ++row) {
    double lo = by.translation[row];
    double hi = lo;
    for (std::size_t column = 0; column < static_cast<std::size_t>(dimension); ++column) {
      const double factor = by.rotation[3 * row + column] * by.scale;
      if (factor == 0) continue;
      lo += factor * (factor > 0 ? box.lo[column] : box.hi[column]);
      hi += factor * (factor > 0 ? box.hi[column] : box.lo[column]);
    }
    result.lo[row] = lo;
    result.hi[row] = hi;
  }
  return result;
}

Facts derive_facts(const Shape& shape) {
  const Entry& entry = entry_of(shape);
  Facts facts;
  if (entry.row.kind == OpKind::primitive) {
    const ops::PrimitiveFacts own = entry.primitive_facts(shape.parameters());
    facts = {entry.row.dimension, own.outside, own.inside, 1.0, own.convex, entry.is_unsigned, {}};
  } else if (entry.row.kind == OpKind::formula) {
    return {shape.dimension(), Exactness::sign_only, Exactness::sign_only, Bounds::kInfinity, false, false, {}};
  } else {
    const ops::JoinedFacts own = own_facts(shape, entry);
    facts = {shape.operands()[0].dimension(), own.outside, own.inside, 0.0, own.convex, own.is_unsigned, {}};
    for (const Shape& operand : shape.operands())
      facts.lipschitz = std::max(facts.lipschitz, operand.facts().lipschitz);
    facts.lipschitz *= entry.stretch;
  }
  facts.bounds = LevelBounds()(shape, 0);
  return facts;
}

Bounds level_bounds(const Shape& shape, double level) { return LevelBounds()(shape, level); }

}  // namespace thalweg::shape
