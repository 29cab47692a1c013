// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "baselines/midsurface.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace thalweg::bench {
namespace {

constexpr double kStep = 2;  // halved before the first trial
constexpr double kLastStep = 1e-4;
constexpr double kArmijo = 0.1;
/// Contacts closer than this are one.
constexpr double kSamePoint = 1e-15;
/// A gradient beyond this ends a descent.
constexpr double kLargest = 1e10;

double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void normalise(double* v) {
  const double length = std::sqrt(dot(v, v));
  for (int i = 0; i < 3; ++i) v[i] = length < kSamePoint ? (i == 0 ? 1.0 : 0.0) : v[i] / length;
}

/// The function that a descent goes down.
enum class Objective { collision, intersection };

class PairOfFields {
 public:
  PairOfFields(const FieldPlugin& a, const FieldPlugin& b, const TorusPose& pose) : a_(a), b_(b), pose_(pose) {}

  [[nodiscard]] double value(Objective of, const double* p) const {
    double in_b[3];
    into_b(p, in_b);
    const double a = a_.distance(p, a_.shape), b = b_.distance(in_b, b_.shape);
    const double greater = std::max(a, b);
    return of == Objective::intersection ? greater : a + b + std::fabs(greater);
  }

  void slope(Objective of, const double* p, double* g) const {
    double in_b[3], of_a[3], of_b[3];
    into_b(p, in_b);
    const double a = a_.distance(p, a_.shape), b = b_.distance(in_b, b_.shape);
    if (of == Objective::intersection) {
      if (a > b) return a_.gradient(g, p, a_.shape);
      b_.gradient(of_b, in_b, b_.shape);
      return out_of_b(of_b, g);
    }
    a_.gradient(of_a, p, a_.shape);
    b_.gradient(g, in_b, b_.shape);
    out_of_b(g, of_b);
    const double* of_greater = a > b ? of_a : of_b;
    const double sign = std::max(a, b) > 0 ? 1 : -1;
    for (int i = 0; i < 3; ++i) g[i] = of_a[i] + of_b[i] + sign * of_greater[i];
  }

  void normal(const double* p, double* n) const {
    double in_b[3], of_a[3], of_b[3];
    into_b(p, in_b);
    a_.gradient(of_a, p, a_.shape);
    normalise(of_a);
    b_.gradient(n, in_b, b_.shape);
    out_of_b(n, of_b);
    normalise(of_b);
    for (int i = 0; i < 3; ++i) n[i] = of_a[i] - of_b[i];
    normalise(n);
  }

 private:
  void into_b(const double* p, double* q) const {
    const double v[3] = {p[0] - pose_.offset[0], p[1] - pose_.offset[1], p[2] - pose_.offset[2]};
    const double* m = pose_.turn;
    for (int i = 0; i < 3; ++i) q[i] = m[i] * v[0] + m[3 + i] * v[1] + m[6 + i] * v[2];
  }
  void out_of_b(const double* v, double* w) const {
    for (int i = 0; i < 3; ++i) w[i] = dot(pose_.turn + 3 * i, v);
  }

  const FieldPlugin& a_;
  const FieldPlugin& b_;
  const TorusPose& pose_;
};

/// Goes down from p, in place; returns the objective at the last trial.
double descend(const PairOfFields& pair, Objective of, double* p, int iterations) {
  double reached = std::numeric_limits<double>::max();
  for (int k = 0; k < iterations; ++k) {
    double g[3];
    pair.slope(of, p, g);
    if (!(std::fabs(g[0]) <= kLargest && std::fabs(g[1]) <= kLargest && std::fabs(g[2]) <= kLargest)) return kLargest;
    const double from[3] = {p[0], p[1], p[2]};
    const double before = pair.value(of, from);
    double step = kStep;
    double enough = -kArmijo * step * dot(g, g);
    do {
      step /= 2;
      enough /= 2;
      for (int i = 0; i < 3; ++i) p[i] = from[i] - step * g[i];
      reached = pair.value(of, p);
    } while (step > kLastStep && reached - before > enough);
    if (before < reached) return reached;
  }
  return reached;
}

double halton(int index, int base) {
  double digit = 1.0 / base, result = 0;
  for (; index > 0; index /= base, digit /= base) result += digit * (index % base);
  return result;
}

/// The overlap of the two boxes along each axis of A's frame; false when there is none.
bool overlap(const Torus& t, const TorusPose& pose, double* lo, double* hi) {
  const double half[3] = {t.radius + t.tube, t.tube, t.radius + t.tube};
  for (int i = 0; i < 3; ++i) {
    double reach = 0;
    for (int k = 0; k < 3; ++k) reach += std::fabs(pose.turn[3 * i + k]) * half[k];
    lo[i] = std::max(-half[i], pose.offset[i] - reach);
    hi[i] = std::min(half[i], pose.offset[i] + reach);
    if (lo[i] > hi[i]) return false;
  }
  return true;
}

bool is_known(const MidsurfaceAnswer& answer, const double* p) {
  for (std::size_t i = 0; i < answer.contacts; ++i) {
    const double* q = answer.contact[i].point;
    const double v[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
    if (std::sqrt(dot(v, v)) < kSamePoint) return true;
  }
  return false;
}

}  // namespace

TorusPose torus_pose(const float* row) {
  TorusPose pose;
  double q[4], norm = 0;
  for (int i = 0; i < 3; ++i) pose.offset[i] = row[i];
  for (int i = 0; i < 4; ++i) {
    q[i] = row[3 + i];
    norm += q[i] * q[i];
  }
  const double s = 2 / norm, w = q[0], x = q[1], y = q[2], z = q[3];
  const double turn[9] = {1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
                          s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
                          s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
  std::copy_n(turn, 9, pose.turn);
  return pose;
}

double common_value(const Torus& torus, const TorusPose& pose, const double* point) {
  const FieldPlugin plugin = torus_plugin(torus);
  return PairOfFields(plugin, plugin, pose).value(Objective::intersection, point);
}

MidsurfaceAnswer midsurface(const Torus& torus, const TorusPose& pose, const MidsurfaceOptions& options) {
  MidsurfaceAnswer answer;
  answer.value = std::numeric_limits<double>::infinity();
  double lo[3], hi[3];
  if (!overlap(torus, pose, lo, hi)) return answer;
  const FieldPlugin plugin = torus_plugin(torus);
  const PairOfFields pair(plugin, plugin, pose);
  for (int start = 0; start < options.starts; ++start) {
    double p[3];
    for (int i = 0; i < 3; ++i) p[i] = lo[i] + (hi[i] - lo[i]) * halton(start, i == 0 ? 2 : i == 1 ? 3 : 5);
    descend(pair, Objective::collision, p, options.iterations);
    const double value = descend(pair, Objective::intersection, p, 1);
    answer.value = std::min(answer.value, value);
    if (value > 0 || answer.contacts == std::size(answer.contact) || is_known(answer, p)) continue;
    MidsurfaceContact& contact = answer.contact[answer.contacts++];
    std::copy_n(p, 3, contact.point);
    contact.value = value;
    pair.normal(p, contact.normal);
  }
  answer.overlaps = answer.value <= 0;
  return answer;
}

}  // namespace thalweg::bench
