// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Best first, by lower bound, over boxes halved across their longest side. The bounds are those of bounds.inl, one cell
// at a time. The reported point is a float32 one, and what is said of it is evaluated at it.
#include "solve/pairs/decide_pairs.h"

#include <algorithm>
#include <cmath>

namespace thalweg {
namespace {

/// A visit evaluates centre and far points, and two candidates for the incumbent.
constexpr std::uint32_t kMostPerVisit = 4;
/// Open cells held at once, whatever the budget.
constexpr std::size_t kMostCells = std::size_t{1} << 20;

bool higher(const PairHeapCell& a, const PairHeapCell& b) { return a.lo > b.lo; }

float rounded_down(double x) {
  const auto nearest = static_cast<float>(x);
  return static_cast<double>(nearest) > x ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}

/// One field about a cell's centre, in A's frame: f >= base + slope . y over the cell.
struct Linear {
  double value = 0;
  double base = 0;
  double slope[3] = {};
};

class PairDecider {
 public:
  PairDecider(const PairProblem& problem, PairTwins& twins, std::vector<PairHeapCell>& heap)
      : problem_(problem), d_(problem.dimension), twins_(twins), heap_(heap) {
    heap_.clear();
    double largest = 0;
    for (int axis = 0; axis < d_; ++axis) {
      largest = std::max({largest, std::fabs(problem.lo[axis]), std::fabs(problem.hi[axis])});
    }
    slack_ = problem.slack64(largest + problem.limits.size);
  }

  PairDecision run(const float* start, std::uint32_t evaluations) {
    most_ = evaluations;
    value_ = lower_ = std::numeric_limits<double>::infinity();
    if (start != nullptr) consider_rounded(start);
    PairHeapCell root{};
    for (int axis = 0; axis < d_; ++axis) {
      root.at[axis] = (problem_.lo[axis] + problem_.hi[axis]) / 2;
      root.half[axis] = (problem_.hi[axis] - problem_.lo[axis]) / 2 * (1 + 1e-12);
    }
    visit(root);
    while (!heap_.empty() && !witness_ && spent_ + 2 * kMostPerVisit <= most_ && heap_.size() < kMostCells &&
           !settled()) {
      std::pop_heap(heap_.begin(), heap_.end(), higher);
      const PairHeapCell parent = heap_.back();
      heap_.pop_back();
      split(parent);
    }
    if (!heap_.empty()) lower_ = std::min(lower_, heap_.front().lo);
    return answer();
  }

 private:
  PairDecision answer() const {
    PairDecision decision;
    decision.slack = slack_;
    decision.evaluations = spent_;
    std::copy_n(point_, 3, decision.found.point);
    decision.found.value = static_cast<float>(value_);
    decision.found.lower = rounded_down(std::min(lower_, value_));
    decision.found.witness = witness_;
    const double tolerance = problem_.limits.tolerance;
    const bool touching = value_ + slack_ <= tolerance && lower_ >= -tolerance;
    decision.found.converged =
        lower_ > 0 || (problem_.limits.goal == Goal::verdict && (witness_ || touching)) || value_ - lower_ <= tolerance;
    return decision;
  }

  /// Touching is proven, and either double can tell no more or enough has been tried.
  [[nodiscard]] bool settled() const {
    const double lower = std::min(lower_, heap_.front().lo);
    const double tolerance = problem_.limits.tolerance;
    if (!(value_ + slack_ <= tolerance && lower >= -tolerance)) return false;
    return heap_.front().lo >= value_ - 2 * slack_ || spent_ > problem_.limits.budget / 4;
  }

  void consider_rounded(const float* point) {
    double exact[3] = {};
    std::copy_n(point, d_, exact);
    ++spent_;
    const double value = evaluate_pair(problem_, twins_, exact);
    if (!(value < value_)) return;
    value_ = value;
    std::copy_n(point, d_, point_);
    witness_ = value < -slack_;
  }

  void consider(const double* exact) {
    float point[3] = {};
    for (int axis = 0; axis < d_; ++axis) point[axis] = static_cast<float>(exact[axis]);
    consider_rounded(point);
  }

