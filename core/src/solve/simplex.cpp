// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The inner point where it lies in the triangle, else the best of the three edges: no case can divide by zero.
#include "solve/simplex.h"

namespace thalweg {
namespace {

struct EdgePoint {
  float along;   ///< 0 at the first end, 1 at the second
  float square;  ///< squared distance to p
};

EdgePoint closest_on_edge(const float* from, const float* to, const float* p, std::size_t dimension) {
  float edge_square = 0;
  float along = 0;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const float e = to[axis] - from[axis];
    edge_square += e * e;
    along += e * (p[axis] - from[axis]);
  }
  along = edge_square > 0 ? std::clamp(along / edge_square, 0.0F, 1.0F) : 0;
  float square = 0;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const float x = p[axis] - (from[axis] + along * (to[axis] - from[axis]));
    square += x * x;
  }
  return {along, square};
}

/// In double: the differences of float32 coordinates are exact there, so a flat triangle shows as one.
double dot_of(const float* a, const float* a0, const float* b, const float* b0, std::size_t dimension) {
  double sum = 0;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const double x = static_cast<double>(a[axis]) - static_cast<double>(a0[axis]);
    const double y = static_cast<double>(b[axis]) - static_cast<double>(b0[axis]);
    sum += x * y;
  }
  return sum;
}

}  // namespace

Barycentric closest_point(const float* corners, const float* p, std::size_t dimension) {
  const float* a = corners;
  const float* b = corners + dimension;
  const float* c = corners + 2 * dimension;
  const double bb = dot_of(b, a, b, a, dimension);
  const double bc = dot_of(b, a, c, a, dimension);
  const double cc = dot_of(c, a, c, a, dimension);
  const double pb = dot_of(p, a, b, a, dimension);
  const double pc = dot_of(p, a, c, a, dimension);
  const double determinant = bb * cc - bc * bc;
  if (determinant > 1e-12 * bb * cc) {
    const double u = (cc * pb - bc * pc) / determinant;
    const double v = (bb * pc - bc * pb) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1) {
      return {static_cast<float>(1 - u - v), static_cast<float>(u), static_cast<float>(v)};
    }
  }
  const EdgePoint ab = closest_on_edge(a, b, p, dimension);
  const EdgePoint ac = closest_on_edge(a, c, p, dimension);
  const EdgePoint bc_edge = closest_on_edge(b, c, p, dimension);
  if (ab.square <= ac.square && ab.square <= bc_edge.square) return {1 - ab.along, ab.along, 0};
  if (ac.square <= bc_edge.square) return {1 - ac.along, 0, ac.along};
  return {0, 1 - bc_edge.along, bc_edge.along};
}

}  // namespace thalweg
