// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Where a field has a kink: ties of min and max, medial axes inside primitives, centres. Gradients at the vertices of a
// regular simplex as small as the rounding of f around the point differ in direction there, whatever made the kink; on
// a smooth piece they cannot. So nothing is asked of the ops, and whoever does not ask for ties does not pay for them.
#pragma once

#include "kernels/kernels.h"
#include "solve/arena.h"

namespace thalweg {

/// Gradients that differ by more than this are two, as a cosine: 3 degrees. A smooth field turns so much over the
/// simplex only where its radius of curvature is some thirty times the rounding of f, or less.
inline constexpr float kTieCosine = 0.9986295F;

/// Padded columns, one entry a point.
struct Ties {
  std::uint8_t* tied = nullptr;  ///< 1 within rounding of a kink, and where the gradient vanishes
  /// Unit gradients on two sides of a kink: of those around the point the two that differ most, first the one nearer to
  /// the gradient at the point. Elsewhere both are that gradient. Null where nobody wants them.
  float* sides[2][3] = {};

  static Ties make(Arena& arena, int dimension, std::size_t count, bool with_sides);
};

/// How far from a point of this largest coordinate the vertices are.
[[nodiscard]] float tie_reach(const Tape& tape, float largest);

/// Takes d + 2 gradient passes over the points.
void find_ties(const Tape& tape, const Kernels& kernels, const float* const* points, std::size_t count,
               const Ties& ties, float* kernel_scratch, Arena& arena);

}  // namespace thalweg
