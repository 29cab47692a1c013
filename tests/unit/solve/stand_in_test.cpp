// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Which tape is asked, told apart by one that stands in with other values.
#include "solve/pairs/stand_in.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "thalweg/ops.h"
#include "thalweg/simd.h"

namespace thalweg {
namespace {

/// A disc of radius 1, and one of radius 3 that stands in for it within [-2, 2] x [0, 4].
struct Discs {
  Tape whole = *compile(circle(1)), other = *compile(circle(3));
  StandIn near{.tape = &other, .lo = {-2, 0}, .hi = {2, 4}};
};

TEST(StandIn, HoldsThePointsOfItsBoxAndNoOther) {
  const Discs discs;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const float x[] = {0, -2, 2, 2.0000002F, 0, kNan}, y[] = {1, 0, 4, 1, -1e-30F, 1};
  const bool inside[] = {true, true, true, false, false, false};
  for (std::size_t i = 0; i < 6; ++i) {
    const float* const columns[] = {x + i, y + i};
    const double point[] = {x[i], y[i]};
    EXPECT_EQ(discs.near.holds(columns, 1), inside[i]) << i;
    EXPECT_EQ(discs.near.holds(point), inside[i]) << i;
  }
  const float* const all[] = {x, y};
  EXPECT_TRUE(discs.near.holds(all, 3));
  EXPECT_FALSE(discs.near.holds(all, 6));
  EXPECT_FALSE(StandIn{}.holds(all, 1));
}

TEST(StandIn, IsAskedForTheBlocksThatItHolds) {
  const Discs discs;
  constexpr std::size_t kCount = 4 * kColumnPadding - 5;
  std::vector<float> x(padded(kCount), 1), y(padded(kCount), 1), value(padded(kCount)), slope(padded(kCount));
  // One stray point takes its block along.
  y[kColumnPadding + 3] = 10;
  const float* const points[] = {x.data(), y.data()};
  Arena arena;
  NearField field;
  field.begin(*default_target().kernels, discs.whole, discs.near, arena);
  const auto expect_blocks = [&] {
    for (std::size_t i = 0; i < kCount; ++i) {
      const float radius = i / kColumnPadding == 1 ? 1 : 3;
      EXPECT_FLOAT_EQ(value[i], std::hypot(x[i], y[i]) - radius) << i;
    }
  };
  field.values(points, kCount, value.data());
  expect_blocks();
  std::fill(value.begin(), value.end(), 0.0F);
  float* const gradient[] = {slope.data(), slope.data()};
  field.gradients(points, kCount, value.data(), gradient);
  expect_blocks();
}

TEST(StandIn, IsAskedInDoubleToo) {
  const Discs discs;
  Twin whole(discs.whole), near;
  NearTwin twin(whole, near, discs.near);
  const double inside[] = {0, 1}, outside[] = {0, -1};
  double gradient[2] = {};
  EXPECT_EQ(twin.value(inside), -2);
  EXPECT_EQ(twin.value(outside), 0);
  EXPECT_EQ(twin.gradient(inside, gradient), -2);
  EXPECT_EQ(twin.gradient(outside, gradient), 0);
}

}  // namespace
}  // namespace thalweg
