// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of distances.
#include <algorithm>
#include <memory>
#include <vector>

#include "reuse.h"
#include "schedule.h"
#include "solve/distance/distance_tile.h"
#include "solve/pairs/problem.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Queries per tile: a distance takes tens of microseconds.
constexpr std::size_t kTile = 16;

/// What a batch leaves for the next one.
struct Memory {
  std::vector<std::unique_ptr<PairScratch>> workers;
  // Columns that the caller does not ask for.
  std::vector<std::uint8_t> status;
  std::vector<std::uint32_t> evaluations;
};

/// Room for `count` entries, where they are wanted.
template <class T>
T* room(std::vector<T>& memory, T* asked, std::size_t count) {
  if (asked != nullptr) return asked;
  if (memory.size() < count) memory.resize(count);
  return memory.data();
}

class DistanceTask final : public TileTask {
 public:
  DistanceTask(const DistanceTile& all, Memory& memory, const Execution& execution)
      : all_(all), workers_(memory.workers) {
    workers_.resize(std::max(workers_.size(), worker_count(execution)));
    for (const auto& scratch : workers_) {
      if (scratch != nullptr) scratch->begin(*all.pairs.queries);
    }
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    std::unique_ptr<PairScratch>& scratch = workers_[index];
    if (scratch == nullptr) scratch = std::make_unique<PairScratch>();
    DistanceTile tile = all_;
    tile.pairs.begin = begin;
    tile.pairs.count = end - begin;
    tile.pairs.kernels->certify_distances(tile, *scratch);
  }

 private:
  const DistanceTile& all_;
  std::vector<std::unique_ptr<PairScratch>>& workers_;
};

}  // namespace

Result<Summary> measure_distances(const PairQueries& queries, const DistanceOptions& options,
                                  const DistanceColumns& columns, const Execution& execution) {
  PairOptions of_pairs;
  of_pairs.tolerance = options.tolerance;
  of_pairs.budget = options.budget;
  const auto checked = check_pairs(queries, of_pairs);
  if (!checked) return checked.error();
  const Reused<Memory> memory;
  DistanceTile all;
  all.pairs.queries = &queries;
  all.pairs.options = &of_pairs;
  all.pairs.kernels = (execution.target == nullptr ? &default_target() : execution.target)->kernels;
  all.options = &options;
  all.columns = columns;
  all.columns.status = room(memory->status, columns.status, queries.count);
  all.columns.evaluations = room(memory->evaluations, columns.evaluations, queries.count);
  DistanceTask task(all, *memory, execution);
  Summary summary;
  summary.cancelled = !schedule(task, queries.count, execution.tile == 0 ? kTile : execution.tile, execution);
  summary.rows = queries.count;
  for (std::size_t i = 0; !summary.cancelled && i < queries.count; ++i) {
    ++summary.by_status[std::min<std::size_t>(all.columns.status[i], 4)];
    summary.evaluations += all.columns.evaluations[i];
  }
  return summary;
}

}  // namespace thalweg
