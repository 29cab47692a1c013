// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Best first, by lower bound. A cell is given by exact dyadic numbers, so children tile their parent; its corners and
// centre are rounded to double and the slack covers that. The reported point is a float32 one, and what is said of it
// is evaluated at it.
#include "solve/decide.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solve/record.h"

namespace thalweg {
namespace {

using HeapCell = TileScratch::HeapCell;

/// A visit evaluates the enclosure, its centre's float32 rounding, and a probe's gradient, value and rounding; with
/// formulas also the ranges at the two points and their roundings.
constexpr std::uint32_t kMostPerVisit = 5;
constexpr std::uint32_t kMostPerVisitByRanges = 9;
/// Open cells held at once: 64 MB at the most, whatever the budget.
constexpr std::size_t kMostCells = std::size_t{1} << 20;

struct Decision {
  double value = 0;      ///< f at `point`
  double lower = 0;      ///< proven lower bound of f over the region
  float point[3] = {};   ///< the deepest point found, as reported
  double u = 0, v = 0;   ///< its barycentric coordinates of the second and third corner
  double error = 0;      ///< f there is at most value + error, proven
  bool witness = false;  ///< f < 0 is proven at `point` and at the point of the region that it was rounded from
  bool closed = false;   ///< the goal was reached
  std::uint32_t evaluations = 0;
};

float rounded_down(double x) {
  const auto nearest = static_cast<float>(x);
  return static_cast<double>(nearest) > x ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}

bool higher(const HeapCell& a, const HeapCell& b) { return a.lo > b.lo; }

class Search {
 public:
  Search(const Region64& region, const SolveLimits& limits, TileScratch& scratch)
      : region_(region),
        limits_(limits),
        twin_(scratch.twin),
        heap_(scratch.heap),
        by_ranges_(scratch.twin.tape().has_formulas) {
    heap_.clear();
    const auto d = static_cast<std::size_t>(region.dimension);
    double largest = 0;
    for (std::size_t corner = 0; corner < (region.is_ball ? 1U : 3U); ++corner) {
      for (std::size_t axis = 0; axis < d; ++axis) largest = std::max(largest, std::fabs(region.corner[corner][axis]));
    }
    slack_ = limits.slack64(largest + region.radius);
    place_ = by_ranges_ ? kPlaceRounding * Twin::kSlackRatio * (largest + region.radius) : 0;
  }

  /// Keeps every cell that the search ends with, and its bound.
  void keep_cells(std::vector<HeapCell>& kept) { kept_ = &kept; }

  Decision run(const Decision& start, std::uint32_t evaluations) {
    best_ = start;
    best_.evaluations = 0;
    best_.lower = std::numeric_limits<double>::infinity();
    most_evaluations_ = evaluations;
    best_.witness = false;
    best_.value = value_at(start.point);
    best_.error = error_at(start.point, best_.value);
    if (!region_.is_ball) {
      double exact[3] = {};
      locate(start.u, start.v, exact);
      ++best_.evaluations;
      consider(exact, twin_.value(exact), start.u, start.v);
    }
    visit(region_.is_ball ? HeapCell{.lo = 0, .at = {0, 0, 0, 1}} : HeapCell{.lo = 0, .at = {0, 0, 1, 0, 0, 1}});
    const std::uint32_t children = region_.is_ball ? 1U << region_.dimension : 2U;
    while (!heap_.empty() && !satisfied() && best_.evaluations + children * most_per_visit() <= most_evaluations_ &&
           heap_.size() < kMostCells && !settled()) {
      std::pop_heap(heap_.begin(), heap_.end(), higher);
      const HeapCell parent = heap_.back();
      heap_.pop_back();
      region_.is_ball ? split_box(parent) : split_triangle(parent);
    }
    best_.closed = (heap_.empty() && !gave_up_) || satisfied();
    if (!heap_.empty()) best_.lower = std::min(best_.lower, heap_.front().lo);
    best_.lower = std::min(best_.lower, best_.value);
    if (kept_ != nullptr) kept_->insert(kept_->end(), heap_.begin(), heap_.end());
    return best_;
  }

