// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of pairs of shapes.
#include <algorithm>
#include <memory>
#include <vector>

#include "schedule.h"
#include "solve/pairs/local.h"
#include "solve/pairs/problem.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Queries per tile: a pair takes microseconds, a hard one a millisecond.
constexpr std::size_t kTile = 32;

class PairTask final : public TileTask {
 public:
  PairTask(const PairTile& all, const Execution& execution) : all_(all), workers_(worker_count(execution)) {}

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
  std::vector<std::unique_ptr<PairScratch>> workers_;
};

}  // namespace

Result<Summary> collide_pairs(const PairQueries& queries, const PairOptions& options, const CollideColumns& columns,
                              const PairContacts& contacts, const Execution& execution, const PairPaths& paths) {
  const auto checked = check_pairs(queries, options);
  if (!checked) return checked.error();
  // The summary counts what the caller may not have asked for.
  std::vector<std::uint8_t> status(columns.status == nullptr ? queries.count : 0);
  std::vector<std::uint32_t> evaluations(columns.evaluations == nullptr ? queries.count : 0);
  // Normals by a strategy are taken where the points are.
  const bool wants_points = strategy_of(options) != Gradient::autodiff && queries.count > 0;
  const std::size_t floats = wants_points ? queries.count * static_cast<std::size_t>(queries.shapes[0]->dimension) : 0;
  std::vector<float> point(columns.point == nullptr ? floats : 0);
  std::vector<float> contact_point(contacts.normal != nullptr && contacts.point == nullptr ? floats * contacts.capacity
                                                                                           : 0);
  PairTile all;
  all.queries = &queries;
  all.options = &options;
  all.kernels = (execution.target == nullptr ? &default_target() : execution.target)->kernels;
  all.columns = columns;
  if (columns.status == nullptr) all.columns.status = status.data();
  if (!point.empty()) all.columns.point = point.data();
  if (columns.evaluations == nullptr) all.columns.evaluations = evaluations.data();
  all.contacts = contacts;
  if (!contact_point.empty()) all.contacts.point = contact_point.data();
  all.paths = paths;
  PairTask task(all, execution);
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
