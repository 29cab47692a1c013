// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Parameters by their quantity and range, so that a new op takes part without a line here.
#include "cases.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string_view>

#include "random_shapes.h"
#include "thalweg/op_table.h"
#include "thalweg/tape.h"

namespace thalweg::conformance {
namespace {

using oracle::Random;

constexpr double kPi = std::numbers::pi;
constexpr double kRoot2 = std::numbers::sqrt2;

const OpRow& row_of(int op) { return op_table()[static_cast<std::size_t>(op)]; }

template <std::size_t N>
double pick(Random& random, const double (&from)[N]) {
  return from[random.index(N)];
}

double within(const OpParameter& p, double number) {
  if (p.least == 0 && number < 1e-15) return 0;
  return std::clamp(number, p.least, p.most);
}

/// Lengths and coordinates around a scale; `earlier` are the node's numbers so far, for equal corners and radii.
double spicy_length(Random& random, const OpParameter& p, double scale, const std::vector<double>& earlier) {
  static constexpr double kFactors[] = {1, 1, kRoot2, kPi, 0.5, 3, 1e-3, 1e-7, 1 + 0x1p-23};
  const double sign = p.least < 0 && random.chance(0.5) ? -1 : 1;
  if (!earlier.empty() && random.chance(0.3)) return within(p, earlier[random.index(earlier.size())]);
  if (random.chance(0.05)) return random.chance(0.5) ? p.least : p.most;
  if (p.least <= 0 && random.chance(0.15)) return 0;
  return within(p, sign * scale * pick(random, kFactors));
}

double spicy_number(Random& random, const OpParameter& p, double scale, const std::vector<double>& earlier) {
  switch (p.quantity) {
    case Quantity::length:
    case Quantity::vector:
    case Quantity::point:
      return spicy_length(random, p, scale, earlier);
    case Quantity::angle: {
      const double angles[] = {p.least,
                               p.most,
                               kPi / 2,
                               kPi,
                               kPi / 4,
                               2 * kPi / 3,
                               1e-6,
                               kPi - 1e-6,
                               kPi / 2 + 1e-7,
                               kPi * (1 - 1e-15),
                               1,
                               random.uniform(-kPi, kPi)};
      const double angle = pick(random, angles);
      return std::clamp(p.least < 0 && random.chance(0.5) ? -angle : angle, p.least, p.most);
    }
    case Quantity::count: {
      const double counts[] = {p.least, p.most, 4, 5, 6, 7, 8, 12, 17, 100, 4096};
      return std::clamp(pick(random, counts), p.least, p.most);
    }
    case Quantity::number: {
      const double last = earlier.empty() ? 1 : earlier.back();
      const double numbers[] = {p.least, p.most, 2, kRoot2, kPi, 2.5, last, last * (1 - 1e-7), 1e-6, 1e6};
      return std::clamp(pick(random, numbers), p.least, p.most);
    }
    case Quantity::choice: {
      const auto words = 1 + std::count(p.choices.begin(), p.choices.end(), '|');
      return static_cast<double>(random.index(static_cast<std::size_t>(words)));
    }
    case Quantity::direction:
    case Quantity::quaternion: {
      const double parts[] = {0, 0, 1, -1, kRoot2, 1e-7, random.uniform(-1, 1)};
      return pick(random, parts);
    }
    case Quantity::text:  // formulas have tests of their own
      break;
  }
  return 0;
}

/// Lists of corners: needles, near-straight angles, fine outlines, far from the origin.
void append_corners(Random& random, double scale, std::vector<double>& numbers) {
  const std::size_t corners = random.chance(0.2) ? 64 : 3 + random.index(6);
  const double narrow = random.chance(0.3) ? 1e-4 : 1;
  const double far = random.chance(0.2) ? 1000 * scale : 0;
  const double turn = random.chance(0.5) ? -1 : 1;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = turn * 2 * kPi * static_cast<double>(i) / static_cast<double>(corners);
    const double radius = scale * (random.chance(0.3) ? random.uniform(0.3, 1) : 1);
    numbers.push_back(far + radius * std::cos(angle));
    numbers.push_back(far + narrow * radius * std::sin(angle));
  }
}

std::vector<double> spicy_numbers(Random& random, const OpRow& row, double scale) {
  std::vector<double> numbers;
  for (const OpParameter& p : row.parameters) {
    if (p.arity == 0) append_corners(random, scale, numbers);
    for (int i = 0; i < p.arity; ++i) {
      numbers.push_back(p.implicit ? p.fallback : spicy_number(random, p, scale, numbers));
    }
  }
  return numbers;
}

Shape spicy_shape(Random& random, int op, double scale, const std::vector<Shape>& of) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    if (auto shape = Shape::make(op, spicy_numbers(random, row_of(op), scale), of)) return *shape;
  }
  throw std::logic_error("no spicy parameters suit " + label(op));
}