 private:
  [[nodiscard]] std::uint32_t most_per_visit() const { return by_ranges_ ? kMostPerVisitByRanges : kMostPerVisit; }
  [[nodiscard]] bool satisfied() const { return limits_.goal == Goal::verdict && best_.witness; }

  /// Short of a proven sign, the goal is reached, and either double can tell no more or enough has been tried.
  [[nodiscard]] bool settled() const {
    const double lower = std::min(best_.lower, heap_.front().lo);
    const bool reached = limits_.goal == Goal::deepest
                             ? best_.value - lower <= limits_.tolerance
                             : best_.value + best_.error <= limits_.tolerance && lower >= -limits_.tolerance;
    const bool exhausted = heap_.front().lo >= best_.value - 2 * best_.error;
    return reached && (exhausted || best_.evaluations > limits_.budget / kTouchingEffort);
  }

  /// No point of a cell with this bound can change the answer.
  [[nodiscard]] bool is_closed(double lo) const {
    const bool verdict_known = lo > 0 || best_.witness;
    if (limits_.goal == Goal::verdict) return verdict_known;
    return verdict_known && lo >= best_.value - limits_.tolerance;
  }

  double value_at(const float* point) {
    double exact[3] = {};
    std::copy_n(point, region_.dimension, exact);
    ++best_.evaluations;
    return finite(twin_.value(exact));
  }
  /// Where a formula is undefined every other value is better.
  static double finite(double value) { return std::isfinite(value) ? value : std::numeric_limits<double>::infinity(); }

  /// What f may be above `value`, the one computed at a point.
  double error_at(const float* point, double value) {
    double exact[3] = {};
    for (int axis = 0; axis < region_.dimension; ++axis) exact[axis] = static_cast<double>(point[axis]);
    return error_at(exact, value);
  }
  double error_at(const double* point, double value) {
    if (!by_ranges_) return slack_;
    Cell64 cell;
    cell.is_box = true;
    cell.place = place_;
    ++best_.evaluations;
    const double error = twin_.enclose(point, cell).hi + slack_ - value;
    return std::isnan(error) ? std::numeric_limits<double>::infinity() : error * (1 + 0x1p-50);
  }

  /// Makes a point of the region the incumbent if f is lower at its float32 rounding. A witness needs both to be
  /// negative, since the rounded point may lie outside the region; it only gives way to a better witness.
  void consider(const double* exact, double value, double u, double v) {
    float point[3] = {};
    for (int axis = 0; axis < region_.dimension; ++axis) point[axis] = static_cast<float>(exact[axis]);
    const double rounded = value_at(point);
    const bool may_be_witness = value < -slack_ && rounded < -slack_;
    const bool is_candidate = rounded < best_.value || (may_be_witness && !best_.witness);
    if (by_ranges_ && !is_candidate) return;
    const double error = error_at(point, rounded);
    const bool witness = by_ranges_ ? value + error_at(exact, value) < 0 && rounded + error < 0 : may_be_witness;
    if (best_.witness ? !witness || rounded >= best_.value : !witness && rounded >= best_.value) return;
    best_.value = rounded;
    best_.error = error;
    best_.witness = witness;
    std::copy_n(point, region_.dimension, best_.point);
    best_.u = u;
    best_.v = v;
  }

  void visit(HeapCell cell) {
    double centre[3] = {};
    Cell64 shape;
    if (region_.is_ball ? !ball_cell(cell, centre, shape) : !triangle_cell(cell, centre, shape)) return;
    shape.place = place_;
    const Enclosure64 f = twin_.enclose(centre, shape);
    ++best_.evaluations;
    cell.lo = f.lo - slack_;
    if (f.value < best_.value || (f.value < -slack_ && !best_.witness)) {
      const double u = region_.is_ball ? 0 : (cell.at[0] + cell.at[2] + cell.at[4]) / 3;
      const double v = region_.is_ball ? 0 : (cell.at[1] + cell.at[3] + cell.at[5]) / 3;
      consider(centre, f.value, u, v);
      if (!region_.is_ball) probe(cell, centre, shape);
    }
    // Too small to learn more from, in double as well.
    const bool at_the_end = shape.reach <= (by_ranges_ ? place_ : slack_ / 4);
    const bool closed = is_closed(cell.lo);
    if (closed || at_the_end) {
      gave_up_ = gave_up_ || !closed;
      best_.lower = std::min(best_.lower, cell.lo);
      if (kept_ != nullptr) kept_->push_back(cell);
    } else {
      heap_.push_back(cell);
      std::push_heap(heap_.begin(), heap_.end(), higher);
    }
  }

