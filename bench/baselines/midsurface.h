// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// MuJoCo's way with two signed distance fields, as the baseline that pairs of shapes are held against, in scalar double
// and one start after the other: Halton points in the overlap of the boxes, gradient descent on
// f_a + f_b + |max(f_a, f_b)| with a backtracking line search, one step on max(f_a, f_b), and a contact with a normal
// from grad f_a - grad f_b for each start that ends with it <= 0 at a point not yet seen.
//
// What is evaluated follows engine_collision_sdf.c as it is since it has a line search: fields are plug-ins behind
// function pointers; every value takes the point to the other frame again; a step evaluates both fields for the
// gradient, once more for the value before it, and for each trial; the first trial is 1, halved until Armijo's rule
// with 0.1 holds or it is at most 1e-4, and the last trial is kept; a start ends early when a step went up.
// The pair is two equal tori around the y axis.
#pragma once

#include <cstddef>

namespace thalweg::bench {

struct Torus {
  double radius = 0.35, tube = 0.15;
};

/// B in A's frame: a point and a rotation, row-major.
struct TorusPose {
  double offset[3] = {};
  double turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
};
/// From a row x y z qw qx qy qz.
[[nodiscard]] TorusPose torus_pose(const float* row);

/// A field as a plug-in: the descent knows nothing of what is behind the pointers.
struct FieldPlugin {
  double (*distance)(const double* point, const void* shape) = nullptr;
  void (*gradient)(double* gradient, const double* point, const void* shape) = nullptr;
  const void* shape = nullptr;
};
/// In a file of its own, so that no compiler looks through the pointers.
[[nodiscard]] FieldPlugin torus_plugin(const Torus& torus);

struct MidsurfaceOptions {
  int starts = 40;
  int iterations = 10;
};

struct MidsurfaceContact {
  double point[3];
  double normal[3];
  double value;
};

struct MidsurfaceAnswer {
  bool overlaps = false;  ///< some start ended with max(f_a, f_b) <= 0
  double value = 0;       ///< the least max(f_a, f_b) that a start ended with
  std::size_t contacts = 0;
  MidsurfaceContact contact[40];  ///< as many as there are by default starts; no more are kept
};

[[nodiscard]] MidsurfaceAnswer midsurface(const Torus& torus, const TorusPose& pose,
                                          const MidsurfaceOptions& options = {});

/// max(f_a, f_b) at a point of A's frame.
[[nodiscard]] double common_value(const Torus& torus, const TorusPose& pose, const double* point);

}  // namespace thalweg::bench
