// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A lane is one (triangle, start). All lanes take a step together; lanes that have stopped are compacted away so that
// the kernels only see live ones. The arithmetic between evaluations is plain float32: the same bits on every target.
#include "solve/descend.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gradient/strategies.h"
#include "solve/finish.h"
#include "solve/simplex.h"
#include "solve/starts.h"

namespace thalweg {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Live lanes of one descent, packed at the front of their columns.
struct Lanes {
  std::uint32_t* query = nullptr;
  Barycentric* at = nullptr;
  float* step = nullptr;  ///< current step length, `projected` only
  float* points[3] = {};
  float* value = nullptr;
  float* gradient[3] = {};
  std::uint32_t* evaluations = nullptr;  ///< of this iteration
  std::size_t count = 0;

  void take(Arena& arena, std::size_t room, int dimension) {
    query = arena.take<std::uint32_t>(padded(room));
    at = arena.take<Barycentric>(padded(room));
    step = arena.take<float>(padded(room));
    value = arena.take<float>(padded(room));
    evaluations = arena.take<std::uint32_t>(padded(room));
    for (int axis = 0; axis < dimension; ++axis) {
      points[axis] = arena.take<float>(padded(room));
      gradient[axis] = arena.take<float>(padded(room));
    }
  }
};

class Descent {
 public:
  Descent(const TriangleTile& tile, TileScratch& scratch) : tile_(tile), limits_(*tile.limits), arena_(scratch.arena) {
    arena_.reset();
    dimension_ = static_cast<std::size_t>(tile.tape->dimension);
    state_ = QueryState::make(arena_, tile.tape->dimension, tile.count);
    lanes_.take(arena_, tile.count, tile.tape->dimension);
    stopped_.take(arena_, tile.count, 0);
    kernel_scratch_ = arena_.take<float>(scratch_floats(*tile.tape));
    for (std::size_t q = 0; q < tile.count; ++q) begin(q);
  }

  void run() {
    for (std::uint32_t start = 0; start < limits_.starts; ++start) {
      choose_starts(start);
      for (std::uint32_t k = 0; k < limits_.iterations && lanes_.count > 0; ++k) iterate();
      retire_all();
    }
    tile_.kernels->finish(tile_, state_, kernel_scratch_, arena_);
  }

 private:
  [[nodiscard]] const float* row(std::size_t q) const { return tile_.rows + q * 3 * dimension_; }

  void begin(std::size_t q) {
    float largest = 0;
    bool bad = false;
    for (std::size_t i = 0; i < 3 * dimension_; ++i) {
      const float size = std::fabs(row(q)[i]);
      bad = bad || !(size <= kLargestCoordinate);
      largest = std::max(largest, size);
    }
    state_.is_bad[q] = bad ? 1 : 0;
    state_.slack[q] = static_cast<float>(limits_.slack(bad ? 0 : static_cast<double>(largest)) * (1 + 1e-6));
    state_.value[q] = kInfinity;
    state_.lower[q] = -kInfinity;
    state_.witness[q] = state_.converged[q] = 0;
    state_.evaluations[q] = state_.iterations[q] = 0;
    state_.barycentric[0][q] = state_.barycentric[1][q] = 0;
    for (std::size_t axis = 0; axis < dimension_; ++axis) state_.point[axis][q] = 0;
  }

  void locate(std::size_t lane) {
    const float* corners = row(lanes_.query[lane]);
    for (std::size_t axis = 0; axis < dimension_; ++axis) {
      lanes_.points[axis][lane] =
          lanes_.at[lane].of(corners[axis], corners[dimension_ + axis], corners[2 * dimension_ + axis]);
    }
  }

  void evaluate_lanes() {
    tile_.kernels->value(*tile_.tape, lanes_.points, lanes_.count, lanes_.value, kernel_scratch_);
  }

  // --- starts
  // ---------------------------------------------------------------------------------------------------------

  void choose_starts(std::uint32_t start) {
    lanes_.count = 0;
    for (std::uint32_t q = 0; q < tile_.count; ++q) {
      if (state_.is_bad[q] != 0) continue;
      lanes_.query[lanes_.count] = q;
      lanes_.at[lanes_.count] = start_point(start);
      locate(lanes_.count++);
    }
    if (limits_.method != Method::projected) return;
    if (limits_.starts == 1) choose_best_of_four();
    for (std::size_t lane = 0; lane < lanes_.count; ++lane) lanes_.step[lane] = first_step(lane);
  }

  /// The centroid or the corner with the least value.
  void choose_best_of_four() {
    auto* best = arena_.take<Barycentric>(lanes_.count);
    float* least = arena_.take<float>(lanes_.count);
    std::fill_n(least, lanes_.count, kInfinity);
    for (std::uint32_t candidate = 0; candidate < 4; ++candidate) {
      for (std::size_t lane = 0; lane < lanes_.count; ++lane) {
        lanes_.at[lane] = start_point(candidate);
        locate(lane);
      }
      evaluate_lanes();
      for (std::size_t lane = 0; lane < lanes_.count; ++lane) {
        ++state_.evaluations[lanes_.query[lane]];
        if (!(lanes_.value[lane] < least[lane])) continue;
        least[lane] = lanes_.value[lane];
        best[lane] = lanes_.at[lane];
      }
    }
    for (std::size_t lane = 0; lane < lanes_.count; ++lane) {
      lanes_.at[lane] = best[lane];
      locate(lane);
    }
  }

