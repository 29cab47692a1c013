// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The curve is cut into tasks of a few thousand neighbouring rows, whose tapes are shortened 32 tasks at a time. A task
// gathers its rows and halves its box until 32 boxes are left or each has few rows; those get tapes of their own, and
// boxes that still have many rows are halved on. Before a part is answered its tape is shortened once more, by an
// analysis of where its rows lie in pieces.
#include "ordered_batch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "gradient/ties.h"
#include "ops/registry.h"
#include "schedule.h"

namespace thalweg {
namespace {

/// Where a part's tape is longer than this it is halved on, down to few rows.
constexpr std::size_t kShortTape = 80;
/// Where it is no longer than this, pieces of the region are not looked at.
constexpr std::size_t kShortestInPieces = 12;
/// Fewer points are not worth an order.
constexpr std::size_t kLeastPoints = 256;
/// Tasks for each worker, at least, where there are rows enough.
constexpr std::size_t kTasksPerWorker = 8;
/// Programs of so many tasks are held at a time.
constexpr std::size_t kHeldTasks = 1024;
/// Rows ahead of which the gathering loop asks for memory.
constexpr std::size_t kAhead = 24;
/// Row numbers are of 32 bits.
constexpr std::size_t kMostOrdered = std::numeric_limits<std::uint32_t>::max();
/// Nanoseconds, to weigh one against the other (measured on points of 100 to 2000 primitives and of formulas): to order
/// a row and answer it, and to shorten a tape for a batch and for a row, of each instruction. Those of evaluating an
/// instruction are in suits_points.
constexpr double kOrdering = 12, kShortening = 180, kShorteningForRow = 0.002;

/// Whether enough instructions choose between two operands, one of which may be left out.
bool is_shortened(const Tape& tape) {
  const auto chooses = [](const Instruction& in) {
    if (in.op >= Instruction::kKeep) return false;
    const ops::Entry& entry = ops::registry()[in.op];
    return entry.row.kind == OpKind::combine || entry.selects;
  };
  const auto choices = static_cast<std::size_t>(std::ranges::count_if(tape.instructions, chooses));
  return 8 * choices >= tape.instructions.size();
}

/// The region cut into `most` boxes, a power of two, of about the same width along every axis.
void cut_into_pieces(const Region& region, std::size_t dimension, std::size_t most, std::vector<Region>& pieces) {
  std::size_t cuts[3] = {1, 1, 1}, count = 1;
  const auto width = [&](std::size_t axis) { return region.half[axis] / static_cast<float>(cuts[axis]); };
  for (; count < most; count *= 2) {
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < dimension; ++axis) widest = width(axis) > width(widest) ? axis : widest;
    cuts[widest] *= 2;
  }
  pieces.assign(count, region);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;
    double square = 0;
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      const auto place = static_cast<double>(2 * (rest % cuts[axis]) + 1) / static_cast<double>(cuts[axis]) - 1;
      rest /= cuts[axis];
      const double half = static_cast<double>(region.half[axis]) / static_cast<double>(cuts[axis]);
      const double centre = static_cast<double>(region.centre[axis]) + place * static_cast<double>(region.half[axis]);
      pieces[i].centre[axis] = static_cast<float>(centre);
      const double own = 1.000001 * (half + 1e-6 * std::fabs(centre));
      pieces[i].half[axis] = static_cast<float>(own);
      square += own * own;
    }
    pieces[i].reach = static_cast<float>(1.000001 * std::sqrt(square));
  }
}

}  // namespace

struct OrderedBatch::Worker {
  Arena arena;
  Shortener tasks;
  std::vector<std::unique_ptr<Shortener>> shorteners;  ///< by depth
  std::vector<std::unique_ptr<Tape>> tapes;            ///< by depth; 0 is the task's
  Shortener pieces;
  std::unique_ptr<Tape> of_part;       ///< of the part that is answered
  std::vector<std::vector<Run>> runs;  ///< by depth
  std::vector<Region> regions;
  std::vector<float> rows;
  std::vector<Extent> extents;
  bool begun = false;
};

struct OrderedBatch::Memory {
  SpatialOrder order;
  std::vector<Run> tasks;
  std::vector<std::vector<Instruction>> programs;
  std::vector<std::unique_ptr<Worker>> workers;
};

/// Tasks get their programs.
struct OrderedBatch::Shorten final : TileTask {
  explicit Shorten(OrderedBatch& of) : batch(of) {}
  void run(std::size_t begin, std::size_t end, std::size_t worker) override { batch.shorten(begin, end, worker); }
  OrderedBatch& batch;
};

