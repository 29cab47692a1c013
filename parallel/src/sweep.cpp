// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of moving triangles and circles: tile by tile, or, near a long tape, in the order of where they pass.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "ordered_batch.h"
#include "reuse.h"
#include "schedule.h"
#include "solve/sweep/path.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Queries of a tile: a search takes some hundred nanoseconds, and lanes run dry at the end of each tile.
constexpr std::size_t kMostTile = 4096;
constexpr std::size_t kLeastTile = 256;
constexpr std::size_t kTilesPerWorker = 8;
/// Of parts near a long tape: a few queries take hundreds of looks, and would have the lanes of a small part for
/// themselves (measured, growth/sweeps).
constexpr PartSizes kParts{.most = 4096, .few = 256};

/// Calls visit(width, columns.c...) for every column c, with its numbers per row.
template <class Visit, class... Columns>
void for_each_column(std::size_t d, Visit&& visit, Columns&... columns) {
  visit(std::size_t{1}, columns.status...);
  visit(std::size_t{1}, columns.toi_lower...);
  visit(std::size_t{1}, columns.toi_upper...);
  visit(std::size_t{1}, columns.converged...);
  visit(std::size_t{1}, columns.value...);
  visit(d, columns.point...);
  visit(d, columns.normal...);
  visit(std::size_t{3}, columns.barycentric...);
  visit(std::size_t{1}, columns.evaluations...);
}

/// What a worker keeps.
struct Worker {
  SweepScratch scratch;
  Arena gathered;  ///< queries of a part side by side, and their results
};

struct SweepMemory {
  std::vector<std::unique_ptr<Worker>> workers;
  std::vector<float> boxes;
  // Columns that the caller does not ask for.
  std::vector<std::uint8_t> status;
  std::vector<std::uint32_t> evaluations;
};

Error refused(std::string_view place, std::string_view expected, std::string_view found) {
  return {.file = "", .place = std::string(place), .expected = std::string(expected), .found = std::string(found)};
}

std::optional<Error> refusal(const Tape& tape, const SweepQueries& queries, const SweepOptions& options) {
  if (tape.has_formulas || !std::isfinite(tape.facts.lipschitz)) {
    return refused("SCENE", "a shape with a Lipschitz constant", "a formula");
  }
  if (options.tolerance != 0 && !(options.tolerance >= 1e-5 && options.tolerance <= 1)) {
    return refused("--tolerance", "a part of the motion's time, from 1e-5 to 1 (0: the default)", "another number");
  }
  if (options.budget < 6) return refused("--budget", "at least 6 evaluations", std::to_string(options.budget));
  if (queries.count > 0 && (queries.ends == nullptr) == (queries.motions == nullptr)) {
    return refused("--motions", "either ends or motions", queries.ends == nullptr ? "neither" : "both");
  }
  return std::nullopt;
}

template <class Tile>
class SweepTask final : public TileTask, public OrderedBatch::Answer {
 public:
  static constexpr bool kIsBall = std::is_same_v<Tile, BallSweepTile>;

  SweepTask(Tile all, SweepMemory& memory, const Execution& execution)
      : all_(std::move(all)),
        memory_(memory),
        execution_(execution),
        d_(static_cast<std::size_t>(all_.tape->dimension)) {
    memory_.workers.resize(std::max(memory_.workers.size(), worker_count(execution)));
    all_.stays_near = all_.tape->instructions.size() >= kLongTape;
  }