  /// The corner of a triangle furthest against the gradient: a minimum on the rim is met by no centre.
  void probe(const HeapCell& cell, const double* centre, const Cell64& shape) {
    double gradient[3] = {};
    twin_.gradient(centre, gradient);
    ++best_.evaluations;
    const int d = region_.dimension;
    int lowest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 3; ++corner) {
      double height = 0;
      for (int axis = 0; axis < d; ++axis) height += gradient[axis] * shape.edges[corner * d + axis];
      if (height >= least) continue;
      least = height;
      lowest = corner;
    }
    double point[3] = {};
    const double u = cell.at[2 * lowest];
    const double v = cell.at[2 * lowest + 1];
    locate(u, v, point);
    const double value = twin_.value(point);
    ++best_.evaluations;
    consider(point, value, u, v);
  }

  void locate(double u, double v, double* point) const {
    for (int axis = 0; axis < region_.dimension; ++axis) {
      const double a = region_.corner[0][axis];
      point[axis] = a + u * (region_.corner[1][axis] - a) + v * (region_.corner[2][axis] - a);
    }
  }

  bool triangle_cell(const HeapCell& cell, double* centre, Cell64& shape) const {
    const int d = region_.dimension;
    double corner[3][3] = {};
    for (int k = 0; k < 3; ++k) locate(cell.at[2 * k], cell.at[2 * k + 1], corner[k]);
    for (int axis = 0; axis < d; ++axis) centre[axis] = (corner[0][axis] + corner[1][axis] + corner[2][axis]) / 3;
    for (int k = 0; k < 3; ++k) {
      double square = 0;
      for (int axis = 0; axis < d; ++axis) {
        const double edge = corner[k][axis] - centre[axis];
        shape.edges[k * d + axis] = edge;
        square += edge * edge;
      }
      shape.reach = std::max(shape.reach, std::sqrt(square));
    }
    return true;
  }

  /// A box cut with the ball, evaluated at its centre moved into the ball; false where they do not meet.
  bool ball_cell(const HeapCell& cell, double* centre, Cell64& shape) const {
    const double* offsets = cell.at;
    const double size = cell.at[3];
    const double half = size * region_.radius;
    double square = 0;
    for (int axis = 0; axis < region_.dimension; ++axis) square += offsets[axis] * offsets[axis];
    const double distance = std::sqrt(square);
    const double corner = std::sqrt(static_cast<double>(region_.dimension)) * size;
    if (distance - corner > 1 + 1e-9) return false;
    const double inward = distance > 1 ? (1 - 1e-15) / distance : 1;
    shape.is_box = true;
    shape.reach = std::sqrt(static_cast<double>(region_.dimension)) * half;
    for (int axis = 0; axis < region_.dimension; ++axis) {
      const double moved = offsets[axis] * inward * region_.radius;
      centre[axis] = region_.corner[0][axis] + moved;
      shape.edges[axis] = half + std::fabs(offsets[axis] * region_.radius - moved);
    }
    return true;
  }

  /// Halves the longest edge.
  void split_triangle(const HeapCell& p) {
    double corner[3][3] = {};
    for (int k = 0; k < 3; ++k) locate(p.at[2 * k], p.at[2 * k + 1], corner[k]);
    int longest = 0;
    double most = -1;
    for (int k = 0; k < 3; ++k) {
      double square = 0;
      for (int axis = 0; axis < region_.dimension; ++axis) {
        const double x = corner[k][axis] - corner[(k + 1) % 3][axis];
        square += x * x;
      }
      if (square <= most) continue;
      most = square;
      longest = k;
    }
    const int next = (longest + 1) % 3;
    HeapCell halves[2] = {p, p};
    for (int i = 0; i < 2; ++i) {
      const double middle = (p.at[2 * longest + i] + p.at[2 * next + i]) / 2;
      halves[0].at[2 * longest + i] = middle;
      halves[1].at[2 * next + i] = middle;
    }
    for (const HeapCell& half : halves) visit(half);
  }

