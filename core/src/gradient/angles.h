// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The directions that a dichotomy over angles can ask for (Luneau 2025, section 2.3): three thirds of a turn, each
// halved nine times. There are 1537 of them, so their sines are taken once and not for every probe.
#pragma once

#include <array>
#include <cstddef>

namespace thalweg {

inline constexpr int kBisections = 8;
/// Steps of a third of a turn: its ends are 512 apart, and the last middle is a whole number.
inline constexpr std::size_t kStepsPerThird = std::size_t{1} << (kBisections + 1);

struct Directions {
  std::array<float, 3 * kStepsPerThird + 1> cosine, sine;
};

/// Direction i is i / 512 thirds of a turn from the first probe, which is at a sixth of a turn. Each angle is the mean
/// of the two it was halved from, in float32, as the published code has it.
[[nodiscard]] const Directions& directions();

}  // namespace thalweg