int primitive_of(Random& random, int dimension) {
  for (;;) {
    const int op = static_cast<int>(random.index(op_table().size()));
    if (row_of(op).kind == OpKind::primitive && row_of(op).dimension == dimension) return op;
  }
}

/// Operands for an operator: ordinary or spicy primitives of size 1; now and then the same one twice.
std::vector<Shape> operands(Random& random, int op, bool spicy) {
  const OpRow& row = row_of(op);
  std::vector<Shape> of;
  if (row.kind == OpKind::primitive) return of;
  const int dimension = row.dimension != 0 ? row.dimension : 2 + static_cast<int>(random.index(2));
  const std::size_t count = row.kind == OpKind::combine ? 1 + random.index(4) : 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (!of.empty() && random.chance(0.15)) {
      of.push_back(of.front());
    } else if (spicy && random.chance(0.5)) {
      of.push_back(spicy_shape(random, primitive_of(random, dimension), 1, {}));
    } else {
      of.push_back(oracle::random_primitive_of(random, dimension));
    }
  }
  return of;
}

std::uint64_t seed_of(int op, std::size_t index) { return static_cast<std::uint64_t>(op) * 1'000'000 + index; }

}  // namespace

std::size_t amount(std::size_t quick) {
  const char* value = std::getenv("THALWEG_FULL");
  const bool full = value != nullptr && *value != '\0' && std::string_view(value) != "0";
  return full ? 20 * quick : quick;
}

std::vector<Case> plain_cases(int op, std::size_t count) {
  std::vector<Case> cases;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed_of(op, i));
    if (row_of(op).kind == OpKind::primitive) {
      cases.push_back({seed_of(op, i), oracle::random_primitive(random, op)});
    } else {
      const std::vector<Shape> of = operands(random, op, false);
      cases.push_back({seed_of(op, i), oracle::random_operator(random, op, of.front(), of.back())});
    }
  }
  return cases;
}

std::vector<Case> spicy_cases(int op, std::size_t count) {
  static constexpr double kScales[] = {1, 1, 1, 1e-6, 1e6, 1e-12, 1e12, 1e-15, 1e15};
  std::vector<Case> cases;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t seed = seed_of(op, 500'000 + i);
    Random random(seed);
    const double scale = row_of(op).kind == OpKind::primitive ? pick(random, kScales) : 1;
    Shape shape = spicy_shape(random, op, scale, operands(random, op, true));
    // A scale may push lengths out of the range in which anything is answered; that is refused, and drawn again.
    while (row_of(op).name == "scale" && !compile(shape))
      shape = spicy_shape(random, op, 1, operands(random, op, true));
    cases.push_back({seed, std::move(shape)});
  }
  return cases;
}

std::vector<int> every_op() {
  std::vector<int> ops;
  // Formulas have tests of their own: they have neither parameters nor a distance.
  for (std::size_t i = 0; i < op_table().size(); ++i) {
    if (op_table()[i].kind != OpKind::formula) ops.push_back(static_cast<int>(i));
  }
  return ops;
}

std::vector<OnTarget> every_op_on_every_target() {
  std::vector<OnTarget> all;
  for (const int op : every_op()) {
    for (const Target& target : targets()) all.push_back({op, &target});
  }
  return all;
}

std::string label(int op) {
  const OpRow& row = row_of(op);
  int variant = 1;
  for (int i = 0; i < op; ++i) variant += row_of(i).name == row.name && row_of(i).dimension == row.dimension ? 1 : 0;
  std::string text(row.name);
  if (row.dimension != 0) text += "_" + std::to_string(row.dimension) + "d";
  return variant == 1 ? text : text + "_" + std::to_string(variant);
}

std::string label(const OnTarget& on) { return label(on.op) + "_" + std::string(on.target->name); }
std::ostream& operator<<(std::ostream& out, const OnTarget& on) { return out << label(on); }

}  // namespace thalweg::conformance
