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
#include "ordered_batch.h"
#include "reuse.h"
#include "schedule.h"
#include "solve/arena.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Points per tile.
constexpr std::size_t kTile = 4096;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

const Target& target_of(const Execution& execution) {
  return execution.target == nullptr ? default_target() : *execution.target;
}

/// What one worker keeps from tile to tile, and from batch to batch.
struct Worker {
  Arena arena;
  EvaluateSummary summary;
};

class EvaluateTask final : public TileTask, public OrderedBatch::Answer {
 public:
  EvaluateTask(const Tape& tape, const Points& points, const PointColumns& out, const Execution& execution)
      : tape_(tape), points_(points), out_(out), execution_(execution), target_(target_of(execution)) {
    d_ = static_cast<std::size_t>(tape.dimension);
    workers_->resize(std::max(workers_->size(), worker_count(execution)));
    for (const auto& worker : *workers_) {
      if (worker != nullptr) worker->summary = {};
    }
  }

  void take_gradients_by(const GradientRule& rule) { rule_ = rule; }

  EvaluateSummary run() {
    bool complete = false;
    // Nearest surface points may be anywhere, where a tape shortened for the points says nothing.
    if ((in_rows() || rule_.strategy != Gradient::closest_point) &&
        OrderedBatch::suits_points(tape_, points_.count, out_.gradient != nullptr)) {
      const Surroundings around{.bounds = false, .sizes = 0, .probe = in_rows() ? ProbeRule{} : rule_.probe};
      constexpr PartSizes kParts{.most = 256, .few = 32, .in_pieces = false};
      OrderedBatch batch(tape_, {.dimension = d_}, points_.rows, points_.count, around, execution_, kParts);
      complete = batch.run(*this);
    } else {
      complete = schedule(*this, points_.count, execution_.tile == 0 ? kTile : execution_.tile, execution_);
    }
    EvaluateSummary total;
    for (const auto& worker : *workers_) {
      if (worker == nullptr) continue;
      total.rows += worker->summary.rows;
      total.bad_rows += worker->summary.bad_rows;
      total.undefined_rows += worker->summary.undefined_rows;
      total.evaluations += worker->summary.evaluations;
    }
    total.cancelled = !complete;
    return total;
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    Worker& own = worker(index);
    own.summary.rows += end - begin;
    own.arena.reset();
    const Rows rows{tape_, begin, nullptr, end - begin};
    in_rows() ? run_rows(rows, own) : run_columns(rows, own);
    if (out_.ambiguous != nullptr || out_.one_sided != nullptr) run_ties(rows, own.arena);
  }

  void answer(const OrderedBatch::Part& part) override {
    Worker& own = worker(part.worker);
    own.summary.rows += part.order.size();
    own.arena.reset();
    const Rows rows{part.tape, 0, part.order.data(), part.order.size()};
    in_rows() ? run_gathered(rows, part.rows, own) : run_columns(rows, own);
    if (out_.ambiguous != nullptr || out_.one_sided != nullptr) run_ties(rows, own.arena);
  }

 private:
  /// Some of the caller's rows, and a tape for them.
  struct Rows {
    const Tape& tape;
    std::size_t begin;
    const std::uint32_t* order;  ///< null: one after the other from `begin` on
    std::size_t count;
    [[nodiscard]] std::size_t operator[](std::size_t i) const { return order == nullptr ? begin + i : order[i]; }
  };
  struct TileColumns {
    float* points[3] = {};
    float* gradient[3] = {};
    float* witness[3] = {};
    float* value = nullptr;
    std::uint32_t* evaluations = nullptr;
  };

  [[nodiscard]] bool in_rows() const { return rule_.strategy == Gradient::autodiff || out_.gradient == nullptr; }

  Worker& worker(std::size_t index) {
    std::unique_ptr<Worker>& own = (*workers_)[index];
    if (own == nullptr) own = std::make_unique<Worker>();
    return *own;
  }

  /// Rows that were copied together.
  void run_gathered(const Rows& rows, const float* gathered, Worker& worker) const {
    float* scratch = worker.arena.take<float>(scratch_floats(tape_));
    float* value = worker.arena.take<float>(rows.count);
    float* gradient = out_.gradient == nullptr ? nullptr : worker.arena.take<float>(rows.count * d_);
    const std::size_t unanswered = target_.kernels->rows(rows.tape, gathered, rows.count, value, gradient, scratch);
    count_rows(rows, unanswered, worker.summary);
    for (std::size_t i = 0; i < rows.count; ++i) {
      const std::size_t row = rows[i];
      if (out_.value != nullptr) out_.value[row] = value[i];
      for (std::size_t k = 0; gradient != nullptr && k < d_; ++k) out_.gradient[row * d_ + k] = gradient[i * d_ + k];
      if (out_.evaluations != nullptr) out_.evaluations[row] = is_bad(row) ? 0 : 1;
    }
  }

