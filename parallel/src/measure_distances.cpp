// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of distances.
#include "pair_batch.h"
#include "reuse.h"
#include "solve/distance/distance_tile.h"
#include "solve/pairs/problem.h"

namespace thalweg {
namespace {

/// Queries per tile: a distance takes microseconds.
constexpr std::size_t kTile = 16;

struct DistanceBatch final : PairBatch {
  const DistanceOptions* options = nullptr;
  DistanceColumns columns;

  void answer(const PairTile& rows, PairScratch& scratch) const override {
    rows.kernels->certify_distances({.pairs = rows, .options = options, .columns = columns}, scratch);
  }
};

}  // namespace

Result<Summary> measure_distances(const PairQueries& queries, const DistanceOptions& options,
                                  const DistanceColumns& columns, const Execution& execution) {
  PairOptions of_pairs;
  of_pairs.tolerance = options.tolerance;
  of_pairs.budget = options.budget;
  const auto checked = check_pairs(queries, of_pairs);
  if (!checked) return checked.error();
  const Reused<PairMemory> memory;
  DistanceBatch batch;
  batch.tile = kTile;
  batch.measures = true;
  batch.all.queries = &queries;
  batch.all.options = &of_pairs;
  batch.all.kernels = (execution.target == nullptr ? &default_target() : execution.target)->kernels;
  batch.options = &options;
  batch.columns = columns;
  batch.status = batch.columns.status = room(memory->status, columns.status, queries.count);
  batch.evaluations = batch.columns.evaluations = room(memory->evaluations, columns.evaluations, queries.count);
  return run_pairs(batch, *memory, execution);
}

}  // namespace thalweg
