// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/descent.h"

#include <algorithm>

#include "solve/prove.h"

namespace thalweg {

DescentLanes::DescentLanes(const TriangleTile& tile, TileScratch& scratch)
    : tile_(tile), limits_(*tile.limits), arena_(scratch.arena) {
  arena_.reset();
  dimension_ = static_cast<std::size_t>(tile.tape->dimension);
  state_ = QueryState::make(arena_, tile.tape->dimension, tile.count);
  const std::size_t room = padded(tile.count);
  state_.stop = arena_.take<std::uint8_t>(room);
  query_ = arena_.take<std::uint32_t>(room);
  at_ = arena_.take<Barycentric>(room);
  best_at_ = arena_.take<Barycentric>(room);
  best_ = arena_.take<float>(room);
  value_ = arena_.take<float>(room);
  spent_ = arena_.take<std::uint32_t>(room);
  for (std::size_t axis = 0; axis < dimension_; ++axis) {
    points_[axis] = arena_.take<float>(room);
    gradient_[axis] = arena_.take<float>(room);
  }
  stopped_ = arena_.take<Stopped>(room);
  kernel_scratch_ = arena_.take<float>(scratch_floats(*tile.tape));
  for (std::size_t q = 0; q < tile.count; ++q) begin(q);
}

void DescentLanes::begin(std::size_t q) {
  float largest = 0;
  bool bad = false;
  for (std::size_t i = 0; i < 3 * dimension_; ++i) {
    const float size = std::fabs(row(q)[i]);
    bad = bad || !(size <= kLargestCoordinate);
    largest = std::max(largest, size);
  }
  state_.is_bad[q] = bad ? 1 : 0;
  state_.slack[q] = static_cast<float>(limits_.slack(bad ? 0 : static_cast<double>(largest)) * (1 + 1e-6));
  state_.value[q] = std::numeric_limits<float>::infinity();
  state_.lower[q] = -std::numeric_limits<float>::infinity();
  state_.witness[q] = state_.converged[q] = 0;
  state_.evaluations[q] = state_.iterations[q] = 0;
  state_.stop[q] = static_cast<std::uint8_t>(Stop::none);
  state_.barycentric[0][q] = state_.barycentric[1][q] = 0;
  for (std::size_t axis = 0; axis < dimension_; ++axis) state_.point[axis][q] = bad ? 0 : row(q)[axis];
}

void DescentLanes::place(std::size_t lane, const Barycentric& at) {
  at_[lane] = at;
  const float* corners = row(query_[lane]);
  for (std::size_t axis = 0; axis < dimension_; ++axis) {
    points_[axis][lane] = at.of(corners[axis], corners[dimension_ + axis], corners[2 * dimension_ + axis]);
  }
}

void DescentLanes::evaluate_values() {
  std::fill_n(spent_, count_, 1U);
  tile_.kernels->value(*tile_.tape, points_, count_, value_, kernel_scratch_);
}

void DescentLanes::evaluate_gradients(bool with_value) {
  std::fill_n(spent_, count_, 0U);
  const GradientColumns columns{.points = points_,
                                .count = count_,
                                .value = with_value ? value_ : nullptr,
                                .gradient = gradient_,
                                .evaluations = spent_};
  evaluate_gradient(limits_.gradient, *tile_.tape, *tile_.kernels, columns, kernel_scratch_);
}

LaneView DescentLanes::view(std::size_t lane) const {
  const std::uint32_t q = query_[lane];
  LaneView seen{row(q), dimension_, at_[lane], {}, value_[lane], {}, state_.slack[q]};
  for (std::size_t axis = 0; axis < dimension_; ++axis) {
    seen.point[axis] = points_[axis][lane];
    seen.gradient[axis] = gradient_[axis][lane];
  }
  return seen;
}

void DescentLanes::choose_starts(std::uint32_t start) {
  count_ = 0;
  for (std::uint32_t q = 0; q < tile_.count; ++q) {
    if (state_.is_bad[q] != 0) continue;
    query_[count_] = q;
    best_[count_] = std::numeric_limits<float>::infinity();
    place(count_++, start_point(limits_.start, start));
  }
  if (limits_.start == Start::best_of_4) choose_best_of_four();
}

/// The centroid or the corner with the least value.
void DescentLanes::choose_best_of_four() {
  for (std::uint32_t candidate = 0; candidate < 4; ++candidate) {
    for (std::size_t lane = 0; lane < count_; ++lane) place(lane, start_point(candidate));
    evaluate_values();
    for (std::size_t lane = 0; lane < count_; ++lane) {
      ++state_.evaluations[query_[lane]];
      keep_best(lane);
    }
  }
  for (std::size_t lane = 0; lane < count_; ++lane) place(lane, best_at_[lane]);
}

void DescentLanes::keep_best(std::size_t lane) {
  if (!(value_[lane] < best_[lane])) return;
  best_[lane] = value_[lane];
  best_at_[lane] = at_[lane];
}

void DescentLanes::move(std::size_t from, std::size_t to) {
  if (from == to) return;
  query_[to] = query_[from];
  at_[to] = at_[from];
  best_[to] = best_[from];
  best_at_[to] = best_at_[from];
  for (std::size_t axis = 0; axis < dimension_; ++axis) points_[axis][to] = points_[axis][from];
}

void DescentLanes::retire(std::size_t lane, Stop why, bool keeps_best) {
  stopped_[stopped_count_++] = {query_[lane], keeps_best ? best_at_[lane] : at_[lane], best_[lane], why};
}

void DescentLanes::adopt_stopped(bool keeps_best) {
  count_ = stopped_count_;
  for (std::size_t i = 0; i < count_; ++i) {
    query_[i] = stopped_[i].query;
    place(i, stopped_[i].at);
  }
  if (!keeps_best && count_ > 0) evaluate_values();
  for (std::size_t i = 0; i < count_; ++i) {
    adopt(stopped_[i], keeps_best ? stopped_[i].value : value_[i], i);
  }
  count_ = stopped_count_ = 0;
}

void DescentLanes::adopt(const Stopped& stopped, float value, std::size_t lane) {
  const std::uint32_t q = stopped.query;
  if (!(value < state_.value[q])) return;
  state_.value[q] = value;
  for (std::size_t axis = 0; axis < dimension_; ++axis) state_.point[axis][q] = points_[axis][lane];
  state_.barycentric[0][q] = stopped.at.b;
  state_.barycentric[1][q] = stopped.at.c;
  state_.witness[q] = value < -state_.slack[q] ? 1 : 0;
  state_.converged[q] = limits_.goal == Goal::verdict ? state_.witness[q] : 0;
  state_.stop[q] = static_cast<std::uint8_t>(stopped.why);
}

void DescentLanes::finish() {
  if (tile_.tape->has_formulas) {
    prove_incumbents(tile_, state_, kernel_scratch_, arena_, [this](std::size_t q) {
      const float* const corners = row(q);
      const auto by_size = [](float a, float b) { return std::fabs(a) < std::fabs(b); };
      return static_cast<double>(std::fabs(*std::max_element(corners, corners + 3 * dimension_, by_size)));
    });
    for (std::size_t q = 0; q < tile_.count; ++q) conclude_undefined(state_, q);
  }
  tile_.kernels->finish(tile_, state_, kernel_scratch_, arena_);
}

}  // namespace thalweg
