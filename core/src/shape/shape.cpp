// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Nodes are checked and given their facts when they are made, so that every Shape that exists is valid.
#include "thalweg/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <unordered_set>

#include "ops/registry.h"
#include "shape/facts.h"
#include "shape/node.h"
#include "shape/validate.h"
#include "thalweg/ops.h"

namespace thalweg {

std::string to_string(const Error& error) {
  std::string line;
  if (!error.file.empty()) line += error.file + ": ";
  if (!error.place.empty()) line += error.place + ": ";
  return line + "expected " + error.expected + ", found " + error.found;
}

std::string_view name(Exactness exactness) {
  static constexpr std::string_view kNames[] = {"exact", "lower bound", "sign only"};
  return kNames[static_cast<std::size_t>(exactness)];
}

bool Bounds::empty(int dimension) const {
  for (int axis = 0; axis < dimension; ++axis) {
    if (lo[axis] > hi[axis]) return true;
  }
  return false;
}

bool Bounds::finite(int dimension) const {
  for (int axis = 0; axis < dimension; ++axis) {
    if (!std::isfinite(lo[axis]) || !std::isfinite(hi[axis])) return false;
  }
  return true;
}

double Bounds::diagonal(int dimension) const {
  if (empty(dimension)) return 0;
  double square = 0;
  for (int axis = 0; axis < dimension; ++axis) square += (hi[axis] - lo[axis]) * (hi[axis] - lo[axis]);
  return std::sqrt(square);
}

Result<Shape> Shape::make(std::string_view op, int dimension, std::span<const double> parameters, std::vector<Shape> of,
                          int variant) {
  const std::vector<int> rows = ops::find_ops(op, dimension);
  if (static_cast<std::size_t>(variant) >= rows.size()) {
    return Error{.file = "",
                 .place = "op",
                 .expected = "an op of dimension " + std::to_string(dimension),
                 .found = "\"" + std::string(op) + "\""};
  }
  return make(rows[static_cast<std::size_t>(variant)], parameters, std::move(of));
}

Result<Shape> Shape::make(int op_index, std::span<const double> parameters, std::vector<Shape> of) {
  const ops::Entry& entry = ops::registry()[static_cast<std::size_t>(op_index)];
  auto node = std::make_shared<Node>();
  node->op = op_index;
  node->parameters.assign(parameters.begin(), parameters.end());
  if (auto error = shape::validate(entry, node->parameters, of)) return *std::move(error);
  for (const Shape& operand : of) node->depth = std::max(node->depth, operand.node_->depth + 1);
  if (node->depth > kDeepest) {
    return Error{.file = "",
                 .place = "of",
                 .expected = "nodes nested at most " + std::to_string(kDeepest) + " deep",
                 .found = "deeper ones"};
  }
  node->operands = std::move(of);
  Shape made{std::move(node)};
  const_cast<Node&>(*made.node_).facts = shape::derive_facts(made);  // the node is not shared yet
  return made;
}

Result<Shape> Shape::formula(std::string_view op, int dimension, std::string_view text) {
  const std::vector<int> rows = ops::find_ops(op, dimension);
  const bool is_formula =
      !rows.empty() && ops::registry()[static_cast<std::size_t>(rows[0])].row.kind == OpKind::formula;
  if (!is_formula) {
    return Error{.file = "", .place = "op", .expected = "expression or vm", .found = "\"" + std::string(op) + "\""};
  }
  auto made = op == "vm" ? formula::parse_program(text) : formula::parse_expression(text);
  if (!made) return made.error();
  if (dimension == 2 && made->uses(2)) {
    return Error{.file = "", .place = "", .expected = "a formula of x and y in a scene of dimension 2", .found = "z"};
  }
  auto node = std::make_shared<Node>();
  node->op = rows[0];
  node->text = text;
  node->facts.dimension = dimension != 0 ? dimension : made->uses(2) ? 3 : 2;
  node->formula = *std::move(made);
  Shape shape{node};
  node->facts = shape::derive_facts(shape);
  return shape;
}

std::string_view Shape::text() const { return node_->text; }
const formula::Formula* Shape::formula() const { return node_->formula.steps.empty() ? nullptr : &node_->formula; }
const Facts& Shape::facts() const { return node_->facts; }
std::string_view Shape::op() const { return ops::registry()[static_cast<std::size_t>(node_->op)].row.name; }
int Shape::op_index() const { return node_->op; }
std::span<const double> Shape::parameters() const { return node_->parameters; }
std::span<const Shape> Shape::operands() const { return node_->operands; }
const void* Shape::identity() const { return node_.get(); }
Bounds Shape::level_bounds(double level) const { return shape::level_bounds(*this, level); }

namespace {

/// For nodes that are valid by construction unless the caller broke a documented range.
Shape made(Result<Shape> result) {
  if (!result) throw std::invalid_argument(to_string(result.error()));
  return std::move(result).value();
}

/// `a op b`, continuing a's own list of operands when a is the same op.
Shape folded(std::string_view op, const Shape& a, const Shape& b) {
  std::vector<Shape> of;
  if (a.op() == op) {
    of.assign(a.operands().begin(), a.operands().end());
  } else {
    of.push_back(a);
  }
  of.push_back(b);
  return made(Shape::make(op, a.dimension(), {}, std::move(of)));
}

}  // namespace

Shape Shape::translate(Vec2 by) const { return made(make("translate", 2, std::array{by.x, by.y}, {*this})); }
Shape Shape::translate(Vec3 by) const { return made(make("translate", 3, std::array{by.x, by.y, by.z}, {*this})); }
Shape Shape::rotate(double angle) const { return made(make("rotate", 2, std::array{angle}, {*this})); }
Shape Shape::rotate(Vec3 axis, double angle) const {
  return made(make("rotate", 3, std::array{axis.x, axis.y, axis.z, angle}, {*this}));
}
Shape Shape::scale(double factor) const { return made(make("scale", dimension(), std::array{factor}, {*this})); }

Shape operator|(const Shape& a, const Shape& b) { return folded("union", a, b); }
Shape operator&(const Shape& a, const Shape& b) { return folded("intersection", a, b); }
Shape operator-(const Shape& a, const Shape& b) { return folded("subtraction", a, b); }

Shape builder::made(std::string_view op, int dimension, std::span<const double> numbers, std::vector<Shape> of,
                    int variant) {
  if (dimension == kOfOperands) dimension = of.empty() ? 2 : of[0].dimension();
  return thalweg::made(Shape::make(op, dimension, numbers, std::move(of), variant));
}

Shape builder::made_formula(std::string_view op, std::string_view text, int dimension) {
  return thalweg::made(Shape::formula(op, dimension, text));
}

std::size_t node_count(const Shape& shape) {
  std::unordered_set<const void*> seen;
  std::vector<const Shape*> open = {&shape};
  while (!open.empty()) {
    const Shape* next = open.back();
    open.pop_back();
    if (!seen.insert(next->identity()).second) continue;
    for (const Shape& operand : next->operands()) open.push_back(&operand);
  }
  return seen.size();
}

}  // namespace thalweg
