// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Grids of points in two levels. The tape is shortened for tiles of the grid, 32 of them together, and from there for
// their sub-tiles; a sub-tile's points are evaluated by the tape that is left, if any is.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "compile/shorten.h"
#include "reuse.h"
#include "schedule.h"
#include "thalweg/batch.h"

namespace thalweg {
namespace {

using Index = std::array<std::size_t, 3>;

/// Programs of so many tiles are held at a time, whatever the size of the grid.
constexpr std::size_t kHeldTiles = 1024;

/// Some points of the grid: from `first` on, `size` along each axis.
struct Box {
  Index first{}, size{};
  [[nodiscard]] std::size_t count() const { return size[0] * size[1] * size[2]; }
};

/// A box cut into boxes of `edge` points along each axis; the last ones are smaller.
struct Cut {
  Box whole;
  Index edge{}, parts{};

  Cut(const Box& box, const Index& edge_points) : whole(box), edge(edge_points) {
    for (std::size_t b = 0; b < 3; ++b) parts[b] = (box.size[b] + edge[b] - 1) / edge[b];
  }
  [[nodiscard]] std::size_t count() const { return parts[0] * parts[1] * parts[2]; }
  [[nodiscard]] Box part(std::size_t index) const {
    Box box;
    for (std::size_t b = 0; b < 3; ++b) {
      const std::size_t begin = index % parts[b] * edge[b];
      index /= parts[b];
      box.first[b] = whole.first[b] + begin;
      box.size[b] = std::min(edge[b], whole.size[b] - begin);
    }
    return box;
  }
};

/// Points along each axis of a sub-tile, 256 or 512 in all, and of a tile, 64 sub-tiles.
struct Levels {
  Index tile{1, 1, 1}, sub_tile{1, 1, 1};

  Levels(const Grid& grid, std::size_t tile_points) {
    const auto axes = static_cast<std::size_t>(std::ranges::count_if(grid.size, [](std::size_t n) { return n > 1; }));
    constexpr std::size_t kEdge[4] = {1, 256, 16, 8};
    constexpr std::size_t kPerEdge[4] = {1, 64, 8, 4};
    for (std::size_t b = 0; b < 3; ++b) {
      if (grid.size[b] == 1) continue;
      sub_tile[b] = kEdge[axes];
      const auto asked =
          static_cast<std::size_t>(std::pow(static_cast<double>(tile_points), 1.0 / static_cast<double>(axes)) /
                                   static_cast<double>(kEdge[axes]));
      tile[b] = kEdge[axes] * (tile_points == 0 ? kPerEdge[axes] : std::max<std::size_t>(asked, 1));
    }
  }
};

/// Where the points of a box lie.
class Places {
 public:
  Places(const Grid& grid, int dimension) : grid_(grid), d_(static_cast<std::size_t>(dimension)) {}

  /// A ball that holds a box's points, their rounding to float32 included; nothing where one cannot be answered.
  [[nodiscard]] bool region(const Box& box, Region& region) const {
    double square = 0;
    double largest = 0;
    for (std::size_t axis = 0; axis < d_; ++axis) {
      double middle = grid_.origin[axis];
      double half = 0;
      for (std::size_t b = 0; b < 3; ++b) {
        const double span = 0.5 * static_cast<double>(box.size[b] - 1);
        middle += grid_.step[b][axis] * (static_cast<double>(box.first[b]) + span);
        half += std::fabs(grid_.step[b][axis]) * span;
      }
      region.centre[axis] = static_cast<float>(middle);
      square += half * half;
      largest = std::max(largest, std::fabs(middle) + half);
      region.half[axis] = static_cast<float>(1.000001 * half + 0x1p-22 * (std::fabs(middle) + half));
    }
    region.reach = static_cast<float>(1.000001 * std::sqrt(square) + 0x1p-22 * largest);
    return largest < 0.999 * static_cast<double>(kLargestCoordinate);
  }

