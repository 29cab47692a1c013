// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Kinks: ties of operators, medial axes of primitives, centres; and smooth places that must not be taken for any.
#include <gtest/gtest.h>

#include "asked.h"
#include "gradient/ties.h"
#include "random.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

using testing_gradients::compiled;

struct Kinks {
  std::vector<std::uint8_t> ambiguous;
  std::vector<float> one_sided;
};

Kinks kinks_of(const Tape& tape, const std::vector<float>& points) {
  const auto d = static_cast<std::size_t>(tape.dimension);
  Kinks kinks{std::vector<std::uint8_t>(points.size() / d), std::vector<float>(2 * points.size())};
  const auto done = evaluate(tape, Points{points.data(), points.size() / d}, {},
                             {.ambiguous = kinks.ambiguous.data(), .one_sided = kinks.one_sided.data()});
  EXPECT_TRUE(done);
  return kinks;
}

struct Place {
  const char* name;
  Shape shape;
  std::vector<float> kinks, smooth;
};

std::vector<Place> places() {
  const Shape pair = circle(1).translate({-2, 0}) | circle(1).translate({2, 0});
  const Shape bitten = circle(2) - circle(1).translate({2, 0});
  return {
      {"union", pair, {0, 0, 0, 5, 0, -0.3F}, {0.01F, 0, -3, 1, 2.5F, 0}},
      {"intersection", half_plane(Vec2{1, 0}, 0) & half_plane(Vec2{0, 1}, 0), {0, 0, 2, 2, -3, -3}, {2, 1, 0, -1}},
      {"subtraction", bitten, {1.75F, 0.9682458F}, {1.2F, 0, -1, 1}},
      {"onion", onion(circle(1), 0.25), {1, 0, 0, -1}, {1.1F, 0, 0.8F, 0}},
      {"medial axis of a box", box(Vec2{2, 1}), {1.5F, 0.5F, 0, 0, 0.5F, 0}, {1.5F, 0.4F, 3, 3, 3, 0.2F}},
      {"centre of a circle", circle(1), {0, 0}, {0.01F, 0}},
      {"notches of a star", star(2, 7, 3), {0, 0}, {0.1F, 3}},
      {"axis of a torus", torus(2, 0.5), {0, 0, 0, 0, 1, 0}, {0.1F, 0, 0, 2.2F, 0.1F, 0}},
      {"box in space", box(Vec3{1, 1, 1}).rotate(Vec3{1, 2, 3}, 0.7), {0, 0, 0}, {3, 3, 3}},
  };
}

TEST(Ties, AreFoundWhereTheGradientIsNotUniqueAndNowhereElse) {
  for (const Place& place : places()) {
    const Tape tape = compiled(place.shape);
    const Kinks kinks = kinks_of(tape, place.kinks);
    for (std::size_t i = 0; i < kinks.ambiguous.size(); ++i) EXPECT_EQ(kinks.ambiguous[i], 1) << place.name << ' ' << i;
    const Kinks smooth = kinks_of(tape, place.smooth);
    for (std::size_t i = 0; i < smooth.ambiguous.size(); ++i) {
      EXPECT_EQ(smooth.ambiguous[i], 0) << place.name << ' ' << i;
    }
  }
}

TEST(Ties, AreRareAmongRandomPoints) {
  oracle::Random random(5);
  for (const Place& place : places()) {
    const Tape tape = compiled(place.shape);
    std::vector<float> points;
    for (int i = 0; i < 6000; ++i) points.push_back(static_cast<float>(random.uniform(-4, 4)));
    const Kinks kinks = kinks_of(tape, points);
    std::size_t count = 0;
    for (const std::uint8_t tied : kinks.ambiguous) count += tied;
    EXPECT_LE(count, kinks.ambiguous.size() / 500) << place.name;
  }
}

TEST(OneSidedGradients, AreThoseOfTheTwoPieces) {
  // Between two circles the gradient leads away from one centre or from the other.
  const Tape tape = compiled(circle(1).translate({-2, 0}) | circle(1).translate({2, 0}));
  const Kinks kinks = kinks_of(tape, {0, 1, 1, 1});
  const double r = std::sqrt(5.0);
  // First the one that autodiff reports: at a tie that of the first operand.
  const double expected[4] = {2 / r, 1 / r, -2 / r, 1 / r};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(static_cast<double>(kinks.one_sided[i]), expected[i], 1e-4) << i;
  for (int i = 0; i < 2; ++i) EXPECT_EQ(kinks.one_sided[4 + i], kinks.one_sided[6 + i]);
}

TEST(OneSidedGradients, AreUnitOrNone) {
  for (const Place& place : places()) {
    const Tape tape = compiled(place.shape);
    const auto d = static_cast<std::size_t>(tape.dimension);
    const Kinks kinks = kinks_of(tape, place.kinks);
    for (std::size_t at = 0; at < kinks.one_sided.size(); at += d) {
      double square = 0;
      for (std::size_t axis = 0; axis < d; ++axis) {
        square += static_cast<double>(kinks.one_sided[at + axis]) * static_cast<double>(kinks.one_sided[at + axis]);
      }
      EXPECT_NEAR(square, 1, 1e-5) << place.name;
    }
  }
}

TEST(Ties, AreFoundFarFromTheOriginToo) {
  const Shape pair = circle(1).translate({-2, 0}) | circle(1).translate({2, 0});
  const Kinks kinks = kinks_of(compiled(pair.translate({4000, 3000})), {4000, 3001, 4001, 3001});
  EXPECT_EQ(kinks.ambiguous, (std::vector<std::uint8_t>{1, 0}));
}

}  // namespace
}  // namespace thalweg
