// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of points. Values and closed-form gradients go through the rows kernel as they are; the other strategies
// want columns.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "gradient/strategies.h"
#include "gradient/ties.h"
#include "ordered_rows.h"
#include "schedule.h"
#include "solve/arena.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Points per tile.
constexpr std::size_t kTile = 4096;
/// Values cost less than queries do: only tapes from this length on pay for ordering the points.
constexpr std::size_t kLongTapeForValues = 512;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

const Target& target_of(const Execution& execution) {
  return execution.target == nullptr ? default_target() : *execution.target;
}

class EvaluateTask final : public TileTask {
 public:
  EvaluateTask(const Tape& tape, const Points& points, const PointColumns& out, const Execution& execution)
      : tape_(tape), points_(points), out_(out), target_(target_of(execution)), workers_(worker_count(execution)) {
    d_ = static_cast<std::size_t>(tape.dimension);
  }

  void take_gradients_by(const GradientRule& rule) { rule_ = rule; }

  /// Long tapes: points in spatial order. Strategies that probe around a point may leave its tile's region.
  void order_rows() {
    if (!in_rows() || tape_.instructions.size() < kLongTapeForValues || points_.count < kOrderedTile ||
        points_.count >= std::numeric_limits<std::uint32_t>::max()) {
      return;
    }
    order_ = spatial_order(layout(), points_.rows, points_.count);
  }
  [[nodiscard]] std::size_t rows_per_task(const Execution& execution) const {
    if (execution.tile != 0) return execution.tile;
    return order_.empty() ? kTile : kOrderedTile * kBlockTiles;
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    std::unique_ptr<Worker>& worker = workers_[index];
    if (worker == nullptr) worker = std::make_unique<Worker>();
    worker->arena.reset();
    worker->summary.rows += end - begin;
    if (!order_.empty()) {
      run_ordered({order_.data() + begin, end - begin}, *worker);
    } else {
      in_rows() ? run_rows(begin, end - begin, *worker) : run_columns(begin, end - begin, *worker);
    }
    if (out_.ambiguous != nullptr || out_.one_sided != nullptr) run_ties(begin, end - begin, worker->arena);
  }

  [[nodiscard]] EvaluateSummary summary() const {
    EvaluateSummary total;
    for (const auto& worker : workers_) {
      if (worker == nullptr) continue;
      total.rows += worker->summary.rows;
      total.bad_rows += worker->summary.bad_rows;
      total.evaluations += worker->summary.evaluations;
    }
    return total;
  }

 private:
  struct Worker {
    Arena arena;
    EvaluateSummary summary;
    std::unique_ptr<OrderedRows> ordered;
  };
  struct TileColumns {
    float* points[3] = {};
    float* gradient[3] = {};
    float* witness[3] = {};
    float* value = nullptr;
    std::uint32_t* evaluations = nullptr;
  };

  [[nodiscard]] bool in_rows() const { return rule_.strategy == Gradient::autodiff || out_.gradient == nullptr; }
  [[nodiscard]] RowLayout layout() const { return {.dimension = d_, .points = 1, .has_radius = false}; }

  /// Rows of the caller's columns `order` names: a tape for each tile of neighbours.
  void run_ordered(std::span<const std::uint32_t> order, Worker& worker) const {
    if (worker.ordered == nullptr) worker.ordered = std::make_unique<OrderedRows>(tape_, layout(), false, 0.0F);
    OrderedRows& rows = *worker.ordered;
    rows.take(points_.rows, order, kOrderedTile, *target_.kernels);
    float* scratch = worker.arena.take<float>(scratch_floats(tape_));
    float* value = worker.arena.take<float>(kOrderedTile);
    float* gradient = out_.gradient == nullptr ? nullptr : worker.arena.take<float>(kOrderedTile * d_);
    for (std::size_t begin = 0; begin < order.size(); begin += kOrderedTile) {
      const auto own = order.subspan(begin, std::min(kOrderedTile, order.size() - begin));
      const Tape& tape = rows.tape_of(begin / kOrderedTile);
      const std::size_t bad_rows =
          target_.kernels->rows(tape, rows.rows() + begin * d_, own.size(), value, gradient, scratch);
      worker.summary.bad_rows += bad_rows;
      worker.summary.evaluations += own.size() - bad_rows;
      for (std::size_t i = 0; i < own.size(); ++i) {
        if (out_.value != nullptr) out_.value[own[i]] = value[i];
        for (std::size_t k = 0; gradient != nullptr && k < d_; ++k)
          out_.gradient[own[i] * d_ + k] = gradient[i * d_ + k];
        if (out_.evaluations != nullptr) out_.evaluations[own[i]] = is_bad(own[i]) ? 0 : 1;
      }
    }
  }

  void run_rows(std::size_t begin, std::size_t count, Worker& worker) const {
    float* scratch = worker.arena.take<float>(scratch_floats(tape_));
    float* value = out_.value == nullptr ? nullptr : out_.value + begin;
    float* gradient = out_.gradient == nullptr ? nullptr : out_.gradient + begin * d_;
    const float* rows = points_.rows + begin * d_;
    const std::size_t bad_rows = target_.kernels->rows(tape_, rows, count, value, gradient, scratch);
    worker.summary.bad_rows += bad_rows;
    worker.summary.evaluations += count - bad_rows;
    if (out_.evaluations == nullptr) return;
    for (std::size_t i = 0; i < count; ++i) out_.evaluations[begin + i] = is_bad(begin + i) ? 0 : 1;
  }

