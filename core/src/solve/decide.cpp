// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Best first, by lower bound. A cell is given by exact dyadic numbers, so children tile their parent; centres are
// rounded to double and the slack covers that. The reported point is a float32 one, and what is said of it is
// evaluated at it.
#include "solve/decide.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg {
namespace {

using HeapCell = TileScratch::HeapCell;

bool higher(const HeapCell& a, const HeapCell& b) { return a.lo > b.lo; }

class Search {
 public:
  Search(const Region64& region, const SolveLimits& limits, TileScratch& scratch)
      : region_(region), limits_(limits), twin_(scratch.twin), heap_(scratch.heap) {
    heap_.clear();
    const auto d = static_cast<std::size_t>(region.dimension);
    double largest = 0;
    for (std::size_t corner = 0; corner < (region.is_ball ? 1U : 3U); ++corner) {
      for (std::size_t axis = 0; axis < d; ++axis) largest = std::max(largest, std::fabs(region.corner[corner][axis]));
    }
    slack_ = limits.slack64(largest + region.radius);
  }

  Decision run(const Decision& start, std::uint32_t evaluations) {
    best_ = start;
    best_.evaluations = 0;
    best_.lower = std::numeric_limits<double>::infinity();
    most_evaluations_ = evaluations;
    best_.witness = false;
    best_.value = value_at(start.point);
    visit({.lo = 0, .u = 0, .v = 0, .w = 0, .size = 1});
    while (!heap_.empty() && !satisfied()) {
      const std::uint32_t children = region_.is_ball ? 1U << region_.dimension : 4U;
      if (best_.evaluations + children > most_evaluations_) break;
      std::pop_heap(heap_.begin(), heap_.end(), higher);
      const HeapCell parent = heap_.back();
      heap_.pop_back();
      region_.is_ball ? split_box(parent) : split_triangle(parent);
    }
    best_.closed = heap_.empty() || satisfied();
    if (!heap_.empty()) best_.lower = std::min(best_.lower, heap_.front().lo);
    best_.lower = std::min(best_.lower, best_.value);
    return best_;
  }

 private:
  [[nodiscard]] bool satisfied() const { return limits_.goal == Goal::verdict && best_.witness; }

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
    return twin_.value(exact);
  }

  /// Makes a centre the incumbent if f is lower at its float32 rounding. A witness needs both to be negative, since
  /// the rounded point may lie outside the region; it only gives way to a better witness.
  void consider(const double* centre, double value, const HeapCell& cell) {
    float point[3] = {};
    for (int axis = 0; axis < region_.dimension; ++axis) point[axis] = static_cast<float>(centre[axis]);
    const double rounded = value_at(point);
    const bool witness = value < -slack_ && rounded < -slack_;
    if (best_.witness ? !witness || rounded >= best_.value : !witness && rounded >= best_.value) return;
    best_.value = rounded;
    best_.witness = witness;
    std::copy_n(point, region_.dimension, best_.point);
    best_.u = cell.u + cell.size / 3;
    best_.v = cell.v + cell.size / 3;
  }

  void visit(HeapCell cell) {
    double centre[3] = {};
    Cell64 shape;
    if (region_.is_ball ? !ball_cell(cell, centre, shape) : !triangle_cell(cell, centre, shape)) return;
    const Enclosure64 f = twin_.enclose(centre, shape);
    ++best_.evaluations;
    cell.lo = f.lo - slack_;
    if (f.value < best_.value || (f.value < -slack_ && !best_.witness)) consider(centre, f.value, cell);
    // Too small to learn more from, in double as well.
    const bool at_the_end = shape.reach <= slack_ / 4;
    if (is_closed(cell.lo) || at_the_end) {
      best_.lower = std::min(best_.lower, cell.lo);
    } else {
      heap_.push_back(cell);
      std::push_heap(heap_.begin(), heap_.end(), higher);
    }
  }

  bool triangle_cell(const HeapCell& cell, double* centre, Cell64& shape) const {
    const int d = region_.dimension;
    const double u = cell.u + cell.size / 3;
    const double v = cell.v + cell.size / 3;
    for (int axis = 0; axis < d; ++axis) {
      const double a = region_.corner[0][axis];
      const double ab = region_.corner[1][axis] - a;
      const double ac = region_.corner[2][axis] - a;
      centre[axis] = a + u * ab + v * ac;
      shape.edges[axis] = -(ab + ac) / 3 * cell.size;
      shape.edges[d + axis] = (2 * ab - ac) / 3 * cell.size;
      shape.edges[2 * d + axis] = (2 * ac - ab) / 3 * cell.size;
    }
    for (int vertex = 0; vertex < 3; ++vertex) {
      double square = 0;
      for (int axis = 0; axis < d; ++axis) square += shape.edges[vertex * d + axis] * shape.edges[vertex * d + axis];
      shape.reach = std::max(shape.reach, std::sqrt(square));
    }
    return true;
  }

  /// A box cut with the ball, evaluated at its centre moved into the ball; false where they do not meet.
  bool ball_cell(const HeapCell& cell, double* centre, Cell64& shape) const {
    const double offsets[3] = {cell.u, cell.v, cell.w};
    const double half = cell.size * region_.radius;
    double square = 0;
    for (int axis = 0; axis < region_.dimension; ++axis) square += offsets[axis] * offsets[axis];
    const double distance = std::sqrt(square);
    const double corner = std::sqrt(static_cast<double>(region_.dimension)) * cell.size;
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

  void split_triangle(const HeapCell& p) {
    const double half = p.size / 2;
    visit({0, p.u, p.v, 0, half});
    visit({0, p.u + half, p.v, 0, half});
    visit({0, p.u, p.v + half, 0, half});
    visit({0, p.u + half, p.v + half, 0, -half});
  }

  void split_box(const HeapCell& p) {
    const double half = p.size / 2;
    for (int child = 0; child < 1 << region_.dimension; ++child) {
      visit({0, p.u + ((child & 1) != 0 ? half : -half), p.v + ((child & 2) != 0 ? half : -half),
             region_.dimension == 3 ? p.w + ((child & 4) != 0 ? half : -half) : 0, half});
    }
  }

  const Region64& region_;
  const SolveLimits& limits_;
  Twin& twin_;
  std::vector<HeapCell>& heap_;
  Decision best_;
  double slack_ = 0;
  std::uint32_t most_evaluations_ = 0;
};

}  // namespace

Decision decide(const Region64& region, const SolveLimits& limits, const Decision& best, std::uint32_t evaluations,
                TileScratch& scratch) {
  return Search(region, limits, scratch).run(best, evaluations);
}

}  // namespace thalweg
