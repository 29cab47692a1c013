// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Descents that step in the space of the scene and project on the triangle: the thesis' method as published (Luneau
// 2025, section 3.2), the variants that its text discusses, and steps of the field's own length.
#include <algorithm>

#include "solve/descend.h"
#include "solve/descent.h"

namespace thalweg {
namespace {

class StepInSpace {
 public:
  struct Memory {};
  static constexpr bool kNeedsValue = true;
  static constexpr bool kKeepsBest = false;

  StepInSpace(const Tape& tape, const SolveLimits& limits) {
    is_fixed_ = limits.method == Method::thesis_fixed;
    // The published descent evaluates f once more for its step.
    extra_cost_ = limits.method == Method::distance_step ? 0 : 1;
    const bool divides = limits.method == Method::distance_step && std::isfinite(tape.facts.lipschitz);
    alpha_ = static_cast<float>(limits.step / (divides ? std::max(tape.facts.lipschitz, 1e-6) : 1.0));
    floor_ = static_cast<float>(limits.floor);
    stop_ = static_cast<float>(limits.stop);
  }

  [[nodiscard]] static Barycentric begin(const LaneView& lane, Memory&) { return lane.at; }
  [[nodiscard]] static bool wants_gradient(std::uint32_t) { return true; }
  [[nodiscard]] static bool ends_iteration(std::uint32_t) { return true; }
  [[nodiscard]] std::uint32_t extra_cost() const { return extra_cost_; }

  Stop step(const LaneView& lane, std::uint32_t, Memory&, Barycentric& next) const {
    const float length = is_fixed_ ? alpha_ : alpha_ * std::max(std::fabs(lane.value), floor_);
    float moved[3] = {};
    for (std::size_t axis = 0; axis < lane.dimension; ++axis) {
      moved[axis] = lane.point[axis] - length * lane.gradient[axis];
    }
    next = closest_point(lane.corners, moved, lane.dimension);
    return stop_ > 0 && distance(lane.at, next) < stop_ ? Stop::small_step : Stop::none;
  }

 private:
  bool is_fixed_ = false;
  std::uint32_t extra_cost_ = 0;
  float alpha_ = 0;
  float floor_ = 0;
  float stop_ = 0;
};

}  // namespace

void descend_in_space(const TriangleTile& tile, TileScratch& scratch) { Descent<StepInSpace>(tile, scratch).run(); }

}  // namespace thalweg
