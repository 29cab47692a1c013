// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Ops that move the point at which their operand is evaluated. A `place` op is a similarity: the compiler composes
// them and folds them into primitives, and only a rotation that a primitive cannot absorb becomes an instruction (of
// the op `rigid`). A `warp` op is any other map of the point; `pull` brings a gradient back through it.
// Included by all.inl once per SIMD target.

inline Similarity rotation2(double angle) {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  return {.rotation = {c, -s, 0, s, c, 0, 0, 0, 1}};
}

/// From a unit quaternion w, x, y, z.
inline Similarity rotation3(double w, double x, double y, double z) {
  return {.rotation = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
                       2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),  //
                       2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
}

inline Similarity translation(Numbers by) {
  Similarity s;
  std::copy(by.begin(), by.end(), s.translation.begin());
  return s;
}

consteval OpParameter displacement(std::string_view name, int arity) {
  return {.name = name,
          .quantity = Quantity::vector,
          .arity = arity,
          .least = -kLargest,
          .most = kLargest,
          .meaning = "displacement per axis",
          .choices = ""};
}
consteval OpParameter turn_angle(std::string_view name) {
  return ranged(name, Quantity::angle, -1e6, 1e6, "counter-clockwise angle");
}
consteval OpParameter quaternion(std::string_view name) {
  return {.name = name,
          .quantity = Quantity::quaternion,
          .arity = 4,
          .least = -kLargest,
          .most = kLargest,
          .meaning = "rotation as w, x, y, z; normalised on reading",
          .choices = ""};
}

THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "translate", .kind = OpKind::place, .dimension = 2, .exactness = "keeps its operand's"};
  static constexpr OpParameter kParameters[] = {displacement("by", 2)};
  static Similarity similarity(Numbers p) { return translation(p); }
};
THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "translate", .kind = OpKind::place, .dimension = 3, .exactness = "keeps its operand's"};
  static constexpr OpParameter kParameters[] = {displacement("by", 3)};
  static Similarity similarity(Numbers p) { return translation(p); }
};
THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "rotate", .kind = OpKind::place, .dimension = 2, .exactness = "keeps its operand's"};
  static constexpr OpParameter kParameters[] = {turn_angle("angle")};
  static Similarity similarity(Numbers p) { return rotation2(p[0]); }
};
THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "rotate", .kind = OpKind::place, .dimension = 3, .exactness = "keeps its operand's"};
  static constexpr OpParameter kParameters[] = {direction("axis", "axis of the rotation", 3), turn_angle("angle")};
  static Similarity similarity(Numbers p) {
    const double s = std::sin(p[3] / 2);
    return rotation3(std::cos(p[3] / 2), s * p[0], s * p[1], s * p[2]);
  }
};
THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "rotate",
                                            .kind = OpKind::place,
                                            .dimension = 3,
                                            .exactness = "keeps its operand's",
                                            .note = "the same by quaternion"};
  static constexpr OpParameter kParameters[] = {quaternion("quaternion")};
  static Similarity similarity(Numbers p) { return rotation3(p[0], p[1], p[2], p[3]); }
};
THALWEG_OP {
  static constexpr Declaration kDeclaration{
      .name = "scale", .kind = OpKind::place, .exactness = "keeps its operand's", .note = "uniform"};
  static constexpr OpParameter kParameters[] = {
      ranged("factor", Quantity::number, kSmallest, kLargest, "how many times larger")};
  static Similarity similarity(Numbers p) { return {.scale = p[0]}; }
};

/// The one placement that is left in a tape, as an instruction of its own or as the beginning of a primitive: constants
/// are the translation and the rotation's rows as they act on the way in, p -> R^T (p - t).
THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "rigid",
                                            .kind = OpKind::place,
                                            .dimension = 2,
                                            .exactness = "keeps its operand's",
                                            .note = "rotate, then translate",
                                            .rounding = 4};
  static constexpr OpParameter kParameters[] = {displacement("translate", 2), turn_angle("rotate")};
  static Similarity similarity(Numbers p) {
    Similarity s = rotation2(p[2]);
    s.translation = {p[0], p[1], 0};
    return s;
  }
  static constexpr std::size_t kConstants = 4;
  static void derive(const Similarity& s, Constants64& c) {
    c = {s.translation[0], s.translation[1], s.rotation[0], s.rotation[3]};
  }
  template <class T>
  static HWY_INLINE Point<T, 2> map(Point<T, 2> p, Constants<T> c) {
    const Point<T, 2> w = {p.x - c[0], p.y - c[1]};
    return {mul_add(c[2], w.x, c[3] * w.y), mul_sub(c[2], w.y, c[3] * w.x)};
  }
  template <class T>
  static HWY_INLINE Point<T, 2> pull(Point<T, 2>, Constants<T> c, Point<T, 2> g) {
    return {mul_sub(c[2], g.x, c[3] * g.y), mul_add(c[3], g.x, c[2] * g.y)};
  }
};
THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "rigid",
                                            .kind = OpKind::place,
                                            .dimension = 3,
                                            .exactness = "keeps its operand's",
                                            .note = "rotate, then translate",
                                            .rounding = 6};
  static constexpr OpParameter kParameters[] = {displacement("translate", 3), quaternion("rotate")};
  static Similarity similarity(Numbers p) {
    Similarity s = rotation3(p[3], p[4], p[5], p[6]);
    s.translation = {p[0], p[1], p[2]};
    return s;
  }
  static constexpr std::size_t kConstants = 12;
  static void derive(const Similarity& s, Constants64& c) {
    c.assign(s.translation.begin(), s.translation.end());
    c.insert(c.end(), s.rotation.begin(), s.rotation.end());
  }
  template <class T>
  static HWY_INLINE Point<T, 3> map(Point<T, 3> p, Constants<T> c) {
    const Point<T, 3> w = {p.x - c[0], p.y - c[1], p.z - c[2]};
    return {dot(w, Point<T, 3>{c[3], c[6], c[9]}), dot(w, Point<T, 3>{c[4], c[7], c[10]}),
            dot(w, Point<T, 3>{c[5], c[8], c[11]})};
  }
  template <class T>
  static HWY_INLINE Point<T, 3> pull(Point<T, 3>, Constants<T> c, Point<T, 3> g) {
    return {dot(g, Point<T, 3>{c[3], c[4], c[5]}), dot(g, Point<T, 3>{c[6], c[7], c[8]}),
            dot(g, Point<T, 3>{c[9], c[10], c[11]})};
  }
};

