// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/sweep/path.h"

#include <algorithm>
#include <cmath>

namespace thalweg {
namespace {

/// Lengths are rounded up by this part.
constexpr double kUp = 1 + 1e-5;

/// A turn by the shorter way: unit axis and angle of a quaternion w, x, y, z. False for one of zeros.
bool axis_and_angle(const float* quaternion, double* axis, double& angle) {
  double w = static_cast<double>(quaternion[0]), square = 0;
  for (int k = 0; k < 3; ++k) {
    axis[k] = static_cast<double>(quaternion[1 + k]);
    square += axis[k] * axis[k];
  }
  const double length = std::sqrt(square);
  if (length == 0) {
    axis[0] = axis[1] = 0, axis[2] = 1;
    angle = 0;
    return w != 0;
  }
  // q and -q are the same turn; this one is the shorter.
  const double sign = w < 0 ? -1 : 1;
  for (int k = 0; k < 3; ++k) axis[k] *= sign / length;
  angle = 2 * std::atan2(length, sign * w);
  return true;
}

std::size_t width_of(int dimension) { return dimension == 2 ? 3 : 7; }

/// A vertex of a row, or the centre of its ball, and how far it moves by itself.
struct Vertex {
  double at[3] = {}, move[3] = {};
};

Vertex vertex_of(const SweepTile& tile, std::size_t row, std::size_t k, bool is_ball) {
  const auto d = static_cast<std::size_t>(tile.tape->dimension);
  const std::size_t first = row * (is_ball ? d + 1 : 3 * d) + k * d;
  Vertex v;
  for (std::size_t axis = 0; axis < d; ++axis) {
    v.at[axis] = static_cast<double>(tile.queries.rows[first + axis]);
    v.move[axis] = tile.queries.ends != nullptr
                       ? static_cast<double>(tile.queries.ends[first + axis]) - v.at[axis]
                       : -static_cast<double>(tile.queries.motions[row * width_of(tile.tape->dimension) + axis]);
  }
  return v;
}

bool is_answerable(const float* numbers, std::size_t count) {
  return std::all_of(numbers, numbers + count, [](float x) { return std::fabs(x) <= kLargestCoordinate; });
}

/// Reads how the scene turns; false where that cannot be answered.
bool read_turn(const SweepTile& tile, std::size_t row, Path& path) {
  if (tile.queries.motions == nullptr) return true;
  const int d = tile.tape->dimension;
  const float* const motion = tile.queries.motions + row * width_of(d);
  if (!is_answerable(motion, width_of(d))) return false;
  if (d == 2) path.angle = static_cast<double>(motion[2]);
  if (d == 3 && !axis_and_angle(motion + 3, path.axis, path.angle)) return false;
  return std::fabs(path.angle) <= kMostTurn;
}

}  // namespace

Path path_of(const SweepTile& tile, std::size_t row, bool is_ball) {
  const int d = tile.tape->dimension;
  const auto width = static_cast<std::size_t>(is_ball ? d + 1 : 3 * d);
  Path path;
  const float* const numbers = tile.queries.rows + row * width;
  const double radius = is_ball ? static_cast<double>(numbers[d]) : 0;
  path.is_bad = !is_answerable(numbers, width) || radius < 0 || !read_turn(tile, row, path) ||
                (tile.queries.ends != nullptr && !is_answerable(tile.queries.ends + row * width, width));
  if (path.is_bad) {
    path.angle = 0;
    return path;
  }
  // Squares first: a row takes three roots.
  double speed = 0, distance = 0, size = 0;
  Vertex first;
  for (std::size_t k = 0; k < (is_ball ? 1 : 3); ++k) {
    const Vertex v = vertex_of(tile, row, k, is_ball);
    if (k == 0) first = v;
    double move = 0, now = 0, then = 0, apart = 0;
    for (int axis = 0; axis < d; ++axis) {
      const double at = v.at[axis], by = v.move[axis];
      move += by * by;
      now += at * at;
      then += (at + by) * (at + by);
      apart += (at - first.at[axis]) * (at - first.at[axis]);
    }
    speed = std::max(speed, move);
    distance = std::max({distance, now, then});
    size = std::max(size, apart);
  }
  path.fastest = std::sqrt(speed) * kUp;
  path.furthest = std::sqrt(distance) * kUp;
  path.furthest += radius;
  const double angle = std::fabs(path.angle) * kUp;
  path.bend = angle * (angle * path.furthest + 2 * path.fastest);
  path.fastest += angle * path.furthest;
  path.margin = std::max(radius, std::sqrt(size)) + path.fastest / 8;
  return path;
}

Bounds box_of(const SweepTile& tile, std::size_t row, bool is_ball) {
  const int d = tile.tape->dimension;
  const Path path = path_of(tile, row, is_ball);
  Bounds box;
  for (int axis = 0; axis < d; ++axis) {
    box.lo[axis] = Bounds::kInfinity;
    box.hi[axis] = -Bounds::kInfinity;
  }
  if (path.is_bad) return box;
  const ScenePlace place = place_of_scene(tile, row, 0.5);
  const double radius =
      is_ball
          ? static_cast<double>(tile.queries.rows[row * static_cast<std::size_t>(d + 1) + static_cast<std::size_t>(d)])
          : 0;
  // No point is further from where it is at half the time than half the way.
  const double around = radius + path.fastest / 2 + path.margin + 1e-5 * path.furthest;
  for (std::size_t k = 0; k < (is_ball ? 1 : 3); ++k) {
    const Vertex v = vertex_of(tile, row, k, is_ball);
    for (int column = 0; column < d; ++column) {
      double at = 0;
      for (int axis = 0; axis < d; ++axis) {
        at += place.rotation[3 * axis + column] * (v.at[axis] + 0.5 * v.move[axis]);
      }
      box.lo[column] = std::min(box.lo[column], at - around);
      box.hi[column] = std::max(box.hi[column], at + around);
    }
  }
  return box;
}

ScenePlace place_of_scene(const SweepTile& tile, std::size_t row, double time) {
  ScenePlace place;
  if (tile.queries.motions == nullptr) return place;
  const int d = tile.tape->dimension;
  const float* const motion = tile.queries.motions + row * width_of(d);
  for (int axis = 0; axis < d; ++axis) place.translation[axis] = time * static_cast<double>(motion[axis]);
  double n[3] = {0, 0, 1}, angle = static_cast<double>(motion[2]);
  if (d == 3) axis_and_angle(motion + 3, n, angle);
  const double cosine = std::cos(time * angle), sine = std::sin(time * angle);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      // The entry of the cross product by n that is not i nor k, with its sign.
      const double cross = i == k ? 0 : ((k - i + 3) % 3 == 1 ? -1 : 1) * n[3 - i - k];
      place.rotation[3 * i + k] = (i == k ? cosine : 0) + sine * cross + (1 - cosine) * n[i] * n[k];
    }
  }
  return place;
}

}  // namespace thalweg
