// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of triangles and circles: plans once, solves tile by tile, counts the answers.
#include <algorithm>
#include <memory>
#include <mutex>
#include <vector>

#include "schedule.h"
#include "solve/plan.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Queries per tile: their columns fit the second-level cache, and a tile takes tens of microseconds.
constexpr std::size_t kTile = 1024;

void count_statuses(const std::uint8_t* status, std::size_t rows, Summary& summary) {
  for (std::size_t i = 0; i < rows; ++i) {
    ++summary.by_status[std::min<std::size_t>(status[i], 4)];
  }
}

/// What one worker keeps from tile to tile.
struct Worker {
  explicit Worker(const Tape& tape) : scratch(tape) {}
  TileScratch scratch;
  std::vector<std::uint8_t> status;
  std::vector<std::uint32_t> evaluations;
  Summary summary;
};

template <class Tile>
class CollideTask final : public TileTask {
 public:
  CollideTask(const Tape& tape, const SolveLimits& limits, const Queries& queries, const CollideColumns& columns,
              const Execution& execution)
      : tape_(tape), limits_(limits), queries_(queries), columns_(columns), workers_(worker_count(execution)) {
    target_ = execution.target == nullptr ? &default_target() : execution.target;
    const auto d = static_cast<std::size_t>(tape.dimension);
    width_ = std::is_same_v<Tile, TriangleTile> ? 3 * d : d + 1;
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    std::unique_ptr<Worker>& worker = workers_[index];
    if (worker == nullptr) worker = std::make_unique<Worker>(tape_);
    worker->status.resize(end - begin);
    worker->evaluations.resize(end - begin);
    Tile tile;
    tile.tape = &tape_;
    tile.kernels = target_->kernels;
    tile.limits = &limits_;
    tile.rows = queries_.rows + begin * width_;
    tile.count = end - begin;
    tile.columns = columns_from(columns_, begin, tape_.dimension);
    // The summary counts what the caller may not have asked for.
    if (tile.columns.status == nullptr) tile.columns.status = worker->status.data();
    if (tile.columns.evaluations == nullptr) tile.columns.evaluations = worker->evaluations.data();
    solve(tile, worker->scratch);
    worker->summary.rows += tile.count;
    count_statuses(tile.columns.status, tile.count, worker->summary);
    for (std::size_t i = 0; i < tile.count; ++i) worker->summary.evaluations += tile.columns.evaluations[i];
  }

  [[nodiscard]] Summary summary() const {
    Summary total;
    for (const auto& worker : workers_) {
      if (worker == nullptr) continue;
      total.rows += worker->summary.rows;
      total.evaluations += worker->summary.evaluations;
      for (std::size_t i = 0; i < 5; ++i) total.by_status[i] += worker->summary.by_status[i];
    }
    return total;
  }

 private:
  const Tape& tape_;
  const SolveLimits& limits_;
  const Queries& queries_;
  const CollideColumns& columns_;
  const Target* target_;
  std::size_t width_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

template <class Tile>
Result<Summary> collide(QueryKind kind, const Tape& tape, const Queries& queries, const CollideOptions& options,
                        const CollideColumns& columns, const Execution& execution) {
  const auto limits = plan(tape, kind, options);
  if (!limits) return limits.error();
  CollideTask<Tile> task(tape, *limits, queries, columns, execution);
  const bool complete = schedule(task, queries.count, execution.tile == 0 ? kTile : execution.tile, execution);
  Summary summary = task.summary();
  summary.cancelled = !complete;
  return summary;
}

}  // namespace

Result<Summary> collide_triangles(const Tape& tape, Queries triangles, const CollideOptions& options,
                                  const CollideColumns& columns, const Execution& execution) {
  return collide<TriangleTile>(QueryKind::triangles, tape, triangles, options, columns, execution);
}

Result<Summary> collide_circles(const Tape& tape, Queries circles, const CollideOptions& options,
                                const CollideColumns& columns, const Execution& execution) {
  return collide<CircleTile>(QueryKind::circles, tape, circles, options, columns, execution);
}

}  // namespace thalweg
