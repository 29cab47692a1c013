// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One pass backwards over the tape carries, for the accumulator and each register, the range of values that matter to
// what comes later: of min(a, b) < c only values below c do. An operand whose interval lies outside of what can matter
// is dropped, and then all that only it needed. Registers keep their numbers.
//
// Why the bits stay. Say only values of min(a, b) up to C matter, and b > C all over the region. Where a <= C the
// result is a with or without b; elsewhere it is above C with or without b. A blend of width w is exact where its
// operands are further apart than w and lowers the result by w / 4 at the most: with b > C + 2w, either a <= C + w and
// the result is a, or it is above C both times. Maxima mirror this.
#include "compile/shorten.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ops/registry.h"

namespace thalweg {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const ops::Entry& entry_of(const Instruction& in) { return ops::registry()[in.op]; }

bool is_op(const Instruction& in) { return in.op < Instruction::kKeep; }

bool moves_position(const Instruction& in) { return is_op(in) && entry_of(in).row.kind >= OpKind::place; }

}  // namespace

Shortener::Shortener(const Tape& full)
    : slack_(full.search_slack),
      writer_(static_cast<std::size_t>(full.register_count)),
      register_range_(static_cast<std::size_t>(full.register_count)),
      position_used_(static_cast<std::size_t>(full.position_count)) {}

void Shortener::analyse(const Tape& from, const Kernels& kernels, std::span<const Region> regions) {
  arena_.reset();
  columns_.count = regions.size();
  columns_.stride = (regions.size() + kRegionLanes - 1) / kRegionLanes * kRegionLanes;
  for (float*& column : columns_.centre) column = arena_.take<float>(columns_.stride);
  for (float** column : {&columns_.reach, &columns_.lower, &columns_.upper}) {
    *column = arena_.take<float>(columns_.stride);
  }
  gap_.resize(columns_.stride);
  for (std::size_t i = 0; i < columns_.stride; ++i) {
    const Region& region = regions[std::min(i, regions.size() - 1)];
    float largest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns_.centre[axis][i] = region.centre[axis];
      largest = std::max(largest, std::fabs(region.centre[axis]));
    }
    // Two values of the region differ by their distance and by the rounding of both; as much again for blends, which
    // are monotone but for theirs.
    const auto rounding = static_cast<float>(4 * slack_(static_cast<double>(largest + region.reach)));
    columns_.reach[i] = 1.00001F * region.reach + rounding;
    gap_[i] = region.cell_reach > 0 ? 1.00001F * region.cell_reach + rounding : 0;
  }
  record_ = arena_.take<float>(from.instructions.size() * 2 * columns_.stride);
  kernels.intervals(from, columns_, record_, arena_.take<float>(scratch_floats(from)));
  trace_sources(from);
}

void Shortener::trace_sources(const Tape& from) {
  accumulator_source_.resize(from.instructions.size());
  operand_source_.resize(from.instructions.size());
  std::uint32_t accumulator = 0;
  for (std::uint32_t i = 0; i < from.instructions.size(); ++i) {
    const Instruction& in = from.instructions[i];
    accumulator_source_[i] = accumulator;
    if (moves_position(in)) continue;
    if (in.op == Instruction::kLoad || (is_op(in) && entry_of(in).row.kind == OpKind::combine)) {
      operand_source_[i] = writer_[in.operand];
    }
    if (in.op == Instruction::kLoad) accumulator = operand_source_[i];
    if (is_op(in)) accumulator = i;
    if (in.target != Instruction::kNone) writer_[in.target] = accumulator;
  }
}

Shortener::Range Shortener::interval(std::uint32_t instruction, std::size_t region) const {
  const float* const at = record_ + static_cast<std::size_t>(instruction) * 2 * columns_.stride + region;
  return {static_cast<double>(at[0]), static_cast<double>(at[columns_.stride])};
}

Shortener::Needs Shortener::needs(const Tape& from, std::size_t instruction, std::size_t region, Range matters) const {
  const Instruction& in = from.instructions[instruction];
  const ops::Entry& op = entry_of(in);
  const bool swapped = (in.flags & Instruction::kSwapped) != 0;
  Range first = interval(operand_source_[instruction], region);
  Range second = interval(accumulator_source_[instruction], region);
  if (swapped) std::swap(first, second);
  // Everything as if for the least of two.
  const bool mirrored = op.selection == ops::Selection::greatest;
  const auto mirror = [](Range r) { return Range{-r.hi, -r.lo}; };
  if (mirrored) matters = mirror(matters);
  if (mirrored) first = mirror(first);
  if (mirrored != op.second_falls) second = mirror(second);
  const double width = op.blends ? static_cast<double>(from.constants[in.constants]) : 0.0;
  Range first_range{matters.lo, std::min(matters.hi + 2 * width, second.hi + width)};
  Range second_range{matters.lo, std::min(matters.hi + 2 * width, first.hi + width)};
  const auto gap = static_cast<double>(gap_[region]);
  const bool drops_second = second.lo > second_range.hi + gap;
  // Without the first operand a falling one would be left, which no load can negate.
  const bool drops_first = !drops_second && !op.second_falls && first.lo > first_range.hi + gap;
  if (mirrored) first_range = mirror(first_range);
  if (mirrored != op.second_falls) second_range = mirror(second_range);
  return swapped ? Needs{!drops_first, !drops_second, first_range, second_range}
                 : Needs{!drops_second, !drops_first, second_range, first_range};
}

void Shortener::require(std::uint16_t slot, Range range) {
  Range& all = register_range_[slot];
  all = {std::min(all.lo, range.lo), std::max(all.hi, range.hi)};
}

void Shortener::shorten(const Tape& from, std::size_t region, Tape& to) {
  constexpr Range kNothing{kInfinity, -kInfinity};
  constexpr Range kEverything{-kInfinity, kInfinity};
  std::ranges::fill(register_range_, kNothing);
  std::ranges::fill(position_used_, 0);
  Range accumulator = kEverything;
  to.instructions.clear();
  for (std::size_t i = from.instructions.size(); i-- > 0;) {
    Instruction in = from.instructions[i];
    if (moves_position(in)) {
      if (position_used_[in.target] == 0) continue;
      position_used_[in.target] = 0;
      position_used_[in.operand] = 1;
      to.instructions.push_back(in);
      continue;
    }
    Range matters = accumulator;
    if (in.target != Instruction::kNone) {
      Range& stored = register_range_[in.target];
      if (stored.lo > stored.hi) in.target = Instruction::kNone;
      matters = {std::min(matters.lo, stored.lo), std::max(matters.hi, stored.hi)};
      stored = kNothing;
    }
    if (matters.lo > matters.hi) continue;
    accumulator = kNothing;
    if (in.op == Instruction::kKeep) {
      accumulator = matters;
    } else if (in.op == Instruction::kLoad) {
      require(in.operand, matters);
    } else if (entry_of(in).row.kind == OpKind::primitive) {
      position_used_[in.operand] = 1;
    } else if (entry_of(in).row.kind == OpKind::map) {
      accumulator = kEverything;
    } else {
      const Needs need = needs(from, i, region, matters);
      if (need.accumulator) accumulator = need.accumulator_range;
      if (need.operand) require(in.operand, need.operand_range);
      if (!need.accumulator) in = {.op = Instruction::kLoad, .operand = in.operand, .target = in.target};
      if (!need.operand) in = {.op = Instruction::kKeep, .target = in.target};
    }
    if (in.op == Instruction::kKeep && in.target == Instruction::kNone) continue;
    to.instructions.push_back(in);
  }
  std::ranges::reverse(to.instructions);
}

}  // namespace thalweg
