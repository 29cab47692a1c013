// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the demo holds its answers against: an independent oracle in double precision for whether they are right, and
// the thesis' published method for how fast they are. Both are libraries of other rooms that only the demo links.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "thalweg/shape.h"

namespace thalweg::cli {

struct OracleCheck {
  std::size_t checked = 0;
  std::size_t wrong = 0;
  std::size_t oracle_undecided = 0;  ///< rows that the oracle could not tell
  std::size_t first_wrong_row = 0;
  std::string first_expected, first_found;
};

struct DemoRows {
  std::span<const float> triangles;      ///< (N,3,2)
  std::span<const std::uint8_t> status;  ///< (N)
  double tolerance = 0;                  ///< that `touching` was proven with
};

/// Checks `sample` rows spread evenly over all.
[[nodiscard]] OracleCheck check_with_oracle(const Shape& shape, const DemoRows& rows, std::size_t sample);

struct ThesisTiming {
  std::size_t triangles = 0;
  double seconds = 0;
  double evaluations_per_triangle = 0;
};

/// Times the published method on the thesis scene on so many threads.
[[nodiscard]] ThesisTiming time_thesis(std::span<const float> triangles, int threads);

}  // namespace thalweg::cli
