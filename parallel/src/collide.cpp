// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of triangles and circles: plans once, solves tile by tile, counts the answers.
#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "ordered_rows.h"
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

/// A tile's own result columns, for rows that are answered in another order than the caller's.
class ResultBuffer {
 public:
  /// Room for `count` rows of every column that `wanted` has.
  const CollideColumns& take(const CollideColumns& wanted, std::size_t count, int dimension) {
    arena_.reset();
    for_each_column(
        dimension,
        [&]<class T>(std::size_t width, T*& own, T* const& asked) {
          own = asked == nullptr ? nullptr : arena_.take<T>(count * width);
        },
        columns_, wanted);
    return columns_;
  }
  /// Row i goes to row order[i] of the caller's columns.
  void scatter(std::span<const std::uint32_t> order, const CollideColumns& to, int dimension) const {
    for_each_column(
        dimension,
        [&]<class T>(std::size_t width, T* const& own, T* const& out) {
          for (std::size_t i = 0; out != nullptr && i < order.size(); ++i) {
            for (std::size_t k = 0; k < width; ++k) out[order[i] * width + k] = own[i * width + k];
          }
        },
        columns_, to);
  }

 private:
  Arena arena_;
  CollideColumns columns_;
};

/// What one worker keeps from tile to tile.
struct Worker {
  explicit Worker(const Tape& tape) : scratch(tape) {}
  TileScratch scratch;
  std::vector<std::uint8_t> status;
  std::vector<std::uint32_t> evaluations;
  Summary summary;
  // Of ordered rows.
  std::unique_ptr<OrderedRows> ordered;
  ResultBuffer results;
};

template <class Tile>
class CollideTask final : public TileTask {
 public:
  CollideTask(const Tape& tape, const SolveLimits& limits, const Queries& queries, const CollideColumns& columns,
              const Execution& execution)
      : tape_(tape),
        limits_(limits),
        queries_(queries),
        columns_(columns),
        execution_(execution),
        workers_(worker_count(execution)) {
    target_ = execution.target == nullptr ? &default_target() : execution.target;
    layout_.dimension = static_cast<std::size_t>(tape.dimension);
    layout_.points = std::is_same_v<Tile, TriangleTile> ? 3 : 1;
    layout_.has_radius = !std::is_same_v<Tile, TriangleTile>;
    // Local methods, and gradients by probes, evaluate outside of the queries, where a tape shortened for them says
    // nothing; contacts are written in place.
    const bool stays_inside = limits.method == Method::certified && limits.normals.strategy == Gradient::autodiff;
    if (stays_inside && limits.contacts == 0 && tape.instructions.size() >= kLongTape &&
        queries.count >= kOrderedTile && queries.count < std::numeric_limits<std::uint32_t>::max()) {
      order_ = spatial_order(layout_, queries.rows, queries.count);
    }
  }

  /// Rows for one call of run().
  [[nodiscard]] std::size_t rows_per_task() const {
    return order_.empty() ? tile_for(limits_, queries_.count, execution_) : ordered_tile() * kBlockTiles;
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    std::unique_ptr<Worker>& worker = workers_[index];
    if (worker == nullptr) worker = std::make_unique<Worker>(tape_);
    if (order_.empty()) {
      answer(tape_, queries_.rows + begin * layout_.width(), end - begin,
             columns_from(columns_, begin, tape_.dimension, limits_.contacts), *worker);
    } else {
      run_ordered({order_.data() + begin, end - begin}, *worker);
    }
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
  [[nodiscard]] std::size_t ordered_tile() const { return execution_.tile == 0 ? kOrderedTile : execution_.tile; }

  void run_ordered(std::span<const std::uint32_t> order, Worker& worker) {
    if (worker.ordered == nullptr) {
      const float around = limits_.goal == Goal::deepest ? limits_.far_reaches : 0;
      worker.ordered = std::make_unique<OrderedRows>(tape_, layout_, true, around);
    }
    OrderedRows& rows = *worker.ordered;
    rows.take(queries_.rows, order, ordered_tile(), *target_->kernels);
    for (std::size_t begin = 0; begin < order.size(); begin += ordered_tile()) {
      const auto own = order.subspan(begin, std::min(ordered_tile(), order.size() - begin));
      const CollideColumns& results = worker.results.take(columns_, own.size(), tape_.dimension);
      answer(rows.tape_of(begin / ordered_tile()), rows.rows() + begin * layout_.width(), own.size(), results, worker);
      worker.results.scatter(own, columns_, tape_.dimension);
    }
  }

  void answer(const Tape& tape, const float* rows, std::size_t count, const CollideColumns& columns, Worker& worker) {
    worker.status.resize(count);
    worker.evaluations.resize(count);
    worker.scratch.twin.use(tape);
    Tile tile;
    tile.tape = &tape;
    tile.kernels = target_->kernels;
    tile.limits = &limits_;
    tile.rows = rows;
    tile.count = count;
    tile.columns = columns;
    // The summary counts what the caller may not have asked for.
    if (tile.columns.status == nullptr) tile.columns.status = worker.status.data();
    if (tile.columns.evaluations == nullptr) tile.columns.evaluations = worker.evaluations.data();
    solve(tile, worker.scratch);
    worker.summary.rows += count;
    count_statuses({tile.columns.status, count}, worker.summary);
    worker.summary.evaluations +=
        std::accumulate(tile.columns.evaluations, tile.columns.evaluations + count, std::uint64_t{0});
  }

  const Tape& tape_;
  const SolveLimits& limits_;
  const Queries& queries_;
  const CollideColumns& columns_;
  const Execution& execution_;
  const Target* target_;
  RowLayout layout_;
  std::vector<std::uint32_t> order_;  ///< empty: the caller's
  std::vector<std::unique_ptr<Worker>> workers_;
};

template <class Tile>
Result<Summary> collide(QueryKind kind, const Tape& tape, const Queries& queries, const CollideOptions& options,
                        const CollideColumns& columns, const Execution& execution) {
  const auto limits = plan(tape, kind, options);
  if (!limits) return limits.error();
  CollideTask<Tile> task(tape, *limits, queries, columns, execution);
  const bool complete = schedule(task, queries.count, task.rows_per_task(), execution);
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
