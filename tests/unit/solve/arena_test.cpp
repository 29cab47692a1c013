// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/arena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace thalweg {
namespace {

std::uintptr_t address(const void* block) { return reinterpret_cast<std::uintptr_t>(block); }

TEST(Arena, AlignsEveryBlockToACacheLine) {
  Arena arena;
  for (const std::size_t count : {1U, 3U, 16U, 17U, 1000U, 70'000U}) {
    EXPECT_EQ(address(arena.take<float>(count)) % Arena::kAlignment, 0U) << count;
    EXPECT_EQ(address(arena.take<std::uint8_t>(count)) % Arena::kAlignment, 0U) << count;
  }
}

TEST(Arena, KeepsBlocksApart) {
  Arena arena;
  struct Block {
    std::uint32_t* begin;
    std::size_t count;
  };
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < 200; ++i) {
    const std::size_t count = 1 + 997 * i % 5000;
    blocks.push_back({arena.take<std::uint32_t>(count), count});
    std::fill_n(blocks.back().begin, count, static_cast<std::uint32_t>(i));
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_EQ(std::count(blocks[i].begin, blocks[i].begin + blocks[i].count, i),
              static_cast<std::ptrdiff_t>(blocks[i].count));
  }
}

TEST(Arena, GivesTheSameMemoryAgainOnceWarm) {
  Arena arena;
  const auto round = [&] {
    arena.reset();
    std::vector<std::uintptr_t> all;
    for (std::size_t i = 1; i < 40; ++i) all.push_back(address(arena.take<double>(i * 4000)));
    return all;
  };
  round();
  const auto warm = round();
  EXPECT_EQ(round(), warm);
  // One chunk holds all of it: blocks follow one another.
  EXPECT_TRUE(std::is_sorted(warm.begin(), warm.end()));
}

TEST(Arena, GivesNothingForNothing) {
  Arena arena;
  EXPECT_NE(arena.take<float>(1), nullptr);
  arena.reset();
  arena.reset();
  EXPECT_NE(arena.take<float>(0), nullptr);
}

TEST(Arena, HoldsABlockLargerThanAnyChunkSoFar) {
  Arena arena;
  auto* small = arena.take<std::uint8_t>(10);
  std::fill_n(small, 10, std::uint8_t{7});
  auto* large = arena.take<std::uint8_t>(10'000'000);
  std::fill_n(large, 10'000'000, std::uint8_t{9});
  EXPECT_EQ(std::count(small, small + 10, 7), 10);
}

}  // namespace
}  // namespace thalweg
