// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The dichotomy as published against a transcription that does one point at a time: the same bits.
#include <gtest/gtest.h>

#include <numbers>

#include "asked.h"
#include "random.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

using testing_gradients::ask;
using testing_gradients::Asked;
using testing_gradients::compiled;

struct Scalar {
  const Tape& tape;
  std::uint32_t evaluations = 0;

  float f(float x, float y) {
    const float p[2] = {x, y};
    float value = 0;
    evaluate(tape, p, 1, &value, nullptr, {.threads = 1});
    ++evaluations;
    return value;
  }
};

struct Direction {
  float x, y;
};

/// Luneau 2025, section 2.3: |f| at three angles, the pair with the greatest sum, eight halvings.
Direction published(Scalar& scalar, float x, float y, float offset) {
  constexpr float kTau = 2 * std::numbers::pi_v<float>;
  const float sign = scalar.f(x, y) < 0 ? -1.0F : 1.0F;
  const auto probe = [&](float angle) {
    return std::fabs(scalar.f(x + std::cos(angle) * offset, y + std::sin(angle) * offset));
  };
  float angles[3], values[3];
  for (int k = 0; k < 3; ++k) {
    angles[k] = kTau / 6 + static_cast<float>(k) * kTau / 3;
    values[k] = probe(angles[k]);
  }
  int first = 0;
  for (int k = 1; k < 3; ++k) {
    if (values[k] + values[(k + 1) % 3] > values[first] + values[(first + 1) % 3]) first = k;
  }
  float from = angles[first], to = angles[(first + 1) % 3];
  float at_from = values[first], at_to = values[(first + 1) % 3];
  if (to < from) to += kTau;
  for (int step = 0; step < 8; ++step) {
    const float middle = (from + to) / 2;
    const float value = probe(middle);
    if (at_from < at_to) {
      from = middle, at_from = value;
    } else {
      to = middle, at_to = value;
    }
  }
  const float angle = (from + to) / 2;
  return {sign * std::cos(angle), sign * std::sin(angle)};
}

TEST(DichotomyVerbatim, IsThePublishedMethodBitForBit) {
  const Tape tape =
      compiled(smooth_union(1.0, {star(300, 12, 4).translate({1000, 550}), circle(200).translate({750, 400})}));
  oracle::Random random(17);
  std::vector<float> points;
  for (int i = 0; i < 1500; ++i) {
    points.push_back(static_cast<float>(random.uniform(400, 1500)));
    points.push_back(static_cast<float>(random.uniform(100, 1000)));
  }
  const Asked asked = ask(tape, points, {Gradient::dichotomy_verbatim, {}});
  for (std::size_t i = 0; i < asked.count(); ++i) {
    Scalar scalar{tape};
    const Direction expected = published(scalar, asked.point(i)[0], asked.point(i)[1], 0.005F);
    ASSERT_EQ(asked.direction(i)[0], expected.x) << i;
    ASSERT_EQ(asked.direction(i)[1], expected.y) << i;
    ASSERT_EQ(asked.evaluations[i], scalar.evaluations) << i;
  }
}

}  // namespace
}  // namespace thalweg
