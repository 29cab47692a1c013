// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What a collision query asks and what it answers. Inputs and results are columns that the caller owns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "thalweg/result.h"

namespace thalweg {

enum class Status : std::uint8_t {
  separated = 0,    ///< min f > 0 over the query is proven
  overlapping = 1,  ///< f(point) < 0 is proven
  touching = 2,     ///< neither is, and min f lies, proven, in [-tolerance, tolerance]
  undecided = 3,    ///< anything else
  bad_row = 255,    ///< a coordinate is not finite, or beyond 1e15 in size
};

enum class Method : std::uint8_t {
  certified,   ///< branch and bound with proven bounds
  thesis,      ///< triangles: projected descent as published by Luneau (2025), section 3.2
  projected,   ///< triangles: barycentric projected descent, Macklin et al. (2020); also `descent`
  midsurface,  ///< pairs of shapes: MuJoCo's objective from many Halton starts
  published,   ///< circles: f(centre) < radius, Luneau (2025), section 3.1
};
enum class Goal : std::uint8_t { verdict, deepest };

/// How a gradient is had; see core/docs/gradients.md. The dichotomies exist in 2D only.
enum class Gradient : std::uint8_t {
  autodiff,
  central,
  forward,
  simplex,
  dichotomy,
  dichotomy_verbatim,
  closest_point
};

/// How far from the point the strategies that take differences probe f: o is the greatest of the three. The default is
/// the rule of Luneau (2025), section 2.3, which was made for scenes in pixels. Nothing keeps o above the spacing of
/// float32 numbers: where P + o is P the difference, and with it the gradient, is zero.
struct ProbeOffset {
  double absolute = 0.005;       ///< scene units; `dichotomy:verbatim` takes this part alone
  double of_value = 0.005 / 20;  ///< times |f|
  double of_scene = 0;           ///< times the diagonal of the scene's bounds, which must be finite
};

[[nodiscard]] std::string_view name(Status status);
[[nodiscard]] std::string_view name(Method method);
[[nodiscard]] std::string_view name(Goal goal);
[[nodiscard]] std::string_view name(Gradient gradient);
[[nodiscard]] Result<Method> parse_method(std::string_view text);
[[nodiscard]] Result<Goal> parse_goal(std::string_view text);
[[nodiscard]] Result<Gradient> parse_gradient(std::string_view text);
/// `0.005`, `f:0.00025`, `scene:1e-6`, or several of them with commas between; what is not named is 0.
[[nodiscard]] Result<ProbeOffset> parse_probe_offset(std::string_view text);
[[nodiscard]] std::string to_string(const ProbeOffset& offset);

struct GradientOptions {
  Gradient strategy = Gradient::autodiff;
  ProbeOffset offset = {};
};

/// Columns of a batch of points, N rows each; a null column is not computed. Vectors are (N,d) in C order.
struct PointColumns {
  float* value = nullptr;     ///< f
  float* gradient = nullptr;  ///< of length 1 or, where differences vanish, 0; `autodiff` leaves the length of grad f
  float* witness = nullptr;   ///< `closest_point`: a point of the surface, the nearest found
  std::uint32_t* evaluations = nullptr;  ///< of f, the one for `value` among them; ties are not counted
  std::uint8_t* ambiguous = nullptr;     ///< 1 within rounding of a kink of f, or where its gradient vanishes
  float* one_sided = nullptr;  ///< (N,2,d): unit gradients on two sides of a kink; elsewhere twice grad f; 0 for none
};

struct CollideOptions {
  Method method = Method::certified;
  Goal goal = Goal::verdict;
  Gradient gradient = Gradient::autodiff;  ///< of the steps of local methods, and of the normals
  bool gradient_given = false;  ///< false: each method its own (`thesis`: dichotomy_verbatim), normals autodiff
  ProbeOffset gradient_offset = {};
  std::uint32_t starts = 0;      ///< 0: the method's own
  std::uint32_t iterations = 0;  ///< 0: the method's own
  double tolerance = 0;          ///< scene units; 0: 1e-4 of the bounds' diagonal, or 1e-4
  std::uint32_t budget = 4096;   ///< evaluations per query
};

/// Triangles or circles (2D) / spheres (3D), as rows in C order.
struct Queries {
  const float* rows = nullptr;  ///< triangles (N,3,d); circles (N,d+1): centre, then radius
  std::size_t count = 0;
};

/// Result columns, N rows each; a null column is not computed. Points and normals are (N,d) in C order.
struct CollideColumns {
  std::uint8_t* status = nullptr;
  float* value = nullptr;  ///< f at `point`
  float* lower = nullptr;  ///< proven lower bound of f over the query; -inf where none is
  std::uint8_t* converged = nullptr;
  float* point = nullptr;
  float* normal = nullptr;          ///< unit, out of the shape
  float* barycentric = nullptr;     ///< (N,3), triangles only
  std::uint8_t* claimed = nullptr;  ///< a local method's opinion: 1 when its value is negative
  std::uint32_t* starts = nullptr;
  std::uint32_t* iterations = nullptr;
  std::uint32_t* evaluations = nullptr;
  /// The gradient is not unique at `point`: it vanishes there, and the normal is a fixed unit vector, or f has a kink
  /// within rounding. Kinks are not looked for in rows proven separated under Goal::verdict.
  std::uint8_t* ambiguous = nullptr;
  float* one_sided = nullptr;  ///< (N,2,d): unit gradients on two sides of a kink; elsewhere twice grad f; 0 for none
};

}  // namespace thalweg
