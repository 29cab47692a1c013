// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What batches of pairs have in common, whatever is asked of them: workers' memory, columns that the summary needs and
// the caller does not, and the summary.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "schedule.h"
#include "solve/pairs/pair_tile.h"
#include "thalweg/batch.h"

namespace thalweg {

/// What a batch leaves for the next one.
struct PairMemory {
  std::vector<std::unique_ptr<PairScratch>> workers;
  // Columns that the caller does not ask for.
  std::vector<std::uint8_t> status;
  std::vector<std::uint32_t> evaluations;
  std::vector<float> point, contact_point;
};

/// Room for `count` entries, where they are wanted.
template <class T>
T* room(std::vector<T>& memory, T* asked, std::size_t count) {
  if (asked != nullptr || count == 0) return asked;
  if (memory.size() < count) memory.resize(count);
  return memory.data();
}

/// Calls solve(begin, end, scratch) for each tile.
template <class Solve>
class PairTask final : public TileTask {
 public:
  PairTask(const PairQueries& queries, std::vector<std::unique_ptr<PairScratch>>& workers, const Execution& execution,
           Solve solve)
      : workers_(workers), solve_(std::move(solve)) {
    workers_.resize(std::max(workers_.size(), worker_count(execution)));
    for (const auto& scratch : workers_) {
      if (scratch != nullptr) scratch->begin(queries);
    }
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    std::unique_ptr<PairScratch>& scratch = workers_[index];
    if (scratch == nullptr) scratch = std::make_unique<PairScratch>();
    solve_(begin, end, *scratch);
  }

 private:
  std::vector<std::unique_ptr<PairScratch>>& workers_;
  Solve solve_;
};

/// Runs all tiles, and counts what the columns hold then.
template <class Solve>
Summary run_pairs(const PairQueries& queries, PairMemory& memory, const Execution& execution, std::size_t tile,
                  const std::uint8_t* status, const std::uint32_t* evaluations, Solve solve) {
  PairTask<Solve> task(queries, memory.workers, execution, std::move(solve));
  Summary summary;
  summary.cancelled = !schedule(task, queries.count, execution.tile == 0 ? tile : execution.tile, execution);
  summary.rows = queries.count;
  for (std::size_t i = 0; !summary.cancelled && i < queries.count; ++i) {
    ++summary.by_status[std::min<std::size_t>(status[i], 4)];
    summary.evaluations += evaluations[i];
  }
  return summary;
}

}  // namespace thalweg
