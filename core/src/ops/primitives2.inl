// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// 2D primitives bounded by circles, boxes and lines. Shapes follow Inigo Quilez, "2D distance functions"; the
// derivations are ours: a point is folded into a fundamental domain, the closest feature found there, and value and
// gradient read off it. A sign is always taken from a test whose error stays of the order of the rounding of the
// value, so that a thin shape seen from afar never turns inside out.
// Included by all.inl once per SIMD target.

/// Signed distance to an axis-aligned box given q = |p| - half_size, in the first quadrant; rounded by `radius`.
template <class T>
HWY_INLINE Ray<T, 2> corner_field(Point<T, 2> q, T radius) {
  const Point<T, 2> out = {max(q.x, zero<T>()), max(q.y, zero<T>())};
  const T distance = length(out);
  const T depth = min(max(q.x, q.y), zero<T>());
  const auto is_outside = zero<T>() < distance;
  const auto face_x = q.y <= q.x;
  const Point<T, 2> face = {select(face_x, one<T>(), zero<T>()), select(face_x, zero<T>(), one<T>())};
  return {distance + depth - radius, select(is_outside, out, face), select(is_outside, distance, one<T>())};
}

/// Closest point of the segment from the origin along the unit vector `edge`: the residual from it, and how far along
/// it lies.
template <class T, int D>
struct Foot {
  T along;
  Point<T, D> residual;
};
template <class T, int D>
HWY_INLINE Foot<T, D> foot_on_edge(Point<T, D> w, Point<T, D> edge, T length) {
  const T along = clamp(dot(w, edge), zero<T>(), length);
  return {along, neg_mul_add(edge, along, w)};
}

/// A component of the unit vector along an edge; an edge of no length is a point.
inline double along_edge(double component, double length) { return length > 0 ? component / length : 0.0; }

