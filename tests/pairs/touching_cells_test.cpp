// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The fast way of joining touching cells gives the components that comparing all of them gives.
#include <gtest/gtest.h>

#include <hwy/highway.h>

#include <set>
#include <vector>

#include "oracle/random.h"
#include "solve/pairs/components.inl"

namespace thalweg {
namespace {

namespace simd = HWY_NAMESPACE;

struct Cells {
  std::vector<float> at[3], size;
  [[nodiscard]] simd::CellBoxes boxes(int dimension) const {
    simd::CellBoxes boxes;
    boxes.dimension = dimension;
    for (int axis = 0; axis < dimension; ++axis) boxes.at[axis] = at[axis].data();
    boxes.size = size.data();
    boxes.count = size.size();
    return boxes;
  }
};

/// Disjoint cells of a random octree (quadtree): each node is dropped, kept or split.
void grow(oracle::Random& random, int dimension, const float* at, float half, int levels, Cells& cells) {
  const double chance = random.uniform(0, 1);
  if (chance < 0.35) return;
  if (levels == 0 || chance < 0.45) {
    for (int axis = 0; axis < dimension; ++axis) cells.at[axis].push_back(at[axis]);
    return cells.size.push_back(half);
  }
  for (int child = 0; child < 1 << dimension; ++child) {
    float middle[3] = {};
    for (int axis = 0; axis < dimension; ++axis) {
      middle[axis] = at[axis] + ((child >> axis & 1) != 0 ? half / 2 : -half / 2);
    }
    grow(random, dimension, middle, half / 2, levels - 1, cells);
  }
}

TEST(TouchingCells, BitRowsAndSweepAgreeOnRandomTrees) {
  oracle::Random random(5);
  std::set<std::uint32_t> counts;
  for (int round = 0; round < 300; ++round) {
    const int dimension = 2 + round % 2;
    Cells cells;
    const float middle[3] = {1, -3, 5};
    grow(random, dimension, middle, 1, dimension == 2 ? 6 : 4, cells);
    const std::size_t count = cells.size.size();
    std::vector<std::uint32_t> fast(count), slow(count);
    const simd::CellBoxes boxes = cells.boxes(dimension);
    Arena arena;
    const simd::TouchingCells by_rows(boxes, fast.data(), arena);
    const simd::TouchingCells by_sweep(boxes, slow.data(), arena, true);
    ASSERT_EQ(by_rows.count(), by_sweep.count()) << "round " << round;
    ASSERT_EQ(fast, slow) << "round " << round;
    counts.insert(by_rows.count());
  }
  EXPECT_GT(counts.size(), 5U);
}

TEST(TouchingCells, CornersTouchAndGapsDoNot) {
  Cells cells;
  for (const float x : {0.0F, 2.0F, 6.0F}) {
    cells.at[0].push_back(x);
    cells.at[1].push_back(x);
    cells.size.push_back(1);
  }
  std::vector<std::uint32_t> component(3);
  const simd::CellBoxes boxes = cells.boxes(2);
  Arena arena;
  EXPECT_EQ(simd::TouchingCells(boxes, component.data(), arena).count(), 2U);
  EXPECT_EQ(component, (std::vector<std::uint32_t>{0, 0, 1}));
}

}  // namespace
}  // namespace thalweg
