// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Lower bounds over cells: never above a value that the cell has, and exact for a cell along the face of something
// convex, which is what keeps flush triangles from being cut to pieces.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "comparison.h"
#include "random_queries.h"
#include "random_shapes.h"
#include "thalweg/op_table.h"
#include "thalweg/ops.h"

namespace thalweg::conformance {
namespace {

using oracle::describe;
using oracle::Field;
using oracle::Random;
using oracle::Vec;

class Enclosures : public testing::TestWithParam<OnTarget> {};

constexpr std::size_t kCells = 48;

/// A random point of cell `i`, as the kernel understands the cell: the centre plus what its edges span.
Vec sample(Random& random, const Cells& cells, std::size_t i) {
  const auto d = static_cast<std::size_t>(cells.centres.dimension);
  double at[3] = {};
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  if (random.chance(0.2)) u = v = 0;
  for (std::size_t axis = 0; axis < d; ++axis) {
    if (cells.is_box) {
      at[axis] = cells.edges[axis][i] *
                 (random.chance(0.3) ? std::copysign(1.0, random.uniform(-1, 1)) : random.uniform(-1, 1));
    } else {
      at[axis] = (1 - u - v) * cells.edges[axis][i] + u * cells.edges[d + axis][i] + v * cells.edges[2 * d + axis][i];
    }
  }
  return cells.centres.at(i) + Vec{at[0], at[1], at[2]};
}

Cells random_cells(Random& random, const Shape& shape, bool boxes) {
  Cells cells(shape.dimension());
  const auto region = oracle::region_of(shape);
  const double size = length(region.hi - region.lo);
  const auto offset = [&](double by) {
    return Vec{random.uniform(-by, by), random.uniform(-by, by), shape.dimension() == 3 ? random.uniform(-by, by) : 0};
  };
  for (std::size_t i = 0; i < kCells; ++i) {
    const Vec centre = oracle::point_in(random, region);
    const double by = size * random.spread(1e-4, 0.5);
    if (boxes) {
      const Vec half = offset(by);
      cells.add_box(centre, {std::fabs(half.x), std::fabs(half.y), std::fabs(half.z)});
    } else {
      cells.add_triangle({centre + offset(by), centre + offset(by), centre + offset(by)});
    }
  }
  cells.pad();
  return cells;
}

/// What is wrong with the bounds of these cells, or nothing.
std::string fault(const Tape& tape, const Field& field, const Target& target, const Cells& cells, Random& random) {
  const Columns found = run_enclosure(tape, target, cells);
  const Columns values = run_value(tape, target, cells.centres);
  for (std::size_t i = 0; i < cells.centres.count; ++i) {
    const double m = cells.centres.magnitude(i) + cells.reach[i];
    if (found.value[i] != values.value[i]) return "the value at the centre is not the value kernel's";
    for (int k = 0; k < 24; ++k) {
      const Vec p = sample(random, cells, i);
      const double f = field(p);
      if (found.lower[i] <= f + tape.search_slack(m) + field.margin(m)) continue;
      return "lower " + std::to_string(found.lower[i]) + " but f = " + std::to_string(f) + " at " +
             std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z);
    }
  }
  return "";
}

TEST_P(Enclosures, AreNeverAboveAValueOfTheCell) {
  auto cases = plain_cases(GetParam().op, amount(10));
  for (Case& drawn : spicy_cases(GetParam().op, amount(10))) cases.push_back(std::move(drawn));
  for (const Case& drawn : cases) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error());
    const Field field(drawn.shape);
    Random random(drawn.seed);
    for (const bool boxes : {false, true}) {
      const Cells cells = random_cells(random, drawn.shape, boxes);
      ASSERT_EQ(fault(*tape, field, *GetParam().target, cells, random), "") << describe(drawn.shape, drawn.seed);
    }
  }
}

