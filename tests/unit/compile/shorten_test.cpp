// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Shortened tapes return the bits of the full one within their region, in every mode, and are short where they should
// be.
#include "compile/shorten.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "random_shapes.h"
#include "thalweg/ops.h"
#include "thalweg/simd.h"

namespace thalweg {
namespace {

using oracle::Random;

constexpr std::size_t kPoints = 128;

Tape tape_of(const Shape& shape) { return std::move(compile(shape)).value(); }

/// Points within a region, and cells around them of the region's cell reach.
struct Cells {
  std::array<std::vector<float>, 3> centre;
  std::vector<float> reach;
  std::array<std::vector<float>, 9> edges;

  Cells(Random& random, const Region& region, int dimension) : reach(padded(kPoints)) {
    for (auto& column : centre) column.resize(padded(kPoints));
    for (auto& column : edges) column.resize(padded(kPoints));
    const double half = static_cast<double>(region.reach) / std::sqrt(static_cast<double>(dimension)) * 0.999;
    const double size = static_cast<double>(region.cell_reach) / std::sqrt(static_cast<double>(dimension)) * 0.999;
    for (std::size_t i = 0; i < padded(kPoints); ++i) {
      reach[i] = region.cell_reach;
      for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
        centre[axis][i] = static_cast<float>(static_cast<double>(region.centre[axis]) + random.uniform(-half, half));
        edges[axis][i] = static_cast<float>(random.uniform(0, size));
      }
    }
  }
};

/// All that the kernels say about some cells.
std::vector<float> answers(const Tape& tape, const Kernels& kernels, const Cells& cells) {
  const std::size_t room = padded(kPoints);
  std::vector<float> all(7 * room);
  // A register that nobody wrote shows.
  std::vector<float> scratch(scratch_floats(tape), std::numeric_limits<float>::quiet_NaN());
  const float* points[3] = {cells.centre[0].data(), cells.centre[1].data(), cells.centre[2].data()};
  float* gradient[3] = {&all[room], &all[2 * room], &all[3 * room]};
  kernels.value(tape, points, kPoints, all.data(), scratch.data());
  kernels.gradient(tape, points, kPoints, &all[4 * room], gradient, scratch.data());
  CellColumns columns;
  columns.reach = cells.reach.data();
  for (std::size_t i = 0; i < 3; ++i) columns.edges[i] = cells.edges[i].data();
  columns.is_box = true;
  kernels.enclosure(tape, points, columns, kPoints, &all[5 * room], &all[6 * room], scratch.data());
  return all;
}

Region random_region(Random& random, int dimension, double world) {
  Region region;
  for (int axis = 0; axis < dimension; ++axis) {
    region.centre[axis] = static_cast<float>(random.uniform(-world, world));
  }
  region.reach = static_cast<float>(random.spread(world * 1e-4, world));
  region.cell_reach = random.chance(0.5) ? 0 : region.reach * static_cast<float>(random.uniform(0.01, 0.5));
  return region;
}

/// Of regions on their own, or of pieces of one, of which a target takes so many.
void expect_the_same_bits(const Tape& full, Shortener& shortener, std::span<const Region> regions, bool are_pieces,
                          Random& random, const std::string& scene) {
  Tape tape = full;
  for (const Target& target : targets()) {
    if (are_pieces) {
      regions = regions.first(std::min(regions.size(), target.kernels->pieces));
      shortener.analyse_pieces(full, *target.kernels, regions);
    } else {
      shortener.analyse(full, *target.kernels, regions);
    }
    for (std::size_t i = 0; i < regions.size(); ++i) {
      shortener.shorten(are_pieces ? 0 : i, tape);
      const Cells cells(random, regions[i], full.dimension);
      auto expected = answers(full, *target.kernels, cells);
      auto found = answers(tape, *target.kernels, cells);
      // Without cells only values and gradients are promised.
      const std::size_t promised = regions[i].cell_reach > 0 ? expected.size() : 5 * padded(kPoints);
      ASSERT_EQ(std::memcmp(expected.data(), found.data(), promised * sizeof(float)), 0)
          << target.name << " region " << i << "\n"
          << full.disassembly() << tape.disassembly() << scene;
      for (std::size_t k = 0; k < kPoints; ++k) {
        ASSERT_GE(expected[k], shortener.lower(i));
        ASSERT_LE(expected[k], shortener.upper(i));
      }
    }
  }
}

class RandomScenes : public testing::TestWithParam<int> {};

TEST_P(RandomScenes, KeepTheirBits) {
  const int dimension = GetParam();
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const Shape shape = oracle::random_shape(random, dimension, 12 + static_cast<int>(random.index(30)));
    const Tape full = tape_of(shape);
    Shortener shortener;
    shortener.begin(full);
    std::vector<Region> regions;
    for (int i = 0; i < 5; ++i) regions.push_back(random_region(random, dimension, 20));
    for (const bool are_pieces : {false, true}) {
      expect_the_same_bits(full, shortener, regions, are_pieces, random, oracle::describe(shape, seed));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shortened, RandomScenes, testing::Values(2, 3));

/// Discs on a grid, one unit apart, joined in an order that has nothing to do with their places.
Shape scattered_discs(int side, double k) {
  std::vector<Shape> parts;
  for (int i = 0; i < side * side; ++i) {
    const int at = i * 7 % (side * side);
    parts.push_back(circle(0.3).translate(Vec2{static_cast<double>(at % side), static_cast<double>(at / side)}));
  }
  while (parts.size() > 1) {
    std::vector<Shape> joined;
    for (std::size_t i = 0; i + 1 < parts.size(); i += 2) joined.push_back(smooth_union(k, {parts[i], parts[i + 1]}));
    if (parts.size() % 2 != 0) joined.push_back(parts.back());
    parts = joined;
  }
  return parts[0];
}

TEST(Shortened, TapeHoldsWhatIsNearWhateverTheOrderOfTheUnions) {
  for (const double k : {0.0, 0.01}) {
    const Tape full = tape_of(scattered_discs(20, k));
    Shortener shortener;
    shortener.begin(full);
    Tape tape = full;
    Region region;
    region.centre[0] = 7.2F;
    region.centre[1] = 11.9F;
    region.reach = 0.2F;
    shortener.analyse(full, *default_target().kernels, {&region, 1});
    shortener.shorten(0, tape);
    EXPECT_GT(full.instructions.size(), 700U);
    EXPECT_LT(tape.instructions.size(), 12U) << tape.disassembly();
  }
}

TEST(Shortened, TapesShortenFurtherByPiecesOfARegion) {
  const Tape full = tape_of(scattered_discs(20, 0.01));
  Shortener shortener;
  shortener.begin(full);
  Region whole;
  whole.centre[0] = whole.centre[1] = 8;
  whole.half[0] = whole.half[1] = 2;
  whole.reach = 2.9F;
  std::vector<Region> pieces;
  for (int i = 0; i < 8; ++i) {
    Region& piece = pieces.emplace_back();
    piece.centre[0] = 6.5F + static_cast<float>(i % 4);
    piece.centre[1] = i < 4 ? 7 : 9;
    piece.half[0] = 0.5F;
    piece.half[1] = 1;
    piece.reach = 1.12F;
  }
  Tape by_whole = full, by_pieces = full;
  shortener.analyse(full, *default_target().kernels, {&whole, 1});
  shortener.shorten(0, by_whole);
  shortener.analyse_pieces(full, *default_target().kernels, pieces);
  shortener.shorten(0, by_pieces);
  EXPECT_LT(by_pieces.instructions.size(), 2 * by_whole.instructions.size() / 3);
}

TEST(Shortened, TapesShortenFurtherInSmallerRegions) {
  const Tape full = tape_of(scattered_discs(20, 0.01));
  Shortener shortener;
  shortener.begin(full);
  Region large, small;
  large.centre[0] = small.centre[0] = 8;
  large.centre[1] = small.centre[1] = 8;
  large.reach = 3;
  small.reach = 0.1F;
  Tape half = full, least = full, at_once = full;
  shortener.analyse(full, *default_target().kernels, {&large, 1});
  shortener.shorten(0, half);
  shortener.analyse(half, *default_target().kernels, {&small, 1});
  shortener.shorten(0, least);
  shortener.analyse(full, *default_target().kernels, {&small, 1});
  shortener.shorten(0, at_once);
  EXPECT_LT(half.instructions.size(), full.instructions.size() / 2);
  EXPECT_LT(least.instructions.size(), half.instructions.size() / 4);
  EXPECT_LE(least.instructions.size(), at_once.instructions.size() + 2);
}

}  // namespace
}  // namespace thalweg