  /// Columns of a box's points.
  void columns(const Box& box, float* const* to) const {
    for (std::size_t axis = 0; axis < d_; ++axis) {
      const bool turns = grid_.step[1][axis] != 0 || grid_.step[2][axis] != 0;
      float* out = to[axis];
      for (std::size_t k = 0; k < box.size[2]; ++k) {
        for (std::size_t j = 0; j < box.size[1]; ++j, out += box.size[0]) {
          if (turns || out == to[axis]) {
            row(axis, box, box.first[1] + j, box.first[2] + k, out);
          } else {
            std::copy_n(to[axis], box.size[0], out);
          }
        }
      }
    }
  }

  [[nodiscard]] float coordinate(std::size_t axis, std::size_t i, double base) const {
    return static_cast<float>(base + static_cast<double>(i) * grid_.step[0][axis]);
  }
  [[nodiscard]] double row_base(std::size_t axis, std::size_t j, std::size_t k) const {
    return grid_.origin[axis] + static_cast<double>(j) * grid_.step[1][axis] +
           static_cast<double>(k) * grid_.step[2][axis];
  }

 private:
  void row(std::size_t axis, const Box& box, std::size_t j, std::size_t k, float* out) const {
    const double base = row_base(axis, j, k);
    if (grid_.step[0][axis] == 0) {
      std::fill_n(out, box.size[0], static_cast<float>(base));
      return;
    }
    for (std::size_t i = 0; i < box.size[0]; ++i) out[i] = coordinate(axis, box.first[0] + i, base);
  }

  const Grid& grid_;
  std::size_t d_;
};

/// Where a formula is undefined there is one NaN, whatever the target made of it; returns how often.
std::size_t mark_undefined(std::span<float> value) {
  std::size_t count = 0;
  for (float& f : value) {
    if (!std::isnan(f)) continue;
    f = std::numeric_limits<float>::quiet_NaN();
    ++count;
  }
  return count;
}

/// Rows of d coordinates that cannot be answered.
std::size_t bad_rows(std::span<const float> rows, std::size_t d) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < rows.size(); i += d) {
    const auto row = rows.subspan(i, d);
    const bool good = std::ranges::all_of(row, [](float x) { return std::fabs(x) <= kLargestCoordinate; });
    count += good ? 0 : 1;
  }
  return count;
}

/// What one worker keeps from tile to tile.
struct Worker {
  Arena arena;
  Shortener tiles, sub_tiles;
  Tape tile_tape, sub_tape;
  std::vector<Region> regions;
  EvaluateSummary summary;
  bool begun = false;

  void begin(const Tape& tape) {
    if (begun) return;
    tiles.begin(tape);
    sub_tiles.begin(tape);
    tile_tape = tape;
    sub_tape = tape;
    summary = {};
    begun = true;
  }
};

/// What is known of a tile.
struct Tile {
  float lower = 0, upper = 0;
  bool answerable = false;  ///< all of its points are
  std::vector<Instruction> program;
};

struct Memory {
  std::vector<Worker> workers;
  std::vector<Tile> tiles;
};

class GridTask {
 public:
  GridTask(const Tape& tape, const Grid& grid, const GridColumns& out, const Execution& execution)
      : tape_(tape),
        grid_(grid),
        out_(out),
        execution_(execution),
        kernels_(*(execution.target == nullptr ? default_target() : *execution.target).kernels),
        levels_(grid, execution.tile),
        cut_({{0, 0, 0}, {grid.size[0], grid.size[1], grid.size[2]}}, levels_.tile),
        places_(grid, tape.dimension),
        band_(out.value == nullptr ? 0 : out.band) {
    const std::size_t workers = worker_count(execution);
    if (memory_->workers.size() < workers) memory_->workers.resize(workers);
    for (Worker& worker : memory_->workers) worker.begun = false;
    memory_->tiles.resize(std::max(memory_->tiles.size(), std::min(cut_.count(), kHeldTiles)));
    // Tiles are counted as points.
    tile_execution_ = execution;
    tile_execution_.done = nullptr;
  }