  void run_columns(std::size_t begin, std::size_t count, Worker& worker) const {
    TileColumns tile = take(count, worker.arena);
    load(begin, count, tile);
    const GradientColumns columns{.points = tile.points,
                                  .count = count,
                                  .value = out_.value == nullptr ? nullptr : tile.value,
                                  .gradient = tile.gradient,
                                  .evaluations = tile.evaluations,
                                  .witness = out_.witness == nullptr ? nullptr : tile.witness};
    evaluate_gradient(rule_, tape_, *target_.kernels, columns, worker.arena.take<float>(scratch_floats(tape_)));
    for (std::size_t i = 0; i < count; ++i) store(begin + i, i, tile, worker.summary);
  }

  void run_ties(std::size_t begin, std::size_t count, Arena& arena) const {
    const TileColumns tile = take(count, arena);
    load(begin, count, tile);
    const Ties ties = Ties::make(arena, tape_.dimension, count, out_.one_sided != nullptr);
    find_ties(tape_, *target_.kernels, tile.points, count, ties, arena.take<float>(scratch_floats(tape_)), arena);
    for (std::size_t i = 0; i < count; ++i) {
      const bool bad = is_bad(begin + i);
      if (out_.ambiguous != nullptr) out_.ambiguous[begin + i] = bad ? 0 : ties.tied[i];
      if (out_.one_sided == nullptr) continue;
      float* to = out_.one_sided + 2 * d_ * (begin + i);
      for (const auto& side : ties.sides) {
        for (std::size_t axis = 0; axis < d_; ++axis) *to++ = bad ? kNan : side[axis][i];
      }
    }
  }

  [[nodiscard]] TileColumns take(std::size_t count, Arena& arena) const {
    TileColumns tile;
    for (std::size_t axis = 0; axis < d_; ++axis) {
      tile.points[axis] = arena.take<float>(padded(count));
      tile.gradient[axis] = arena.take<float>(padded(count));
      tile.witness[axis] = arena.take<float>(padded(count));
    }
    tile.value = arena.take<float>(padded(count));
    tile.evaluations = arena.take<std::uint32_t>(padded(count));
    std::fill_n(tile.evaluations, count, 0U);
    return tile;
  }

  [[nodiscard]] bool is_bad(std::size_t row) const {
    for (std::size_t axis = 0; axis < d_; ++axis) {
      if (!(std::fabs(points_.rows[row * d_ + axis]) <= kLargestCoordinate)) return true;
    }
    return false;
  }

  void load(std::size_t begin, std::size_t count, const TileColumns& tile) const {
    for (std::size_t i = 0; i < count; ++i) {
      const bool bad = is_bad(begin + i);
      for (std::size_t axis = 0; axis < d_; ++axis) {
        tile.points[axis][i] = bad ? 0 : points_.rows[(begin + i) * d_ + axis];
      }
    }
  }

  void store(std::size_t row, std::size_t i, const TileColumns& tile, EvaluateSummary& summary) const {
    const bool bad = is_bad(row);
    summary.bad_rows += bad ? 1 : 0;
    summary.evaluations += bad ? 0 : tile.evaluations[i];
    if (out_.evaluations != nullptr) out_.evaluations[row] = bad ? 0 : tile.evaluations[i];
    if (out_.value != nullptr) out_.value[row] = bad ? kNan : tile.value[i];
    for (std::size_t axis = 0; axis < d_; ++axis) {
      out_.gradient[row * d_ + axis] = bad ? kNan : tile.gradient[axis][i];
      if (out_.witness != nullptr) out_.witness[row * d_ + axis] = bad ? kNan : tile.witness[axis][i];
    }
  }

  const Tape& tape_;
  const Points points_;
  const PointColumns out_;
  const Target& target_;
  GradientRule rule_;
  std::size_t d_ = 2;
  std::vector<std::uint32_t> order_;  ///< empty: the caller's
  std::vector<std::unique_ptr<Worker>> workers_;
};

EvaluateSummary run(EvaluateTask& task, std::size_t count, const Execution& execution) {
  task.order_rows();
  const bool complete = schedule(task, count, task.rows_per_task(execution), execution);
  EvaluateSummary summary = task.summary();
  summary.cancelled = !complete;
  return summary;
}

}  // namespace

std::size_t evaluate(const Tape& tape, const float* points, std::size_t count, float* value, float* gradient,
                     const Execution& execution) {
  EvaluateTask task(tape, {points, count}, {.value = value, .gradient = gradient}, execution);
  return run(task, count, execution).bad_rows;
}

Result<EvaluateSummary> evaluate(const Tape& tape, Points points, const GradientOptions& options,
                                 const PointColumns& columns, const Execution& execution) {
  if (auto error = refusal(tape, options.strategy, options.offset)) return *std::move(error);
  if (columns.witness != nullptr && (options.strategy != Gradient::closest_point || columns.gradient == nullptr)) {
    return Error{.file = "",
                 .place = "--gradient",
                 .expected = "closest_point, which alone gives witnesses, and its gradients",
                 .found = std::string(name(options.strategy))};
  }
  EvaluateTask task(tape, points, columns, execution);
  task.take_gradients_by(rule_of(tape, options.strategy, options.offset));
  return run(task, points.count, execution);
}

}  // namespace thalweg
