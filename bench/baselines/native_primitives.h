// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The mathematics of the native baseline: value and gradient in closed form, every number that does not depend on the
// point handed in as a literal. Where only the value is stored the compiler drops the gradient. Each primitive is
// folded into a fundamental domain and answers with its closest feature, as core does; the star needs no atan.
// Only native.cpp includes this.
#pragma once

#include "native_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg::bench::native {

struct Field {
  Lanes value;
  Lanes gx, gy;
};

HWY_INLINE Lanes dot(Pair u, Pair v) { return mul_add(u.x, v.x, u.y * v.y); }
HWY_INLINE Lanes norm(Pair u) { return sqrt(dot(u, u)); }
HWY_INLINE Pair scaled(Pair u, Lanes s) { return {u.x * s, u.y * s}; }
HWY_INLINE Pair pick(Mask m, Pair yes, Pair no) { return {select(m, yes.x, no.x), select(m, yes.y, no.y)}; }
/// 1 / r, and 0 where r is 0.
HWY_INLINE Lanes inverse(Lanes r) { return keep(Lanes(0.0F) < r, Lanes(1.0F) / r); }
/// u with the sign of v flipped in: u * sign(v).
HWY_INLINE Lanes times_sign(Lanes u, Lanes v) {
  const Tag tag;
  const auto sign = hn::SignBit(tag);
  return {hn::Xor(u.a, hn::And(sign, v.a)), hn::Xor(u.b, hn::And(sign, v.b))};
}

// --- placement: literals only -------------------------------------------------------------------------------------

/// Local coordinates of a turn by the angle of (c, s) and a shift.
HWY_INLINE Pair turned(Pair p, float c, float s, float x, float y) {
  return {mul_add(p.x, c, mul_add(p.y, s, x)), mul_add(p.y, c, neg_mul_add(p.x, s, y))};
}
HWY_INLINE Field turned_back(Field f, float c, float s) {
  return {f.value, neg_mul_add(f.gy, s, f.gx * c), mul_add(f.gx, s, f.gy * c)};
}

// --- primitives ------------------------------------------------------------------------------------------------------

HWY_INLINE Field circle(Pair p, float radius) {
  const Lanes r = norm(p);
  const Pair g = scaled(p, inverse(r));
  return {r - radius, g.x, g.y};
}

/// The corner of a box: q = |p| - half_size.
HWY_INLINE Field corner(Pair q, Pair p, Lanes radius) {
  const Pair out{max(q.x, 0.0F), max(q.y, 0.0F)};
  const Lanes distance = norm(out);
  const Lanes depth = min(max(q.x, q.y), 0.0F);
  const Mask outside = Lanes(0.0F) < distance;
  const Mask side = q.y <= q.x;
  const Lanes inv = Lanes(1.0F) / distance;
  const Lanes gx = select(outside, out.x * inv, keep(side, 1.0F));
  const Lanes gy = select(outside, out.y * inv, select(side, Lanes(0.0F), Lanes(1.0F)));
  return {distance + depth - radius, copysign(gx, p.x), copysign(gy, p.y)};
}

HWY_INLINE Field box(Pair p, float half_x, float half_y) {
  return corner({abs(p.x) - half_x, abs(p.y) - half_y}, p, 0.0F);
}

/// Radii: top right, bottom right, top left, bottom left; half sizes are taken off after the choice.
HWY_INLINE Field rounded_box(Pair p, float half_x, float half_y, const float (&r)[4]) {
  const Mask top = Lanes(0.0F) < p.y;
  const Lanes radius = select(Lanes(0.0F) < p.x, select(top, r[0], r[1]), select(top, r[2], r[3]));
  return corner({abs(p.x) + (radius - half_x), abs(p.y) + (radius - half_y)}, p, radius);
}

struct Stroke {
  float ex, ey;  // from the origin
  float fx, fy;  // the same over its squared length
  float radius;  // what `round` takes off
};
HWY_INLINE Field stroke(Pair p, const Stroke& s) {
  const Lanes t = clamp(mul_add(p.x, s.fx, p.y * s.fy), 0.0F, 1.0F);
  const Pair residual{neg_mul_add(t, s.ex, p.x), neg_mul_add(t, s.ey, p.y)};
  const Lanes r = norm(residual);
  const Pair g = scaled(residual, inverse(r));
  return {r - s.radius, g.x, g.y};
}

struct Edge {
  float x, y;    // start
  float ex, ey;  // along
  float fx, fy;  // along, over its squared length
  float nx, ny;  // outward unit normal
};