/// Tasks are answered.
struct OrderedBatch::Solve final : TileTask {
  Solve(OrderedBatch& of, Answer& by) : batch(of), answer(by) {}
  void run(std::size_t begin, std::size_t end, std::size_t worker) override {
    for (std::size_t i = begin; i < end; ++i) batch.solve(i, worker, answer);
  }
  OrderedBatch& batch;
  Answer& answer;
};

bool OrderedBatch::suits_queries(const Tape& tape, std::size_t count, std::size_t least_count) {
  return tape.instructions.size() >= kLongTape && count >= least_count && count < kMostOrdered && is_shortened(tape);
}

bool OrderedBatch::suits_points(const Tape& tape, std::size_t count, bool with_gradient) {
  if (count < kLeastPoints || count >= kMostOrdered) return false;
  const auto length = static_cast<double>(tape.instructions.size());
  const double instruction = tape.only_scalars ? (with_gradient ? 0.05 : 0.021) : (with_gradient ? 0.11 : 0.05);
  const double ordered = kOrdering + length * (kShortening / static_cast<double>(count) + kShorteningForRow);
  return instruction * length > ordered && is_shortened(tape);
}

OrderedBatch::OrderedBatch(const Tape& tape, const RowLayout& layout, const float* rows, std::size_t count,
                           const Surroundings& surroundings, const Execution& execution, PartSizes sizes)
    : tape_(tape),
      layout_(layout),
      rows_(rows),
      surroundings_(surroundings),
      execution_(execution),
      kernels_(*(execution.target == nullptr ? default_target() : *execution.target).kernels),
      sizes_(sizes) {
  if (execution.tile != 0) sizes_.most = execution.tile;
  sizes_.few = std::min(sizes_.few, sizes_.most);
  memory_->order.sort(layout, rows, count, execution);
  cut_into_tasks();
  const std::size_t workers = worker_count(execution);
  if (memory_->workers.size() < workers) memory_->workers.resize(workers);
  for (const auto& worker : memory_->workers) {
    if (worker != nullptr) worker->begun = false;
  }
}

OrderedBatch::~OrderedBatch() = default;

OrderedBatch::Run OrderedBatch::run_of(std::size_t first_cell, int level) const {
  const SpatialOrder& order = memory_->order;
  return {first_cell, level, order.begin_of(first_cell), order.begin_of(first_cell + (std::size_t{1} << level))};
}

void OrderedBatch::halve(Run& run, std::vector<Run>& into) const {
  // Where one half is empty, the other is the run.
  while (run.level > 0) {
    const std::size_t half = std::size_t{1} << --run.level;
    const Run first = run_of(run.first_cell, run.level), second = run_of(run.first_cell + half, run.level);
    run = first.count() == 0 ? second : first;
    if (first.count() == 0 || second.count() == 0) continue;
    into.push_back(second);
    return;
  }
}

void OrderedBatch::cut_into_tasks() {
  const std::size_t share = memory_->order.rows().size() / (kTasksPerWorker * worker_count(execution_));
  const std::size_t most = std::clamp(share, sizes_.most, sizes_.most * kRegionLanes);
  std::vector<Run>& tasks = memory_->tasks;
  tasks.assign(1, run_of(0, memory_->order.levels()));
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    while (tasks[i].count() > most && tasks[i].level > 0) {
      Run run = tasks[i];
      halve(run, tasks);
      tasks[i] = run;
    }
  }
  // Neighbours one after the other.
  std::ranges::sort(tasks, {}, &Run::begin);
}

OrderedBatch::Worker& OrderedBatch::worker(std::size_t index) {
  std::unique_ptr<Worker>& own = memory_->workers[index];
  if (own == nullptr) own = std::make_unique<Worker>();
  if (!own->begun) {
    own->tasks.begin(tape_);
    if (sizes_.in_pieces) own->pieces.begin(tape_);
    for (const auto& shortener : own->shorteners) shortener->begin(tape_);
    for (const auto& tape : own->tapes) *tape = tape_;
    if (own->of_part != nullptr) *own->of_part = tape_;
    own->begun = true;
  }
  return *own;
}