  /// Field `which` at a cell, with its cone or, where it is convex, its tangent plane.
  Linear field(int which, const PairHeapCell& cell, double reach) {
    const Tape& tape = which == 0 ? *problem_.a : *problem_.b;
    double at[3] = {}, gradient[3] = {};
    std::copy_n(cell.at, 3, at);
    if (which == 1) problem_.pose.to_b(cell.at, at, d_);
    Linear f;
    f.value = twins_[which].gradient(at, gradient);
    f.base = -std::numeric_limits<double>::max() / 4;
    double square = 0;
    for (int axis = 0; axis < d_; ++axis) square += gradient[axis] * gradient[axis];
    if (!tape.facts.convex && square > 0.1 && std::isfinite(tape.facts.lipschitz)) {
      const double distance = std::sqrt(reach * problem_.limits.size);
      double far[3] = {};
      for (int axis = 0; axis < d_; ++axis) {
        gradient[axis] *= tape.facts.lipschitz / std::sqrt(square);
        far[axis] = at[axis] + distance * gradient[axis] / tape.facts.lipschitz;
      }
      const double bend = distance + reach * reach / (2 * distance);
      f.base = twins_[which].value(far) - tape.facts.lipschitz * bend;
    } else if (tape.facts.convex) {
      f.base = f.value;
    }
    std::copy_n(gradient, 3, f.slope);
    if (which == 1) problem_.pose.turn_to_a(gradient, f.slope, d_);
    return f;
  }

  [[nodiscard]] double mixed(const Linear& a, const Linear& b, double weight, const double* half) const {
    double fall = 0;
    for (int axis = 0; axis < d_; ++axis) {
      fall += std::fabs(weight * a.slope[axis] + (1 - weight) * b.slope[axis]) * half[axis];
    }
    return weight * a.base + (1 - weight) * b.base - fall;
  }

  void visit(PairHeapCell cell) {
    double square = 0;
    for (int axis = 0; axis < d_; ++axis) square += cell.half[axis] * cell.half[axis];
    const double reach = std::sqrt(square) * (1 + 1e-12);
    const Linear a = field(0, cell, reach);
    const Linear b = field(1, cell, reach);
    spent_ += 2;
    double length = 0, along = 0;
    for (int axis = 0; axis < d_; ++axis) {
      const double difference = b.slope[axis] - a.slope[axis];
      length += difference * difference;
      along += difference * b.slope[axis];
    }
    const double weight = std::clamp(along / std::max(length, 1e-30), 0.0, 1.0);
    double lo = std::max(a.value - problem_.a->facts.lipschitz * reach, b.value - problem_.b->facts.lipschitz * reach);
    for (const double w : {0.0, 1.0, weight}) lo = std::max(lo, mixed(a, b, w, cell.half));
    cell.lo = lo - 2 * slack_;
    if (std::max(a.value, b.value) < value_) {
      consider(cell.at);
      step(cell, a, b, reach);
    }
    // Too small to learn more from, in double as well.
    if (cell.lo > 0 || reach <= slack_ / 4) {
      lower_ = std::min(lower_, cell.lo);
      return;
    }
    heap_.push_back(cell);
    std::push_heap(heap_.begin(), heap_.end(), higher);
  }

  /// The proximal step of polish.inl, of the cell's length.
  void step(const PairHeapCell& cell, const Linear& a, const Linear& b, double reach) {
    double square = 0, along = 0;
    for (int axis = 0; axis < d_; ++axis) {
      const double difference = a.slope[axis] - b.slope[axis];
      square += difference * difference;
      along += difference * b.slope[axis];
    }
    double weight = a.value > b.value ? 1 : 0;
    if (square > 1e-16) weight = std::clamp(((a.value - b.value) / reach - along) / square, 0.0, 1.0);
    double to[3] = {};
    for (int axis = 0; axis < d_; ++axis) {
      to[axis] = cell.at[axis] - reach * (weight * a.slope[axis] + (1 - weight) * b.slope[axis]);
    }
    consider(to);
  }

  void split(const PairHeapCell& parent) {
    int longest = 0;
    for (int axis = 1; axis < d_; ++axis) {
      if (parent.half[axis] > parent.half[longest]) longest = axis;
    }
    const double half = parent.half[longest] / 2;
    for (const double side : {-half, half}) {
      PairHeapCell child = parent;
      child.at[longest] += side;
      child.half[longest] = half * (1 + 1e-15);
      visit(child);
    }
  }

  const PairProblem& problem_;
  int d_;
  PairTwins& twins_;
  std::vector<PairHeapCell>& heap_;
  double slack_ = 0;
  double value_ = 0, lower_ = 0;
  float point_[3] = {};
  bool witness_ = false;
  std::uint32_t spent_ = 0, most_ = 0;
};

}  // namespace

PairDecision decide_in_double(const PairProblem& problem, const float* start, std::uint32_t evaluations,
                              PairTwins& twins, std::vector<PairHeapCell>& heap) {
  if (evaluations < 1 + 3 * kMostPerVisit) return {};
  return PairDecider(problem, twins, heap).run(start, evaluations);
}

}  // namespace thalweg