HWY_INLINE Field triangle(Pair p, const Edge (&edges)[3]) {
  Lanes square = 3e38F, side = -3e38F;
  Pair residual{0.0F, 0.0F}, normal{0.0F, 0.0F};
  for (const Edge& e : edges) {
    const Pair w{p.x - e.x, p.y - e.y};
    const Lanes t = clamp(mul_add(w.x, e.fx, w.y * e.fy), 0.0F, 1.0F);
    const Pair q{neg_mul_add(t, e.ex, w.x), neg_mul_add(t, e.ey, w.y)};
    const Lanes squared = dot(q, q);
    residual = pick(squared < square, q, residual);
    square = min(square, squared);
    const Lanes height = mul_add(w.x, e.nx, w.y * e.ny);
    normal = pick(side < height, Pair{e.nx, e.ny}, normal);
    side = max(side, height);
  }
  const Lanes distance = sqrt(square);
  const Mask outside = Lanes(0.0F) < side;
  const Mask face = either(side <= Lanes(0.0F), distance <= side);
  const Pair g = pick(face, normal, scaled(residual, inverse(distance)));
  return {select(outside, distance, side), g.x, g.y};
}

/// A point folded by reflections, and the image of the first axis under them; `parity` keeps the handedness.
struct Folded {
  Pair p;
  Pair axis;
  Lanes parity;
};
/// Keeps the side of the line through the origin that (nx, ny) points to.
HWY_INLINE Folded reflect(Folded f, float nx, float ny) {
  const Lanes height = mul_add(f.p.x, nx, f.p.y * ny);
  const Lanes shift = min(height, 0.0F);
  const Mask behind = height < Lanes(0.0F);
  const Lanes turn = keep(behind, mul_add(f.axis.x, 2 * nx, f.axis.y * (2 * ny)));
  return {{neg_mul_add(shift, 2 * nx, f.p.x), neg_mul_add(shift, 2 * ny, f.p.y)},
          {neg_mul_add(turn, nx, f.axis.x), neg_mul_add(turn, ny, f.axis.y)},
          select(behind, -f.parity, f.parity)};
}

struct StarEdge {
  float radius;
  float ex, ey, fx, fy;    // from the tip to the notch, and that over its squared length
  float nx, ny;            // outward unit normal
  float notch_x, notch_y;  // the sum of the normals that meet at the notch
};
/// `lines` are the reflections, widest first.
template <size_t kLines>
HWY_INLINE Field star(Pair p, const StarEdge& e, const float (&lines)[kLines][2]) {
  Folded f{{p.y, abs(p.x)}, {0.0F, copysign(1.0F, p.x)}, copysign(1.0F, -p.x)};
  for (const auto& line : lines) f = reflect(f, line[0], line[1]);
  const Pair w{f.p.x - e.radius, f.p.y};
  const Lanes t = clamp(mul_add(w.x, e.fx, w.y * e.fy), 0.0F, 1.0F);
  const Pair q{neg_mul_add(t, e.ex, w.x), neg_mul_add(t, e.ey, w.y)};
  const Mask tip = t <= Lanes(0.0F), notch = Lanes(1.0F) <= t;
  const Pair judge = pick(tip, Pair{e.nx + 1, e.ny}, pick(notch, Pair{e.notch_x, e.notch_y}, Pair{e.nx, e.ny}));
  const Lanes distance = norm(q);
  const Lanes value = copysign(distance, dot(judge, q));
  const Pair away = scaled(q, copysign(inverse(distance), value));
  const Pair g = pick(either(tip, notch), away, Pair{e.nx, e.ny});
  const Lanes cross = neg_mul_add(f.axis.y, g.x, f.axis.x * g.y);
  return {value, dot(g, f.axis), f.parity * cross};
}

/// Positive beyond the wedge around +y whose half angle has this sine and cosine; p.x >= 0.
HWY_INLINE Lanes beyond_wedge(Pair p, float sine, float cosine) {
  const Lanes side = neg_mul_add(p.y, sine, p.x * cosine);
  const Lanes behind = mul_add(p.x, sine, p.y * cosine);
  return select(behind < Lanes(0.0F), side - p.y, side);
}

HWY_INLINE Field pie(Pair p, float sine, float cosine, float radius) {
  const Pair q{abs(p.x), p.y};
  const Lanes r = norm(p);
  const Lanes rim = r - radius;
  const Lanes t = clamp(mul_add(q.x, sine, q.y * cosine), 0.0F, radius);
  const Pair residual{neg_mul_add(t, sine, q.x), neg_mul_add(t, cosine, q.y)};
  const Lanes distance = norm(residual);
  const Lanes edge = copysign(distance, beyond_wedge(q, sine, cosine));
  const Mask on_rim = edge <= rim;
  const Mask flat = both(Lanes(0.0F) < t, t < Lanes(radius));
  // One division serves both features.
  const Lanes inv = inverse(select(on_rim, r, distance));
  const Pair feature = pick(on_rim, q, Pair{times_sign(residual.x, edge), times_sign(residual.y, edge)});
  const Pair round = scaled(feature, inv);
  const Mask face = both(flat, rim < edge);
  const Pair g = pick(face, Pair{cosine, -sine}, round);
  return {max(rim, edge), times_sign(g.x, p.x), g.y};
}

