// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of triangles and circles: plans once, solves tile by tile, counts the answers.
#include <algorithm>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "schedule.h"
#include "solve/plan.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Queries per tile. Verdicts take tens of nanoseconds each, and the lanes of a large tile stay full for longer; its
/// columns still fit the second-level cache. Everything else takes long enough for small tiles to balance the load.
constexpr std::size_t kVerdictTile = 4096;
constexpr std::size_t kTile = 1024;
constexpr std::size_t kLeastTile = 256;
/// Tiles for each worker, at least, as long as they stay above the least size.
constexpr std::size_t kTilesPerWorker = 8;

/// No result depends on it.
std::size_t tile_for(const SolveLimits& limits, std::size_t count, const Execution& execution) {
  if (execution.tile != 0) return execution.tile;
  const bool quick = limits.method == Method::certified && limits.goal == Goal::verdict;
  const std::size_t share = count / (kTilesPerWorker * worker_count(execution)) / kLeastTile * kLeastTile;
  return std::clamp(share, kLeastTile, quick ? kVerdictTile : kTile);
}

/// Rows of one status. Counted in 32 bits, which the compiler does a whole vector at a time.
std::size_t count_of(std::span<const std::uint8_t> status, Status wanted) {
  std::uint32_t count = 0;
  for (const std::uint8_t found : status) count += found == static_cast<std::uint8_t>(wanted) ? 1U : 0U;
  return count;
}

void count_statuses(std::span<const std::uint8_t> status, Summary& summary) {
  const std::size_t separated = count_of(status, Status::separated);
  const std::size_t overlapping = count_of(status, Status::overlapping);
  summary.by_status[0] += separated;
  summary.by_status[1] += overlapping;
  if (separated + overlapping == status.size()) return;
  summary.by_status[2] += count_of(status, Status::touching);
  summary.by_status[3] += count_of(status, Status::undecided);
  summary.by_status[4] += count_of(status, Status::bad_row);
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
    count_statuses({tile.columns.status, tile.count}, worker->summary);
    worker->summary.evaluations +=
        std::accumulate(tile.columns.evaluations, tile.columns.evaluations + tile.count, std::uint64_t{0});
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
  const bool complete = schedule(task, queries.count, tile_for(*limits, queries.count, execution), execution);
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
