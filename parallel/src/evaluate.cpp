// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of points.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "gradient/strategies.h"
#include "schedule.h"
#include "solve/arena.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Points per tile.
constexpr std::size_t kTile = 4096;

struct Rows {
  const float* points;
  float* value;
  float* gradient;
};

class EvaluateTask final : public TileTask {
 public:
  EvaluateTask(const Tape& tape, const Rows& rows, Gradient strategy, const Execution& execution)
      : tape_(tape), rows_(rows), strategy_(strategy), workers_(worker_count(execution)) {
    target_ = execution.target == nullptr ? &default_target() : execution.target;
    d_ = static_cast<std::size_t>(tape.dimension);
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    std::unique_ptr<Worker>& worker = workers_[index];
    if (worker == nullptr) worker = std::make_unique<Worker>();
    Arena& arena = worker->arena;
    arena.reset();
    float* scratch = arena.take<float>(scratch_floats(tape_));
    if (rows_.gradient == nullptr || strategy_ == Gradient::autodiff) {
      float* value = rows_.value == nullptr ? nullptr : rows_.value + begin;
      float* gradient = rows_.gradient == nullptr ? nullptr : rows_.gradient + begin * d_;
      worker->bad_rows +=
          target_->kernels->rows(tape_, rows_.points + begin * d_, end - begin, value, gradient, scratch);
    } else {
      worker->bad_rows += difference(begin, end - begin, arena, scratch);
    }
  }

  [[nodiscard]] std::size_t bad_rows() const {
    std::size_t total = 0;
    for (const auto& worker : workers_) total += worker == nullptr ? 0 : worker->bad_rows;
    return total;
  }

 private:
  struct Worker {
    Arena arena;
    std::size_t bad_rows = 0;
  };

  /// Strategies that probe around each point want columns.
  std::size_t difference(std::size_t begin, std::size_t count, Arena& arena, float* scratch) const {
    float* points[3] = {};
    float* gradient[3] = {};
    for (std::size_t axis = 0; axis < d_; ++axis) points[axis] = arena.take<float>(padded(count));
    for (std::size_t axis = 0; axis < d_; ++axis) gradient[axis] = arena.take<float>(padded(count));
    float* value = arena.take<float>(padded(count));
    const std::size_t bad_rows = to_columns(begin, count, points);
    const GradientColumns columns{points, count, value, gradient};
    evaluate_gradient(strategy_, tape_, *target_->kernels, columns, {}, scratch, arena);
    to_rows(begin, count, value, gradient);
    return bad_rows;
  }

  [[nodiscard]] bool is_bad(std::size_t row) const {
    for (std::size_t axis = 0; axis < d_; ++axis) {
      if (!(std::fabs(rows_.points[row * d_ + axis]) <= kLargestCoordinate)) return true;
    }
    return false;
  }

  std::size_t to_columns(std::size_t begin, std::size_t count, float* const* points) const {
    std::size_t bad_rows = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const bool bad = is_bad(begin + i);
      bad_rows += bad ? 1 : 0;
      for (std::size_t axis = 0; axis < d_; ++axis) {
        points[axis][i] = bad ? 0 : rows_.points[(begin + i) * d_ + axis];
      }
    }
    return bad_rows;
  }

  void to_rows(std::size_t begin, std::size_t count, const float* value, float* const* gradient) const {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < count; ++i) {
      const bool bad = is_bad(begin + i);
      if (rows_.value != nullptr) rows_.value[begin + i] = bad ? kNan : value[i];
      for (std::size_t axis = 0; axis < d_; ++axis) {
        rows_.gradient[(begin + i) * d_ + axis] = bad ? kNan : gradient[axis][i];
      }
    }
  }

  const Tape& tape_;
  const Rows rows_;
  const Gradient strategy_;
  const Target* target_;
  std::size_t d_ = 2;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace

std::size_t evaluate(const Tape& tape, const float* points, std::size_t count, float* value, float* gradient,
                     Gradient strategy, const Execution& execution) {
  EvaluateTask task(tape, {points, value, gradient}, strategy, execution);
  schedule(task, count, execution.tile == 0 ? kTile : execution.tile, execution);
  return task.bad_rows();
}

}  // namespace thalweg