  /// 1 / (2 max |corner - point|).
  [[nodiscard]] float first_step(std::size_t lane) const {
    const float* corners = row(lanes_.query[lane]);
    float most = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      float square = 0;
      for (std::size_t axis = 0; axis < dimension_; ++axis) {
        const float x = corners[corner * dimension_ + axis] - lanes_.points[axis][lane];
        square += x * x;
      }
      most = std::max(most, square);
    }
    return most > 0 ? 0.5F / std::sqrt(most) : 0;
  }

  // --- steps
  // ----------------------------------------------------------------------------------------------------------

  void iterate() {
    const bool thesis = limits_.method == Method::thesis;
    std::fill_n(lanes_.evaluations, lanes_.count, 0U);
    const GradientColumns columns{.points = lanes_.points,
                                  .count = lanes_.count,
                                  .value = thesis ? lanes_.value : nullptr,
                                  .gradient = lanes_.gradient,
                                  .evaluations = lanes_.evaluations};
    evaluate_gradient(limits_.gradient, *tile_.tape, *tile_.kernels, columns, kernel_scratch_);
    // The published descent evaluates f once more for its step.
    const std::uint32_t more = thesis ? 1 : 0;
    std::size_t kept = 0;
    for (std::size_t lane = 0; lane < lanes_.count; ++lane) {
      const std::uint32_t q = lanes_.query[lane];
      state_.evaluations[q] += lanes_.evaluations[lane] + more;
      ++state_.iterations[q];
      const bool stops = thesis ? step_as_published(lane) : step_in_barycentrics(lane);
      locate(lane);
      if (stops) {
        retire(lane);
        continue;
      }
      keep(lane, kept++);
    }
    lanes_.count = kept;
  }

  void keep(std::size_t lane, std::size_t to) {
    lanes_.query[to] = lanes_.query[lane];
    lanes_.at[to] = lanes_.at[lane];
    lanes_.step[to] = lanes_.step[lane];
    for (std::size_t axis = 0; axis < dimension_; ++axis) lanes_.points[axis][to] = lanes_.points[axis][lane];
  }

  /// P <- closest point of the triangle to P - 0.1 max(|f|, mu) grad f; there is no stop test.
  bool step_as_published(std::size_t lane) {
    constexpr float kAlpha = 0.1F;
    constexpr float kMu = 100;
    const float length = kAlpha * std::max(std::fabs(lanes_.value[lane]), kMu);
    float moved[3] = {};
    for (std::size_t axis = 0; axis < dimension_; ++axis) {
      moved[axis] = lanes_.points[axis][lane] - length * lanes_.gradient[axis][lane];
    }
    lanes_.at[lane] = closest_point(row(lanes_.query[lane]), moved, dimension_);
    return false;
  }

  /// Projected gradient in barycentric coordinates; the step shrinks by 0.8 each time, and the descent stops when the
  /// coordinates move by less than 1e-3.
  bool step_in_barycentrics(std::size_t lane) {
    const float* corners = row(lanes_.query[lane]);
    float slope[3] = {};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t axis = 0; axis < dimension_; ++axis) {
        slope[corner] +=
            lanes_.gradient[axis][lane] * (corners[corner * dimension_ + axis] - lanes_.points[axis][lane]);
      }
    }
    const Barycentric before = lanes_.at[lane];
    const float step = lanes_.step[lane];
    lanes_.step[lane] *= 0.8F;
    lanes_.at[lane] =
        project_on_simplex(before.a - step * slope[0], before.b - step * slope[1], before.c - step * slope[2]);
    return distance(before, lanes_.at[lane]) < 1e-3F;
  }

  // --- results
  // --------------------------------------------------------------------------------------------------------

  /// Lanes that stop wait until their values are taken together.
  void retire(std::size_t lane) {
    stopped_.query[stopped_.count] = lanes_.query[lane];
    stopped_.at[stopped_.count++] = lanes_.at[lane];
  }

  void retire_all() {
    for (std::size_t lane = 0; lane < lanes_.count; ++lane) retire(lane);
    lanes_.count = 0;
    for (std::size_t i = 0; i < stopped_.count; ++i) {
      lanes_.query[i] = stopped_.query[i];
      lanes_.at[i] = stopped_.at[i];
      locate(i);
    }
    lanes_.count = stopped_.count;
    stopped_.count = 0;
    evaluate_lanes();
    for (std::size_t lane = 0; lane < lanes_.count; ++lane) adopt(lane);
    lanes_.count = 0;
  }

  void adopt(std::size_t lane) {
    const std::uint32_t q = lanes_.query[lane];
    const float value = lanes_.value[lane];
    if (!(value < state_.value[q])) return;
    state_.value[q] = value;
    for (std::size_t axis = 0; axis < dimension_; ++axis) state_.point[axis][q] = lanes_.points[axis][lane];
    state_.barycentric[0][q] = lanes_.at[lane].b;
    state_.barycentric[1][q] = lanes_.at[lane].c;
    state_.witness[q] = value < -state_.slack[q] ? 1 : 0;
    state_.converged[q] = limits_.goal == Goal::verdict ? state_.witness[q] : 0;
  }

  const TriangleTile& tile_;
  const SolveLimits& limits_;
  Arena& arena_;
  std::size_t dimension_ = 2;
  QueryState state_;
  Lanes lanes_;
  Lanes stopped_;  ///< queries and coordinates of lanes that have stopped
  float* kernel_scratch_ = nullptr;
};

}  // namespace

void descend_triangles(const TriangleTile& tile, TileScratch& scratch) { Descent(tile, scratch).run(); }

}  // namespace thalweg