  void split_box(const HeapCell& p) {
    const double half = p.at[3] / 2;
    for (int child = 0; child < 1 << region_.dimension; ++child) {
      HeapCell cell = p;
      for (int axis = 0; axis < region_.dimension; ++axis) cell.at[axis] += (child >> axis & 1) != 0 ? half : -half;
      cell.at[3] = half;
      visit(cell);
    }
  }

  const Region64& region_;
  const SolveLimits& limits_;
  Twin& twin_;
  std::vector<HeapCell>& heap_;
  std::vector<HeapCell>* kept_ = nullptr;
  Decision best_;
  bool gave_up_ = false;  ///< some cell was too small for double
  double slack_ = 0;
  const bool by_ranges_;  ///< bounds and witnesses are proven by intervals, which carry a formula's rounding
  double place_ = 0;      ///< how far places may be off
  std::uint32_t most_evaluations_ = 0;
};

}  // namespace

bool can_decide(std::uint32_t evaluations, bool by_ranges) {
  return evaluations > (by_ranges ? 6 + kMostPerVisitByRanges : 3 + kMostPerVisit);
}

bool goal_reached(const SolveLimits& limits, const QueryState& state, std::size_t q, float lower) {
  const auto tolerance = static_cast<float>(limits.tolerance);
  if (limits.goal == Goal::deepest) return state.value[q] - lower <= tolerance;
  return state.value[q] + state.slack[q] <= tolerance && lower >= -tolerance;
}

void decide_in_double(const Region64& region, const SolveLimits& limits, QueryState& state, std::size_t q,
                      TileScratch& scratch) {
  Decision start;
  for (int axis = 0; axis < region.dimension; ++axis) start.point[axis] = state.point[axis][q];
  start.u = static_cast<double>(state.barycentric[0][q]);
  start.v = static_cast<double>(state.barycentric[1][q]);
  Search search(region, limits, scratch);
  const Decision found = search.run(start, limits.budget - state.evaluations[q]);
  state.evaluations[q] += found.evaluations;
  state.iterations[q] += 1;
  const bool had_witness = state.witness[q] != 0;
  if (!had_witness || (found.witness && found.value < static_cast<double>(state.value[q]))) {
    for (int axis = 0; axis < region.dimension; ++axis) state.point[axis][q] = found.point[axis];
    state.value[q] = static_cast<float>(found.value);
    state.barycentric[0][q] = static_cast<float>(found.u);
    state.barycentric[1][q] = static_cast<float>(found.v);
    state.witness[q] = found.witness || had_witness ? 1 : 0;
  }
  state.lower[q] = std::max(state.lower[q], rounded_down(found.lower));
  // What is said from here on has double's slack.
  state.slack[q] = static_cast<float>(found.error * 1.001);
  state.converged[q] = found.closed || goal_reached(limits, state, q, state.lower[q]) ? 1 : 0;
}

void record_in_double(const Region64& region, const SolveLimits& limits, std::uint32_t evaluations,
                      TileScratch& scratch, Proof& proof) {
  Decision start;
  std::copy_n(proof.point, region.dimension, start.point);
  start.u = proof.u;
  start.v = proof.v;
  Search search(region, limits, scratch);
  std::vector<HeapCell> kept;
  search.keep_cells(kept);
  const Decision found = search.run(start, evaluations);
  std::copy_n(found.point, region.dimension, proof.point);
  proof.u = found.u;
  proof.v = found.v;
  proof.value = found.value;
  proof.evaluations = found.evaluations;
  proof.lower = std::numeric_limits<double>::infinity();
  for (const HeapCell& cell : kept) {
    ProofCell& made = proof.cells.emplace_back();
    std::copy_n(cell.at, 6, made.at);
    made.bound = cell.lo;
    proof.lower = std::min(proof.lower, cell.lo);
  }
  const bool brackets = found.value + found.error <= limits.tolerance && proof.lower >= -limits.tolerance;
  proof.status = found.witness     ? Status::overlapping
                 : proof.lower > 0 ? Status::separated
                 : brackets        ? Status::touching
                                   : Status::undecided;
}

}  // namespace thalweg
