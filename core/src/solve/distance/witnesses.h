// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Two points, one of each shape, and how far they are apart at the most: by projecting in turns, in double.
#pragma once

#include <cstdint>
#include <limits>

#include "solve/pairs/problem.h"

namespace thalweg {

class Witnesses {
 public:
  Witnesses(const PairProblem& problem, const PairTwins& twins) : problem_(problem), twins_(twins) {}

  /// Looks for witnesses near a point of A's frame, and keeps the nearest pair.
  void look_near(const double* point);

  /// At most this far apart are the shapes: |a - b|, and what the fields say that a and b lack of their shapes.
  [[nodiscard]] double distance() const { return distance_; }
  [[nodiscard]] const double* a() const { return at_[0]; }
  [[nodiscard]] const double* b() const { return at_[1]; }
  /// A point of both shapes was met: it is a() and b().
  [[nodiscard]] bool is_common() const { return common_; }
  [[nodiscard]] std::uint32_t evaluations() const { return evaluations_; }

 private:
  /// A point near the shape's surface, and how far from the shape it may be; infinite: nothing is known.
  struct Footing {
    double point[3];
    double lacks = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] Footing project(int which, const double* from);
  void search_inside(int which, const double* from, Footing& found);
  [[nodiscard]] bool step_inside(int which, double* at, double f, const double* gradient, double square);
  [[nodiscard]] double gradient_at(int which, const double* at, double* gradient);
  [[nodiscard]] double value_at(int which, const double* at);
  [[nodiscard]] double slack_at(const double* point) const;
  bool meet(const double* point);

  const PairProblem& problem_;
  PairTwins twins_;
  double at_[2][3] = {};
  double distance_ = std::numeric_limits<double>::infinity();
  bool common_ = false;
  bool searched_[2] = {};
  std::uint32_t evaluations_ = 0;
};

}  // namespace thalweg