  void run_rows(const Rows& rows, Worker& worker) const {
    float* scratch = worker.arena.take<float>(scratch_floats(tape_));
    float* value = out_.value == nullptr ? nullptr : out_.value + rows.begin;
    float* gradient = out_.gradient == nullptr ? nullptr : out_.gradient + rows.begin * d_;
    const std::size_t unanswered =
        target_.kernels->rows(tape_, points_.rows + rows.begin * d_, rows.count, value, gradient, scratch);
    count_rows(rows, unanswered, worker.summary);
    if (out_.evaluations == nullptr) return;
    for (std::size_t i = 0; i < rows.count; ++i) out_.evaluations[rows[i]] = is_bad(rows[i]) ? 0 : 1;
  }

  /// Rows that were not answered are bad, but for those where a formula is undefined.
  void count_rows(const Rows& rows, std::size_t unanswered, EvaluateSummary& summary) const {
    std::size_t bad = unanswered;
    if (tape_.has_formulas && unanswered > 0) {
      bad = 0;
      for (std::size_t i = 0; i < rows.count; ++i) bad += is_bad(rows[i]) ? 1 : 0;
    }
    summary.bad_rows += bad;
    summary.undefined_rows += unanswered - bad;
    summary.evaluations += rows.count - bad;
  }

  void run_columns(const Rows& rows, Worker& worker) const {
    TileColumns tile = take(rows.count, worker.arena);
    load(rows, tile);
    const GradientColumns columns{.points = tile.points,
                                  .count = rows.count,
                                  .value = out_.value == nullptr ? nullptr : tile.value,
                                  .gradient = tile.gradient,
                                  .evaluations = tile.evaluations,
                                  .witness = out_.witness == nullptr ? nullptr : tile.witness};
    evaluate_gradient(rule_, rows.tape, *target_.kernels, columns, worker.arena.take<float>(scratch_floats(tape_)));
    for (std::size_t i = 0; i < rows.count; ++i) store(rows[i], i, tile, worker.summary);
  }

  void run_ties(const Rows& rows, Arena& arena) const {
    const TileColumns tile = take(rows.count, arena);
    load(rows, tile);
    const Ties ties = Ties::make(arena, tape_.dimension, rows.count, out_.one_sided != nullptr);
    find_ties(rows.tape, *target_.kernels, tile.points, rows.count, ties, arena.take<float>(scratch_floats(tape_)),
              arena);
    for (std::size_t i = 0; i < rows.count; ++i) {
      const std::size_t row = rows[i];
      const bool bad = is_bad(row);
      if (out_.ambiguous != nullptr) out_.ambiguous[row] = bad ? 0 : ties.tied[i];
      if (out_.one_sided == nullptr) continue;
      float* to = out_.one_sided + 2 * d_ * row;
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

  void load(const Rows& rows, const TileColumns& tile) const {
    for (std::size_t i = 0; i < rows.count; ++i) {
      const bool bad = is_bad(rows[i]);
      for (std::size_t axis = 0; axis < d_; ++axis) {
        tile.points[axis][i] = bad ? 0 : points_.rows[rows[i] * d_ + axis];
      }
    }
  }

  void store(std::size_t row, std::size_t i, const TileColumns& tile, EvaluateSummary& summary) const {
    bool bad = is_bad(row);
    summary.bad_rows += bad ? 1 : 0;
    summary.evaluations += bad ? 0 : tile.evaluations[i];
    if (out_.evaluations != nullptr) out_.evaluations[row] = bad ? 0 : tile.evaluations[i];
    if (!bad && out_.value != nullptr && std::isnan(tile.value[i])) {
      ++summary.undefined_rows;
      bad = true;
    }
    if (out_.value != nullptr) out_.value[row] = bad ? kNan : tile.value[i];
    for (std::size_t axis = 0; axis < d_; ++axis) {
      out_.gradient[row * d_ + axis] = bad ? kNan : tile.gradient[axis][i];
      if (out_.witness != nullptr) out_.witness[row * d_ + axis] = bad ? kNan : tile.witness[axis][i];
    }
  }

  const Tape& tape_;
  const Points points_;
  const PointColumns out_;
  const Execution& execution_;
  const Target& target_;
  GradientRule rule_;
  std::size_t d_ = 2;
  Reused<std::vector<std::unique_ptr<Worker>>> workers_;
};

}  // namespace

std::size_t evaluate(const Tape& tape, const float* points, std::size_t count, float* value, float* gradient,
                     const Execution& execution) {
  EvaluateTask task(tape, {points, count}, {.value = value, .gradient = gradient}, execution);
  return task.run().bad_rows;
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
  return task.run();
}

}  // namespace thalweg
