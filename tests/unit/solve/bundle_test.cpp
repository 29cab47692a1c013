// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/bundle.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "random.h"

namespace thalweg {
namespace {

float greatest(const Cut* cuts, std::size_t count, float u, float v) {
  float most = cuts[0].at(u, v);
  for (std::size_t i = 1; i < count; ++i) most = std::max(most, cuts[i].at(u, v));
  return most;
}

TEST(LeastOfGreatest, OfOneCutIsItsLowestCorner) {
  const Cut down_v{1, -1, -3};
  const ModelPoint least = least_of_greatest(&down_v, 1);
  EXPECT_EQ(least.u, 0);
  EXPECT_EQ(least.v, 1);
  EXPECT_EQ(least.value, -2);
}

TEST(LeastOfGreatest, OfTwoCutsMayLieOnAnEdge) {
  const Cut cuts[] = {{0, 1, 5}, {1, -1, 5}};
  const ModelPoint least = least_of_greatest(cuts, 2);
  EXPECT_FLOAT_EQ(least.u, 0.5F);
  EXPECT_EQ(least.v, 0);
  EXPECT_FLOAT_EQ(least.value, 0.5F);
}

TEST(LeastOfGreatest, IsAtMostTheModelOnADenseLatticeAndAttained) {
  oracle::Random random(11);
  for (int round = 0; round < 400; ++round) {
    Cut cuts[kMostCuts];
    const std::size_t count = 1 + random.index(kMostCuts);
    for (std::size_t i = 0; i < count; ++i) {
      cuts[i] = {static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-2, 2)),
                 static_cast<float>(random.uniform(-2, 2))};
    }
    const ModelPoint least = least_of_greatest(cuts, count);
    ASSERT_GE(std::min({least.u, least.v, 1 - least.u - least.v}), -1e-6F);
    ASSERT_FLOAT_EQ(least.value, greatest(cuts, count, least.u, least.v));
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; i + j <= 40; ++j) {
        const float u = static_cast<float>(i) / 40, v = static_cast<float>(j) / 40;
        ASSERT_LE(least.value, greatest(cuts, count, u, v) + 1e-5F) << round;
      }
    }
  }
}

}  // namespace
}  // namespace thalweg
