// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Flattens a Shape by the names of its op's parameters and evaluates it node by node.
#include "oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "primitives.h"
#include "thalweg/op_table.h"

namespace thalweg::oracle {

double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(Vec a) { return std::hypot(a.x, a.y, a.z); }
double distance(Vec a, Vec b) { return length(a - b); }

namespace {

using Turn = std::array<double, 9>;

Turn planar_turn(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c, s, 0, -s, c, 0, 0, 0, 1};  // the inverse of turning by angle
}

/// The inverse of the rotation that a quaternion stands for: its matrix by rows is the rotation's by columns.
Turn spatial_turn(double w, double x, double y, double z) {
  const double n = std::sqrt(w * w + x * x + y * y + z * z);
  w /= n, x /= n, y /= n, z /= n;
  return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),
          2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
          2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y)};
}

double smooth_minimum(double a, double b, double k) {
  if (k <= 0) return std::min(a, b);
  const double support = 4 * k;
  const double h = std::max(support - std::abs(a - b), 0.0) / support;
  return std::min(a, b) - h * h * support / 4;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The numbers of one parameter of a shape, by name; empty when its op has none of that name.
std::span<const double> numbers_of(const Shape& shape, std::string_view parameter) {
  const OpRow& row = op_table()[static_cast<std::size_t>(shape.op_index())];
  const auto all = shape.parameters();
  std::size_t fixed = 0;
  for (const OpParameter& p : row.parameters) fixed += static_cast<std::size_t>(p.arity);
  std::size_t offset = 0;
  for (const OpParameter& p : row.parameters) {
    const std::size_t arity = p.arity == 0 ? all.size() - fixed : static_cast<std::size_t>(p.arity);
    if (offset + arity > all.size()) return {};
    if (p.name == parameter) return all.subspan(offset, arity);
    offset += arity;
  }
  return {};
}

double number_of(const Shape& shape, std::string_view parameter, double fallback) {
  const auto numbers = numbers_of(shape, parameter);
  return numbers.empty() ? fallback : numbers[0];
}

const std::map<std::string_view, Field::Kind>& operators() {
  using Kind = Field::Kind;
  static const std::map<std::string_view, Kind> table = {
      {"union", Kind::unite},
      {"intersection", Kind::intersect},
      {"subtraction", Kind::subtract},
      {"smooth_union", Kind::smooth_unite},
      {"smooth_intersection", Kind::smooth_intersect},
      {"smooth_subtraction", Kind::smooth_subtract},
      {"round", Kind::round},
      {"onion", Kind::onion},
      {"translate", Kind::rigid},
      {"rotate", Kind::rigid},
      {"rigid", Kind::rigid},
      {"scale", Kind::scale},
      {"mirror", Kind::mirror},
  };
  return table;
}

}  // namespace

struct Field::Builder {
  Field& field;
  std::map<const void*, std::size_t> known;

  std::size_t add(const Shape& shape) {
    if (const auto found = known.find(shape.identity()); found != known.end()) return found->second;
    Node node;
    for (const Shape& operand : shape.operands()) node.operands.push_back(add(operand));
    for (const double v : shape.parameters()) {
      if (std::isfinite(v)) field.size_ = std::max(field.size_, std::abs(v));
    }
    if (const auto found = operators().find(shape.op()); found != operators().end()) {
      node.kind = found->second;
      read_operator(shape, node);
    } else {
      read_primitive(shape, node);
    }
    field.nodes_.push_back(std::move(node));
    return known[shape.identity()] = field.nodes_.size() - 1;
  }

  void read_primitive(const Shape& shape, Node& node) {
    for (const PrimitiveEntry& entry : primitives()) {
      if (entry.op != shape.op() || entry.dimension != shape.dimension()) continue;
      std::string_view rest = entry.order;
      while (!rest.empty()) {
        const auto blank = std::min(rest.find(' '), rest.size());
        const auto numbers = numbers_of(shape, rest.substr(0, blank));
        if (numbers.empty()) throw std::invalid_argument("oracle: no such parameter: " + std::string(rest));
        node.numbers.insert(node.numbers.end(), numbers.begin(), numbers.end());
        rest.remove_prefix(std::min(blank + 1, rest.size()));
      }
      node.primitive = entry.evaluate;
      node.convex = entry.convex != nullptr && entry.convex(node.numbers.data());
      node.never_negative = entry.never_negative;
      return;
    }
    throw std::invalid_argument("oracle: unknown op " + std::string(shape.op()));
  }

