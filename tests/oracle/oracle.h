// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A second opinion in double precision. It shares no code with core/src: textbook formulas (angles by atan2, polygons
// by their edges), a recursive walk of the tree, its own cells (a triangle is halved across its longest edge, a disc
// is covered by boxes) and its own bounds. What core proves is held against what this finds.
//
// Bounds used here: every op of the language keeps the Lipschitz constant 1, so |f(x) - f(c)| <= |x - c|. Over a cell
// that the placements map to vertices v_i around the sample c, a convex primitive also obeys, without any gradient,
//   2 f(c) - max f(2c - v_i) <= f(x) <= max f(v_i),
// one without an inside is at least 0, and the operators are monotone, so they act on the ends of the operands'
// intervals.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "thalweg/shape.h"

namespace thalweg::oracle {

struct Vec {
  double x = 0, y = 0, z = 0;
  friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};
[[nodiscard]] double dot(Vec a, Vec b);
[[nodiscard]] double length(Vec a);
[[nodiscard]] double distance(Vec a, Vec b);

struct Interval {
  double lower = 0, upper = 0;
};

/// The field of a shape, flattened once for a fast walk. z is ignored in 2D.
class Field {
 public:
  /// Throws std::invalid_argument for an op that the oracle does not know.
  explicit Field(const Shape& shape);

  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] double operator()(Vec p) const { return evaluate(nodes_.size() - 1, p); }

  /// Encloses f over the convex hull of `corners`, of which `centre` is the mean; at most eight corners.
  [[nodiscard]] Interval enclose(Vec centre, const Vec* corners, std::size_t count) const;

  /// Rounding of one evaluation at coordinates of size `magnitude`, generously.
  [[nodiscard]] double margin(double magnitude) const { return 1e-13 * (magnitude + size_); }

  using Primitive = double (*)(const double* numbers, std::size_t count, Vec p);
  enum class Kind {
    primitive,
    unite,
    intersect,
    subtract,
    smooth_unite,
    smooth_intersect,
    smooth_subtract,
    round,
    onion,
    rigid,
    scale,
    mirror
  };

 private:
  struct Node {
    Kind kind = Kind::primitive;
    Primitive primitive = nullptr;
    bool convex = false;
    bool never_negative = false;
    std::vector<double> numbers;
    std::vector<std::size_t> operands;
    std::array<double, 9> turn = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // world to local, row-major
    Vec origin;                                                // local origin in the operand's world
  };
  struct Cell {
    Vec centre;
    std::array<Vec, 8> corners;
    std::size_t count = 0;
  };
  struct Builder;

  [[nodiscard]] double evaluate(std::size_t index, Vec p) const;
  [[nodiscard]] double combine(const Node& node, const double* values) const;
  [[nodiscard]] Interval enclose(std::size_t index, const Cell& cell) const;
  [[nodiscard]] Interval enclose_primitive(const Node& node, const Cell& cell) const;
  [[nodiscard]] Interval enclose_operands(const Node& node, const Cell& cell) const;
  [[nodiscard]] static Vec into(const Node& node, Vec p);

  std::vector<Node> nodes_;  // operands before users; the root is last
  int dimension_ = 2;
  double size_ = 0;
};

/// When a search may stop before its cells are used up.
struct Limits {
  bool verdict_only = false;  ///< stop as soon as the sign of the minimum is known
  double width = 0;           ///< stop when upper - lower is at most this
  std::size_t cap = 20000;    ///< evaluations
};

/// lower <= min f <= upper = f(witness), up to rounding.
struct Bracket {
  double lower = 0, upper = 0;
  Vec witness;
  bool decided = false;  ///< the sign is known, or the width was reached
  std::size_t evaluations = 0;
};

enum class Verdict { separated, overlapping, cannot_tell };

[[nodiscard]] Bracket minimum_over_triangle(const Field& field, const std::array<Vec, 3>& triangle,
                                            const Limits& limits);
/// The disc (2D) or ball (3D).
[[nodiscard]] Bracket minimum_over_ball(const Field& field, Vec centre, double radius, const Limits& limits);

/// What a bracket says, with the oracle's own rounding kept on the safe side.
[[nodiscard]] Verdict verdict(const Field& field, const Bracket& bracket, double magnitude);
[[nodiscard]] std::string_view name(Verdict verdict);

/// Brackets the distance from `point` to {f = 0} by subdividing space around it down to cells of `resolution`; uses
/// values of f alone. upper is infinite when no surface was found within `reach`.
[[nodiscard]] Interval brute_force_distance(const Shape& shape, Vec point, double reach, double resolution);
[[nodiscard]] Interval brute_force_distance(const Field& field, Vec point, double reach, double resolution);

}  // namespace thalweg::oracle
