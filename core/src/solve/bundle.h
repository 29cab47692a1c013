// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A model of f over a triangle: the greatest of a few linear functions (Kelley 1960), and its least point.
#pragma once

#include <cstddef>

namespace thalweg {

/// f0 + fu u + fv v over the coordinates u, v >= 0, u + v <= 1 of the second and third corner.
struct Cut {
  float f0, fu, fv;
  [[nodiscard]] float at(float u, float v) const { return f0 + (fu * u + fv * v); }
};

struct ModelPoint {
  float u, v, value;
};

inline constexpr std::size_t kMostCuts = 6;

/// The least point over the triangle of the greatest of 1 to kMostCuts cuts; exact up to rounding. Of equal ones
/// corners come before points of edges, and these before inner ones.
[[nodiscard]] ModelPoint least_of_greatest(const Cut* cuts, std::size_t count);

}  // namespace thalweg
