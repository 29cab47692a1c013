// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// MuJoCo's way with two signed distance fields, as the baseline that pairs of shapes are held against: one start after
// the other in scalar double, Halton points in the overlap of the boxes, gradient descent on
// f_a + f_b + |max(f_a, f_b)| with a backtracking line search (first step 2, halved down to 1e-4, Armijo 0.1), and one
// step on max(f_a, f_b) at the end. Nothing is allocated in the loop. The pair is two equal tori around the y axis.
#pragma once

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

struct MidsurfaceOptions {
  int starts = 40;
  int iterations = 10;
};

struct MidsurfaceAnswer {
  bool overlaps = false;  ///< some start ended with max(f_a, f_b) <= 0
  double value = 0;       ///< the least max(f_a, f_b) that a start ended with
  double point[3] = {};
  int contacts = 0;  ///< starts that ended with it <= 0
};

[[nodiscard]] MidsurfaceAnswer midsurface(const Torus& torus, const TorusPose& pose,
                                          const MidsurfaceOptions& options = {});

/// max(f_a, f_b) at a point of A's frame.
[[nodiscard]] double common_value(const Torus& torus, const TorusPose& pose, const double* point);

}  // namespace thalweg::bench
