// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What is true of a pair of shapes, found with nothing of the solver: the oracle's fields in double on a dense grid,
// and a branch and bound of its own for the sign of min max(f_a, f_b).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "oracle/oracle.h"

namespace thalweg::oracle {

/// B's frame in A's: x_a = turn x_b + offset.
struct Placement {
  std::array<double, 9> turn = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vec offset;
};
/// From a pose row of 3 (2D) or 7 (3D) float32 numbers.
[[nodiscard]] Placement placement(const float* row, int dimension);

class PairField {
 public:
  PairField(const Shape& a, const Shape& b, const Placement& at) : a_(a), b_(b), at_(at) {}
  [[nodiscard]] double operator()(Vec p) const;
  [[nodiscard]] int dimension() const { return a_.dimension(); }

 private:
  Field a_, b_;
  Placement at_;
};

struct Box {
  Vec lo, hi;
};

/// g on a grid of `count` points along the longest side of a box.
class PairGrid {
 public:
  PairGrid(const PairField& field, const Box& box, int count);

  [[nodiscard]] double least() const { return least_; }
  [[nodiscard]] Vec least_at() const { return least_at_; }
  /// Between neighbours, diagonals included, a 1-Lipschitz field changes by at most twice this.
  [[nodiscard]] double half_step() const { return half_step_; }

  /// Components of {g <= level} among the grid's points, diagonal neighbours joined: a label per point, -1 above the
  /// level.
  [[nodiscard]] std::vector<int> components(double level) const;
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// Labels met at the grid points around `p`.
  [[nodiscard]] std::vector<int> labels_near(const std::vector<int>& labels, Vec p) const;

 private:
  [[nodiscard]] std::size_t index(const std::array<int, 3>& at) const;

  std::array<int, 3> count_ = {1, 1, 1};
  Vec lo_;
  double step_ = 0, half_step_ = 0;
  std::vector<double> values_;
  double least_ = 0;
  Vec least_at_;
};

/// The sign of min g over a box, g being 1-Lipschitz.
[[nodiscard]] Verdict pair_verdict(const PairField& field, const Box& box, std::size_t cap = 400000);

}  // namespace thalweg::oracle
