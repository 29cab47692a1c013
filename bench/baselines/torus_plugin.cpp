// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The torus around the y axis as a plug-in of baselines/midsurface.h.
#include <algorithm>
#include <cmath>

#include "baselines/midsurface.h"

namespace thalweg::bench {
namespace {

/// A gradient where the direction is undefined is short, not infinite.
constexpr double kLeastLength = 1e-15;

const Torus& torus_of(const void* shape) { return *static_cast<const Torus*>(shape); }

double distance(const double* p, const void* shape) {
  const Torus& t = torus_of(shape);
  const double ring = std::sqrt(p[0] * p[0] + p[2] * p[2]) - t.radius;
  return std::sqrt(ring * ring + p[1] * p[1]) - t.tube;
}

void gradient(double* g, const double* p, const void* shape) {
  const double axis = std::sqrt(p[0] * p[0] + p[2] * p[2]);
  const double ring = axis - torus_of(shape).radius;
  const double length = std::max(std::sqrt(ring * ring + p[1] * p[1]), kLeastLength);
  g[0] = ring * (p[0] / axis) / length;
  g[1] = p[1] / length;
  g[2] = ring * (p[2] / axis) / length;
}

}  // namespace

FieldPlugin torus_plugin(const Torus& torus) { return {distance, gradient, &torus}; }

}  // namespace thalweg::bench