  /// False if it was cancelled.
  bool run() {
    const std::size_t count = all_.queries.count;
    if (OrderedBatch::suits_queries(*all_.tape, count, kLeastTile)) return run_in_order();
    const std::size_t share = count / (kTilesPerWorker * worker_count(execution_));
    const std::size_t tile = std::clamp(share, kLeastTile, kMostTile);
    return schedule(*this, count, execution_.tile == 0 ? tile : execution_.tile, execution_);
  }

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    Tile tile = all_;
    move_to(tile, begin);
    tile.queries.count = end - begin;
    solve(tile, worker(index).scratch);
  }

  void answer(const OrderedBatch::Part& part) override {
    Worker& own = worker(part.worker);
    own.gathered.reset();
    Tile tile = all_;
    tile.tape = &part.tape;
    tile.queries.count = part.order.size();
    tile.queries.rows = gather(all_.queries.rows, query_width(), part.order, own.gathered);
    tile.queries.ends = gather(all_.queries.ends, query_width(), part.order, own.gathered);
    tile.queries.motions = gather(all_.queries.motions, motion_width(), part.order, own.gathered);
    for_each_column(
        d_,
        [&]<class T>(std::size_t width, T*& column, T* const& asked) {
          column = asked == nullptr ? nullptr : own.gathered.template take<T>(width * part.order.size());
        },
        tile.columns, all_.columns);
    solve(tile, own.scratch);
    for_each_column(
        d_,
        [&]<class T>(std::size_t width, T* const& from, T* const& to) {
          for (std::size_t i = 0; to != nullptr && i < part.order.size(); ++i) {
            std::copy_n(from + width * i, width, to + width * part.order[i]);
          }
        },
        tile.columns, all_.columns);
  }

 private:
  [[nodiscard]] std::size_t query_width() const { return kIsBall ? d_ + 1 : 3 * d_; }
  [[nodiscard]] std::size_t motion_width() const { return d_ == 2 ? 3 : 7; }

  Worker& worker(std::size_t index) {
    std::unique_ptr<Worker>& own = memory_.workers[index];
    if (own == nullptr) own = std::make_unique<Worker>();
    return *own;
  }

  static void solve(const Tile& tile, SweepScratch& scratch) {
    if constexpr (kIsBall) {
      tile.kernels->sweep_balls(tile, scratch);
    } else {
      tile.kernels->sweep_triangles(tile, scratch);
    }
  }

  /// By the boxes that paths lie in with all that is asked around them.
  bool run_in_order() {
    memory_.boxes.resize(std::max(memory_.boxes.size(), 2 * d_ * all_.queries.count));
    prepare_rows(all_.queries.count, kLeastTile, execution_, [this](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t row = begin; row < end; ++row) write_box(row);
    });
    const RowLayout layout{.dimension = d_, .points = 2, .has_radius = false};
    OrderedBatch batch(*all_.tape, layout, memory_.boxes.data(), all_.queries.count, {}, execution_, kParts);
    return batch.run(*this);
  }
  void write_box(std::size_t row) {
    const Bounds box = box_of(all_, row, kIsBall);
    for (std::size_t axis = 0; axis < d_; ++axis) {
      memory_.boxes[2 * d_ * row + axis] = static_cast<float>(box.lo[axis]);
      memory_.boxes[2 * d_ * row + d_ + axis] = static_cast<float>(box.hi[axis]);
    }
  }

  static const float* gather(const float* from, std::size_t width, std::span<const std::uint32_t> order, Arena& arena) {
    if (from == nullptr) return nullptr;
    float* const to = arena.take<float>(width * order.size());
    for (std::size_t i = 0; i < order.size(); ++i) std::copy_n(from + width * order[i], width, to + width * i);
    return to;
  }

  void move_to(Tile& tile, std::size_t row) const {
    tile.queries.rows += row * query_width();
    if (tile.queries.ends != nullptr) tile.queries.ends += row * query_width();
    if (tile.queries.motions != nullptr) tile.queries.motions += row * motion_width();
    for_each_column(
        d_,
        [row](std::size_t width, auto*& column) {
          if (column != nullptr) column += width * row;
        },
        tile.columns);
  }

  Tile all_;
  SweepMemory& memory_;
  const Execution& execution_;
  std::size_t d_;
};

template <class Tile>
Result<Summary> sweep(const Tape& tape, const SweepQueries& queries, const SweepOptions& options,
                      const SweepColumns& columns, const Execution& execution) {
  if (auto error = refusal(tape, queries, options)) return *std::move(error);
  const Reused<SweepMemory> memory;
  Tile all;
  all.tape = &tape;
  all.kernels = (execution.target == nullptr ? &default_target() : execution.target)->kernels;
  all.tolerance = static_cast<float>(options.tolerance > 0 ? options.tolerance : kDefaultSweepTolerance);
  all.budget = options.budget;
  all.queries = queries;
  all.columns = columns;
  // The summary counts what the caller may not have asked for.
  const std::uint8_t* const status = all.columns.status = room(memory->status, columns.status, queries.count);
  const std::uint32_t* const evaluations = all.columns.evaluations =
      room(memory->evaluations, columns.evaluations, queries.count);
  Summary summary;
  summary.cancelled = !SweepTask<Tile>(all, *memory, execution).run();
  summary.rows = queries.count;
  for (std::size_t i = 0; !summary.cancelled && i < queries.count; ++i) {
    ++summary.by_status[std::min<std::size_t>(status[i], 4)];
    summary.evaluations += evaluations[i];
  }
  return summary;
}

}  // namespace

Result<Summary> sweep_triangles(const Tape& tape, const SweepQueries& queries, const SweepOptions& options,
                                const SweepColumns& columns, const Execution& execution) {
  return sweep<TriangleSweepTile>(tape, queries, options, columns, execution);
}

Result<Summary> sweep_circles(const Tape& tape, const SweepQueries& queries, const SweepOptions& options,
                              const SweepColumns& columns, const Execution& execution) {
  if (queries.ends != nullptr) return refused("--circles", "motions of the scene", "ends");
  SweepColumns wanted = columns;
  wanted.barycentric = nullptr;
  return sweep<BallSweepTile>(tape, queries, options, wanted, execution);
}

}  // namespace thalweg