HWY_INLINE Field arc(Pair p, float sine, float cosine, float radius, float thickness) {
  const Pair q{abs(p.x), p.y};
  const Mask past = Lanes(0.0F) < beyond_wedge(q, sine, cosine);
  // The stroke's end or its centre line: either way one root, of the distance from a point.
  const Pair from = pick(past, Pair{q.x - sine * radius, q.y - cosine * radius}, q);
  const Lanes distance = norm(from);
  const Lanes radial = distance - select(past, Lanes(0.0F), Lanes(radius));
  const Pair g = scaled(from, times_sign(inverse(distance), radial));
  return {abs(radial) - thickness, times_sign(g.x, p.x), g.y};
}

HWY_INLINE Field ring(Pair p, float sine, float cosine, float radius, float half) {
  const Pair q{abs(p.x), p.y};
  const Lanes r = norm(p);
  const Lanes off = r - radius;
  const Lanes band = abs(off) - half;
  const Lanes across = neg_mul_add(q.y, sine, q.x * cosine);
  const Lanes along = mul_add(q.x, sine, q.y * cosine) - radius;
  const Lanes past = max(abs(along) - half, 0.0F);
  const Lanes distance = sqrt(mul_add(across, across, past * past));
  const Lanes end = copysign(distance, beyond_wedge(q, sine, cosine));
  const Mask on_band = end <= band;
  const Lanes inv = inverse(select(on_band, r, distance));
  const Lanes across_unit = select(past <= Lanes(0.0F), Lanes(1.0F), times_sign(across * inv, end));
  const Lanes along_unit = copysign(past * inv, along);
  const Pair at_end{mul_add(across_unit, cosine, along_unit * sine),
                    neg_mul_add(across_unit, sine, along_unit * cosine)};
  const Pair g = pick(on_band, scaled(q, times_sign(inv, off)), at_end);
  return {max(band, end), times_sign(g.x, p.x), g.y};
}

struct Moon {
  float offset, ra, rb;  // disc ra at the origin without disc rb at (offset, 0)
  float x, y;            // where the circles cross, y > 0
};
HWY_INLINE Field moon(Pair p, const Moon& m) {
  const Pair q{p.x, abs(p.y)};
  const Pair from_b{q.x - m.offset, q.y};
  const Lanes beyond_a = neg_mul_add(q.y, m.x, q.x * m.y);
  const Lanes beyond_b = neg_mul_add(q.y, m.x - m.offset, from_b.x * m.y);
  const Mask horn = Lanes(0.0F) < select(Lanes(m.y) <= q.y, beyond_a, beyond_b);
  // The horn or the outer circle: one root, then the inner circle where there is no horn.
  const Pair from = pick(horn, Pair{q.x - m.x, q.y - m.y}, q);
  const Lanes to_from = norm(from), to_b = norm(from_b);
  const Lanes outer = to_from - select(horn, Lanes(0.0F), Lanes(m.ra));
  const Lanes inner = Lanes(m.rb) - to_b;
  const Mask first = either(horn, inner <= outer);
  const Pair feature = pick(first, from, Pair{-from_b.x, -from_b.y});
  const Pair g = scaled(feature, inverse(select(first, to_from, to_b)));
  return {select(first, outer, inner), g.x, times_sign(g.y, p.y)};
}

// --- operators -------------------------------------------------------------------------------------------------------

HWY_INLINE Field negated(Field f) { return {-f.value, -f.gx, -f.gy}; }

HWY_INLINE Field unite(Field f, Field g) {
  const Mask first = f.value <= g.value;
  return {min(f.value, g.value), select(first, f.gx, g.gx), select(first, f.gy, g.gy)};
}
HWY_INLINE Field intersect(Field f, Field g) {
  const Mask first = g.value <= f.value;
  return {max(f.value, g.value), select(first, f.gx, g.gx), select(first, f.gy, g.gy)};
}
HWY_INLINE Field subtract(Field f, Field g) { return intersect(f, negated(g)); }

/// Quadratic, spanning `support` = 4 k: the weight of the farther operand is h / 2.
HWY_INLINE Field smooth_unite(Field f, Field g, float support) {
  const Mask first = f.value <= g.value;
  const Lanes gap = abs(f.value - g.value);
  const Lanes h = max(neg_mul_add(gap, 1 / support, 1.0F), 0.0F);
  const Lanes value = neg_mul_add(h * h, support / 4, min(f.value, g.value));
  const Lanes far = h * 0.5F;
  const Lanes weight = select(first, far, Lanes(1.0F) - far);  // of g
  return {value, mul_add(weight, g.gx - f.gx, f.gx), mul_add(weight, g.gy - f.gy, f.gy)};
}

}  // namespace thalweg::bench::native
HWY_AFTER_NAMESPACE();