  EvaluateSummary run() {
    bool complete = true;
    for (first_ = 0; first_ < cut_.count() && complete; first_ += kHeldTiles) {
      const std::size_t held = std::min(kHeldTiles, cut_.count() - first_);
      Shorten shorten(*this);
      Answer answer(*this);
      complete = schedule(shorten, held, kRegionLanes, tile_execution_) && schedule(answer, held, 1, tile_execution_);
    }
    EvaluateSummary total;
    for (const Worker& worker : memory_->workers) {
      if (!worker.begun) continue;
      total.rows += worker.summary.rows;
      total.bad_rows += worker.summary.bad_rows;
      total.undefined_rows += worker.summary.undefined_rows;
      total.evaluations += worker.summary.evaluations;
    }
    total.cancelled = !complete;
    return total;
  }

 private:
  /// Tiles get their programs.
  struct Shorten final : TileTask {
    explicit Shorten(GridTask& of) : task(of) {}
    void run(std::size_t begin, std::size_t end, std::size_t worker) override { task.shorten(begin, end, worker); }
    GridTask& task;
  };
  /// Tiles are evaluated.
  struct Answer final : TileTask {
    explicit Answer(GridTask& of) : task(of) {}
    void run(std::size_t begin, std::size_t end, std::size_t worker) override {
      for (std::size_t i = begin; i < end; ++i) task.answer(i, worker);
    }
    GridTask& task;
  };

  Worker& worker(std::size_t index) {
    Worker& worker = memory_->workers[index];
    worker.begin(tape_);
    return worker;
  }

  void shorten(std::size_t begin, std::size_t end, std::size_t index) {
    Worker& own = worker(index);
    own.regions.assign(end - begin, {});
    for (std::size_t i = begin; i < end; ++i) {
      memory_->tiles[i].answerable = places_.region(cut_.part(first_ + i), own.regions[i - begin]);
      if (!memory_->tiles[i].answerable) own.regions[i - begin] = {};
    }
    own.tiles.analyse(tape_, kernels_, own.regions, band_);
    for (std::size_t i = begin; i < end; ++i) {
      Tile& tile = memory_->tiles[i];
      tile.lower = own.tiles.lower(i - begin);
      tile.upper = own.tiles.upper(i - begin);
      const auto program = own.tiles.program(i - begin);
      tile.program.assign(program.begin(), program.end());
    }
  }

  void answer(std::size_t index, std::size_t worker_index) {
    Worker& own = worker(worker_index);
    const Tile& tile = memory_->tiles[index];
    const Box box = cut_.part(first_ + index);
    own.summary.rows += box.count();
    if (!tile.answerable) {
      answer_each(box, own);
    } else if (is_decided(tile.lower, tile.upper)) {
      fill(box, tile.lower > 0);
    } else {
      own.tile_tape.shorten_to(tile.program);
      answer_sub_tiles(Cut(box, levels_.sub_tile), own);
    }
    if (execution_.done != nullptr) execution_.done->fetch_add(box.count(), std::memory_order_relaxed);
  }

  void answer_sub_tiles(const Cut& cut, Worker& own) const {
    own.regions.assign(cut.count(), {});
    for (std::size_t i = 0; i < cut.count(); ++i) {
      // A part of what can be answered can be.
      static_cast<void>(places_.region(cut.part(i), own.regions[i]));
    }
    own.sub_tiles.analyse(own.tile_tape, kernels_, own.regions, band_);
    for (std::size_t i = 0; i < cut.count(); ++i) {
      if (is_decided(own.sub_tiles.lower(i), own.sub_tiles.upper(i))) {
        fill(cut.part(i), own.sub_tiles.lower(i) > 0);
      } else {
        own.sub_tiles.shorten(i, own.sub_tape);
        evaluate_part(cut.part(i), own);
      }
    }
  }

  void evaluate_part(const Box& box, Worker& own) const {
    own.arena.reset();
    float* points[3] = {};
    for (int axis = 0; axis < tape_.dimension; ++axis) points[axis] = own.arena.take<float>(padded(box.count()));
    float* value = own.arena.take<float>(padded(box.count()));
    places_.columns(box, points);
    kernels_.value(own.sub_tape, points, box.count(), value, own.arena.take<float>(scratch_floats(tape_)));
    own.summary.evaluations += box.count();
    if (tape_.has_formulas) own.summary.undefined_rows += mark_undefined({value, box.count()});
    store(box, value);
  }

