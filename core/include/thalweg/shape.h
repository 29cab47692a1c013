// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A Shape is an immutable node of a DAG: an op of the table, its parameters and its operands, with the facts that
// follow from them. Handles are cheap to copy and safe to share between threads. thalweg/ops.h names every op as a
// function, so that a scene reads like the mathematics:
//
//   Shape scene = smooth_union(1.0, {star(300, 12, 4).translate({1000, 550}), circle(200).translate({750, 400})});
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "thalweg/result.h"

namespace thalweg {

namespace formula {
struct Formula;
}

struct Vec2 {
  double x = 0, y = 0;
};
struct Vec3 {
  double x = 0, y = 0, z = 0;

  // All three or none: {1, 2} is a Vec2 wherever both are accepted.
  constexpr Vec3() = default;
  constexpr Vec3(double along_x, double along_y, double along_z) : x(along_x), y(along_y), z(along_z) {}
};

/// What |f| says about the distance to the surface, on one side of it.
enum class Exactness : std::uint8_t {
  exact,        ///< |f| is the distance
  lower_bound,  ///< |f| <= distance, the sign is right
  sign_only,    ///< only the sign is right
};
[[nodiscard]] std::string_view name(Exactness exactness);

/// Axis-aligned box in scene units; an unbounded side is infinite, an empty box has lo > hi. 2D boxes use x and y.
struct Bounds {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double lo[3] = {-kInfinity, -kInfinity, -kInfinity};
  double hi[3] = {kInfinity, kInfinity, kInfinity};

  [[nodiscard]] bool empty(int dimension) const;
  [[nodiscard]] bool finite(int dimension) const;
  [[nodiscard]] double diagonal(int dimension) const;  ///< length of the diagonal; infinite when a side is
};

/// What the compiler proves of a node's field; every label is backed by a test against brute force.
struct Facts {
  int dimension = 2;  ///< 2 or 3
  Exactness outside = Exactness::exact;
  Exactness inside = Exactness::exact;
  double lipschitz = 1.0;    ///< proven global Lipschitz constant of f; infinite where there is none
  bool convex = false;       ///< f is a convex function
  bool is_unsigned = false;  ///< f is never negative (a segment): nothing can be proven inside
  Bounds bounds;             ///< holds {f <= 0}
};

class Shape {
 public:
  /// Makes a node from an op's name, its flattened parameters and its operands, or says why it cannot be.
  /// `parameters` holds the numbers in the order of the op table (`thalweg ops`); the error's place is the
  /// parameter's name. An op that exists in 2D and 3D (box) takes the dimension from `dimension`; of several rows
  /// with one name and dimension (rotate by axis and angle, or by quaternion), `variant` counts.
  static Result<Shape> make(std::string_view op, int dimension, std::span<const double> parameters,
                            std::vector<Shape> of = {}, int variant = 0);

  /// The same by row of the op table.
  static Result<Shape> make(int op_index, std::span<const double> parameters, std::vector<Shape> of = {});

  /// A leaf whose field is a formula: `op` is "expression" or "vm". Dimension 0: 3 if the formula depends on z, else 2.
  /// The error's place is line:column of the text.
  static Result<Shape> formula(std::string_view op, int dimension, std::string_view text);

  /// Nodes may be nested this deep.
  static constexpr int kDeepest = 5000;

  [[nodiscard]] const Facts& facts() const;
  [[nodiscard]] int dimension() const { return facts().dimension; }
  [[nodiscard]] std::string_view op() const;  ///< the op's name
  [[nodiscard]] int op_index() const;         ///< its row in the op table
  [[nodiscard]] std::span<const double> parameters() const;
  [[nodiscard]] std::span<const Shape> operands() const;
  [[nodiscard]] std::string_view text() const;            ///< of a formula, else empty
  [[nodiscard]] const formula::Formula* formula() const;  ///< of a formula, else null
  [[nodiscard]] const void* identity() const;             ///< equal for handles to the same node

  /// A box that holds {f <= level}; Facts::bounds is the one at level 0.
  [[nodiscard]] Bounds level_bounds(double level) const;

  /// The node as a scene file's text (JSON), readable back by parse_scene.
  [[nodiscard]] std::string to_json() const;

  // Placement. Angles are in radians, counter-clockwise positive.
  [[nodiscard]] Shape translate(Vec2 by) const;
  [[nodiscard]] Shape translate(Vec3 by) const;
  [[nodiscard]] Shape rotate(double angle) const;
  [[nodiscard]] Shape rotate(Vec3 axis, double angle) const;
  [[nodiscard]] Shape scale(double factor) const;

 private:
  struct Node;
  explicit Shape(std::shared_ptr<const Node> node) : node_(std::move(node)) {}
  std::shared_ptr<const Node> node_;
};

[[nodiscard]] Shape operator|(const Shape& a, const Shape& b);  ///< union
[[nodiscard]] Shape operator&(const Shape& a, const Shape& b);  ///< intersection
[[nodiscard]] Shape operator-(const Shape& a, const Shape& b);  ///< subtraction

/// Number of distinct nodes of the DAG below and including `shape`.
[[nodiscard]] std::size_t node_count(const Shape& shape);

}  // namespace thalweg
