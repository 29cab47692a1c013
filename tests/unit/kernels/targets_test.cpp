// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <vector>

#include "kernels/kernels.h"
#include "solve/arena.h"
#include "thalweg/ops.h"
#include "thalweg/simd.h"
#include "thalweg/tape.h"

namespace thalweg {
namespace {

TEST(Targets, AreAtLeastOneEachWithEveryKernel) {
  ASSERT_FALSE(targets().empty());
  std::set<std::string> names;
  for (const Target& target : targets()) {
    EXPECT_TRUE(names.insert(std::string(target.name)).second) << target.name;
    ASSERT_NE(target.kernels, nullptr);
    const Kernels& k = *target.kernels;
    EXPECT_TRUE(k.value && k.gradient && k.enclosure && k.certify_triangles && k.certify_circles) << target.name;
  }
}

TEST(Targets, PutThoseWithFusedMultiplyAddFirst) {
  EXPECT_TRUE(std::is_partitioned(targets().begin(), targets().end(),
                                  [](const Target& target) { return target.fused_multiply_add; }));
}

TEST(Targets, AreFoundByNameInAnyCase) {
  for (const Target& target : targets()) {
    std::string name(target.name);
    EXPECT_EQ(find_target(name), &target);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    EXPECT_EQ(find_target(name), &target);
  }
  EXPECT_EQ(find_target("none"), nullptr);
  EXPECT_EQ(find_target(""), nullptr);
}

TEST(DefaultTarget, IsOneOfTheTargets) {
  EXPECT_NE(std::ranges::find(targets(), &default_target(), [](const Target& target) { return &target; }),
            targets().end());
}

/// A kernel on `count` points whose padding holds the given number.
std::vector<float> values(const Tape& tape, const Target& target, std::size_t count, float padding) {
  std::vector<float> x(padded(count), padding), y(padded(count), padding), out(padded(count));
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = 0.1F * static_cast<float>(i) - 3;
    y[i] = 0.05F * static_cast<float>(i % 7);
  }
  Arena arena;
  const float* points[] = {x.data(), y.data()};
  target.kernels->value(tape, points, count, out.data(), arena.take<float>(scratch_floats(tape)));
  out.resize(count);
  return out;
}

TEST(ValueKernel, GivesTheSameBitsForAnyCountAndAnyPadding) {
  const auto tape = compile(smooth_union(0.3, {circle(1), box(Vec2{1, 2}).rotate(0.4), star(1, 5, 3)}));
  ASSERT_TRUE(tape);
  for (const Target& target : targets()) {
    const std::vector<float> all = values(*tape, target, 130, 0);
    for (const std::size_t count : {0U, 1U, 3U, 31U, 32U, 33U, 64U, 65U, 129U}) {
      const std::vector<float> some = values(*tape, target, count, 1e30F);
      EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin())) << target.name << ' ' << count;
    }
  }
}

}  // namespace
}  // namespace thalweg
