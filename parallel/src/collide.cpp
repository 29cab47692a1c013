// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of triangles and circles: plans once, solves tile by tile, counts the answers.
#include <algorithm>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "ordered_batch.h"
#include "reuse.h"
#include "schedule.h"
#include "solve/plan.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Queries per tile. Certified ones take some ten or hundred nanoseconds each, and the lanes of a large tile stay full
/// for longer; its columns still fit the second-level cache. Everything else takes long enough for small tiles to
/// balance the load.
constexpr std::size_t kCertifiedTile = 8192;
constexpr std::size_t kTile = 1024;
constexpr std::size_t kLeastTile = 256;
/// Tiles for each worker, at least, as long as they stay above the least size.
constexpr std::size_t kTilesPerWorker = 8;

/// No result depends on it.
std::size_t tile_for(const SolveLimits& limits, std::size_t count, const Execution& execution) {
  if (execution.tile != 0) return execution.tile;
  const bool quick = limits.method == Method::certified;
  const std::size_t share = count / (kTilesPerWorker * worker_count(execution)) / kLeastTile * kLeastTile;
  return std::clamp(share, kLeastTile, quick ? kCertifiedTile : kTile);
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

/// What one worker keeps from tile to tile, and from batch to batch.
struct Worker {
  TileScratch scratch;
  std::vector<std::uint8_t> status;
  std::vector<std::uint32_t> evaluations;
  ResultBuffer results;
  Summary summary;
};

/// Where a search evaluates besides its queries.
Surroundings surroundings_of(const SolveLimits& limits) {
  Surroundings around{.bounds = limits.method == Method::certified, .sizes = 0, .probe = {}};
  if (limits.method == Method::certified) around.sizes = limits.far_reaches;
  for (const GradientRule& rule : {limits.gradient, limits.normals}) {
    if (rule.strategy == Gradient::autodiff) continue;
    around.probe.absolute = std::max(around.probe.absolute, rule.probe.absolute);
    around.probe.of_value = std::max(around.probe.of_value, rule.probe.of_value);
  }
  return around;
}

template <class Tile>
class CollideTask final : public TileTask, public OrderedBatch::Answer {
 public:
  CollideTask(const Tape& tape, const SolveLimits& limits, const Queries& queries, const CollideColumns& columns,
              const Execution& execution)
      : tape_(tape), limits_(limits), queries_(queries), columns_(columns), execution_(execution) {
    target_ = execution.target == nullptr ? &default_target() : execution.target;
    layout_.dimension = static_cast<std::size_t>(tape.dimension);
    layout_.points = std::is_same_v<Tile, TriangleTile> ? 3 : 1;
    layout_.has_radius = !std::is_same_v<Tile, TriangleTile>;
    workers_->resize(std::max(workers_->size(), worker_count(execution)));
    for (const auto& worker : *workers_) {
      if (worker != nullptr) worker->summary = {};
    }
  }

  Summary run() {
    bool complete = false;
    if (answers_in_order()) {
      OrderedBatch batch(tape_, layout_, queries_.rows, queries_.count, surroundings_of(limits_), execution_);
      complete = batch.run(*this);
    } else {
      complete = schedule(*this, queries_.count, tile_for(limits_, queries_.count, execution_), execution_);
    }
    Summary total;
    for (const auto& worker : *workers_) {
      if (worker == nullptr) continue;
      total.rows += worker->summary.rows;
      total.evaluations += worker->summary.evaluations;
      for (std::size_t i = 0; i < std::size(total.by_status); ++i) {
        total.by_status[i] += worker->summary.by_status[i];
      }
    }
    total.cancelled = !complete;
    return total;
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    answer(tape_, queries_.rows + begin * layout_.width(), end - begin,
           columns_from(columns_, begin, tape_.dimension, limits_.contacts), worker(index));
  }

  void answer(const OrderedBatch::Part& part) override {
    Worker& own = worker(part.worker);
    ResultBuffer::prefetch(part.order, columns_, tape_.dimension);
    const CollideColumns& results = own.results.take(columns_, part.order.size(), tape_.dimension, limits_.contacts);
    answer(part.tape, part.rows, part.order.size(), results, own);
    own.results.scatter(part.order, columns_, tape_.dimension);
    if (limits_.contacts > 0) {
      own.results.scatter_contacts(part.order, columns_.contacts, tape_.dimension, limits_.contacts);
    }
  }

 private:
  /// Nearest surface points, and the point of contact of a disc as published, may be anywhere, where a tape shortened
  /// for the queries says nothing.
  [[nodiscard]] bool answers_in_order() const {
    const bool stays = limits_.method != Method::published && limits_.gradient.strategy != Gradient::closest_point &&
                       limits_.normals.strategy != Gradient::closest_point;
    return stays && OrderedBatch::suits_queries(tape_, queries_.count, kLeastTile);
  }

  Worker& worker(std::size_t index) {
    std::unique_ptr<Worker>& own = (*workers_)[index];
    if (own == nullptr) own = std::make_unique<Worker>();
    return *own;
  }

  void answer(const Tape& tape, const float* rows, std::size_t count, const CollideColumns& columns, Worker& worker) {
    worker.status.resize(std::max(worker.status.size(), count));
    worker.evaluations.resize(std::max(worker.evaluations.size(), count));
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
  Reused<std::vector<std::unique_ptr<Worker>>> workers_;
};

template <class Tile>
Result<Summary> collide(QueryKind kind, const Tape& tape, const Queries& queries, const CollideOptions& options,
                        const CollideColumns& columns, const Execution& execution) {
  const auto limits = plan(tape, kind, options);
  if (!limits) return limits.error();
  return CollideTask<Tile>(tape, *limits, queries, columns, execution).run();
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
