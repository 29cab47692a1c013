// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// 2D primitives with arcs and spikes: star, pie, arc, ring, moon, cool_s. Shapes follow Inigo Quilez, "2D distance
// functions"; see primitives2.inl for how they are derived and why signs are taken as they are.
// Included by all.inl once per SIMD target.

/// A point folded into one sector of a dihedral group by reflections, and whether their number is odd: `parity` is
/// negative then.
template <class T>
struct Folded {
  Point<T, 2> p;
  T parity;
};

/// Keeps the side of the line through the origin on which `normal` points; `twice` is twice that.
template <class T>
HWY_INLINE Folded<T> reflect(Folded<T> f, Point<T, 2> normal, Point<T, 2> twice) {
  const T height = dot(f.p, twice);
  return {neg_mul_add(normal, min(height, zero<T>()), f.p), times_sign(f.parity, height)};
}

/// The gradient at p, given the gradient g at its folded image q. As complex numbers an even fold is w -> w q / p, an
/// odd one w -> conj(w) q / conj(p): both ends of a fold tell what it was.
template <class T>
HWY_INLINE Point<T, 2> unfold(Point<T, 2> p, const Folded<T>& f, Point<T, 2> g) {
  const T inverse = one<T>() / max(dot(p, p), Make<T>::set(0x1p-120));
  const Point<T, 2> turn = {dot(g, f.p), times_sign(mul_sub(g.y, f.p.x, g.x * f.p.y), f.parity)};
  const Point<T, 2> u = scaled(p, inverse);
  return {mul_sub(u.x, turn.x, u.y * turn.y), mul_add(u.x, turn.y, u.y * turn.x)};
}

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "star",
                                            .dimension = 2,
                                            .exactness = "exact",
                                            .note = "one tip points along +y; folded by reflections, no trigonometry",
                                            .rounding = 24};
  static constexpr OpParameter kParameters[] = {
      size("radius", "distance from the centre to a tip"), ranged("points", Quantity::count, 3, 1e6, "number of tips"),
      ranged("sharpness", Quantity::number, 2, 1e6, "2: a regular polygon; `points`: spokes without area")};
  static PrimitiveFacts facts(Numbers p) { return {.convex = p[2] == 2}; }
  static Bounds bounds(Numbers p) { return box_bounds({-p[0], -p[0]}, {p[0], p[0]}); }
  static std::optional<Complaint> check(Numbers p) {
    if (p[2] > p[1]) return Complaint{"sharpness", "a number in [2, points]"};
    return std::nullopt;
  }
  /// radius, unit vector (2) and length of the edge from the tip, normal (2), sign vectors at the tip (2) and at the
  /// inner corner (2), then the normal of a reflection line and its double (4) per line. Coordinates: first axis along
  /// the tip, second >= 0.
  static void derive(Numbers p, Constants64 & c) {
    const double sector = std::numbers::pi / p[1];
    const double slope = std::numbers::pi / p[2];
    const double reach = p[0] * std::sin(sector) / std::sin(slope);
    const double inner = p[0] * std::cos(sector) - reach * std::cos(slope);
    const double ex = inner * std::cos(sector) - p[0];
    const double ey = inner * std::sin(sector);
    const double length = std::hypot(ex, ey);
    const double nx = along_edge(ey, length);
    const double ny = -along_edge(ex, length);
    c = {p[0], -ny, nx, length, nx, ny, nx + 1, ny, nx + std::cos(sector), ny + std::sin(sector)};
    double angle = sector;
    std::vector<double> lines;
    for (;; angle *= 2) {
      lines.push_back(angle);
      if (angle >= std::numbers::pi / 2) break;
    }
    for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
      c.insert(c.end(), {std::sin(*line), -std::cos(*line), 2 * std::sin(*line), -2 * std::cos(*line)});
    }
  }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    // Tip frame: first axis +y, second axis +x, folded to second >= 0.
    Folded<T> f = {{p.y, abs(p.x)}, -p.x};
    for (size_t i = 10; i < c.count; i += 4) f = reflect(f, {c[i], c[i + 1]}, {c[i + 2], c[i + 3]});
    const Point<T, 2> w = {f.p.x - c[0], f.p.y};
    const Point<T, 2> normal = {c[4], c[5]};
    const auto foot = foot_on_edge<T, 2>(w, {c[1], c[2]}, c[3]);
    const auto at_tip = foot.along <= zero<T>();
    const auto at_inner = c[3] <= foot.along;
    const Point<T, 2> judge =
        select(at_tip, Point<T, 2>{c[6], c[7]}, select(at_inner, Point<T, 2>{c[8], c[9]}, normal));
    const T distance = length(foot.residual);
    const T value = copysign(distance, dot(judge, foot.residual));
    const auto at_corner = either(at_tip, at_inner);
    return {value, unfold(p, f, select(at_corner, times_sign(foot.residual, value), normal)),
            select(at_corner, distance, one<T>())};
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "pie", .dimension = 2, .exactness = "exact", .note = "symmetric about +y", .rounding = 12};
  static constexpr OpParameter kParameters[] = {
      ranged("aperture", Quantity::angle, 1e-6, std::numbers::pi, "half of the opening angle; pi: a disc"),
      size("radius", "radius")};
  static PrimitiveFacts facts(Numbers p) {
    return {.convex = p[0] <= std::numbers::pi / 2 || p[0] >= std::numbers::pi};
  }
  static Bounds bounds(Numbers p) { return box_bounds({-p[1], -p[1]}, {p[1], p[1]}); }
  /// sin, cos, radius, and whether the disc is whole.
  static void derive(Numbers p, Constants64 & c) {
    c = {std::sin(p[0]), std::cos(p[0]), p[1], p[0] >= std::numbers::pi ? 1.0 : 0.0};
  }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    const Point<T, 2> q = {abs(p.x), p.y};
    const Point<T, 2> ray = {c[0], c[1]};
    const T r = length(p);
    const T arc = r - c[2];
    const T along = clamp(dot(q, ray), zero<T>(), c[2]);
    const Point<T, 2> residual = neg_mul_add(ray, along, q);
    const T distance = length(residual);
    const T side = wedge_side(q, ray);
    const T edge = copysign(distance, side);
    const auto on_arc = either(edge <= arc, zero<T>() < c[3]);
    const auto on_flat = both(zero<T>() < along, along < c[2]);
    const Point<T, 2> from_edge = select(on_flat, Point<T, 2>{ray.y, -ray.x}, times_sign(residual, side));
    const Point<T, 2> way = select(on_arc, q, from_edge);
    return {select(on_arc, arc, edge),
            {times_sign(way.x, p.x), way.y},
            select(on_arc, r, select(on_flat, one<T>(), distance))};
  }
  template <class T>
  static HWY_INLINE T support(Point<T, 2> u, Constants<T> c) {
    const Point<T, 2> q = {abs(u.x), u.y};
    const Point<T, 2> ray = {c[0], c[1]};
    const auto beyond = both(zero<T>() < wedge_side(q, ray), c[3] <= zero<T>());
    return c[2] * select(beyond, max(zero<T>(), dot(q, ray)), one<T>());
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "arc",
                                            .dimension = 2,
                                            .exactness = "exact; a bound inside where the stroke overlaps itself",
                                            .note = "symmetric about +y, round ends",
                                            .rounding = 10};
  static constexpr OpParameter kParameters[] = {
      ranged("aperture", Quantity::angle, 1e-6, std::numbers::pi, "half of the opening angle; pi: a closed ring"),
      size("radius", "radius of the centre line"), size("thickness", "half of the stroke's width")};
  static PrimitiveFacts facts(Numbers p) {
    const bool closed = p[0] >= std::numbers::pi;
    const bool ends_apart = closed || p[0] <= std::numbers::pi / 2 || p[1] * std::sin(p[0]) >= p[2];
    return {.inside = p[2] <= p[1] && ends_apart ? Exactness::exact : Exactness::lower_bound};
  }
  static Bounds bounds(Numbers p) {
    const double r = p[1] + p[2];
    return box_bounds({-r, -r}, {r, r});
  }
  /// sin and cos of the aperture, radius, thickness, an end (2). No point is past the ends of a closed ring.
  static void derive(Numbers p, Constants64 & c) {
    const bool closed = p[0] >= std::numbers::pi;
    const double sine = closed ? 0.0 : std::sin(p[0]);
    const double cosine = closed ? -1.0 : std::cos(p[0]);
    c = {sine, cosine, p[1], p[2], sine * p[1], cosine * p[1]};
  }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    const Point<T, 2> q = {abs(p.x), p.y};
    const Point<T, 2> ray = {c[0], c[1]};
    const auto past_end = zero<T>() < wedge_side(q, ray);
    // Beyond an end the distance to it counts, else the distance to the centre: one of the two is computed.
    const Point<T, 2> from = select(past_end, Point<T, 2>{q.x - c[4], q.y - c[5]}, q);
    const T r = length(from);
    const T radial = r - select(past_end, zero<T>(), c[2]);
    const Point<T, 2> way = times_sign(from, radial);
    return {abs(radial) - c[3], {times_sign(way.x, p.x), way.y}, r};
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "ring", .dimension = 2, .exactness = "exact", .note = "symmetric about +y, flat ends", .rounding = 12};
  static constexpr OpParameter kParameters[] = {
      ranged("aperture", Quantity::angle, 1e-6, std::numbers::pi, "half of the opening angle; pi: closed"),
      size("radius", "radius of the centre line"), size("thickness", "full width, at most twice the radius")};
  static PrimitiveFacts facts(Numbers) { return {}; }
  static Bounds bounds(Numbers p) {
    const double r = p[1] + p[2] / 2;
    return box_bounds({-r, -r}, {r, r});
  }
  static std::optional<Complaint> check(Numbers p) {
    if (p[2] > 2 * p[1]) return Complaint{"thickness", "a width of at most twice the radius"};
    return std::nullopt;
  }
  static void derive(Numbers p, Constants64 & c) {
    c = {std::sin(p[0]), std::cos(p[0]), p[1], p[2] / 2, p[0] >= std::numbers::pi ? 1.0 : 0.0};
  }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    const Point<T, 2> q = {abs(p.x), p.y};
    const Point<T, 2> ray = {c[0], c[1]};
    const T r = length(p);
    const T radial = abs(r - c[2]) - c[3];
    // End frame: across the end's line (positive beyond it) and along it.
    const T across = mul_sub(ray.y, q.x, ray.x * q.y);
    const T along = dot(q, ray) - c[2];
    const T past = max(abs(along) - c[3], zero<T>());
    const T distance = length(Point<T, 2>{across, past});
    const T end = copysign(distance, wedge_side(q, ray));
    const auto on_side = either(end <= radial, zero<T>() < c[4]);
    const auto on_flat = past <= zero<T>();
    const T way_across = select(on_flat, one<T>(), times_sign(across, end));
    // Inside, a corner is nearest only where a radius of 0 makes the end and the inner circle meet.
    const T way_along = times_sign(copysign(past, along), end);
    const Point<T, 2> from_end = {mul_add(way_across, ray.y, way_along * ray.x),
                                  neg_mul_add(way_across, ray.x, way_along * ray.y)};
    const Point<T, 2> way = select(on_side, times_sign(q, r - c[2]), from_end);
    return {select(on_side, radial, end),
            {times_sign(way.x, p.x), way.y},
            select(on_side, r, select(on_flat, one<T>(), distance))};
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "moon", .dimension = 2, .exactness = "exact", .note = "disc ra minus disc rb", .rounding = 16};
  static constexpr OpParameter kParameters[] = {size("offset", "centre of the disc taken away, along +x"),
                                                size("ra", "radius of the disc that is kept"),
                                                size("rb", "radius of the disc taken away; below ra + offset")};
  static PrimitiveFacts facts(Numbers) { return {}; }
  static Bounds bounds(Numbers p) { return box_bounds({-p[1], -p[1]}, {p[1], p[1]}); }
  static std::optional<Complaint> check(Numbers p) {
    if (p[2] >= p[0] + p[1]) return Complaint{"rb", "a radius below ra + offset, or nothing is left"};
    return std::nullopt;
  }
  /// offset, ra, rb, corner (2).
  static void derive(Numbers p, Constants64 & c) {
    const double x = (p[0] + (p[1] - p[2]) * (p[1] + p[2]) / p[0]) / 2;
    // Heron's formula for the height of the triangle of both centres and the corner: no cancellation for a small rb.
    const double excess = p[1] - p[2];
    const double product = (p[0] + excess) * (p[0] - excess) * (p[1] + p[2] - p[0]) * (p[0] + p[1] + p[2]);
    c = {p[0], p[1], p[2], x, std::sqrt(std::max(0.0, product)) / (2 * p[0])};
  }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    const Point<T, 2> q = {p.x, abs(p.y)};
    const Point<T, 2> from_b = {q.x - c[0], q.y};
    // The corner is closest in the cone beyond both circles' radii through it; there is none when they do not cross.
    const T beyond_a = mul_sub(q.x, c[4], q.y * c[3]);
    const T beyond_b = mul_sub(from_b.x, c[4], q.y * (c[3] - c[0]));
    const auto at_corner = both(zero<T>() < select(c[4] <= q.y, beyond_a, beyond_b), zero<T>() < c[4]);
    const Point<T, 2> from_a = select(at_corner, Point<T, 2>{q.x - c[3], q.y - c[4]}, q);
    const T ra = length(from_a);
    const T rb = length(from_b);
    const T outer = ra - c[1];
    const T inner = c[2] - rb;
    const auto on_a = either(at_corner, inner <= outer);
    const Point<T, 2> way = select(on_a, from_a, Point<T, 2>{-from_b.x, -from_b.y});
    return {select(at_corner, ra, max(outer, inner)), {way.x, times_sign(way.y, p.y)}, select(on_a, ra, rb)};
  }
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "cool_s",
                                            .dimension = 2,
                                            .exactness = "exact",
                                            .note = "height 2, width 0.8; its inner strokes are part of the surface",
                                            .rounding = 24};
  static constexpr OpParameter kParameters[] = {OpParameter{.name = "unit",
                                                            .quantity = Quantity::length,
                                                            .arity = 1,
                                                            .least = kSmallest,
                                                            .most = kLargest,
                                                            .meaning = "scene units per unit of the drawing",
                                                            .choices = "",
                                                            .optional = true,
                                                            .fallback = 1,
                                                            .implicit = true}};
  static PrimitiveFacts facts(Numbers) { return {}; }
  static Bounds bounds(Numbers p) { return box_bounds({-0.4 * p[0], -p[0]}, {0.4 * p[0], p[0]}); }
  /// The five strokes of the upper half as start, unit vector, length; then the outline's levels.
  static void derive(Numbers p, Constants64 & c) {
    static constexpr double kStrokes[5][4] = {{0, 1, 0.4, -0.4},     // roof
                                              {0.4, 0.2, 0, 0.4},    // side
                                              {0, -0.2, 0.4, 0.4},   // waist, drawn on across the lower diagonal
                                              {0, 0.2, 0, 0.4},      // inner upright
                                              {0, 0.2, 0.2, -0.2}};  // diagonal
    for (const auto& s : kStrokes) {
      const double length = std::hypot(s[2], s[3]);
      c.insert(c.end(), {s[0] * p[0], s[1] * p[0], s[2] / length, s[3] / length, length * p[0]});
    }
    c.insert(c.end(), {0.4 * p[0], p[0], 0.2 * p[0]});
  }

  template <class T>
  static HWY_INLINE Ray<T, 2> field(Point<T, 2> p, Constants<T> c) {
    // Half a turn maps the S to itself; all strokes but the diagonal are symmetric in x as well.
    const T half_turn = sign_of(p.y);
    const T x = p.x * half_turn;
    const T y = abs(p.y);
    const T mirrored = abs(x);
    T square = Make<T>::set(3e38);
    Point<T, 2> residual = {zero<T>(), zero<T>()};
    for (size_t i = 0; i < 20; i += 5) {
      const auto foot = foot_on_edge<T, 2>({mirrored - c[i], y - c[i + 1]}, {c[i + 2], c[i + 3]}, c[i + 4]);
      const T squared = dot(foot.residual, foot.residual);
      residual = select(squared < square, foot.residual, residual);
      square = min(square, squared);
    }
    const auto foot = foot_on_edge<T, 2>({x - c[20], y - c[21]}, {c[22], c[23]}, c[24]);
    const T squared = dot(foot.residual, foot.residual);
    const auto on_diagonal = squared < square;
    const Point<T, 2> unfolded = {times_sign(residual.x, x), residual.y};
    residual = select(on_diagonal, foot.residual, unfolded);
    const T distance = sqrt(min(square, squared));
    const T outline = select(c[25] <= y, c[26] - y, c[27] + y);
    const T value = copysign(distance, max(mirrored - c[25], mirrored - outline));
    return {value, times_sign(residual, times_sign(value, half_turn)), distance};
  }
};