bool OrderedBatch::run(Answer& answer) {
  const std::size_t tasks = memory_->tasks.size();
  if (memory_->programs.size() < std::min(tasks, kHeldTasks)) memory_->programs.resize(std::min(tasks, kHeldTasks));
  Execution by_task = execution_;
  by_task.done = nullptr;
  for (first_ = 0; first_ < tasks; first_ += kHeldTasks) {
    const std::size_t held = std::min(kHeldTasks, tasks - first_);
    Shorten shorten(*this);
    Solve solve(*this, answer);
    if (!schedule(shorten, held, kRegionLanes, by_task) || !schedule(solve, held, 1, by_task)) return false;
  }
  return true;
}

Region OrderedBatch::region_of(const Extent& extent) const {
  Region region;
  if (!(extent.lo[0] <= extent.hi[0])) return region;
  double square = 0;
  float largest = 0;
  for (std::size_t axis = 0; axis < layout_.dimension; ++axis) {
    largest = std::max({largest, std::fabs(extent.lo[axis]), std::fabs(extent.hi[axis])});
    region.centre[axis] = 0.5F * (extent.lo[axis] + extent.hi[axis]);
    const double half = std::max(static_cast<double>(extent.hi[axis]) - static_cast<double>(region.centre[axis]),
                                 static_cast<double>(region.centre[axis]) - static_cast<double>(extent.lo[axis]));
    square += half * half;
    region.half[axis] = static_cast<float>(half);
  }
  // Kinks are looked for a little way around the rows.
  const float around = std::max(tie_reach(tape_, largest), surroundings_.sizes * extent.largest_row);
  region.reach = static_cast<float>((std::sqrt(square) + static_cast<double>(around)) * 1.000001);
  for (float& half : region.half) half = (half + around) * 1.000001F;
  region.cell_reach = surroundings_.bounds ? extent.largest_row : 0;
  return region;
}

Region OrderedBatch::region_of(const Run& run, const Run& task, const Worker& worker) const {
  Extent extent;
  for (std::size_t i = run.begin; i < run.end; ++i) extent.add(worker.extents[i - task.begin]);
  return region_of(extent);
}

void OrderedBatch::widen_by_probes(const Tape& tape, std::vector<Region>& regions, Arena& arena) const {
  const ProbeRule& probe = surroundings_.probe;
  if (probe.absolute == 0 && probe.of_value == 0) return;
  const std::size_t room = padded(regions.size());
  float* points[3] = {};
  for (std::size_t axis = 0; axis < layout_.dimension; ++axis) {
    points[axis] = arena.take<float>(room);
    for (std::size_t i = 0; i < regions.size(); ++i) points[axis][i] = regions[i].centre[axis];
  }
  float* value = arena.take<float>(room);
  kernels_.value(tape, points, regions.size(), value, arena.take<float>(scratch_floats(tape_)));
  for (std::size_t i = 0; i < regions.size(); ++i) {
    // |f| grows by no more than the way, and a probe's place is rounded.
    const float most = std::fabs(value[i]) + 1.001F * static_cast<float>(tape_.facts.lipschitz) * regions[i].reach;
    const float further = 1.001F * std::max(probe.absolute, probe.of_value * most);
    regions[i].reach += further;
    for (float& half : regions[i].half) half += further;
  }
}

void OrderedBatch::shorten(std::size_t begin, std::size_t end, std::size_t index) {
  Worker& own = worker(index);
  own.arena.reset();
  own.regions.clear();
  for (std::size_t i = begin; i < end; ++i) {
    const Run& task = memory_->tasks[first_ + i];
    own.regions.push_back(region_of(memory_->order.extent_of(task.first_cell, task.level)));
  }
  widen_by_probes(tape_, own.regions, own.arena);
  own.tasks.analyse(tape_, kernels_, own.regions);
  for (std::size_t i = begin; i < end; ++i) {
    const auto program = own.tasks.program(i - begin);
    memory_->programs[i].assign(program.begin(), program.end());
  }
}

void OrderedBatch::gather(const Run& run, Worker& worker) const {
  const std::uint32_t* const order = memory_->order.rows().data();
  worker.rows.resize(std::max(worker.rows.size(), run.count() * layout_.width()));
  worker.extents.resize(std::max(worker.extents.size(), run.count()));
  with_row(layout_, [&]<class Row>(Row row) {
    float* to = worker.rows.data();
    for (std::size_t i = run.begin; i < run.end; ++i, to += Row::kWidth) {
      const float* const ahead = rows_ + order[std::min<std::size_t>(i + kAhead, run.end - 1)] * Row::kWidth;
      __builtin_prefetch(ahead);
      __builtin_prefetch(ahead + Row::kWidth - 1);
      std::memcpy(to, rows_ + order[i] * Row::kWidth, sizeof(float) * Row::kWidth);
      worker.extents[i - run.begin] = row.extent(to);
    }
  });
}

