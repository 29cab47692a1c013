// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One function per primitive, written from its geometry in the most direct way: distance to the boundary curves, then
// a sign from the region's own inequality. Slow and plain on purpose.
#include "primitives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace thalweg::oracle {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec flat(const double* n) { return {n[0], n[1], 0}; }
Vec solid(const double* n) { return {n[0], n[1], n[2]}; }
double signed_by(bool inside, double unsigned_distance) { return inside ? -unsigned_distance : unsigned_distance; }
double cross(Vec a, Vec b) { return a.x * b.y - a.y * b.x; }

double segment_distance(Vec p, Vec a, Vec b) {
  const Vec along = b - a;
  const double square = dot(along, along);
  const double t = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return distance(p, a + along * t);
}

/// Box with corner at `half` (2D: half.z = 0 and p.z = 0 add nothing outside, and must not cap the inside).
double box_distance(Vec p, Vec half, int dimension) {
  const double x = std::abs(p.x) - half.x, y = std::abs(p.y) - half.y;
  const double z = dimension == 3 ? std::abs(p.z) - half.z : -kInfinity;
  const double outside = std::hypot(std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0));
  return outside > 0 ? outside : std::max({x, y, z});
}

double circle(const double* n, std::size_t, Vec p) { return std::hypot(p.x, p.y) - n[0]; }
double sphere(const double* n, std::size_t, Vec p) { return length(p) - n[0]; }
double box2(const double* n, std::size_t, Vec p) { return box_distance({p.x, p.y, 0}, {n[0], n[1], 0}, 2); }
double box3(const double* n, std::size_t, Vec p) { return box_distance(p, solid(n), 3); }
double half_plane(const double* n, std::size_t, Vec p) {
  return (n[0] * p.x + n[1] * p.y) / std::hypot(n[0], n[1]) - n[2];
}
double plane(const double* n, std::size_t, Vec p) { return dot(solid(n), p) / length(solid(n)) - n[3]; }

double rounded_box(const double* n, std::size_t, Vec p) {
  const double right = p.y > 0 ? n[2] : n[3];
  const double left = p.y > 0 ? n[4] : n[5];
  const double r = p.x > 0 ? right : left;
  const double x = std::abs(p.x) - (n[0] - r), y = std::abs(p.y) - (n[1] - r);
  if (x > 0 && y > 0) return std::hypot(x, y) - r;
  return std::max(x, y) - r;
}

double segment(const double* n, std::size_t, Vec p) { return segment_distance({p.x, p.y, 0}, flat(n), flat(n + 2)); }

/// Nearest edge, and inside by the parity of crossings of the ray towards +x.
double polygon(const double* n, std::size_t count, Vec p) {
  p.z = 0;
  const std::size_t corners = count / 2;
  double nearest = kInfinity;
  bool inside = false;
  for (std::size_t i = 0; i < corners; ++i) {
    const Vec a = flat(n + 2 * i), b = flat(n + 2 * ((i + 1) % corners));
    nearest = std::min(nearest, segment_distance(p, a, b));
    if ((a.y > p.y) != (b.y > p.y)) {
      const double x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
      if (p.x < x) inside = !inside;
    }
  }
  return signed_by(inside, nearest);
}

/// Folds the plane into the half sector between a tip and the notch beside it, by its angle from +y.
double star(const double* n, std::size_t, Vec p) {
  const double radius = n[0], points = n[1], sharpness = n[2];
  const double half_sector = kPi / points;
  const double angle = std::atan2(p.x, p.y);
  const double turns = std::floor(angle / (2 * half_sector) + 0.5);
  const double from_tip = std::abs(angle - turns * 2 * half_sector);
  const double r = std::hypot(p.x, p.y);
  // In this frame the tip is at (radius, 0), and the edge leaves it at the angle that the sharpness asks for.
  const Vec q{r * std::cos(from_tip), r * std::sin(from_tip), 0};
  const Vec tip{radius, 0, 0};
  const double edge = kPi / sharpness;
  const double side = radius * std::sin(half_sector) / std::sin(edge);
  // Direction of the edge: towards the notch line, turned from it by the edge angle.
  const double heading = half_sector - edge;
  const Vec notch = tip - Vec{std::cos(heading), std::sin(heading), 0} * side;
  const bool inside = cross(notch - tip, q - tip) > 0;
  return signed_by(inside, segment_distance(q, tip, notch));
}

double pie(const double* n, std::size_t, Vec p) {
  const double aperture = n[0], radius = n[1];
  if (aperture >= kPi) return std::hypot(p.x, p.y) - radius;
  p = {std::abs(p.x), p.y, 0};
  const double angle = std::atan2(p.x, p.y);
  const Vec end{radius * std::sin(aperture), radius * std::cos(aperture), 0};
  const double side = segment_distance(p, {}, end);
  const double r = std::hypot(p.x, p.y);
  // The rim is nearest along the ray through p while that ray is inside the aperture, else at the rim's end.
  const double rim = angle <= aperture ? std::abs(r - radius) : distance(p, end);
  return signed_by(angle <= aperture && r <= radius, std::min(side, rim));
}

double arc(const double* n, std::size_t, Vec p) {
  const double aperture = n[0], radius = n[1], thickness = n[2];
  p = {std::abs(p.x), p.y, 0};
  const Vec end{radius * std::sin(aperture), radius * std::cos(aperture), 0};
  const bool beside = std::atan2(p.x, p.y) <= aperture;
  return (beside ? std::abs(std::hypot(p.x, p.y) - radius) : distance(p, end)) - thickness;
}

