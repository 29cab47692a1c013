// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Distance to a surface from values of f alone: boxes around the point are taken nearest first, dropped where |f|
// exceeds their half diagonal (f moves by at most the distance), and split until one that small still may hold a zero.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "oracle.h"

namespace thalweg::oracle {
namespace {

struct Box {
  double nearest = 0;  // distance from the point to the box
  Vec centre;
  double half = 0;
};

bool farther(const Box& a, const Box& b) { return a.nearest != b.nearest ? a.nearest > b.nearest : a.half > b.half; }

double gap(double p, double centre, double half) { return std::max(std::abs(p - centre) - half, 0.0); }

Box make_box(Vec point, Vec centre, double half, int dimension) {
  const double z = dimension == 3 ? gap(point.z, centre.z, half) : 0;
  return {std::hypot(gap(point.x, centre.x, half), gap(point.y, centre.y, half), z), centre, half};
}

/// A zero between `point` and `c`, whose values differ in sign: its distance from `point`, by bisection.
double crossing(const Field& field, Vec point, Vec c) {
  const bool negative = field(point) < 0;
  double near = 0, far = 1;
  for (int i = 0; i < 50; ++i) {
    const double middle = (near + far) / 2;
    ((field(point + (c - point) * middle) < 0) == negative ? near : far) = middle;
  }
  return far * distance(point, c);
}

}  // namespace

Interval brute_force_distance(const Field& field, Vec point, double reach, double resolution) {
  constexpr std::size_t kMostBoxes = 4'000'000;
  const int dimension = field.dimension();
  const double diagonal = std::sqrt(static_cast<double>(dimension));
  const double value = field(point);
  if (value == 0) return {0, 0};
  Interval found{reach, std::numeric_limits<double>::infinity()};
  std::vector<Box> heap{make_box(point, point, reach, dimension)};
  for (std::size_t boxes = 0; !heap.empty() && boxes < kMostBoxes; ++boxes) {
    std::pop_heap(heap.begin(), heap.end(), farther);
    const Box box = heap.back();
    heap.pop_back();
    found.lower = box.nearest;
    if (box.nearest >= found.upper - resolution) break;
    const double here = field(box.centre);
    if (std::abs(here) > box.half * diagonal) continue;
    if ((here < 0) != (value < 0)) found.upper = std::min(found.upper, crossing(field, point, box.centre));
    if (box.half * diagonal < resolution) {
      found.upper = std::min(found.upper, distance(point, box.centre) + resolution);
      continue;
    }
    const double half = box.half / 2;
    for (int child = 0; child < (1 << dimension); ++child) {
      const Vec centre{box.centre.x + (child & 1 ? half : -half), box.centre.y + (child & 2 ? half : -half),
                       dimension == 3 ? box.centre.z + (child & 4 ? half : -half) : 0};
      heap.push_back(make_box(point, centre, half, dimension));
      std::push_heap(heap.begin(), heap.end(), farther);
    }
  }
  if (heap.empty()) found.lower = std::min(found.upper, std::max(found.lower, reach));
  found.lower = std::min(found.lower, found.upper);
  return found;
}

Interval brute_force_distance(const Shape& shape, Vec point, double reach, double resolution) {
  return brute_force_distance(Field(shape), point, reach, resolution);
}

}  // namespace thalweg::oracle
