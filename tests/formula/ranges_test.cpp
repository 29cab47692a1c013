// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Ranges of random programs hold what a second reader computes, in float32 and in double; shortened tapes have the bits
// of the full one.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "columns.h"
#include "compile/shorten.h"
#include "kernels/twin.h"
#include "program.h"
#include "thalweg/shape.h"

namespace thalweg::formulas {
namespace {

using oracle::Program;
using oracle::Random;

constexpr std::size_t kBoxes = 64;

struct Drawn {
  std::string text;
  Program program;
  Tape tape;
};

Drawn drawn(std::uint64_t seed) {
  Random random(seed);
  const int dimension = seed % 2 == 0 ? 2 : 3;
  const int steps = 2 + static_cast<int>(random.index(38));
  std::string text = oracle::random_program(random, steps, seed % 3 != 0, dimension);
  auto shape = Shape::formula("vm", 3, text);
  EXPECT_TRUE(shape) << to_string(shape.error()) << "\n" << text;
  Program program(text);
  return {std::move(text), std::move(program), std::move(compile(*shape)).value()};
}

Boxes random_boxes(Random& random) {
  Boxes boxes(kBoxes);
  for (std::size_t i = 0; i < kBoxes; ++i) {
    const bool degenerate = random.chance(0.25);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      boxes.centre[axis][i] = static_cast<float>(random.uniform(-2, 2));
      boxes.half[axis][i] = degenerate ? 0 : static_cast<float>(random.spread(1e-5, 1));
    }
  }
  return boxes;
}

/// Where a sample of box i lies, as float32 numbers inside of it.
std::array<float, 3> sample(Random& random, const Boxes& boxes, std::size_t i) {
  std::array<float, 3> at{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float c = boxes.centre[axis][i], h = boxes.half[axis][i];
    const float by =
        random.chance(0.3) ? (random.chance(0.5) ? 1.0F : -1.0F) : static_cast<float>(random.uniform(-1, 1));
    at[axis] = c + by * h;
    const bool outside = std::fabs(static_cast<double>(at[axis]) - static_cast<double>(c)) > static_cast<double>(h);
    if (outside) at[axis] = c;
  }
  return at;
}

TEST(Ranges, OfRandomProgramsHoldTheRealValues) {
  std::size_t known = 0;
  for (std::uint64_t seed = 0; seed < amount(150); ++seed) {
    const Drawn d = drawn(seed);
    Random random(seed + 1'000'000);
    Boxes boxes = random_boxes(random);
    const Target& target = targets()[seed % targets().size()];
    boxes.bound(d.tape, target);
    for (std::size_t i = 0; i < kBoxes; ++i) {
      known += std::isfinite(boxes.lower[i]) ? 1 : 0;
      for (int k = 0; k < 12; ++k) {
        const auto at = sample(random, boxes, i);
        const double f =
            d.program.evaluate(static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2]));
        const auto say = [&] {
          return testing::Message() << "seed " << seed << ", f(" << at[0] << ", " << at[1] << ", " << at[2]
                                    << ") = " << f << ", range " << boxes.lower[i] << " to " << boxes.upper[i] << " on "
                                    << target.name << "\n"
                                    << d.text;
        };
        if (std::isnan(f)) {
          // inf - inf: overflow in the reference, not an undefined formula; nothing finite is known then either.
          ASSERT_TRUE(std::isinf(boxes.lower[i]) || std::isinf(boxes.upper[i])) << say();
          continue;
        }
        ASSERT_GE(f, static_cast<double>(boxes.lower[i])) << say();
        ASSERT_LE(f, static_cast<double>(boxes.upper[i])) << say();
      }
    }
  }
  EXPECT_GT(4 * known, amount(150) * kBoxes) << "the ranges say too little";
}

