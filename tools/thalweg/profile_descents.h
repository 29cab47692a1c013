// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What a gradient strategy does to the local descents over triangles, held against the certified deepest point.
#pragma once

#include <vector>

#include "command.h"
#include "thalweg/query.h"
#include "thalweg/tape.h"

namespace thalweg::cli {

struct DescentProfile {
  Method method = Method::projected;
  Gradient strategy = Gradient::autodiff;
  std::size_t hits = 0;                                     ///< triangles that overlap, proven
  std::size_t misses = 0;                                   ///< of those, not claimed
  double median_error = 0, p99_error = 0, most_error = 0;   ///< value minus the proven minimum, in diagonals
  double iterations = 0, evaluations = 0, nanoseconds = 0;  ///< a triangle; one thread
};

/// Every local method over triangles that takes gradients, with every strategy of the scene's dimension.
[[nodiscard]] std::vector<DescentProfile> profile_descents(const Tape& tape, const std::vector<float>& triangles,
                                                           const ProbeOffset& offset, const Globals& globals);

}  // namespace thalweg::cli
