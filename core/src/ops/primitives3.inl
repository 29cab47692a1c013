// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// 3D primitives. Shapes follow Inigo Quilez, "distance functions"; the derivations are ours, as in primitives2.inl.
// Included by all.inl once per SIMD target.

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "sphere", .dimension = 3, .exactness = "exact", .rounding = 6, .absorbs_rotation = true};
  static constexpr OpParameter kParameters[] = {size("radius", "distance from the centre to the surface")};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) { return box_bounds({-p[0], -p[0], -p[0]}, {p[0], p[0], p[0]}); }
  static void derive(Numbers p, Constants64 & c) { c = {p[0]}; }

  template <class T>
  static HWY_INLINE Ray<T, 3> field(Point<T, 3> p, Constants<T> c) {
    const T r = length(p);
    return {r - c[0], p, r};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 3>, Constants<T> c) {
    return c[0];
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "box", .dimension = 3, .exactness = "exact"};
  static constexpr OpParameter kParameters[] = {size("half_size", "half extents along x, y and z", 3)};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) { return box_bounds({-p[0], -p[1], -p[2]}, {p[0], p[1], p[2]}); }
  static void derive(Numbers p, Constants64 & c) { c.assign(p.begin(), p.end()); }

  template <class T>
  static HWY_INLINE Ray<T, 3> field(Point<T, 3> p, Constants<T> c) {
    const Point<T, 3> q = {abs(p.x) - c[0], abs(p.y) - c[1], abs(p.z) - c[2]};
    const Point<T, 3> out = {max(q.x, zero<T>()), max(q.y, zero<T>()), max(q.z, zero<T>())};
    const T distance = length(out);
    const T highest = max(q.x, max(q.y, q.z));
    const auto is_x = highest <= q.x;
    const auto is_y = highest <= q.y;
    const Point<T, 3> face = {select(is_x, one<T>(), zero<T>()),
                              select(is_x, zero<T>(), select(is_y, one<T>(), zero<T>())),
                              select(either(is_x, is_y), zero<T>(), one<T>())};
    const auto is_outside = zero<T>() < distance;
    const Point<T, 3> g = select(is_outside, out, face);
    return {distance + min(highest, zero<T>()),
            {copysign(g.x, p.x), copysign(g.y, p.y), copysign(g.z, p.z)},
            select(is_outside, distance, one<T>())};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 3> u, Constants<T> c) {
    return mul_add(c[0], abs(u.x), mul_add(c[1], abs(u.y), c[2] * abs(u.z)));
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "torus",
                                            .dimension = 3,
                                            .exactness = "exact; a bound inside where tube > radius",
                                            .note = "around the y axis"};
  static constexpr OpParameter kParameters[] = {size("radius", "radius of the centre line"),
                                                size("tube", "radius of the tube")};
  static PrimitiveFacts facts(Numbers p) {
    return {.inside = p[1] <= p[0] ? Exactness::exact : Exactness::lower_bound};
  }
  static Bounds bounds(Numbers p) {
    const double r = p[0] + p[1];
    return box_bounds({-r, -p[1], -r}, {r, p[1], r});
  }
  static void derive(Numbers p, Constants64 & c) { c.assign(p.begin(), p.end()); }

  template <class T>
  static HWY_INLINE Ray<T, 3> field(Point<T, 3> p, Constants<T> c) {
    const T axis = length(Point<T, 2>{p.x, p.z});
    const Point<T, 2> q = {axis - c[0], p.y};
    const T r = length(q);
    const T inverse = reciprocal_or_zero(axis);
    return {r - c[1], {p.x * inverse * q.x, p.y, p.z * inverse * q.x}, r};
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "capsule", .dimension = 3, .exactness = "exact", .absorbs_rotation = true};
  static constexpr OpParameter kParameters[] = {point("a", "one end of the centre line", 3),
                                                point("b", "the other end", 3), size("radius", "radius")};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) { return grown(point_bounds(p.first(6), 3), 3, p[6]); }
  static void derive(Numbers p, Constants64 & c) {
    const double length = std::hypot(p[3], p[4], p[5]);
    c = {along_edge(p[3], length), along_edge(p[4], length), along_edge(p[5], length), length, p[6]};
  }

  template <class T>
  static HWY_INLINE Ray<T, 3> field(Point<T, 3> p, Constants<T> c) {
    const auto foot = foot_on_edge<T, 3>(p, {c[0], c[1], c[2]}, c[3]);
    const T r = length(foot.residual);
    return {r - c[4], foot.residual, r};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 3> u, Constants<T> c) {
    return mul_add(c[3], max(zero<T>(), dot<T>({c[0], c[1], c[2]}, u)), c[4]);
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "cylinder", .dimension = 3, .exactness = "exact", .note = "along the y axis"};
  static constexpr OpParameter kParameters[] = {size("half_height", "half of the height"), size("radius", "radius")};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) { return box_bounds({-p[1], -p[0], -p[1]}, {p[1], p[0], p[1]}); }
  static void derive(Numbers p, Constants64 & c) { c.assign(p.begin(), p.end()); }

  template <class T>
  static HWY_INLINE Ray<T, 3> field(Point<T, 3> p, Constants<T> c) {
    const T axis = length(Point<T, 2>{p.x, p.z});
    const auto f = corner_field<T>({axis - c[1], abs(p.y) - c[0]}, zero<T>());
    const T inverse = reciprocal_or_zero(axis);
    return {f.value, {p.x * inverse * f.toward.x, copysign(f.toward.y, p.y), p.z * inverse * f.toward.x}, f.length};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 3> u, Constants<T> c) {
    return mul_add(c[0], abs(u.y), c[1] * length(Point<T, 2>{u.x, u.z}));
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "plane",
                                            .dimension = 3,
                                            .exactness = "exact",
                                            .note = "f = normal . p - offset",
                                            .rounding = 6,
                                            .absorbs_rotation = true};
  static constexpr OpParameter kParameters[] = {direction("normal", "points out of the half space", 3),
                                                signed_length("offset", "distance of the plane from the origin")};
  static PrimitiveFacts facts(Numbers) { return {.convex = true}; }
  static Bounds bounds(Numbers p) {
    Bounds bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (p[axis] == 1) bounds.hi[axis] = p[3];
      if (p[axis] == -1) bounds.lo[axis] = -p[3];
    }
    return bounds;
  }
  static void derive(Numbers p, Constants64 & c) { c.assign(p.begin(), p.end()); }

  template <class T>
  static HWY_INLINE Field<T, 3> field(Point<T, 3> p, Constants<T> c) {
    const Point<T, 3> n = {c[0], c[1], c[2]};
    return {dot(n, p) - c[3], n};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 3>, Constants<T> c) {
    return c[3];
  }
};