/// Which side of the ray from the origin along (sine, cosine) a point with x >= 0 lies on: positive beyond the wedge
/// around +y. Behind the apex the axis decides too, which keeps the sign right for wedges of any width.
template <class T>
HWY_INLINE T wedge_side(Point<T, 2> p, Point<T, 2> ray) {
  const T side = mul_sub(ray.y, p.x, ray.x * p.y);
  return select(dot(p, ray) < zero<T>(), side - p.y, side);
}

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "circle", .dimension = 2, .exactness = "exact", .rounding = 6, .absorbs_rotation = true};
  static constexpr OpParameter kParameters[] = {size("radius", "distance from the centre to the edge")};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) { return box_bounds({-p[0], -p[0]}, {p[0], p[0]}); }
  static void derive(Numbers p, Constants64 & c) { c = {p[0]}; }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    const T r = length(p);
    return {r - c[0], p, r};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 2>, Constants<T> c) {
    return c[0];
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "box", .dimension = 2, .exactness = "exact"};
  static constexpr OpParameter kParameters[] = {size("half_size", "half extents along x and y", 2)};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) { return box_bounds({-p[0], -p[1]}, {p[0], p[1]}); }
  static void derive(Numbers p, Constants64 & c) { c = {p[0], p[1]}; }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    const auto f = corner_field<T>({abs(p.x) - c[0], abs(p.y) - c[1]}, zero<T>());
    return {f.value, {copysign(f.toward.x, p.x), copysign(f.toward.y, p.y)}, f.length};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 2> u, Constants<T> c) {
    return mul_add(c[0], abs(u.x), c[1] * abs(u.y));
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "rounded_box", .dimension = 2, .exactness = "exact"};
  static constexpr OpParameter kParameters[] = {
      size("half_size", "half extents along x and y", 2),
      size_or_zero("radii", "corner radii: top right, bottom right, top left, bottom left; at most min(half_size)", 4)};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) { return box_bounds({-p[0], -p[1]}, {p[0], p[1]}); }
  static std::optional<Complaint> check(Numbers p) {
    for (std::size_t i = 2; i < 6; ++i) {
      if (p[i] > p[0] || p[i] > p[1]) return Complaint{"radii", "radii of at most the smaller half_size"};
    }
    return std::nullopt;
  }
  static void derive(Numbers p, Constants64 & c) { c.assign(p.begin(), p.end()); }

  template <class T>
  static HWY_INLINE T corner_radius(Point<T, 2> p, Constants<T> c) {
    const auto top = zero<T>() < p.y;
    return select(zero<T>() < p.x, select(top, c[2], c[3]), select(top, c[4], c[5]));
  }
  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    const T r = corner_radius(p, c);
    const auto f = corner_field<T>({abs(p.x) - (c[0] - r), abs(p.y) - (c[1] - r)}, r);
    return {f.value, {copysign(f.toward.x, p.x), copysign(f.toward.y, p.y)}, f.length};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 2> u, Constants<T> c) {
    const T r = corner_radius(u, c);
    return mul_add(c[0] - r, abs(u.x), mul_add(c[1] - r, abs(u.y), r));
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "segment",
                                            .dimension = 2,
                                            .exactness = "exact, unsigned",
                                            .note = "has no inside: give it `round`",
                                            .absorbs_rotation = true,
                                            .is_unsigned = true};
  static constexpr OpParameter kParameters[] = {point("a", "one end", 2), point("b", "the other end", 2)};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) { return point_bounds(p, 2); }
  static void derive(Numbers p, Constants64 & c) {
    const double length = std::hypot(p[2], p[3]);
    c = {along_edge(p[2], length), along_edge(p[3], length), length};
  }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    const auto foot = foot_on_edge<T, 2>(p, {c[0], c[1]}, c[2]);
    const T r = length(foot.residual);
    return {r, foot.residual, r};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 2> u, Constants<T> c) {
    return c[2] * max(zero<T>(), dot<T>({c[0], c[1]}, u));
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "triangle", .dimension = 2, .exactness = "exact", .rounding = 12, .absorbs_rotation = true};
  static constexpr OpParameter kParameters[] = {point("a", "a corner", 2), point("b", "a corner", 2),
                                                point("c", "a corner; a, b, c must not lie on one line", 2)};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) { return point_bounds(p, 2); }
  static double twice_area(Numbers p) { return (p[2] - p[0]) * (p[5] - p[1]) - (p[3] - p[1]) * (p[4] - p[0]); }
  static std::optional<Complaint> check(Numbers p) {
    const double longest = std::max({std::hypot(p[2] - p[0], p[3] - p[1]), std::hypot(p[4] - p[2], p[5] - p[3]),
                                     std::hypot(p[0] - p[4], p[1] - p[5])});
    if (std::fabs(twice_area(p)) <= 1e-12 * longest * longest || longest < kSmallest) {
      return Complaint{"c", "corners that do not lie on one line"};
    }
    return std::nullopt;
  }
  /// Per edge, counter-clockwise: its unit vector, where its middle lies along it, half of its length, the height of
  /// its line above the origin; then the second and third corner. The first one is the origin.
  static void derive(Numbers p, Constants64 & c) {
    const bool turned = twice_area(p) < 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t from = 2 * (turned ? (3 - i) % 3 : i);
      const std::size_t to = 2 * (turned ? 2 - i : (i + 1) % 3);
      const double length = std::hypot(p[to] - p[from], p[to + 1] - p[from + 1]);
      const double ux = (p[to] - p[from]) / length;
      const double uy = (p[to + 1] - p[from + 1]) / length;
      c.insert(c.end(),
               {ux, uy, ux * p[from] + uy * p[from + 1] + length / 2, length / 2, uy * p[from] - ux * p[from + 1]});
    }
    c.insert(c.end(), {p[2], p[3], p[4], p[5]});
  }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    T square = Make<T>::set(3e38);
    T side = Make<T>::set(-3e38);
    // Of the nearest edge: its direction, the height above it, and how far past its ends.
    Point<T, 2> edge = {zero<T>(), zero<T>()};
    T above = zero<T>();
    T beyond = zero<T>();
    for (size_t i = 0; i < 15; i += 5) {
      const Point<T, 2> u = {c[i], c[i + 1]};
      const T along = mul_add(u.x, p.x, mul_sub(u.y, p.y, c[i + 2]));
      const T height = mul_sub(u.y, p.x, mul_add(u.x, p.y, c[i + 4]));
      const T past = max(abs(along) - c[i + 3], zero<T>());
      const T squared = mul_add(past, past, height * height);
      const auto nearer = squared < square;
      edge = select(nearer, u, edge);
      above = select(nearer, height, above);
      beyond = select(nearer, copysign(past, along), beyond);
      square = min(square, squared);
      side = max(side, height);
    }
    // Inside, the edge of greatest height is the nearest one, and its height the distance to it: heights that are all
    // negative by rounding alone, beyond the tip of a needle, are told by a distance that is far more. Outside, the
    // normal of a face is exact where the way from a point close to it is noise.
    const T distance = sqrt(square);
    const auto is_outside = zero<T>() < mul_add(Make<T>::set(2.0), side, distance);
    const auto at_corner = both(is_outside, zero<T>() < abs(beyond));
    const Point<T, 2> normal = {edge.y, -edge.x};
    const Point<T, 2> from_corner = {mul_add(edge.x, beyond, above * normal.x),
                                     mul_add(edge.y, beyond, above * normal.y)};
    return {select(is_outside, distance, side), select(at_corner, from_corner, normal),
            select(at_corner, distance, one<T>())};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 2> u, Constants<T> c) {
    return max(max(zero<T>(), dot<T>({c[15], c[16]}, u)), dot<T>({c[17], c[18]}, u));
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "polygon",
                                            .dimension = 2,
                                            .exactness = "exact",
                                            .note = "simple, either winding",
                                            .rounding = 12,
                                            .absorbs_rotation = true};
  static constexpr OpParameter kParameters[] = {
      point("points", "the corners in order; edges must not cross or touch", 0)};
  static PrimitiveFacts facts(Numbers p) { return {.convex = is_convex_polygon(p)}; }
  static Bounds bounds(Numbers p) { return point_bounds(p, 2); }
  static std::optional<Complaint> check(Numbers p) {
    if (p.size() < 6) return Complaint{"points", "at least 3 points"};
    if (!is_simple_polygon(p)) return Complaint{"points", "a polygon whose edges do not cross or touch"};
    return std::nullopt;
  }
  /// Per edge: start, unit vector, length, end height, outward normal. The first corner is the origin.
  static void derive(Numbers p, Constants64 & c) {
    const double turn = polygon_area(p) < 0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < p.size(); i += 2) {
      const std::size_t j = (i + 2) % p.size();
      const double ex = p[j] - p[i];
      const double ey = p[j + 1] - p[i + 1];
      const double length = std::hypot(ex, ey);
      const double ux = along_edge(ex, length);
      const double uy = along_edge(ey, length);
      c.insert(c.end(), {p[i], p[i + 1], ux, uy, length, p[j + 1], turn * uy, -turn * ux});
    }
  }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    T square = Make<T>::set(3e38);
    T sign = one<T>();
    Point<T, 2> residual = {zero<T>(), zero<T>()};
    Point<T, 2> normal = residual;
    T on_face = zero<T>();  // positive where the closest point is no corner
    for (size_t i = 0; i < c.count; i += 8) {
      const Point<T, 2> w = {p.x - c[i], p.y - c[i + 1]};
      const Point<T, 2> edge = {c[i + 2], c[i + 3]};
      const auto foot = foot_on_edge<T, 2>(w, edge, c[i + 4]);
      const T squared = dot(foot.residual, foot.residual);
      const auto nearer = squared < square;
      residual = select(nearer, foot.residual, residual);
      normal = select(nearer, Point<T, 2>{c[i + 6], c[i + 7]}, normal);
      on_face = select(nearer, min(foot.along, c[i + 4] - foot.along), on_face);
      square = min(square, squared);
      // Even-odd rule: each edge that spans the point's height and passes on its right turns the sign.
      const auto rises = c[i + 1] <= p.y;
      const auto spans = differ(rises, c[i + 5] <= p.y);
      const auto passes_left = differ(zero<T>() < mul_sub(edge.x, w.y, edge.y * w.x), rises);
      sign = select(spans, select(passes_left, sign, -sign), sign);
    }
    const T distance = sqrt(square);
    const auto at_face = zero<T>() < on_face;
    return {times_sign(distance, sign), select(at_face, normal, times_sign(residual, sign)),
            select(at_face, one<T>(), distance)};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 2> u, Constants<T> c) {
    T most = zero<T>();
    for (size_t i = 8; i < c.count; i += 8) most = max(most, dot<T>({c[i], c[i + 1]}, u));
    return most;
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "half_plane",
                                            .dimension = 2,
                                            .exactness = "exact",
                                            .note = "f = normal . p - offset",
                                            .rounding = 6,
                                            .absorbs_rotation = true};
  static constexpr OpParameter kParameters[] = {direction("normal", "points out of the half plane", 2),
                                                signed_length("offset", "distance of the edge from the origin")};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) {
    Bounds bounds;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (p[axis] == 1) bounds.hi[axis] = p[2];
      if (p[axis] == -1) bounds.lo[axis] = -p[2];
    }
    return bounds;
  }
  static void derive(Numbers p, Constants64 & c) { c.assign(p.begin(), p.end()); }

  template <class T>
  static HWY_INLINE Field<T, 2> field(Point<T, 2> p, Constants<T> c) {
    const Point<T, 2> n = {c[0], c[1]};
    return {dot(n, p) - c[2], n};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 2>, Constants<T> c) {
    return c[2];
  }
};