/// p -> |p| along one axis: the half at positive coordinates is copied to the other side.
struct Mirror {
  static constexpr int kStretch = 1;  ///< Lipschitz constant of the map
  static std::size_t axis(Numbers p) { return static_cast<std::size_t>(p[0]); }
  /// A box that holds every point whose image lies in `image`.
  static Bounds preimage(Bounds image, Numbers p) {
    const double most = image.hi[axis(p)];
    image.lo[axis(p)] = most < 0 ? Bounds::kInfinity : -most;
    image.hi[axis(p)] = most < 0 ? -Bounds::kInfinity : most;
    return image;
  }
  static JoinedFacts facts(const Facts& a, Numbers p) {
    const bool crosses = !(a.bounds.lo[axis(p)] >= 0);
    const bool touches = !(a.bounds.lo[axis(p)] > 0);
    return {.outside = crosses ? weaker(Exactness::lower_bound, a.outside) : a.outside,
            .inside = touches ? weaker(Exactness::lower_bound, a.inside) : a.inside,
            .is_unsigned = a.is_unsigned};
  }
  /// One weight per axis: 1 on the mirrored one.
  static void derive_weights(Numbers p, std::size_t dimension, Constants64& c) {
    c.assign(dimension, 0.0);
    c[axis(p)] = 1;
  }
  template <class T>
  static HWY_INLINE T fold(T x, T mirrored) {
    return select(zero<T>() < mirrored, abs(x), x);
  }
  template <class T>
  static HWY_INLINE T unfold_gradient(T x, T mirrored, T g) {
    return select(zero<T>() < mirrored, g * sign_of(x), g);
  }
};

consteval OpParameter mirror_axis(std::string_view choices) {
  return {.name = "axis", .quantity = Quantity::choice, .meaning = "the axis that changes sign", .choices = choices};
}

THALWEG_OP : Mirror {
  static constexpr Declaration kDeclaration{.name = "mirror",
                                            .kind = OpKind::warp,
                                            .dimension = 2,
                                            .exactness = "keeps its operand's where that lies at positive coordinates",
                                            .rounding = 0};
  static constexpr OpParameter kParameters[] = {mirror_axis("x|y")};
  static void derive(Numbers p, Constants64 & c) { derive_weights(p, 2, c); }
  template <class T>
  static HWY_INLINE Point<T, 2> map(Point<T, 2> p, Constants<T> c) {
    return {fold(p.x, c[0]), fold(p.y, c[1])};
  }
  template <class T>
  static HWY_INLINE Point<T, 2> pull(Point<T, 2> p, Constants<T> c, Point<T, 2> g) {
    return {unfold_gradient(p.x, c[0], g.x), unfold_gradient(p.y, c[1], g.y)};
  }
};
THALWEG_OP : Mirror {
  static constexpr Declaration kDeclaration{.name = "mirror",
                                            .kind = OpKind::warp,
                                            .dimension = 3,
                                            .exactness = "keeps its operand's where that lies at positive coordinates",
                                            .rounding = 0};
  static constexpr OpParameter kParameters[] = {mirror_axis("x|y|z")};
  static void derive(Numbers p, Constants64 & c) { derive_weights(p, 3, c); }
  template <class T>
  static HWY_INLINE Point<T, 3> map(Point<T, 3> p, Constants<T> c) {
    return {fold(p.x, c[0]), fold(p.y, c[1]), fold(p.z, c[2])};
  }
  template <class T>
  static HWY_INLINE Point<T, 3> pull(Point<T, 3> p, Constants<T> c, Point<T, 3> g) {
    return {unfold_gradient(p.x, c[0], g.x), unfold_gradient(p.y, c[1], g.y), unfold_gradient(p.z, c[2], g.z)};
  }
};
