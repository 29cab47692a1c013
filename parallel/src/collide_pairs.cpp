// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of pairs of shapes.
#include <algorithm>
#include <memory>
#include <vector>

#include "reuse.h"
#include "schedule.h"
#include "solve/pairs/local.h"
#include "solve/pairs/problem.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Queries per tile: a pair takes microseconds, a hard one a millisecond.
constexpr std::size_t kTile = 32;

/// What a batch leaves for the next one.
struct Memory {
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

class PairTask final : public TileTask {
 public:
  PairTask(const PairTile& all, Memory& memory, const Execution& execution) : all_(all), workers_(memory.workers) {
    workers_.resize(std::max(workers_.size(), worker_count(execution)));
    for (const auto& scratch : workers_) {
      if (scratch != nullptr) scratch->begin(*all.queries);
    }
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    std::unique_ptr<PairScratch>& scratch = workers_[index];
    if (scratch == nullptr) scratch = std::make_unique<PairScratch>();
    PairTile tile = all_;
    tile.begin = begin;
    tile.count = end - begin;
    solve(tile, *scratch);
  }

 private:
  const PairTile& all_;
  std::vector<std::unique_ptr<PairScratch>>& workers_;
};

}  // namespace

Result<Summary> collide_pairs(const PairQueries& queries, const PairOptions& options, const CollideColumns& columns,
                              const PairContacts& contacts, const Execution& execution, const PairPaths& paths) {
  const auto checked = check_pairs(queries, options);
  if (!checked) return checked.error();
  // Normals by a strategy are taken where the points are.
  const bool wants_points = strategy_of(options) != Gradient::autodiff && queries.count > 0;
  const std::size_t floats = wants_points ? queries.count * static_cast<std::size_t>(queries.shapes[0]->dimension) : 0;
  const Reused<Memory> memory;
  PairTile all;
  all.queries = &queries;
  all.options = &options;
  all.kernels = (execution.target == nullptr ? &default_target() : execution.target)->kernels;
  all.columns = columns;
  // The summary counts what the caller may not have asked for.
  all.columns.status = room(memory->status, columns.status, queries.count);
  all.columns.evaluations = room(memory->evaluations, columns.evaluations, queries.count);
  all.columns.point = room(memory->point, columns.point, floats);
  all.contacts = contacts;
  if (contacts.normal != nullptr) {
    all.contacts.point = room(memory->contact_point, contacts.point, floats * contacts.capacity);
  }
  all.paths = paths;
  PairTask task(all, *memory, execution);
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
