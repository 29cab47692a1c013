// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Circles as published (Luneau 2025, section 3.1): the disc is taken for its centre, and f(centre) < radius for an
// overlap. That is exact only where f is a distance; where f is a lower bound it over-reports, so the claim stands in
// `claimed`. A 1-Lipschitz f does prove the other side: f(centre) - L radius > 0 separates.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solve/descend.h"
#include "solve/finish.h"
#include "solve/prove.h"

namespace thalweg {
namespace {

class Publisher {
 public:
  Publisher(const CircleTile& tile, TileScratch& scratch) : tile_(tile), arena_(scratch.arena) {
    arena_.reset();
    d_ = static_cast<std::size_t>(tile.tape->dimension);
    state_ = QueryState::make(arena_, tile.tape->dimension, tile.count);
    kernel_scratch_ = arena_.take<float>(scratch_floats(*tile.tape));
    value_ = arena_.take<float>(padded(tile.count));
    for (std::size_t axis = 0; axis < d_; ++axis) gradient_[axis] = arena_.take<float>(padded(tile.count));
  }

  void run() {
    for (std::size_t q = 0; q < tile_.count; ++q) begin(q);
    const GradientColumns columns{.points = state_.point,
                                  .count = tile_.count,
                                  .value = value_,
                                  .gradient = gradient_,
                                  .evaluations = state_.evaluations};
    evaluate_gradient(tile_.limits->gradient, *tile_.tape, *tile_.kernels, columns, kernel_scratch_);
    for (std::size_t q = 0; q < tile_.count; ++q) move_to_deepest(q);
    tile_.kernels->value(*tile_.tape, state_.point, tile_.count, state_.value, kernel_scratch_);
    for (std::size_t q = 0; q < tile_.count; ++q) conclude(q);
    if (tile_.tape->has_formulas) prove();
    tile_.kernels->finish(tile_, state_, kernel_scratch_, arena_);
    if (tile_.columns.claimed == nullptr) return;
    for (std::size_t q = 0; q < tile_.count; ++q) {
      tile_.columns.claimed[q] = state_.is_bad[q] == 0 && value_[q] < radius(q) ? 1 : 0;
    }
  }

 private:
  [[nodiscard]] const float* row(std::size_t q) const { return tile_.rows + q * (d_ + 1); }
  [[nodiscard]] float radius(std::size_t q) const { return row(q)[d_]; }

  void begin(std::size_t q) {
    float largest = 0;
    bool bad = !(radius(q) >= 0);
    for (std::size_t i = 0; i <= d_; ++i) {
      bad = bad || !(std::fabs(row(q)[i]) <= kLargestCoordinate);
      if (i < d_) largest = std::max(largest, std::fabs(row(q)[i]));
    }
    state_.is_bad[q] = bad ? 1 : 0;
    state_.evaluations[q] = 0;
    for (std::size_t axis = 0; axis < d_; ++axis) state_.point[axis][q] = bad ? 0 : row(q)[axis];
    const double reach = bad ? 0 : static_cast<double>(largest) + static_cast<double>(radius(q));
    state_.slack[q] = static_cast<float>(tile_.limits->slack(reach) * (1 + 1e-6));
  }

  /// The point of the disc furthest against the gradient.
  void move_to_deepest(std::size_t q) {
    if (state_.is_bad[q] != 0) return;
    float square = 0;
    for (std::size_t axis = 0; axis < d_; ++axis) square += gradient_[axis][q] * gradient_[axis][q];
    const float length = square > 0 ? 0.9999999F * radius(q) / std::sqrt(square) : 0;
    for (std::size_t axis = 0; axis < d_; ++axis) state_.point[axis][q] -= length * gradient_[axis][q];
  }

  void conclude(std::size_t q) {
    const auto lipschitz = static_cast<float>(tile_.tape->facts.lipschitz);
    const float reach = state_.is_bad[q] != 0 ? 0 : radius(q);
    if (state_.value[q] > value_[q]) {
      state_.value[q] = value_[q];
      for (std::size_t axis = 0; axis < d_; ++axis) state_.point[axis][q] = state_.is_bad[q] != 0 ? 0 : row(q)[axis];
    }
    state_.lower[q] = value_[q] - lipschitz * reach - state_.slack[q];
    state_.witness[q] = state_.value[q] < -state_.slack[q] ? 1 : 0;
    const bool decided = state_.lower[q] > 0 || state_.witness[q] != 0;
    const bool bracketed = state_.value[q] - state_.lower[q] <= static_cast<float>(tile_.limits->tolerance);
    state_.converged[q] = decided && (tile_.limits->goal == Goal::verdict || bracketed) ? 1 : 0;
    ++state_.evaluations[q];
    state_.iterations[q] = 1;
    state_.barycentric[0][q] = state_.barycentric[1][q] = 0;
  }

  /// A formula has no Lipschitz constant: only the point is proven.
  void prove() {
    std::fill_n(state_.lower, tile_.count, -std::numeric_limits<float>::infinity());
    prove_incumbents(tile_, state_, kernel_scratch_, arena_, [this](std::size_t q) {
      double largest = 0;
      for (std::size_t axis = 0; axis < d_; ++axis) {
        largest = std::max(largest, std::fabs(static_cast<double>(row(q)[axis])));
      }
      return largest + static_cast<double>(radius(q));
    });
    for (std::size_t q = 0; q < tile_.count; ++q) {
      conclude_undefined(state_, q);
      if (tile_.limits->goal == Goal::deepest) state_.converged[q] = 0;
    }
  }

  const CircleTile& tile_;
  Arena& arena_;
  std::size_t d_ = 2;
  QueryState state_;
  float* kernel_scratch_ = nullptr;
  float* value_ = nullptr;
  float* gradient_[3] = {};
};

}  // namespace

void publish_circles(const CircleTile& tile, TileScratch& scratch) { Publisher(tile, scratch).run(); }

}  // namespace thalweg
