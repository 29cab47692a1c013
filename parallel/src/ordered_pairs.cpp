// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "ordered_pairs.h"

#include <algorithm>
#include <limits>

#include "gradient/strategies.h"
#include "schedule.h"

namespace thalweg {
namespace {

/// A pair asks hundreds of evaluations of its tapes: even a few rows are worth a tape of their own, and where that is
/// short anyway a cohort of them fills the lanes (measured, growth/pairs and growth/distances).
constexpr std::size_t kLeastRows = 32;
constexpr PartSizes kParts{.most = 32, .few = 8};
/// How far around its zone a row is expected to evaluate, in smaller diagonals, by dimension. A descent's longest step
/// and the furthest far points are half of one; in space a smaller box is worth some evaluations of the whole tape.
constexpr double kAround[] = {0.5, 0.25};
/// Rows of a task that finds boxes.
constexpr std::size_t kRowsPerTask = 1024;

double diagonal_of(const Tape& tape) {
  const Bounds& bounds = tape.facts.bounds;
  return bounds.finite(tape.dimension) ? bounds.diagonal(tape.dimension) : std::numeric_limits<double>::infinity();
}

Surroundings surroundings_of(const Tape& tape, const PairOptions& options) {
  Surroundings around;
  if (strategy_of(options) != Gradient::autodiff) {
    around.probe = rule_of(tape, strategy_of(options), options.gradient_offset).probe;
  }
  return around;
}

}  // namespace

OrderedPairs::OrderedPairs(const PairBatch& batch, const PairShapes& shapes, std::span<const std::uint32_t> rows,
                           PairMemory& memory)
    : batch_(batch), shapes_(shapes), rows_(rows), memory_(memory) {
  // Nearest surface points may be anywhere.
  if (strategy_of(*batch.all.options) == Gradient::closest_point) return;
  // Of two, the larger: the other one lies in its midst, and all of it may be met.
  double largest = 0;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    const Tape& tape = *batch.all.queries->shapes[side == 0 ? shapes.first : shapes.second];
    if (!OrderedBatch::suits_queries(tape, rows.size(), kLeastRows) || !(diagonal_of(tape) > largest)) continue;
    largest = diagonal_of(tape);
    side_ = side;
    layout_ = {.dimension = static_cast<std::size_t>(tape.dimension), .points = 2, .has_radius = false};
  }
}

const Tape& OrderedPairs::tape() const {
  return *batch_.all.queries->shapes[*side_ == 0 ? shapes_.first : shapes_.second];
}

void OrderedPairs::find_boxes(std::size_t begin, std::size_t end) {
  const std::size_t d = layout_.dimension;
  for (std::size_t i = begin; i < end; ++i) {
    float* const lo = &memory_.corners[2 * d * i];
    float* const hi = lo + d;
    float* const middle = &memory_.middles[d * i];
    PairProblem problem;
    if (!prepare(*batch_.all.queries, *batch_.all.options, rows_[i], problem)) {
      std::fill_n(lo, 2 * d, std::numeric_limits<float>::quiet_NaN());
      std::fill_n(middle, d, 0.0F);
      continue;
    }
    const Bounds zone = zone_of(problem, *side_);
    const double around = kAround[d - 2] * problem.limits.size;
    for (std::size_t axis = 0; axis < d; ++axis) {
      lo[axis] = static_cast<float>(zone.lo[axis] - around);
      hi[axis] = static_cast<float>(zone.hi[axis] + around);
      middle[axis] = static_cast<float>((zone.lo[axis] + zone.hi[axis]) / 2);
    }
  }
}

void OrderedPairs::find_boxes(const Execution& execution) {
  const std::size_t d = layout_.dimension;
  memory_.corners.resize(std::max(memory_.corners.size(), 2 * d * rows_.size()));
  memory_.middles.resize(std::max(memory_.middles.size(), d * rows_.size()));
  prepare_rows(rows_.size(), kRowsPerTask, execution,
               [this](std::size_t begin, std::size_t end, std::size_t) { find_boxes(begin, end); });
  if (!batch_.measures) return;
  // The nearest point of the long tape's shape is about as far away as it says.
  memory_.values.resize(std::max(memory_.values.size(), rows_.size()));
  Execution uncounted = execution;
  uncounted.done = nullptr;
  evaluate(tape(), memory_.middles.data(), rows_.size(), memory_.values.data(), nullptr, uncounted);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const float away = std::max(memory_.values[i], 0.0F);
    for (std::size_t axis = 0; axis < d; ++axis) {
      memory_.corners[2 * d * i + axis] -= away;
      memory_.corners[2 * d * i + d + axis] += away;
    }
  }
}

bool OrderedPairs::run(const Execution& execution) {
  find_boxes(execution);
  OrderedBatch ordered(tape(), layout_, memory_.corners.data(), rows_.size(),
                       surroundings_of(tape(), *batch_.all.options), execution, kParts);
  return ordered.run(*this);
}

void OrderedPairs::answer(const OrderedBatch::Part& part) {
  std::vector<std::uint32_t>& rows = memory_.parts[part.worker];
  rows.resize(part.order.size());
  std::ranges::transform(part.order, rows.begin(), [this](std::uint32_t i) { return rows_[i]; });
  Extent extent;
  with_row(layout_, [&]<class Row>(Row row) {
    for (std::size_t i = 0; i < part.order.size(); ++i) extent.add(row.extent(part.rows + i * Row::kWidth));
  });
  PairTile tile = batch_.all;
  tile.count = rows.size();
  tile.rows = rows.data();
  StandIn& near = tile.near[*side_];
  near.tape = &part.tape;
  std::copy_n(extent.lo, 3, near.lo);
  std::copy_n(extent.hi, 3, near.hi);
  batch_.answer(tile, memory_.worker(part.worker));
}

}  // namespace thalweg
