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

}  // namespace

Result<Summary> measure_distances(const PairQueries& queries, const DistanceOptions& options,
                                  const DistanceColumns& columns, const Execution& execution) {
  PairOptions of_pairs;
  of_pairs.tolerance = options.tolerance;
  of_pairs.budget = options.budget;
  const auto checked = check_pairs(queries, of_pairs);
  if (!checked) return checked.error();
  const Reused<PairMemory> memory;
  DistanceTile all;
  all.pairs.queries = &queries;
  all.pairs.options = &of_pairs;
  all.pairs.kernels = (execution.target == nullptr ? &default_target() : execution.target)->kernels;
  all.options = &options;
  all.columns = columns;
  all.columns.status = room(memory->status, columns.status, queries.count);
  all.columns.evaluations = room(memory->evaluations, columns.evaluations, queries.count);
  return run_pairs(queries, *memory, execution, kTile, all.columns.status, all.columns.evaluations,
                   [&all](std::size_t begin, std::size_t end, PairScratch& scratch) {
                     DistanceTile tile = all;
                     tile.pairs.begin = begin;
                     tile.pairs.count = end - begin;
                     tile.pairs.kernels->certify_distances(tile, scratch);
                   });
}

}  // namespace thalweg
