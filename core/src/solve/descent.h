// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What all local methods over triangles share. A lane is one (triangle, start). All lanes take a pass together: f, or f
// and its gradient, at one point each, then a step of the method. Lanes that have stopped are compacted away so that
// the kernels only see live ones. The arithmetic between evaluations is plain float32: the same bits on every target.
//
// A method is a class with
//   Memory                              what it keeps for a lane, trivial; begin() initialises it
//   kNeedsValue                         whether it looks at f in passes with gradients
//   kKeepsBest                          whether the best of all points counts, or the last one, as published
//   begin(view, memory)                 where the lane is evaluated first
//   wants_gradient(pass)                what the pass evaluates
//   extra_cost()                        evaluations that a pass with gradients takes besides
//   ends_iteration(pass)                whether an iteration is complete after the pass
//   step(view, pass, memory, next)      where it is evaluated next, or why it stops
#pragma once

#include <cmath>
#include <limits>

#include "gradient/strategies.h"
#include "solve/finish.h"
#include "solve/simplex.h"
#include "solve/starts.h"
#include "solve/tile.h"

namespace thalweg {

/// One lane as its method sees it.
struct LaneView {
  const float* corners;  ///< three points one after the other
  std::size_t dimension;
  Barycentric at;
  float point[3];
  float value;
  float gradient[3];
  float slack;  ///< of the query's float32 values

  /// g . (corner - point): how f changes, to first order, on the way to a corner.
  [[nodiscard]] float slope_to(std::size_t corner) const {
    float slope = 0;
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      slope += gradient[axis] * (corners[corner * dimension + axis] - point[axis]);
    }
    return slope;
  }
  /// g . (corner - first corner): the derivative along a barycentric coordinate.
  [[nodiscard]] float slope_along(std::size_t corner) const {
    float slope = 0;
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      slope += gradient[axis] * (corners[corner * dimension + axis] - corners[axis]);
    }
    return slope;
  }
};

/// Columns of live lanes, packed at the front, and the findings so far.
class DescentLanes {
 public:
  DescentLanes(const TriangleTile& tile, TileScratch& scratch);

 protected:
  void choose_starts(std::uint32_t start);
  void evaluate_values();
  void evaluate_gradients(bool with_value);
  [[nodiscard]] LaneView view(std::size_t lane) const;
  void place(std::size_t lane, const Barycentric& at);
  /// Notes the value at a lane's point, for methods that keep the best.
  void keep_best(std::size_t lane);
  void move(std::size_t from, std::size_t to);
  /// Lanes that stop wait until all of their start have.
  void retire(std::size_t lane, Stop why, bool keeps_best);
  /// Takes over what the stopped lanes found: their best, or the value at their last point.
  void adopt_stopped(bool keeps_best);
  void finish();

  const TriangleTile& tile_;
  const SolveLimits& limits_;
  Arena& arena_;
  QueryState state_;
  std::size_t count_ = 0;  ///< live lanes
  std::uint32_t* query_ = nullptr;
  std::uint32_t* spent_ = nullptr;  ///< evaluations of the last pass

 private:
  struct Stopped {
    std::uint32_t query;
    Barycentric at;
    float value;
    Stop why;
  };

  [[nodiscard]] const float* row(std::size_t q) const { return tile_.rows + q * 3 * dimension_; }
  void begin(std::size_t q);
  void choose_best_of_four();
  void adopt(const Stopped& stopped, float value, std::size_t lane);

  std::size_t dimension_ = 2;
  Barycentric* at_ = nullptr;
  Barycentric* best_at_ = nullptr;
  float* best_ = nullptr;
  float* points_[3] = {};
  float* value_ = nullptr;
  float* gradient_[3] = {};
  Stopped* stopped_ = nullptr;
  std::size_t stopped_count_ = 0;
  float* kernel_scratch_ = nullptr;
};

/// Runs a method over a tile.
template <class Method>
class Descent : private DescentLanes {
 public:
  Descent(const TriangleTile& tile, TileScratch& scratch)
      : DescentLanes(tile, scratch), method_(*tile.tape, *tile.limits) {
    memory_ = arena_.take<Memory>(padded(tile.count));
  }

  void run() {
    for (std::uint32_t start = 0; start < limits_.starts; ++start) {
      choose_starts(start);
      for (std::size_t lane = 0; lane < count_; ++lane) {
        place(lane, method_.begin(view(lane), memory_[lane]));
      }
      std::uint32_t iterations = 0;
      for (std::uint32_t pass = 0; count_ > 0; ++pass) {
        iterations += take(pass, iterations);
      }
      adopt_stopped(Method::kKeepsBest);
    }
    finish();
  }

 private:
  using Memory = typename Method::Memory;

  /// One pass of all lanes; returns 1 when it completes an iteration.
  std::uint32_t take(std::uint32_t pass, std::uint32_t iterations) {
    const bool with_gradient = method_.wants_gradient(pass);
    const bool with_value = Method::kNeedsValue || limits_.stop_at_witness;
    const std::uint32_t extra = with_gradient ? method_.extra_cost() : 0;
    stop_spent(extra + (with_gradient ? gradient_cost(with_value) : 1));
    if (count_ == 0) return 0;
    with_gradient ? evaluate_gradients(with_value) : evaluate_values();
    const std::uint32_t ended = method_.ends_iteration(pass) ? 1 : 0;
    const bool last = ended != 0 && iterations + 1 >= limits_.iterations;
    std::size_t kept = 0;
    for (std::size_t lane = 0; lane < count_; ++lane) {
      state_.evaluations[query_[lane]] += spent_[lane] + extra;
      state_.iterations[query_[lane]] += ended;
      if (Method::kKeepsBest) keep_best(lane);
      const LaneView seen = view(lane);
      Barycentric next = seen.at;
      Stop why = Stop::witness;
      if (!limits_.stop_at_witness || !(seen.value < -seen.slack)) why = method_.step(seen, pass, memory_[lane], next);
      place(lane, next);
      if (why == Stop::none && last) why = Stop::iterations;
      if (why != Stop::none) {
        retire(lane, why, Method::kKeepsBest);
        continue;
      }
      memory_[kept] = memory_[lane];
      move(lane, kept++);
    }
    count_ = kept;
    return ended;
  }

  /// Retires the lanes whose budget does not hold another pass and the value at the end.
  void stop_spent(std::uint32_t cost) {
    std::size_t kept = 0;
    for (std::size_t lane = 0; lane < count_; ++lane) {
      if (state_.evaluations[query_[lane]] + cost + (Method::kKeepsBest ? 0 : 1) > limits_.budget) {
        retire(lane, Stop::budget, Method::kKeepsBest);
        continue;
      }
      memory_[kept] = memory_[lane];
      move(lane, kept++);
    }
    count_ = kept;
  }

  [[nodiscard]] std::uint32_t gradient_cost(bool with_value) const {
    return evaluations_of(limits_.gradient, tile_.tape->dimension, with_value);
  }

  Method method_;
  Memory* memory_ = nullptr;
};

}  // namespace thalweg