/// Triangles (in 2D: segments) at right angles to the gradient at their centre: f is least at the centre.
Cells flush_cells(Random& random, const Shape& shape, const Tape& tape, const Target& target) {
  Points points = plain_points(random, shape, 64);
  const Columns at = run_gradient(tape, target, points);
  Cells cells(shape.dimension());
  for (std::size_t i = 0; i < points.count; ++i) {
    const Vec g{at.gradient[0][i], at.gradient[1][i], tape.dimension == 3 ? at.gradient[2][i] : 0};
    if (length(g) < 0.99) continue;
    const Vec p = points.at(i);
    const double size = random.spread(1e-2, 1);
    const Vec aside = std::fabs(g.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
    Vec t = tape.dimension == 2 ? Vec{-g.y, g.x, 0} : aside - g * dot(aside, g);
    t = t * (size / length(t));
    const Vec s =
        tape.dimension == 2 ? t * 0.5 : Vec{g.y * t.z - g.z * t.y, g.z * t.x - g.x * t.z, g.x * t.y - g.y * t.x};
    cells.add_triangle({p + t + s, p - t + s, p - s * 2});
  }
  cells.pad();
  return cells;
}

TEST_P(Enclosures, AreTightForACellAlongAFaceOfSomethingConvex) {
  std::size_t tight = 0;
  for (const Case& drawn : plain_cases(GetParam().op, amount(20))) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error());
    const bool is_supported = tape->instructions.back().flags & Instruction::kSupport;
    if (!is_supported) continue;
    EXPECT_TRUE(tape->has_support) << describe(drawn.shape, drawn.seed);
    Random random(drawn.seed);
    const Cells cells = flush_cells(random, drawn.shape, *tape, *GetParam().target);
    const Columns found = run_enclosure(*tape, *GetParam().target, cells);
    for (std::size_t i = 0; i < cells.centres.count; ++i, ++tight) {
      const double m = cells.centres.magnitude(i) + cells.reach[i];
      // Beside something round the direction itself is rounded, by the slack over the distance; it turns the cell
      // and what the shape reaches along it, a few units here.
      const double turned = (cells.reach[i] + 4) * 16 * tape->slack(m) / std::fabs(found.value[i]);
      ASSERT_GE(found.lower[i], found.value[i] - tape->search_slack(m) - turned) << describe(drawn.shape, drawn.seed);
    }
  }
  const OpRow& row = op_table()[static_cast<std::size_t>(GetParam().op)];
  RecordProperty("tight_cells", static_cast<int>(tight));
  if (row.name == "box" || row.name == "triangle" || row.name == "plane") {
    EXPECT_GT(tight, 100U);
  }
}

INSTANTIATE_TEST_SUITE_P(Ops, Enclosures, testing::ValuesIn(every_op_on_every_target()),
                         [](const auto& on) { return label(on.param); });

/// A wide triangle just above the top of a block at height `top`.
Cells above(double top, double gap) {
  Cells cells(3);
  const double y = top + gap;
  cells.add_triangle({Vec{-3, y, -2}, Vec{4, y, -3}, Vec{1, y, 5}});
  cells.pad();
  return cells;
}

TEST(EnclosureOfAFlushTriangle, IsItsGapWithoutAnySubdivision) {
  const Shape block = box(Vec3{8, 1, 8});
  const std::pair<Shape, double> tops[] = {
      {block, 1},
      {block.rotate(Vec3{0, 1, 0}, 0.7), 1},
      {block.scale(2).translate(Vec3{1, 3, 0}), 5},
      {round(block, 0.5), 1.5},
      {block | sphere(1).translate(Vec3{0, -9, 0}), 1},
      {block & plane({0, 1, 0}, 0.5), 0.5},
      {block - sphere(2).translate(Vec3{0, -40, 0}), 1},
  };
  for (const auto& [shape, top] : tops) {
    const auto tape = compile(shape);
    ASSERT_TRUE(tape);
    for (const double gap : {1e-3, 0.25}) {
      const Cells cells = above(top, gap);
      for (const Target& target : targets()) {
        const double lower = run_enclosure(*tape, target, cells).lower[0];
        // The gap as float32 coordinates have it.
        const double exact = static_cast<double>(cells.centres.column[1][0]) - top;
        EXPECT_NEAR(lower, exact, tape->search_slack(8)) << target.name << "\n" << shape.to_json();
      }
    }
  }
}

/// Gaps down to a few roundings above a slanted edge of a triangle and of a polygon.
TEST(EnclosureOfAFlushTriangle, IsItsGapAlongASlantedEdge) {
  const Vec from{-0.8, 0.9, 0}, along{1.8, -1.1, 0};
  const Vec normal = Vec{1.1, 1.8, 0} * (1 / length(along));
  const Vec2 corners[] = {{-0.8, 0.9}, {1, -0.2}, {0.3, -0.5}};
  for (const Shape& shape : {triangle(corners[0], corners[1], corners[2]), polygon(corners)}) {
    const auto tape = compile(shape);
    ASSERT_TRUE(tape);
    const Field field(shape);
    for (const double gap : {1e-2, 1e-3, 1e-4, 2e-5}) {
      Cells cells(2);
      for (int i = 0; i < 64; ++i) {
        const Vec a = from + along * (0.1 + 0.003 * i) + normal * gap,
                  b = from + along * (0.9 - 0.003 * i) + normal * gap;
        cells.add_triangle({a, b, (a + b) * 0.5});
      }
      cells.pad();
      for (const Target& target : targets()) {
        const Columns found = run_enclosure(*tape, target, cells);
        for (std::size_t i = 0; i < cells.centres.count; ++i) {
          ASSERT_GE(found.lower[i], field(cells.centres.at(i)) - 2 * tape->search_slack(2))
              << target.name << ", gap " << gap << "\n"
              << shape.to_json();
        }
      }
    }
  }
}

}  // namespace
}  // namespace thalweg::conformance