TEST(Ranges, HoldTheValuesThatTheKernelsCompute) {
  for (std::uint64_t seed = 0; seed < amount(100); ++seed) {
    const Drawn d = drawn(seed);
    Random random(seed + 2'000'000);
    Boxes boxes = random_boxes(random);
    const Target& target = targets()[seed % targets().size()];
    boxes.bound(d.tape, target);
    std::array<Column, 3> points;
    for (std::size_t i = 0; i < kBoxes; ++i) {
      const auto at = sample(random, boxes, i);
      for (std::size_t axis = 0; axis < 3; ++axis) points[axis].push_back(at[axis]);
    }
    const Fields found = fields_at(d.tape, target, points, kBoxes);
    for (std::size_t i = 0; i < kBoxes; ++i) {
      if (std::isnan(found.value[i])) continue;
      ASSERT_GE(found.value[i], boxes.lower[i]) << "seed " << seed << "\n" << d.text;
      ASSERT_LE(found.value[i], boxes.upper[i]) << "seed " << seed << "\n" << d.text;
    }
  }
}

TEST(Ranges, InDoubleHoldTheRealValuesAndAreNarrower) {
  for (std::uint64_t seed = 0; seed < amount(100); ++seed) {
    const Drawn d = drawn(seed);
    Random random(seed + 3'000'000);
    Boxes boxes = random_boxes(random);
    boxes.bound(d.tape, default_target());
    Twin twin(d.tape);
    for (std::size_t i = 0; i < kBoxes; ++i) {
      double centre[3];
      Cell64 cell;
      cell.is_box = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        centre[axis] = static_cast<double>(boxes.centre[axis][i]);
        cell.edges[axis] = static_cast<double>(boxes.half[axis][i]);
      }
      const Enclosure64 range = twin.enclose(centre, cell);
      ASSERT_GE(range.lo, static_cast<double>(boxes.lower[i])) << "seed " << seed << "\n" << d.text;
      ASSERT_LE(range.hi, static_cast<double>(boxes.upper[i])) << "seed " << seed << "\n" << d.text;
      for (int k = 0; k < 8; ++k) {
        const auto at = sample(random, boxes, i);
        const double f =
            d.program.evaluate(static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2]));
        if (std::isnan(f)) continue;
        // The reference rounds too.
        const double margin = 1e-11 * (1 + std::fabs(f));
        ASSERT_GE(f, range.lo - margin) << "seed " << seed << "\n" << d.text;
        ASSERT_LE(f, range.hi + margin) << "seed " << seed << "\n" << d.text;
      }
    }
  }
}

TEST(ShortenedFormulas, HaveTheBitsOfTheFullTapeWithinTheirRegion) {
  std::size_t shorter = 0;
  for (std::uint64_t seed = 0; seed < amount(200); ++seed) {
    const Drawn d = drawn(3 * seed);
    Random random(seed);
    Region region;
    for (float& c : region.centre) c = static_cast<float>(random.uniform(-2, 2));
    region.reach = static_cast<float>(random.spread(1e-3, 1));
    const Target& target = targets()[seed % targets().size()];
    Shortener shortener;
    shortener.begin(d.tape);
    shortener.analyse(d.tape, *target.kernels, {&region, 1});
    Tape shortened = d.tape;
    shortener.shorten(0, shortened);
    shorter += shortened.instructions.size() < d.tape.instructions.size() ? 1 : 0;
    std::array<Column, 3> points;
    for (std::size_t i = 0; i < kBoxes; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        points[axis].push_back(region.centre[axis] + region.reach * static_cast<float>(random.uniform(-0.57, 0.57)));
      }
    }
    const Fields full = fields_at(d.tape, target, points, kBoxes);
    const Fields found = fields_at(shortened, target, points, kBoxes);
    for (std::size_t i = 0; i < kBoxes; ++i) {
      if (std::isnan(full.value[i])) {
        ASSERT_TRUE(std::isnan(found.value[i])) << d.text;
        continue;
      }
      ASSERT_EQ(std::bit_cast<std::uint32_t>(full.value[i]), std::bit_cast<std::uint32_t>(found.value[i]))
          << "seed " << seed << "\n"
          << d.text;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(full.gradient[axis][i]),
                  std::bit_cast<std::uint32_t>(found.gradient[axis][i]))
            << "seed " << seed << "\n"
            << d.text;
      }
    }
  }
  EXPECT_GT(shorter, amount(200) / 10);
}

}  // namespace
}  // namespace thalweg::formulas
