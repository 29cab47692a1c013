// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "gradient/angles.h"

#include <cmath>
#include <numbers>

namespace thalweg {
namespace {

struct Angle {
  std::size_t index;
  float radians;
};

void set(Directions& table, Angle angle) {
  table.cosine[angle.index] = std::cos(angle.radians);
  table.sine[angle.index] = std::sin(angle.radians);
}

// At most nine deep.
void halve(Directions& table, Angle from, Angle to) {  // NOLINT(misc-no-recursion)
  if (to.index - from.index == 1) return;
  const Angle middle{(from.index + to.index) / 2, (from.radians + to.radians) / 2};
  set(table, middle);
  halve(table, from, middle);
  halve(table, middle, to);
}

Directions make_directions() {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  Directions table;
  Angle from{0, kTurn / 6};
  set(table, from);
  for (std::size_t third = 1; third <= 3; ++third) {
    const float radians = third < 3 ? kTurn / 6 + static_cast<float>(third) * kTurn / 3 : kTurn / 6 + kTurn;
    const Angle to{third * kStepsPerThird, radians};
    set(table, to);
    halve(table, from, to);
    from = to;
  }
  return table;
}

}  // namespace

const Directions& directions() {
  static const Directions table = make_directions();
  return table;
}

}  // namespace thalweg
