// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "baselines/midsurface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::bench {
namespace {

constexpr double kFirstStep = 2;
constexpr double kLastStep = 1e-4;
constexpr double kArmijo = 0.1;

struct V3 {
  double x = 0, y = 0, z = 0;
};
V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
V3 operator*(V3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double square(V3 a) { return a.x * a.x + a.y * a.y + a.z * a.z; }

struct Sample {
  double value = 0;
  V3 gradient;
};

double torus_value(const Torus& t, V3 p) {
  const double ring = std::sqrt(p.x * p.x + p.z * p.z) - t.radius;
  return std::sqrt(ring * ring + p.y * p.y) - t.tube;
}

Sample torus_sample(const Torus& t, V3 p) {
  const double axis = std::sqrt(p.x * p.x + p.z * p.z);
  const double ring = axis - t.radius;
  const double r = std::sqrt(ring * ring + p.y * p.y);
  const double radial = r > 0 && axis > 0 ? ring / (r * axis) : 0;
  return {r - t.tube, {p.x * radial, r > 0 ? p.y / r : 0, p.z * radial}};
}

V3 into_b(const TorusPose& pose, V3 p) {
  const double x = p.x - pose.offset[0], y = p.y - pose.offset[1], z = p.z - pose.offset[2];
  const double* m = pose.turn;
  return {m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z};
}

V3 out_of_b(const TorusPose& pose, V3 v) {
  const double* m = pose.turn;
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
          m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

class Descent {
 public:
  Descent(const Torus& torus, const TorusPose& pose) : torus_(torus), pose_(pose) {}

  V3 from(V3 p, int iterations) const {
    for (int k = 0; k < iterations; ++k) {
      if (!step(p, false)) break;
    }
    step(p, true);
    return p;
  }

 private:
  [[nodiscard]] double objective(V3 p, bool last) const {
    const double a = torus_value(torus_, p), b = torus_value(torus_, into_b(pose_, p));
    const double greater = std::max(a, b);
    return last ? greater : a + b + std::fabs(greater);
  }

  /// One step down the gradient, halved until Armijo's rule holds; false when none does.
  bool step(V3& p, bool last) const {
    const Sample a = torus_sample(torus_, p);
    Sample b = torus_sample(torus_, into_b(pose_, p));
    b.gradient = out_of_b(pose_, b.gradient);
    const double greater = std::max(a.value, b.value);
    const V3 of_greater = a.value > b.value ? a.gradient : b.gradient;
    const double before = last ? greater : a.value + b.value + std::fabs(greater);
    const V3 slope = last ? of_greater : a.gradient + b.gradient + of_greater * (greater < 0 ? -1.0 : 1.0);
    const double fall = kArmijo * square(slope);
    if (fall == 0) return false;
    for (double length = kFirstStep; length >= kLastStep; length *= 0.5) {
      const V3 to = p + slope * -length;
      if (objective(to, last) - before > -fall * length) continue;
      p = to;
      return true;
    }
    return false;
  }

  const Torus& torus_;
  const TorusPose& pose_;
};

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
  const V3 p{point[0], point[1], point[2]};
  return std::max(torus_value(torus, p), torus_value(torus, into_b(pose, p)));
}

MidsurfaceAnswer midsurface(const Torus& torus, const TorusPose& pose, const MidsurfaceOptions& options) {
  MidsurfaceAnswer answer;
  answer.value = std::numeric_limits<double>::infinity();
  double lo[3], hi[3];
  if (!overlap(torus, pose, lo, hi)) return answer;
  const Descent descent(torus, pose);
  for (int start = 1; start <= options.starts; ++start) {
    const V3 from{lo[0] + (hi[0] - lo[0]) * halton(start, 2), lo[1] + (hi[1] - lo[1]) * halton(start, 3),
                  lo[2] + (hi[2] - lo[2]) * halton(start, 5)};
    const V3 p = descent.from(from, options.iterations);
    const double point[3] = {p.x, p.y, p.z};
    const double value = common_value(torus, pose, point);
    answer.contacts += value <= 0 ? 1 : 0;
    if (value >= answer.value) continue;
    answer.value = value;
    std::copy_n(point, 3, answer.point);
  }
  answer.overlaps = answer.value <= 0;
  return answer;
}

}  // namespace thalweg::bench