  static void read_operator(const Shape& shape, Node& node) {
    const std::string_view op = shape.op();
    if (op == "round") node.numbers = {number_of(shape, "radius", 0)};
    if (op == "onion") node.numbers = {number_of(shape, "thickness", 0)};
    if (op == "scale") node.numbers = {number_of(shape, "factor", 1)};
    if (op == "mirror") node.numbers = {number_of(shape, "axis", 0)};
    if (op.starts_with("smooth_")) node.numbers = {number_of(shape, "k", 0)};
    if (op == "translate") node.origin = vector_of(shape, "by");
    if (op == "rigid") node.origin = vector_of(shape, "translate");
    if (op == "rotate" || op == "rigid") node.turn = turn_of(shape, op == "rigid" ? "rotate" : "");
  }

  static Vec vector_of(const Shape& shape, std::string_view parameter) {
    const auto n = numbers_of(shape, parameter);
    if (n.size() < 2) throw std::invalid_argument("oracle: no such parameter: " + std::string(parameter));
    return {n[0], n[1], n.size() > 2 ? n[2] : 0};
  }

  static Turn turn_of(const Shape& shape, std::string_view joint) {
    for (const std::string_view candidate : {std::string_view("quaternion"), joint}) {
      const auto q = numbers_of(shape, candidate);
      if (q.size() == 4) return spatial_turn(q[0], q[1], q[2], q[3]);
      if (q.size() == 1) return planar_turn(q[0]);
    }
    const auto angle = numbers_of(shape, "angle");
    if (angle.size() != 1) throw std::invalid_argument("oracle: rotation without an angle");
    const auto axis = numbers_of(shape, "axis");
    if (axis.size() != 3) return planar_turn(angle[0]);
    const double n = std::hypot(axis[0], axis[1], axis[2]), s = std::sin(angle[0] / 2) / n;
    return spatial_turn(std::cos(angle[0] / 2), axis[0] * s, axis[1] * s, axis[2] * s);
  }
};

Field::Field(const Shape& shape) : dimension_(shape.dimension()) {
  Builder builder{*this, {}};
  builder.add(shape);
}

Vec Field::into(const Node& node, Vec p) {
  switch (node.kind) {
    case Kind::rigid: {
      const Vec q = p - node.origin;
      const Turn& t = node.turn;
      return {t[0] * q.x + t[1] * q.y + t[2] * q.z, t[3] * q.x + t[4] * q.y + t[5] * q.z,
              t[6] * q.x + t[7] * q.y + t[8] * q.z};
    }
    case Kind::scale:
      return p * (1 / node.numbers[0]);
    case Kind::mirror:
      if (node.numbers[0] == 0) return {std::abs(p.x), p.y, p.z};
      if (node.numbers[0] == 1) return {p.x, std::abs(p.y), p.z};
      return {p.x, p.y, std::abs(p.z)};
    default:
      return p;
  }
}

/// The operator's value from its operands' values; monotone in each (antitone in what is subtracted).
double Field::combine(const Node& node, const double* values) const {
  const double k = node.numbers.empty() ? 0 : node.numbers[0];
  switch (node.kind) {
    case Kind::round:
      return values[0] - k;
    case Kind::scale:
      return values[0] * k;
    case Kind::onion:
      return std::abs(values[0]) - k;
    case Kind::rigid:
    case Kind::mirror:
      return values[0];
    default:
      break;
  }
  double f = values[0];
  for (std::size_t i = 1; i < node.operands.size(); ++i) {
    const double g = values[i];
    switch (node.kind) {
      case Kind::unite:
        f = std::min(f, g);
        break;
      case Kind::intersect:
        f = std::max(f, g);
        break;
      case Kind::subtract:
        f = std::max(f, -g);
        break;
      case Kind::smooth_unite:
        f = smooth_minimum(f, g, k);
        break;
      case Kind::smooth_intersect:
        f = -smooth_minimum(-f, -g, k);
        break;
      default:
        f = -smooth_minimum(-f, g, k);
        break;
    }
  }
  return f;
}

