// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/starts.h"

#include <gtest/gtest.h>

#include <array>

namespace thalweg {
namespace {

TEST(StartPoint, IsTheCentroidThenCornersThenMidEdges) {
  const float third = 1.0F / 3.0F;
  const Barycentric expected[] = {{third, third, third}, {1, 0, 0},       {0, 1, 0},      {0, 0, 1},
                                  {0.5F, 0.5F, 0},       {0, 0.5F, 0.5F}, {0.5F, 0, 0.5F}};
  for (std::uint32_t i = 0; i < 7; ++i) EXPECT_EQ(distance(start_point(i), expected[i]), 0) << i;
}

TEST(StartPoint, LiesInTheTriangle) {
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const Barycentric p = start_point(i);
    ASSERT_GE(std::min({p.a, p.b, p.c}), 0) << i;
    ASSERT_NEAR(p.a + p.b + p.c, 1, 1e-6) << i;
  }
}

TEST(StartPoint, NeverComesTwice) {
  for (std::uint32_t i = 0; i < 200; ++i) {
    for (std::uint32_t j = 0; j < i; ++j) ASSERT_GT(distance(start_point(i), start_point(j)), 0) << i << ' ' << j;
  }
}

TEST(StartPoint, SpreadsEvenlyFromTheEighthOn) {
  // Sixteen sub-triangles of equal area: a quarter of the count in each four, within a fifth.
  std::array<int, 16> hits{};
  for (std::uint32_t i = 7; i < 7 + 1600; ++i) {
    const Barycentric p = start_point(i);
    const int u = std::min(3, static_cast<int>(4 * p.b)), v = std::min(3, static_cast<int>(4 * p.c));
    const bool upper = 4 * p.b - static_cast<float>(u) + 4 * p.c - static_cast<float>(v) > 1;
    // Row v of the sub-triangles begins after those of the longer rows below it.
    const int row = v == 0 ? 0 : v == 1 ? 7 : v == 2 ? 12 : 15;
    ++hits[static_cast<std::size_t>(std::min(15, row + 2 * u + (upper ? 1 : 0)))];
  }
  for (const int count : hits) EXPECT_NEAR(count, 100, 20);
}

TEST(StartPolicies, ArePartsOfTheSequence) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(distance(start_point(Start::vertices, i), start_point(1 + i)), 0);
    EXPECT_EQ(distance(start_point(Start::mid_edges, i), start_point(4 + i)), 0);
    EXPECT_EQ(distance(start_point(Start::halton, i), start_point(7 + i)), 0);
    EXPECT_EQ(distance(start_point(Start::sequence, i), start_point(i)), 0);
  }
  EXPECT_EQ(distance(start_point(Start::centroid, 0), start_point(0)), 0);
  EXPECT_EQ(most_starts(Start::vertices), 3U);
  EXPECT_EQ(most_starts(Start::centroid), 1U);
  EXPECT_GT(most_starts(Start::halton), 1'000'000U);
}

}  // namespace
}  // namespace thalweg
