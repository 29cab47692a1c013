// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/pairs/problem.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "gradient/strategies.h"

namespace thalweg {
namespace {

std::size_t width_of(int dimension) { return dimension == 2 ? 3 : 7; }

void set_rotation(const double* q, double square, double* m) {
  const double s = 2 / square;
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  m[0] = 1 - s * (y * y + z * z);
  m[1] = s * (x * y - w * z);
  m[2] = s * (x * z + w * y);
  m[3] = s * (x * y + w * z);
  m[4] = 1 - s * (x * x + z * z);
  m[5] = s * (y * z - w * x);
  m[6] = s * (x * z - w * y);
  m[7] = s * (y * z + w * x);
  m[8] = 1 - s * (x * x + y * y);
}

void set_region(PairProblem& p) {
  const Bounds a = p.a->facts.bounds;
  const bool none = a.empty(p.dimension) || p.b->facts.bounds.empty(p.dimension);
  const Bounds b = none ? a : p.pose.to_a(p.b->facts.bounds, p.dimension);
  const auto is_exact = [](const Tape& t) { return t.facts.outside == Exactness::exact; };
  p.outside = is_exact(*p.a) && is_exact(*p.b) ? p.limits.tolerance : 0;
  for (int axis = 0; axis < p.dimension; ++axis) {
    p.lo[axis] = std::max(a.lo[axis], b.lo[axis]) - p.outside;
    p.hi[axis] = std::min(a.hi[axis], b.hi[axis]) + p.outside;
    // The placed box is rounded.
    const double size = std::max({std::fabs(p.lo[axis]), std::fabs(p.hi[axis]), std::fabs(p.pose.translation[axis])});
    p.lo[axis] -= 1e-12 * size;
    p.hi[axis] += 1e-12 * size;
    if (none) p.lo[axis] = p.hi[axis] + 1;
  }
}

Error refused(std::string_view place, std::string_view expected, std::string found) {
  return {.file = "", .place = std::string(place), .expected = std::string(expected), .found = std::move(found)};
}

bool is_finite(const Tape& tape) {
  return tape.facts.bounds.finite(tape.dimension) || tape.facts.bounds.empty(tape.dimension);
}

}  // namespace

double pair_size(const Tape& a, const Tape& b) {
  const auto diagonal = [](const Tape& t) {
    const bool usable = t.facts.bounds.finite(t.dimension);
    return usable ? t.facts.bounds.diagonal(t.dimension) : Bounds::kInfinity;
  };
  const double least = std::min(diagonal(a), diagonal(b));
  return std::isfinite(least) && least > 0 ? least : 1;
}

void Pose64::to_b(const double* point, double* in_b, int dimension) const {
  double from[3] = {};
  for (int axis = 0; axis < dimension; ++axis) from[axis] = point[axis] - translation[axis];
  for (int column = 0; column < dimension; ++column) {
    in_b[column] = 0;
    for (int row = 0; row < dimension; ++row) in_b[column] += rotation[3 * row + column] * from[row];
  }
}

void Pose64::turn_to_a(const double* direction, double* in_a, int dimension) const {
  for (int row = 0; row < dimension; ++row) {
    in_a[row] = 0;
    for (int column = 0; column < dimension; ++column) in_a[row] += rotation[3 * row + column] * direction[column];
  }
}

Bounds Pose64::to_a(const Bounds& box, int dimension) const {
  Bounds result;
  for (int row = 0; row < dimension; ++row) {
    double lo = translation[row];
    double hi = lo;
    for (int column = 0; column < dimension; ++column) {
      const double factor = rotation[3 * row + column];
      if (factor == 0) continue;
      lo += factor * (factor > 0 ? box.lo[column] : box.hi[column]);
      hi += factor * (factor > 0 ? box.hi[column] : box.lo[column]);
    }
    result.lo[row] = lo;
    result.hi[row] = hi;
  }
  return result;
}

bool read_pose(const PairQueries& queries, std::size_t row, int dimension, Pose64& pose) {
  const float* at = queries.poses + row * width_of(dimension);
  for (std::size_t i = 0; i < width_of(dimension); ++i) {
    if (!(std::fabs(at[i]) <= kLargestCoordinate)) return false;
  }
  pose = {};
  for (int axis = 0; axis < dimension; ++axis) pose.translation[axis] = static_cast<double>(at[axis]);
  if (dimension == 2) {
    const auto angle = static_cast<double>(at[2]);
    pose.rotation[0] = pose.rotation[4] = std::cos(angle);
    pose.rotation[3] = std::sin(angle);
    pose.rotation[1] = -pose.rotation[3];
    return true;
  }
  double q[4] = {};
  double square = 0;
  for (int i = 0; i < 4; ++i) {
    q[i] = static_cast<double>(at[3 + i]);
    square += q[i] * q[i];
  }
  if (square == 0) return false;
  set_rotation(q, square, pose.rotation);
  return true;
}

PairShapes shapes_of(const PairQueries& queries, std::size_t row) {
  if (queries.pairs == nullptr) return {};
  return {queries.pairs[2 * row], queries.pairs[2 * row + 1]};
}

bool PairProblem::empty() const {
  for (int axis = 0; axis < dimension; ++axis) {
    if (!(lo[axis] <= hi[axis])) return true;
  }
  return false;
}

double PairProblem::slack(double largest) const {
  double offset = 0;
  for (int axis = 0; axis < dimension; ++axis) offset = std::max(offset, std::fabs(pose.translation[axis]));
  // A turned point's coordinates are at most its distance from the origin.
  const double in_b = std::sqrt(static_cast<double>(dimension)) * (largest + offset);
  // Six roundings a coordinate take a float32 point to B's frame, with a matrix that is itself rounded.
  const double turned = 24 * 0x1p-24 * b->facts.lipschitz * in_b;
  return std::max(a->search_slack(largest), b->search_slack(in_b) + turned);
}

PairLimits limits_of(const Tape& a, const Tape& b, const PairOptions& options) {
  const double diagonal = pair_size(a, b);
  PairLimits limits;
  limits.goal = options.goal;
  limits.method = options.method;
  limits.budget = options.budget;
  limits.tolerance = options.tolerance > 0 ? options.tolerance : 1e-4 * diagonal;
  limits.size = diagonal;
  limits.region = options.region > 0 ? options.region : diagonal / 32;
  const bool midsurface = options.method == Method::midsurface;
  limits.starts = options.starts != 0 ? options.starts : options.method == Method::certified ? 1 : midsurface ? 40 : 8;
  limits.iterations = options.iterations != 0               ? options.iterations
                      : options.method == Method::certified ? 1
                      : midsurface                          ? 10
                                                            : 64;
  return limits;
}

bool prepare(const PairQueries& queries, const PairOptions& options, std::size_t row, PairProblem& problem) {
  const PairShapes shapes = shapes_of(queries, row);
  problem.a = queries.shapes[shapes.first];
  problem.b = queries.shapes[shapes.second];
  problem.dimension = problem.a->dimension;
  if (!read_pose(queries, row, problem.dimension, problem.pose)) return false;
  problem.limits = limits_of(*problem.a, *problem.b, options);
  set_region(problem);
  return true;
}

Bounds zone_of(const PairProblem& problem, std::size_t side) {
  Bounds zone;
  for (int axis = 0; axis < problem.dimension; ++axis) {
    std::tie(zone.lo[axis], zone.hi[axis]) = std::minmax(problem.lo[axis], problem.hi[axis]);
  }
  if (side == 0) return zone;
  double middle[3] = {}, in_b[3] = {};
  for (int axis = 0; axis < problem.dimension; ++axis) middle[axis] = (zone.lo[axis] + zone.hi[axis]) / 2;
  problem.pose.to_b(middle, in_b, problem.dimension);
  Bounds turned;
  for (int axis = 0; axis < problem.dimension; ++axis) {
    double half = 0;
    for (int row = 0; row < problem.dimension; ++row) {
      half += std::fabs(problem.pose.rotation[3 * row + axis]) * (zone.hi[row] - zone.lo[row]) / 2;
    }
    turned.lo[axis] = in_b[axis] - half;
    turned.hi[axis] = in_b[axis] + half;
  }
  return turned;
}

PairTwins twins_of(const PairTile& tile, std::size_t row, PairScratch& scratch) {
  const PairShapes shapes = shapes_of(*tile.queries, row);
  return {{{scratch.twin(*tile.queries, shapes.first), scratch.near[0], tile.near[0]},
           {scratch.twin(*tile.queries, shapes.second), scratch.near[1], tile.near[1]}}};
}

double evaluate_pair(const PairProblem& problem, PairTwins& twins, const double* point) {
  double in_b[3] = {};
  problem.pose.to_b(point, in_b, problem.dimension);
  return std::max(twins[0].value(point), twins[1].value(in_b));
}

Result<bool> check_pairs(const PairQueries& queries, const PairOptions& options) {
  const bool known =
      options.method == Method::certified || options.method == Method::thesis || options.method == Method::midsurface;
  if (!known) {
    return refused("--method", "a method for pairs of shapes: certified, thesis, midsurface",
                   std::string(name(options.method)));
  }
  if (!std::isfinite(options.tolerance) || options.tolerance < 0) {
    return refused("--tolerance", "a length of at least 0 (0: the default)", "another number");
  }
  if (!std::isfinite(options.region) || options.region < 0) {
    return refused("--region", "a length of at least 0 (0: the default)", "another number");
  }
  if (options.budget == 0) return refused("--budget", "at least 1 evaluation", "0");
  for (std::size_t i = 0; i < queries.shape_count; ++i) {
    if (queries.shapes[i]->has_formulas) return refused("shapes", "shapes with a Lipschitz constant", "a formula");
  }
  if (queries.shape_count < 2 && queries.pairs == nullptr) return refused("shapes", "two shapes", "fewer");
  for (std::size_t row = 0; row < queries.count; ++row) {
    const PairShapes shapes = shapes_of(queries, row);
    if (std::max(shapes.first, shapes.second) >= queries.shape_count) {
      return refused("pairs", "indices below the number of shapes", "another one in row " + std::to_string(row));
    }
    const Tape& a = *queries.shapes[shapes.first];
    const Tape& b = *queries.shapes[shapes.second];
    if (a.dimension != b.dimension) {
      return refused("--with", std::to_string(a.dimension) + "D like the first shape",
                     std::to_string(b.dimension) + "D");
    }
    for (const Tape* tape : {&a, &b}) {
      if (auto error = refusal(*tape, strategy_of(options), options.gradient_offset)) return *std::move(error);
    }
    if (!is_finite(a) && !is_finite(b)) {
      return refused("--with", "a bounded shape on one side at least", "two unbounded shapes");
    }
    if (queries.pairs == nullptr) break;
  }
  return true;
}

}  // namespace thalweg
