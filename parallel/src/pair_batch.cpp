// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Rows of the same two shapes are answered together, whatever lies between them: a search takes them side by side, and
// those near a long tape follow one another in space (ordered_pairs.h).
#include "pair_batch.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>

#include "ordered_pairs.h"
#include "schedule.h"
#include "solve/pairs/problem.h"

namespace thalweg {
namespace {

/// Tiles of rows in the caller's order, or of a list of them.
class PairTask final : public TileTask {
 public:
  PairTask(const PairBatch& batch, const std::uint32_t* rows, PairMemory& memory)
      : batch_(batch), rows_(rows), memory_(memory) {}

  void run(std::size_t begin, std::size_t end, std::size_t worker) override {
    PairTile tile = batch_.all;
    tile.begin = begin;
    tile.count = end - begin;
    if (rows_ != nullptr) tile.rows = rows_ + begin;
    batch_.answer(tile, memory_.worker(worker));
  }

 private:
  const PairBatch& batch_;
  const std::uint32_t* rows_;
  PairMemory& memory_;
};

/// Whether it matters which rows are answered together.
bool gains_by_company(const PairTile& all) {
  const std::span shapes(all.queries->shapes, all.queries->shape_count);
  return all.options->goal == Goal::deepest || all.contacts.found != nullptr ||
         std::ranges::any_of(shapes, [](const Tape* tape) { return tape->instructions.size() >= kLongTape; });
}

/// Rows by their shapes, and in the caller's order where those are the same.
void sort_by_shapes(const PairQueries& queries, std::vector<std::uint32_t>& rows) {
  rows.resize(queries.count);
  std::iota(rows.begin(), rows.end(), 0U);
  const auto key = [&](std::uint32_t row) {
    const PairShapes shapes = shapes_of(queries, row);
    return std::tuple(shapes.first, shapes.second, row);
  };
  if (!std::ranges::is_sorted(rows, {}, key)) std::ranges::sort(rows, {}, key);
}

/// Answers the rows near long tapes and lists the others. False if it was cancelled.
bool run_ordered(const PairBatch& batch, PairMemory& memory, const Execution& execution) {
  const PairQueries& queries = *batch.all.queries;
  sort_by_shapes(queries, memory.by_shapes);
  memory.unordered.clear();
  const std::span<const std::uint32_t> rows(memory.by_shapes);
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    const PairShapes shapes = shapes_of(queries, rows[begin]);
    while (end < rows.size() && shapes_of(queries, rows[end]) == shapes) ++end;
    OrderedPairs ordered(batch, shapes, rows.subspan(begin, end - begin), memory);
    if (!ordered.pays()) {
      memory.unordered.insert(memory.unordered.end(), rows.begin() + static_cast<std::ptrdiff_t>(begin),
                              rows.begin() + static_cast<std::ptrdiff_t>(end));
    } else if (!ordered.run(execution)) {
      return false;
    }
  }
  return true;
}

bool run_all(const PairBatch& batch, PairMemory& memory, const Execution& execution) {
  const PairQueries& queries = *batch.all.queries;
  const bool is_listed = queries.count <= std::numeric_limits<std::uint32_t>::max() && gains_by_company(batch.all);
  if (is_listed && !run_ordered(batch, memory, execution)) return false;
  PairTask task(batch, is_listed ? memory.unordered.data() : nullptr, memory);
  return schedule(task, is_listed ? memory.unordered.size() : queries.count,
                  execution.tile == 0 ? batch.tile : execution.tile, execution);
}

}  // namespace

Summary run_pairs(const PairBatch& batch, PairMemory& memory, const Execution& execution) {
  const PairQueries& queries = *batch.all.queries;
  memory.workers.resize(std::max(memory.workers.size(), worker_count(execution)));
  memory.parts.resize(memory.workers.size());
  for (const auto& scratch : memory.workers) {
    if (scratch != nullptr) scratch->begin(queries);
  }
  Summary summary;
  summary.cancelled = !run_all(batch, memory, execution);
  summary.rows = queries.count;
  for (std::size_t i = 0; !summary.cancelled && i < queries.count; ++i) {
    ++summary.by_status[std::min<std::size_t>(batch.status[i], 4)];
    summary.evaluations += batch.evaluations[i];
  }
  return summary;
}

}  // namespace thalweg
