// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches of moving triangles and circles.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "reuse.h"
#include "schedule.h"
#include "solve/sweep/sweep_tile.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

/// Queries of a tile: a search takes some hundred nanoseconds, and lanes run dry at the end of each tile.
constexpr std::size_t kMostTile = 4096;
constexpr std::size_t kLeastTile = 256;
constexpr std::size_t kTilesPerWorker = 8;

struct SweepMemory {
  std::vector<std::unique_ptr<SweepScratch>> workers;
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

template <class T>
void advance(T*& pointer, std::size_t count) {
  if (pointer != nullptr) pointer += count;
}

/// The tile that begins at a row; `width` numbers are one of the queries.
void move_to(SweepTile& tile, std::size_t row, std::size_t width) {
  const auto d = static_cast<std::size_t>(tile.tape->dimension);
  advance(tile.queries.rows, row * width);
  advance(tile.queries.ends, row * width);
  advance(tile.queries.motions, row * (d == 2 ? 3 : 7));
  SweepColumns& out = tile.columns;
  for (std::uint8_t** column : {&out.status, &out.converged}) advance(*column, row);
  for (float** column : {&out.toi_lower, &out.toi_upper, &out.value}) advance(*column, row);
  for (float** column : {&out.point, &out.normal}) advance(*column, row * d);
  advance(out.barycentric, row * 3);
  advance(out.evaluations, row);
}

template <class Tile>
class SweepTask final : public TileTask {
 public:
  SweepTask(const Tile& all, std::size_t width, std::vector<std::unique_ptr<SweepScratch>>& workers)
      : all_(all), width_(width), workers_(workers) {}

  void run(std::size_t begin, std::size_t end, std::size_t index) override {
    std::unique_ptr<SweepScratch>& scratch = workers_[index];
    if (scratch == nullptr) scratch = std::make_unique<SweepScratch>();
    Tile tile = all_;
    move_to(tile, begin, width_);
    tile.queries.count = end - begin;
    if constexpr (std::is_same_v<Tile, TriangleSweepTile>) {
      tile.kernels->sweep_triangles(tile, *scratch);
    } else {
      tile.kernels->sweep_balls(tile, *scratch);
    }
  }

 private:
  const Tile& all_;
  std::size_t width_;
  std::vector<std::unique_ptr<SweepScratch>>& workers_;
};

template <class T>
T* room(std::vector<T>& memory, T* asked, std::size_t count) {
  if (asked != nullptr || count == 0) return asked;
  if (memory.size() < count) memory.resize(count);
  return memory.data();
}

template <class Tile>
Result<Summary> sweep(const Tape& tape, const SweepQueries& queries, const SweepOptions& options,
                      const SweepColumns& columns, const Execution& execution, std::size_t width) {
  if (auto error = refusal(tape, queries, options)) return *std::move(error);
  const Reused<SweepMemory> memory;
  memory->workers.resize(std::max(memory->workers.size(), worker_count(execution)));
  Tile all;
  all.tape = &tape;
  all.kernels = (execution.target == nullptr ? &default_target() : execution.target)->kernels;
  all.tolerance = static_cast<float>(options.tolerance > 0 ? options.tolerance : kDefaultSweepTolerance);
  all.budget = options.budget;
  all.queries = queries;
  all.columns = columns;
  // The summary counts what the caller may not have asked for.
  all.columns.status = room(memory->status, columns.status, queries.count);
  all.columns.evaluations = room(memory->evaluations, columns.evaluations, queries.count);
  const std::size_t share = queries.count / (kTilesPerWorker * worker_count(execution));
  const std::size_t rows = execution.tile == 0 ? std::clamp(share, kLeastTile, kMostTile) : execution.tile;
  SweepTask<Tile> task(all, width, memory->workers);
  Summary summary;
  summary.cancelled = !schedule(task, queries.count, rows, execution);
  summary.rows = queries.count;
  for (std::size_t i = 0; !summary.cancelled && i < queries.count; ++i) {
    ++summary.by_status[std::min<std::size_t>(all.columns.status[i], 4)];
    summary.evaluations += all.columns.evaluations[i];
  }
  return summary;
}

}  // namespace

Result<Summary> sweep_triangles(const Tape& tape, const SweepQueries& queries, const SweepOptions& options,
                                const SweepColumns& columns, const Execution& execution) {
  return sweep<TriangleSweepTile>(tape, queries, options, columns, execution,
                                  3 * static_cast<std::size_t>(tape.dimension));
}

Result<Summary> sweep_circles(const Tape& tape, const SweepQueries& queries, const SweepOptions& options,
                              const SweepColumns& columns, const Execution& execution) {
  if (queries.ends != nullptr) return refused("--circles", "motions of the scene", "ends");
  SweepColumns wanted = columns;
  wanted.barycentric = nullptr;
  return sweep<BallSweepTile>(tape, queries, options, wanted, execution, static_cast<std::size_t>(tape.dimension) + 1);
}

}  // namespace thalweg
