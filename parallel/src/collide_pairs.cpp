// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of pairs of shapes.
#include "pair_batch.h"
#include "reuse.h"
#include "solve/pairs/local.h"
#include "solve/pairs/problem.h"

namespace thalweg {
namespace {

/// Queries per tile: a pair takes microseconds, a hard one a millisecond.
constexpr std::size_t kTile = 32;

struct CollideBatch final : PairBatch {
  void answer(const PairTile& rows, PairScratch& scratch) const override { solve(rows, scratch); }
};

}  // namespace

Result<Summary> collide_pairs(const PairQueries& queries, const PairOptions& options, const CollideColumns& columns,
                              const PairContacts& contacts, const Execution& execution, const PairPaths& paths) {
  const auto checked = check_pairs(queries, options);
  if (!checked) return checked.error();
  // Normals by a strategy are taken where the points are.
  const bool wants_points = strategy_of(options) != Gradient::autodiff && queries.count > 0;
  const std::size_t floats = wants_points ? queries.count * static_cast<std::size_t>(queries.shapes[0]->dimension) : 0;
  const Reused<PairMemory> memory;
  CollideBatch batch;
  batch.tile = kTile;
  PairTile& all = batch.all;
  all.queries = &queries;
  all.options = &options;
  all.kernels = (execution.target == nullptr ? &default_target() : execution.target)->kernels;
  all.columns = columns;
  // The summary counts what the caller may not have asked for.
  batch.status = all.columns.status = room(memory->status, columns.status, queries.count);
  batch.evaluations = all.columns.evaluations = room(memory->evaluations, columns.evaluations, queries.count);
  all.columns.point = room(memory->point, columns.point, floats);
  all.contacts = contacts;
  if (contacts.normal != nullptr) {
    all.contacts.point = room(memory->contact_point, contacts.point, floats * contacts.capacity);
  }
  all.paths = paths;
  return run_pairs(batch, *memory, execution);
}

}  // namespace thalweg
