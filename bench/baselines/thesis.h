// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The published method, P. Luneau, "Détections de collisions avec des SDFs" (CNAM ENJMIN 2025), sections 2.3, 2.4 and
// 3.2, as the baseline that triangle queries are held against: scalar float, a tree of virtual calls, the gradient by
// dichotomy over angles (fixed probe radius, |f| everywhere) and 64 iterations of projected descent from the centroid
// without a stop test. Nothing is allocated in the loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace thalweg::bench {

struct Vec2 {
  float x = 0, y = 0;
};

class Sdf {
 public:
  Sdf() = default;
  Sdf(const Sdf&) = delete;
  Sdf& operator=(const Sdf&) = delete;
  virtual ~Sdf() = default;
  [[nodiscard]] virtual float distance(Vec2 p) const = 0;
};

[[nodiscard]] std::unique_ptr<Sdf> circle(float radius);
/// Sharpness in [2, points], as in shapes.md.
[[nodiscard]] std::unique_ptr<Sdf> star(float radius, int points, float sharpness);
/// Quadratic, k normalised: the blend spans 4 k.
[[nodiscard]] std::unique_ptr<Sdf> smooth_union(float k, std::unique_ptr<Sdf> a, std::unique_ptr<Sdf> b);
[[nodiscard]] std::unique_ptr<Sdf> translate(Vec2 by, std::unique_ptr<Sdf> of);

/// interface.md's example: the star and the circle, smoothly joined.
[[nodiscard]] std::unique_ptr<Sdf> thesis_scene();

struct ThesisAnswer {
  bool overlaps = false;  ///< f < 0 at `point`
  float value = 0;
  Vec2 point;
  std::uint32_t evaluations = 0;
};

struct ThesisDescent {
  int iterations = 64;
  float alpha = 0.1F;
  float floor = 100.0F;  ///< mu: the least |f| that scales a step, in scene units
};

/// The point that the descent ends at, and f there: 13 evaluations an iteration and one at the end.
[[nodiscard]] ThesisAnswer descend(const Sdf& shape, const Vec2 triangle[3], const ThesisDescent& descent = {});

}  // namespace thalweg::bench
