// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A projection walks down the field by its value, x <- x - f grad f / |grad f|^2, which does not overshoot where f
// understates the distance, and then steps inside, where f < 0 proves that the point is of the shape. A shape without
// an inside has none: its points are as far from it as an exact field says.
#include "solve/distance/witnesses.h"

#include <algorithm>
#include <cmath>

namespace thalweg {
namespace {

constexpr int kMostSteps = 64;
constexpr int kMostTurns = 12;
/// Points along each axis of the grid on which a shape's inside is looked for, and halvings of the way to it.
constexpr int kGrid2 = 32, kGrid3 = 10;
constexpr int kHalvings = 40;

double distance_between(const double* a, const double* b, int dimension) {
  double square = 0;
  for (int axis = 0; axis < dimension; ++axis) square += (a[axis] - b[axis]) * (a[axis] - b[axis]);
  return std::sqrt(square);
}

}  // namespace

double Witnesses::value_at(int which, const double* at) {
  double own[3] = {};
  std::copy_n(at, 3, own);
  if (which == 1) problem_.pose.to_b(at, own, problem_.dimension);
  return twins_[which].value(own);
}

double Witnesses::gradient_at(int which, const double* at, double* gradient) {
  ++evaluations_;
  if (which == 0) return twins_[0].gradient(at, gradient);
  double own[3] = {}, turned[3] = {};
  problem_.pose.to_b(at, own, problem_.dimension);
  const double f = twins_[1].gradient(own, turned);
  problem_.pose.turn_to_a(turned, gradient, problem_.dimension);
  return f;
}

double Witnesses::slack_at(const double* point) const {
  double largest = 0;
  for (int axis = 0; axis < problem_.dimension; ++axis) largest = std::max(largest, std::fabs(point[axis]));
  return problem_.slack64(largest);
}

/// Whether the point is of both shapes.
bool Witnesses::meet(const double* point) {
  ++evaluations_;
  if (!(std::max(value_at(0, point), value_at(1, point)) < -slack_at(point))) return false;
  for (double* at : at_) std::copy_n(point, 3, at);
  distance_ = 0;
  common_ = true;
  return true;
}

bool Witnesses::step_inside(int which, double* at, double f, const double* gradient, double square) {
  const double length = std::sqrt(square);
  const double most = 1e-5 * problem_.limits.size, slack = slack_at(at);
  for (double depth = 2 * slack + 1e-12 * problem_.limits.size; depth < most; depth *= 4) {
    double inside[3] = {};
    for (int axis = 0; axis < problem_.dimension; ++axis) {
      inside[axis] = at[axis] - (std::max(f, 0.0) / length + depth) * gradient[axis] / length;
    }
    ++evaluations_;
    if (!(value_at(which, inside) < -slack_at(inside))) continue;
    std::copy_n(inside, 3, at);
    return true;
  }
  return false;
}

Witnesses::Footing Witnesses::project(int which, const double* from) {
  const Tape& tape = which == 0 ? *problem_.a : *problem_.b;
  Footing found{};
  std::copy_n(from, 3, found.point);
  double gradient[3] = {};
  for (int step = 0; step < kMostSteps; ++step) {
    const double f = gradient_at(which, found.point, gradient);
    double square = 0;
    for (int axis = 0; axis < problem_.dimension; ++axis) square += gradient[axis] * gradient[axis];
    const double slack = slack_at(found.point);
    if (f < -slack) {
      found.lacks = 0;
      return found;
    }
    const bool arrived = f <= 4 * slack, flat = !(square > 1e-12);
    if (arrived || flat || step + 1 == kMostSteps) {
      const bool inside = !flat && step_inside(which, found.point, f, gradient, square);
      const bool exact = tape.facts.outside == Exactness::exact;
      found.lacks = inside ? 0 : exact ? std::max(f, 0.0) + slack : found.lacks;
      return found;
    }
    for (int axis = 0; axis < problem_.dimension; ++axis) found.point[axis] -= f * gradient[axis] / square;
  }
  return found;
}

/// Where the way down a field ends above 0, as between two parts of an intersection: the nearest point inside on a
/// grid, and from there back toward `from`.
void Witnesses::search_inside(int which, const double* from, Footing& found) {
  const Tape& tape = which == 0 ? *problem_.a : *problem_.b;
  const Bounds& box = tape.facts.bounds;
  const int d = problem_.dimension, along = d == 2 ? kGrid2 : kGrid3;
  if (searched_[which] || !box.finite(d)) return;
  searched_[which] = true;
  // Twice what rounding may hide, for the way into A's frame.
  const double deep = 2 * slack_at(from);
  double own[3] = {}, best[3] = {}, nearest = std::numeric_limits<double>::infinity();
  std::copy_n(from, 3, own);
  if (which == 1) problem_.pose.to_b(from, own, d);
  const int count = d == 2 ? along * along : along * along * along;
  for (int i = 0; i < count; ++i) {
    const int index[3] = {i % along, i / along % along, i / (along * along)};
    double at[3] = {};
    for (int axis = 0; axis < d; ++axis) {
      at[axis] = box.lo[axis] + (box.hi[axis] - box.lo[axis]) * (index[axis] + 0.5) / along;
    }
    const double distance = distance_between(at, own, d);
    if (distance >= nearest) continue;
    ++evaluations_;
    if (!(twins_[which].value(at) < -deep)) continue;
    nearest = distance;
    std::copy_n(at, 3, best);
  }
  if (!std::isfinite(nearest)) return;
  double inside = 1, outside = 0;
  double at[3] = {};
  const auto place = [&](double t) {
    for (int axis = 0; axis < d; ++axis) at[axis] = own[axis] + t * (best[axis] - own[axis]);
  };
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (inside + outside) / 2;
    place(middle);
    ++evaluations_;
    (twins_[which].value(at) < -deep ? inside : outside) = middle;
  }
  place(inside);
  std::copy_n(at, 3, found.point);
  if (which == 1) {
    problem_.pose.turn_to_a(at, found.point, d);
    for (int axis = 0; axis < d; ++axis) found.point[axis] += problem_.pose.translation[axis];
  }
  if (value_at(which, found.point) < -slack_at(found.point)) found.lacks = 0;
}

void Witnesses::look_near(const double* point) {
  if (common_ || meet(point)) return;
  Footing feet[2] = {project(0, point), project(1, point)};
  for (int which = 0; which < 2; ++which) {
    if (!std::isfinite(feet[which].lacks)) search_inside(which, feet[1 - which].point, feet[which]);
  }
  double before = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < kMostTurns; ++turn) {
    for (const Footing& foot : feet) {
      if (meet(foot.point)) return;
    }
    const double apart = distance_between(feet[0].point, feet[1].point, problem_.dimension);
    const double upper = apart + feet[0].lacks + feet[1].lacks;
    if (upper < distance_) {
      distance_ = upper;
      for (int which = 0; which < 2; ++which) std::copy_n(feet[which].point, 3, at_[which]);
    }
    // The nearest point of the one to the other's, in turns.
    if (!(apart < before * (1 - 1e-6))) return;
    before = apart;
    feet[0] = project(0, feet[1].point);
    feet[1] = project(1, feet[0].point);
  }
}

}  // namespace thalweg