namespace {
/// Operand values of one node; almost all have a few.
class Values {
 public:
  explicit Values(std::size_t count) {
    if (count > inline_.size()) more_.resize(count);
  }
  double* begin() { return more_.empty() ? inline_.data() : more_.data(); }

 private:
  std::array<double, 16> inline_{};
  std::vector<double> more_;
};
}  // namespace

double Field::evaluate(std::size_t index, Vec p) const {
  const Node& node = nodes_[index];
  if (node.kind == Kind::primitive) return node.primitive(node.numbers.data(), node.numbers.size(), p);
  const Vec local = into(node, p);
  Values values(node.operands.size());
  for (std::size_t i = 0; i < node.operands.size(); ++i) values.begin()[i] = evaluate(node.operands[i], local);
  return combine(node, values.begin());
}

Interval Field::enclose(Vec centre, const Vec* corners, std::size_t count) const {
  Cell cell;
  cell.centre = centre;
  cell.count = std::min(count, cell.corners.size());
  std::copy_n(corners, cell.count, cell.corners.begin());
  return enclose(nodes_.size() - 1, cell);
}

Interval Field::enclose_primitive(const Node& node, const Cell& cell) const {
  const auto f = [&](Vec p) { return node.primitive(node.numbers.data(), node.numbers.size(), p); };
  const double value = f(cell.centre);
  double reach = 0;
  for (std::size_t i = 0; i < cell.count; ++i) reach = std::max(reach, distance(cell.corners[i], cell.centre));
  Interval result{value - reach, value + reach};
  if (node.never_negative) result.lower = std::max(result.lower, 0.0);
  if (!node.convex) return result;
  double at_corners = -kInfinity, at_mirrored = -kInfinity;
  for (std::size_t i = 0; i < cell.count; ++i) {
    at_corners = std::max(at_corners, f(cell.corners[i]));
    at_mirrored = std::max(at_mirrored, f(cell.centre * 2 - cell.corners[i]));
  }
  return {std::max(result.lower, 2 * value - at_mirrored), std::min(result.upper, at_corners)};
}

Interval Field::enclose(std::size_t index, const Cell& cell) const {
  const Node& node = nodes_[index];
  if (node.kind == Kind::primitive) return enclose_primitive(node, cell);
  if (node.kind != Kind::rigid && node.kind != Kind::scale && node.kind != Kind::mirror) {
    return enclose_operands(node, cell);
  }
  Cell local = cell;
  local.centre = into(node, cell.centre);
  for (std::size_t i = 0; i < cell.count; ++i) local.corners[i] = into(node, cell.corners[i]);
  if (node.kind == Kind::mirror) {
    // A fold is affine only on one side of its plane; a cell across it falls back on the Lipschitz constant.
    const auto side = [&](Vec p) { return node.numbers[0] == 0 ? p.x : node.numbers[0] == 1 ? p.y : p.z; };
    double reach = 0;
    bool across = false;
    for (std::size_t i = 0; i < cell.count; ++i) {
      across = across || side(cell.corners[i]) * side(cell.centre) <= 0;
      reach = std::max(reach, distance(cell.corners[i], cell.centre));
    }
    const double value = across ? evaluate(node.operands[0], local.centre) : 0;
    if (across) return {value - reach, value + reach};
  }
  const Interval inner = enclose(node.operands[0], local);
  return {combine(node, &inner.lower), combine(node, &inner.upper)};
}

Interval Field::enclose_operands(const Node& node, const Cell& cell) const {
  Values lower(node.operands.size()), upper(node.operands.size());
  const bool subtracts = node.kind == Kind::subtract || node.kind == Kind::smooth_subtract;
  for (std::size_t i = 0; i < node.operands.size(); ++i) {
    Interval inner = enclose(node.operands[i], cell);
    if (node.kind == Kind::onion && inner.lower < 0) {
      // |f| falls, then rises: make its ends the ends of an interval that `combine` may treat as monotone.
      const double most = std::max(-inner.lower, inner.upper);
      inner = {inner.upper < 0 ? -inner.upper : 0, most};
    }
    const bool swapped = subtracts && i > 0;
    lower.begin()[i] = swapped ? inner.upper : inner.lower;
    upper.begin()[i] = swapped ? inner.lower : inner.upper;
  }
  return {combine(node, lower.begin()), combine(node, upper.begin())};
}

}  // namespace thalweg::oracle