double ring(const double* n, std::size_t, Vec p) {
  const double aperture = n[0], radius = n[1], half = n[2] / 2;
  p = {std::abs(p.x), p.y, 0};
  const double band = std::abs(std::hypot(p.x, p.y) - radius) - half;
  if (aperture >= kPi) return band;
  const Vec out{std::sin(aperture), std::cos(aperture), 0};
  const double cap = segment_distance(p, out * (radius - half), out * (radius + half));
  const bool beside = std::atan2(p.x, p.y) <= aperture;
  if (!beside) return cap;
  return band > 0 ? band : std::max(band, -cap);
}

/// The disc `ra` at the origin without the disc `rb` at (offset, 0).
double moon(const double* n, std::size_t, Vec p) {
  const double offset = n[0], ra = n[1], rb = n[2];
  p = {p.x, std::abs(p.y), 0};
  const double x = (ra * ra - rb * rb + offset * offset) / (2 * offset);
  // Height of the horn over the axis, by Pythagoras in the smaller circle: in the larger one its digits cancel.
  const double from_b = ((offset - ra) * (offset + ra) + rb * rb) / (2 * offset);
  const double square = rb < ra ? (rb - from_b) * (rb + from_b) : (ra - x) * (ra + x);
  const double outer = std::hypot(p.x, p.y) - ra;
  const double inner = rb - std::hypot(p.x - offset, p.y);
  if (std::abs(x) >= ra) return std::max(outer, inner);
  const Vec horn{x, std::sqrt(std::max(square, 0.0)), 0};
  // Each arc counts only where the foot of the perpendicular on its circle belongs to the moon's outline: where the
  // direction from the circle's centre is no nearer to +x than the horn's. Turns keep the digits that differences of
  // coordinates lose when one circle is far greater than the other.
  const bool outer_foot = horn.x * p.y >= horn.y * p.x;
  const bool inner_foot = (horn.x - offset) * p.y >= horn.y * (p.x - offset);
  double nearest = distance(p, horn);
  if (outer_foot) nearest = std::min(nearest, std::abs(outer));
  if (inner_foot) nearest = std::min(nearest, std::abs(inner));
  return signed_by(outer <= 0 && inner <= 0, nearest);
}

/// Its strokes are straight segments; inside is the hexagonal outline around them.
double cool_s(const double* n, std::size_t, Vec p) {
  static constexpr double kStrokes[][4] = {
      {0, 1, 0.4, 0.6},       {0, 1, -0.4, 0.6},        {0, 0.2, 0, 0.6},      {0.4, 0.2, 0.4, 0.6},
      {-0.4, 0.2, -0.4, 0.6}, {0.2, 0, 0.4, 0.2},       {-0.2, 0, -0.4, 0.2},  {0, 0.2, 0.2, 0},
      {0, -0.2, -0.2, 0},     {0.2, 0, 0.4, -0.2},      {-0.2, 0, -0.4, -0.2}, {0, -0.2, 0, -0.6},
      {0.4, -0.2, 0.4, -0.6}, {-0.4, -0.2, -0.4, -0.6}, {0, -1, 0.4, -0.6},    {0, -1, -0.4, -0.6}};
  static constexpr double kOutline[] = {0, 1,  0.4,  0.6,  0.4,  0.2,  0.2,  0, 0.4,  -0.2, 0.4,  -0.6,
                                        0, -1, -0.4, -0.6, -0.4, -0.2, -0.2, 0, -0.4, 0.2,  -0.4, 0.6};
  const double unit = n[0];
  p = Vec{p.x, p.y, 0} * (1 / unit);
  double nearest = kInfinity;
  for (const auto& s : kStrokes) nearest = std::min(nearest, segment_distance(p, flat(s), flat(s + 2)));
  return unit * signed_by(polygon(kOutline, std::size(kOutline), p) < 0, nearest);
}

double torus(const double* n, std::size_t, Vec p) { return std::hypot(std::hypot(p.x, p.z) - n[0], p.y) - n[1]; }
double capsule(const double* n, std::size_t, Vec p) { return segment_distance(p, solid(n), solid(n + 3)) - n[6]; }
double cylinder(const double* n, std::size_t, Vec p) {
  return box_distance({std::hypot(p.x, p.z), p.y, 0}, {n[1], n[0], 0}, 2);
}

bool always(const double*) { return true; }
bool at_most_half_a_disc(const double* n) { return n[0] <= kPi / 2; }

constexpr PrimitiveEntry kPrimitives[] = {
    {"circle", 2, "radius", circle, always},
    {"box", 2, "half_size", box2, always},
    {"rounded_box", 2, "half_size radii", rounded_box, always},
    {"segment", 2, "a b", segment, always, true},
    {"triangle", 2, "a b c", polygon, always},
    {"polygon", 2, "points", polygon, nullptr},
    {"star", 2, "radius points sharpness", star, nullptr},
    {"pie", 2, "aperture radius", pie, at_most_half_a_disc},
    {"arc", 2, "aperture radius thickness", arc, nullptr},
    {"ring", 2, "aperture radius thickness", ring, nullptr},
    {"moon", 2, "offset ra rb", moon, nullptr},
    {"cool_s", 2, "unit", cool_s, nullptr},
    {"half_plane", 2, "normal offset", half_plane, always},
    {"sphere", 3, "radius", sphere, always},
    {"box", 3, "half_size", box3, always},
    {"torus", 3, "radius tube", torus, nullptr},
    {"capsule", 3, "a b radius", capsule, always},
    {"cylinder", 3, "half_height radius", cylinder, always},
    {"plane", 3, "normal offset", plane, always},
};

}  // namespace

std::span<const PrimitiveEntry> primitives() { return kPrimitives; }

}  // namespace thalweg::oracle