  /// Where points may be too far away to be answered.
  void answer_each(const Box& box, Worker& own) const {
    for (std::size_t k = 0; k < box.size[2]; ++k) {
      for (std::size_t j = 0; j < box.size[1]; ++j) {
        Box row{{box.first[0], box.first[1] + j, box.first[2] + k}, {box.size[0], 1, 1}};
        own.arena.reset();
        const auto d = static_cast<std::size_t>(tape_.dimension);
        float* rows = own.arena.take<float>(row.count() * d);
        float* value = own.arena.take<float>(row.count());
        for (std::size_t i = 0; i < row.count(); ++i) {
          grid_.point(row.first[0] + i, row.first[1], row.first[2], tape_.dimension, rows + i * d);
        }
        const std::size_t unanswered =
            kernels_.rows(tape_, rows, row.count(), value, nullptr, own.arena.take<float>(scratch_floats(tape_)));
        const std::size_t bad = tape_.has_formulas ? bad_rows({rows, row.count() * d}, d) : unanswered;
        own.summary.bad_rows += bad;
        own.summary.undefined_rows += unanswered - bad;
        own.summary.evaluations += row.count() - bad;
        store(row, value);
      }
    }
  }

  [[nodiscard]] bool is_decided(float lower, float upper) const { return lower > band_ || upper < -band_; }

  [[nodiscard]] std::size_t row_of(const Box& box, std::size_t j, std::size_t k) const {
    return box.first[0] + grid_.size[0] * (box.first[1] + j + grid_.size[1] * (box.first[2] + k));
  }

  void fill(const Box& box, bool above) const {
    for (std::size_t k = 0; k < box.size[2]; ++k) {
      for (std::size_t j = 0; j < box.size[1]; ++j) {
        const std::size_t at = row_of(box, j, k);
        if (out_.value != nullptr) std::fill_n(out_.value + at, box.size[0], above ? band_ : -band_);
        if (out_.inside != nullptr) std::fill_n(out_.inside + at, box.size[0], above ? 0 : 1);
      }
    }
  }

  void store(const Box& box, const float* value) const {
    for (std::size_t k = 0; k < box.size[2]; ++k) {
      for (std::size_t j = 0; j < box.size[1]; ++j, value += box.size[0]) {
        const std::size_t at = row_of(box, j, k);
        for (std::size_t i = 0; out_.inside != nullptr && i < box.size[0]; ++i)
          out_.inside[at + i] = value[i] < 0 ? 1 : 0;
        for (std::size_t i = 0; out_.value != nullptr && i < box.size[0]; ++i) {
          out_.value[at + i] = std::clamp(value[i], -band_, band_);
        }
      }
    }
  }

  const Tape& tape_;
  const Grid& grid_;
  const GridColumns& out_;
  const Execution& execution_;
  Execution tile_execution_;
  const Kernels& kernels_;
  Levels levels_;
  Cut cut_;
  Places places_;
  float band_;
  std::size_t first_ = 0;  ///< of the tiles whose programs are held
  Reused<Memory> memory_;
};

}  // namespace

void Grid::point(std::size_t i, std::size_t j, std::size_t k, int dimension, float* coordinates) const {
  const Places places(*this, dimension);
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
    coordinates[axis] = places.coordinate(axis, i, places.row_base(axis, j, k));
  }
}

Result<EvaluateSummary> evaluate_grid(const Tape& tape, const Grid& grid, const GridColumns& columns,
                                      const Execution& execution) {
  if (!(columns.band >= 0)) {
    return Error{.file = "", .place = "band", .expected = "a number from 0 on", .found = std::to_string(columns.band)};
  }
  if (grid.count() == 0) return EvaluateSummary{};
  return GridTask(tape, grid, columns, execution).run();
}

}  // namespace thalweg
