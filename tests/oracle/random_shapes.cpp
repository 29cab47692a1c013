// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "random_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "thalweg/op_table.h"
#include "thalweg/ops.h"
#include "thalweg/scene.h"

namespace thalweg::oracle {
namespace {

constexpr double kPi = std::numbers::pi;

const OpRow& row_of(int op_index) { return op_table()[static_cast<std::size_t>(op_index)]; }

/// Corners around the origin by rising angle: simple whatever the radii are.
void append_polygon(Random& random, std::vector<double>& numbers) {
  const std::size_t corners = 3 + random.index(8);
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * kPi * (static_cast<double>(i) + random.uniform(0, 0.8)) / static_cast<double>(corners);
    const double radius = random.uniform(0.2, 1.2);
    numbers.insert(numbers.end(), {radius * std::cos(angle), radius * std::sin(angle)});
  }
}

double random_size(Random& random, double least) {
  if (least == 0 && random.chance(0.2)) return 0;
  return random.spread(0.03, 1.5);
}

/// Ranges of the table reach far beyond what a scene of size 1 uses; special values come up often.
double random_number(Random& random, const OpParameter& p) {
  switch (p.quantity) {
    case Quantity::length:
      return p.least < 0 ? random.uniform(-1, 1) : random_size(random, p.least);
    case Quantity::vector:
      return p.least < 0 ? random.uniform(-1.5, 1.5) : random_size(random, p.least);
    case Quantity::point:
      return random.uniform(-1, 1);
    case Quantity::angle: {
      const double special[] = {kPi / 2, kPi, kPi / 4, 0.0};
      const double angle = random.chance(0.2) ? special[random.index(4)] : random.uniform(-kPi, kPi);
      return std::clamp(p.least < 0 ? angle : std::abs(angle), p.least, p.most);
    }
    case Quantity::count:
      return std::min(p.least + static_cast<double>(random.index(12)), p.most);
    case Quantity::choice: {
      const auto words = 1 + std::count(p.choices.begin(), p.choices.end(), '|');
      return static_cast<double>(random.index(static_cast<std::size_t>(words)));
    }
    case Quantity::number:
      if (p.least < 1) return std::clamp(random.spread(0.3, 3), p.least, p.most);
      return random.chance(0.2) ? p.least : std::min(p.least + random.uniform(0, 5), p.most);
    default:
      return random.uniform(-1, 1);
  }
}

std::vector<double> random_numbers(Random& random, const OpRow& row) {
  std::vector<double> numbers;
  for (const OpParameter& p : row.parameters) {
    if (p.arity == 0) append_polygon(random, numbers);
    const bool along_axis = p.quantity == Quantity::direction && random.chance(0.4);
    const std::size_t chosen = along_axis ? random.index(static_cast<std::size_t>(p.arity)) : 0;
    for (int i = 0; i < p.arity; ++i) {
      const double drawn = random_number(random, p);
      if (p.implicit) {
        numbers.push_back(p.fallback);
      } else if (along_axis) {
        numbers.push_back(static_cast<std::size_t>(i) == chosen ? std::copysign(1.0, drawn) : 0.0);
      } else {
        numbers.push_back(drawn);
      }
    }
  }
  return numbers;
}

Shape make(Random& random, int op_index, const std::vector<Shape>& of) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const auto numbers = random_numbers(random, row_of(op_index));
    if (auto shape = Shape::make(op_index, numbers, of)) return *shape;
  }
  throw std::logic_error("no random parameters suit " + std::string(row_of(op_index).name));
}

std::vector<int> rows(int dimension, bool primitives) {
  std::vector<int> found;
  const auto table = op_table();
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool fits = table[i].dimension == dimension || table[i].dimension == 0;
    if (table[i].kind == OpKind::formula) continue;
    if (fits && (table[i].kind == OpKind::primitive) == primitives) found.push_back(static_cast<int>(i));
  }
  return found;
}

int pick_operator(Random& random, int dimension) {
  const auto candidates = rows(dimension, false);
  // Half of all operators combine; the many placements would otherwise grow poles instead of trees.
  const bool combine = random.chance(0.5);
  for (;;) {
    const int row = candidates[random.index(candidates.size())];
    if ((row_of(row).kind == OpKind::combine) == combine) return row;
  }
}

}  // namespace

Shape random_primitive(Random& random, int op_index) { return make(random, op_index, {}); }

Shape random_primitive_of(Random& random, int dimension) {
  const auto candidates = rows(dimension, true);
  return random_primitive(random, candidates[random.index(candidates.size())]);
}

Shape random_operator(Random& random, int op_index, const Shape& a, const Shape& b) {
  const OpKind kind = row_of(op_index).kind;
  if (kind == OpKind::primitive) return a;
  return make(random, op_index, kind == OpKind::combine ? std::vector<Shape>{a, b} : std::vector<Shape>{a});
}

Shape random_shape(Random& random, int dimension, int nodes) {
  if (nodes <= 2) return random_primitive_of(random, dimension);
  const int op = pick_operator(random, dimension);
  if (row_of(op).kind != OpKind::combine) return make(random, op, {random_shape(random, dimension, nodes - 1)});
  std::vector<Shape> of;
  int left = nodes - 1;
  const std::size_t operands = 2 + (left > 6 ? random.index(3) : 0);
  for (std::size_t i = 0; i < operands; ++i) {
    // The last operand takes what is left; a shared operand now and then makes the tree a DAG.
    const int share =
        i + 1 == operands ? left : 1 + static_cast<int>(random.index(static_cast<std::size_t>(std::max(left / 2, 1))));
    const bool shared = !of.empty() && random.chance(0.05);
    of.push_back(shared ? of.front() : random_shape(random, dimension, std::max(share, 1)));
    left = std::max(left - share, 1);
  }
  return make(random, op, of);
}

Shape scattered_parts(int dimension, int groups) {
  Random random(5);
  std::vector<Shape> all;
  for (int i = 0; i < groups; ++i) {
    std::vector<Shape> parts;
    for (int k = 0; k < 4; ++k) {
      const auto at = [&] { return random.uniform(0, 1000); };
      if (dimension == 2) {
        parts.push_back(k % 2 == 0 ? circle(30).translate(Vec2{at(), at()})
                                   : star(40, 5, 3).translate(Vec2{at(), at()}));
      } else {
        parts.push_back(k % 2 == 0 ? sphere(60).translate(Vec3{at(), at(), at()})
                                   : box(Vec3{50, 30, 40}).translate(Vec3{at(), at(), at()}));
      }
    }
    all.push_back(i % 2 == 0 ? smooth_union(3, parts) : union_(parts));
  }
  return union_(all);
}

std::string describe(const Shape& shape, std::uint64_t seed) {
  return "seed " + std::to_string(seed) + "\n" + scene_text(shape);
}

}  // namespace thalweg::oracle
