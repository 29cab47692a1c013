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

/// What method_table() (thalweg/method_table.h) describes, one row each.
enum class Method : std::uint8_t {
  certified,
  accelerated,
  thesis,
  thesis_fixed,
  thesis_scaled,
  projected,
  frank_wolfe,
  frank_wolfe_search,
  golden_section,
  distance_step,
  published,
  midsurface,
};

/// Where local methods over triangles start. `sequence` is centroid, corners, mid-edges, then Halton points.
enum class Start : std::uint8_t { own, centroid, vertices, mid_edges, best_of_4, halton, sequence };

/// Why a query's search ended; of several starts that of the reported point.
enum class Stop : std::uint8_t {
  none = 0,        ///< a bad row
  goal = 1,        ///< what the goal asks for is proven
  budget = 2,      ///< the evaluations allowed are spent, or double precision can tell no more
  iterations = 3,  ///< the iterations allowed are spent
  small_step = 4,  ///< a step moved the barycentric coordinates by less than the stop rule says
  stationary = 5,  ///< no direction leads down: the gradient vanishes, or the model of f has no lower point
  witness = 6,     ///< f < 0 is proven, and that was enough
  excluded = 7,    ///< f(p) - L |x - p| at the points seen leaves no place for a lower one
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
[[nodiscard]] std::string_view name(Start start);
[[nodiscard]] std::string_view name(Stop stop);
[[nodiscard]] std::string_view name(Goal goal);
[[nodiscard]] std::string_view name(Gradient gradient);
[[nodiscard]] Result<Method> parse_method(std::string_view text);
[[nodiscard]] Result<Start> parse_start(std::string_view text);
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
  Start start = Start::own;      ///< of the local methods over triangles
  std::uint32_t starts = 0;      ///< 0: the policy's or the method's own; with Start::own more give `sequence`
  std::uint32_t iterations = 0;  ///< 0: the method's own
  double step = 0;               ///< alpha of the thesis' variants and of `distance_step`; 0: the method's own
  double floor = -1;             ///< mu, least |f| in a step's length, scene units; negative: the method's own
  double stop = -1;              ///< least move in barycentric coordinates; 0: none; negative: the method's own
  bool stop_at_witness = false;  ///< local methods end where f < 0 is proven
  double tolerance = 0;          ///< scene units; 0: 1e-4 of the bounds' diagonal, or 1e-4
  std::uint32_t budget = 4096;   ///< evaluations per query
  std::uint32_t contacts = 0;    ///< triangles: at most so many contacts each; see ContactColumns
  double margin = 0;             ///< contacts are local minima of f of at most this, scene units
  double feature = 0;            ///< contacts closer than this are one, scene units; 0: 1/64 of the bounds' diagonal
};

/// Contacts of triangles: the local minima of f over each, deepest first. Columns have room for K = options.contacts a
/// row; entries beyond a row's `kept` are left as they are. The evaluations that they took are in the row's.
struct ContactColumns {
  std::uint32_t* found = nullptr;  ///< (N): how many there were before the cut to K
  std::uint32_t* kept = nullptr;   ///< (N): how many follow, at most K
  float* value = nullptr;          ///< (N,K): f at the point
  float* point = nullptr;          ///< (N,K,d)
  float* normal = nullptr;         ///< (N,K,d): unit, out of the shape
  float* barycentric = nullptr;    ///< (N,K,3)
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
  float* one_sided = nullptr;    ///< (N,2,d): unit gradients on two sides of a kink; elsewhere twice grad f; 0 for none
  std::uint8_t* stop = nullptr;  ///< a Stop
  ContactColumns contacts = {};  ///< used when options.contacts is not 0
};

}  // namespace thalweg