void OrderedBatch::solve(std::size_t task_index, std::size_t index, Answer& answer) {
  Worker& own = worker(index);
  const Run task = memory_->tasks[first_ + task_index];
  const auto& program = memory_->programs[task_index];
  if (own.tapes.empty()) own.tapes.push_back(std::make_unique<Tape>(tape_));
  own.tapes[0]->shorten_to(program);
  own.arena.reset();
  gather(task, own);
  solve_run(task, task, *own.tapes[0], 0, index, answer);
  if (execution_.done != nullptr) execution_.done->fetch_add(task.count(), std::memory_order_relaxed);
}

void OrderedBatch::solve_run(const Run& run, const Run& task, const Tape& tape, std::size_t depth, std::size_t index,
                             Answer& answer) {
  Worker& own = worker(index);
  if (own.runs.size() == depth) {
    own.runs.emplace_back();
    own.shorteners.push_back(std::make_unique<Shortener>());
    own.shorteners.back()->begin(tape_);
    own.tapes.push_back(std::make_unique<Tape>(tape_));
  }
  const std::size_t most = run.count() <= sizes_.most ? sizes_.few : sizes_.most;
  const auto weight = [&](const Run& r) { return r.count() <= most || r.level == 0 ? std::size_t{0} : r.count(); };
  std::vector<Run>& runs = own.runs[depth];
  runs.assign(1, run);
  while (runs.size() < kRegionLanes) {
    const auto largest = std::ranges::max_element(runs, {}, weight);
    if (weight(*largest) == 0) break;
    Run halved = *largest;
    const auto place = largest - runs.begin();
    halve(halved, runs);
    runs[static_cast<std::size_t>(place)] = halved;
  }
  if (own.runs[depth].size() == 1) {
    answer_run(own.runs[depth][0], task, tape, index, answer);
    return;
  }
  own.regions.clear();
  for (const Run& part : own.runs[depth]) own.regions.push_back(region_of(part, task, own));
  widen_by_probes(tape, own.regions, own.arena);
  own.shorteners[depth]->analyse(tape, kernels_, own.regions);
  for (std::size_t i = 0; i < own.runs[depth].size(); ++i) {
    const Run part = own.runs[depth][i];
    own.shorteners[depth]->shorten(i, *own.tapes[depth + 1]);
    const bool is_short = own.tapes[depth + 1]->instructions.size() <= kShortTape;
    if (part.level == 0 || part.count() <= (is_short ? sizes_.most : sizes_.few)) {
      answer_run(part, task, *own.tapes[depth + 1], index, answer);
    } else {
      solve_run(part, task, *own.tapes[depth + 1], depth + 1, index, answer);
    }
  }
}

const Tape& OrderedBatch::shortened_by_pieces(const Run& run, const Run& task, const Tape& tape, Worker& own) const {
  std::vector<Region>& regions = own.regions;
  regions.assign(1, region_of(run, task, own));
  if (!std::isfinite(regions[0].half[0])) return tape;
  widen_by_probes(tape, regions, own.arena);
  const Region whole = regions[0];
  cut_into_pieces(whole, layout_.dimension, kernels_.pieces, regions);
  own.pieces.analyse_pieces(tape, kernels_, regions);
  if (own.of_part == nullptr) own.of_part = std::make_unique<Tape>(tape_);
  own.pieces.shorten(0, *own.of_part);
  return *own.of_part;
}

void OrderedBatch::answer_run(const Run& run, const Run& task, const Tape& long_tape, std::size_t index,
                              Answer& answer) {
  Worker& own = worker(index);
  const bool has_pieces = sizes_.in_pieces && long_tape.instructions.size() > kShortestInPieces;
  const Tape& tape = has_pieces ? shortened_by_pieces(run, task, long_tape, own) : long_tape;
  const std::span<const std::uint32_t> order(memory_->order.rows());
  // A cell of the curve may hold any number of rows.
  constexpr std::size_t kMostRows = 4096;
  for (std::size_t begin = run.begin; begin < run.end; begin += kMostRows) {
    const std::size_t count = std::min<std::size_t>(kMostRows, run.end - begin);
    answer.answer({.tape = tape,
                   .rows = &own.rows[(begin - task.begin) * layout_.width()],
                   .order = order.subspan(begin, count),
                   .worker = index});
  }
}

}  // namespace thalweg
