// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Built with -O3 -march=native, contraction as the compiler likes it: the baseline gets every chance that scalar code
// has. The class tree stays, for it is what was published.
#include "thesis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace thalweg::bench {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kTau = 2 * kPi;

float dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
float length(Vec2 a) { return std::sqrt(dot(a, a)); }
Vec2 minus(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
Vec2 along(Vec2 a, Vec2 direction, float t) { return {a.x + direction.x * t, a.y + direction.y * t}; }

class Circle final : public Sdf {
 public:
  explicit Circle(float radius) : radius_(radius) {}
  [[nodiscard]] float distance(Vec2 p) const override { return length(p) - radius_; }

 private:
  float radius_;
};

class Star final : public Sdf {
 public:
  Star(float radius, int points, float sharpness)
      : radius_(radius),
        sector_(kPi / static_cast<float>(points)),
        tip_{std::cos(sector_), std::sin(sector_)},
        edge_{std::cos(kPi / sharpness), std::sin(kPi / sharpness)} {}

  /// Folds the angle from +y into one sector, then takes the distance to the edge between tip and notch.
  [[nodiscard]] float distance(Vec2 p) const override {
    const float angle = std::atan2(p.x, p.y);
    const float width = 2 * sector_;
    const float folded = angle - width * std::floor(angle / width) - sector_;
    const float r = length(p);
    Vec2 q{r * std::cos(folded) - radius_ * tip_.x, r * std::abs(std::sin(folded)) - radius_ * tip_.y};
    const float reach = std::clamp(-dot(q, edge_), 0.0F, radius_ * tip_.y / edge_.y);
    q = along(q, edge_, reach);
    return std::copysign(length(q), q.x);
  }

 private:
  float radius_, sector_;
  Vec2 tip_, edge_;
};

class SmoothUnion final : public Sdf {
 public:
  SmoothUnion(float k, std::unique_ptr<Sdf> a, std::unique_ptr<Sdf> b)
      : support_(4 * k), a_(std::move(a)), b_(std::move(b)) {}
  [[nodiscard]] float distance(Vec2 p) const override {
    const float a = a_->distance(p), b = b_->distance(p);
    const float h = std::max(support_ - std::abs(a - b), 0.0F) / support_;
    return std::min(a, b) - h * h * support_ * 0.25F;
  }

 private:
  float support_;
  std::unique_ptr<Sdf> a_, b_;
};

class Translate final : public Sdf {
 public:
  Translate(Vec2 by, std::unique_ptr<Sdf> of) : by_(by), of_(std::move(of)) {}
  [[nodiscard]] float distance(Vec2 p) const override { return of_->distance(minus(p, by_)); }

 private:
  Vec2 by_;
  std::unique_ptr<Sdf> of_;
};

/// |f| at the end of the probe that leaves p at `angle`.
float probe(const Sdf& shape, Vec2 p, float angle, std::uint32_t& evaluations) {
  constexpr float kOffset = 0.005F;
  ++evaluations;
  return std::abs(shape.distance({p.x + std::cos(angle) * kOffset, p.y + std::sin(angle) * kOffset}));
}

struct Direction {
  Vec2 unit;    ///< where |f| grows
  float value;  ///< |f| at the point itself; published code has it, and its fixed offset does not need it
};

/// Three probes, the pair with the greatest sum, then eight halvings that give up the end with the smaller value.
Direction dichotomy(const Sdf& shape, Vec2 p, std::uint32_t& evaluations) {
  ++evaluations;
  const float here = std::abs(shape.distance(p));
  float angles[3], values[3];
  for (int k = 0; k < 3; ++k) {
    angles[k] = kTau / 6 + static_cast<float>(k) * kTau / 3;
    values[k] = probe(shape, p, angles[k], evaluations);
  }
  int first = 0;
  for (int k = 1; k < 3; ++k) {
    if (values[k] + values[(k + 1) % 3] > values[first] + values[(first + 1) % 3]) first = k;
  }
  float from = angles[first], to = angles[(first + 1) % 3];
  float at_from = values[first], at_to = values[(first + 1) % 3];
  if (to < from) to += kTau;
  for (int step = 0; step < 8; ++step) {
    const float middle = (from + to) / 2;
    const float value = probe(shape, p, middle, evaluations);
    if (at_from < at_to) {
      from = middle, at_from = value;
    } else {
      to = middle, at_to = value;
    }
  }
  const float angle = (from + to) / 2;
  return {{std::cos(angle), std::sin(angle)}, here};
}

/// Closest point of the segment from a to b.
Vec2 onto_segment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 edge = minus(b, a);
  const float square = dot(edge, edge);
  const float t = square > 0 ? std::clamp(dot(minus(p, a), edge) / square, 0.0F, 1.0F) : 0.0F;
  return along(a, edge, t);
}

float side(Vec2 a, Vec2 b, Vec2 p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

Vec2 onto_triangle(Vec2 p, const Vec2 t[3]) {
  const float s0 = side(t[0], t[1], p), s1 = side(t[1], t[2], p), s2 = side(t[2], t[0], p);
  const bool within = (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
  if (within && side(t[0], t[1], t[2]) != 0) return p;
  Vec2 best = p;
  float nearest = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Vec2 q = onto_segment(p, t[i], t[(i + 1) % 3]);
    const Vec2 gap = minus(p, q);
    if (dot(gap, gap) < nearest) nearest = dot(gap, gap), best = q;
  }
  return best;
}

}  // namespace

std::unique_ptr<Sdf> circle(float radius) { return std::make_unique<Circle>(radius); }
std::unique_ptr<Sdf> star(float radius, int points, float sharpness) {
  return std::make_unique<Star>(radius, points, sharpness);
}
std::unique_ptr<Sdf> smooth_union(float k, std::unique_ptr<Sdf> a, std::unique_ptr<Sdf> b) {
  return std::make_unique<SmoothUnion>(k, std::move(a), std::move(b));
}
std::unique_ptr<Sdf> translate(Vec2 by, std::unique_ptr<Sdf> of) {
  return std::make_unique<Translate>(by, std::move(of));
}

std::unique_ptr<Sdf> thesis_scene() {
  return smooth_union(1.0F, translate({1000, 550}, star(300, 12, 4.0F)), translate({750, 400}, circle(200)));
}

ThesisAnswer descend(const Sdf& shape, const Vec2 triangle[3], const ThesisDescent& descent) {
  ThesisAnswer answer;
  Vec2 p{(triangle[0].x + triangle[1].x + triangle[2].x) / 3, (triangle[0].y + triangle[1].y + triangle[2].y) / 3};
  for (int i = 0; i < descent.iterations; ++i) {
    const Direction direction = dichotomy(shape, p, answer.evaluations);
    const float f = shape.distance(p);
    ++answer.evaluations;
    // direction.value is |f| again; the published step evaluates f anew to have its sign.
    const float step = -descent.alpha * std::max(direction.value, descent.floor) * std::copysign(1.0F, f);
    p = onto_triangle(along(p, direction.unit, step), triangle);
  }
  answer.value = shape.distance(p);
  ++answer.evaluations;
  answer.point = p;
  answer.overlaps = answer.value < 0;
  return answer;
}

}  // namespace thalweg::bench
