// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The kernel says what each instruction is needed for (kernels/relevance.inl); here the programs are written, an
// instruction after the other, to all regions that need it. Registers keep their numbers.
#include "compile/shorten.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "ops/registry.h"

namespace thalweg {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool moves_position(const Instruction& in) {
  return in.op < Instruction::kKeep && ops::registry()[in.op].row.kind >= OpKind::place;
}

/// Calls body(region) for each bit.
template <class Body>
void for_each_bit(std::uint32_t bits, Body&& body) {
  for (; bits != 0; bits &= bits - 1) body(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace

void Shortener::begin(const Tape& full) {
  slack_ = full.enclosure_slack;
  const auto registers = static_cast<std::size_t>(full.register_count);
  ranges_.resize(registers * 2 * kRegionLanes);
  for (std::size_t i = 0; i < ranges_.size(); ++i) ranges_[i] = i / kRegionLanes % 2 == 0 ? kInfinity : -kInfinity;
  positions_.assign(static_cast<std::size_t>(full.position_count), 0);
}

void Shortener::take_memory(const Tape& from, std::size_t programs) {
  const std::size_t length = from.instructions.size();
  arena_.reset();
  groups_.clear();
  streams_.assign(programs, {});
  work_.scratch = arena_.take<float>(scratch_floats(from));
  work_.record = arena_.take<float>(length * 4 * kRegionLanes);
  work_.use = arena_.take<InstructionUse>(length);
  work_.ranges = ranges_.data();
  work_.positions = positions_.data();
}

void Shortener::analyse(const Tape& from, const Kernels& kernels, std::span<const Region> regions, float band) {
  take_memory(from, regions.size());
  for (std::size_t first = 0; first < regions.size(); first += kRegionLanes) {
    const auto own = regions.subspan(first, std::min(kRegionLanes, regions.size() - first));
    groups_.push_back(columns_of(own, band));
    kernels.regions(from, groups_.back(), work_);
    write(from, {&streams_[first], own.size()});
  }
}

void Shortener::analyse_pieces(const Tape& from, const Kernels& kernels, std::span<const Region> pieces) {
  take_memory(from, 1);
  groups_.push_back(columns_of(pieces, kInfinity));
  groups_.back().are_pieces = true;
  kernels.regions(from, groups_.back(), work_);
  // What is needed for the first piece is for all.
  write(from, streams_);
}

RegionColumns Shortener::columns_of(std::span<const Region> regions, float band) {
  RegionColumns columns;
  for (float** column : {&columns.centre[0], &columns.centre[1], &columns.centre[2], &columns.half[0], &columns.half[1],
                         &columns.half[2], &columns.reach, &columns.gap, &columns.least, &columns.most, &columns.lower,
                         &columns.upper}) {
    *column = arena_.take<float>(kRegionLanes);
  }
  for (std::size_t i = 0; i < kRegionLanes; ++i) {
    const Region& region = regions[std::min(i, regions.size() - 1)];
    float largest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns.centre[axis][i] = region.centre[axis];
      largest = std::max(largest, std::fabs(region.centre[axis]));
    }
    // Two values of the region differ by their distance and by the rounding of both; as much again for blends, which
    // are monotone but for theirs.
    const auto rounding = static_cast<float>(4 * slack_(static_cast<double>(largest + region.reach)));
    columns.reach[i] = 1.00001F * region.reach + rounding;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns.half[axis][i] = std::min(1.00001F * region.half[axis] + rounding, columns.reach[i]);
    }
    columns.gap[i] = region.cell_reach > 0 ? 1.00001F * region.cell_reach + rounding : 0;
    // Lanes without a region need nothing.
    columns.least[i] = i < regions.size() ? -band : kInfinity;
    columns.most[i] = i < regions.size() ? band : -kInfinity;
  }
  return columns;
}

void Shortener::Stream::add(const Instruction& in) {
  instructions[size++] = in;
  producer = size;
}

void Shortener::Stream::keep(std::uint16_t target) {
  Instruction* const made = producer == 0 ? nullptr : &instructions[producer - 1];
  if (made != nullptr && made->target == target) return;
  if (made != nullptr && made->target == Instruction::kNone) {
    made->target = target;
  } else {
    add({.op = Instruction::kKeep, .target = target});
  }
}

void Shortener::Stream::load(std::uint16_t slot, std::uint16_t target) {
  if (slot == target) target = Instruction::kNone;
  if (producer != 0 && instructions[producer - 1].target == slot) {
    // The accumulator still holds it.
    if (target != Instruction::kNone) keep(target);
  } else {
    add({.op = Instruction::kLoad, .operand = slot, .target = target});
  }
}

void Shortener::write(const Tape& from, std::span<Stream> streams) {
  const std::size_t length = from.instructions.size();
  // Programs of equal length would begin at the same place of every page.
  const std::size_t room = length + 4;
  auto* const memory = arena_.take<std::byte>(streams.size() * room * sizeof(Instruction));
  for (std::size_t i = 0; i < streams.size(); ++i) {
    streams[i].instructions = reinterpret_cast<Instruction*>(memory) + i * room;
  }
  const auto written = static_cast<std::uint32_t>((std::uint64_t{1} << streams.size()) - 1);
  static const auto constant = static_cast<std::uint8_t>(ops::find_function("constant"));
  for (std::size_t i = 0; i < length; ++i) {
    InstructionUse use = work_.use[i];
    use.run &= written;
    if (use.run == 0) continue;
    const Instruction& in = from.instructions[i];
    Instruction unread = in;
    unread.target = Instruction::kNone;
    const bool moves = moves_position(in);
    for_each_bit(use.run & use.accumulator & use.operand, [&](std::size_t region) {
      Stream& stream = streams[region];
      stream.instructions[stream.size++] = (use.stored >> region & 1) != 0 ? in : unread;
      if (!moves) stream.producer = stream.size;
    });
    for_each_bit(use.run & ~use.operand, [&](std::size_t region) {
      if ((in.flags & Instruction::kLoads) != 0) {
        streams[region].load(in.first, (use.stored >> region & 1) != 0 ? in.target : Instruction::kNone);
      } else {
        streams[region].keep(in.target);
      }
    });
    for_each_bit(use.run & ~use.accumulator, [&](std::size_t region) {
      const std::uint16_t target = (use.stored >> region & 1) != 0 ? in.target : Instruction::kNone;
      if ((in.flags & Instruction::kImmediate) != 0) {
        streams[region].add({.op = constant, .target = target, .constants = in.constants, .constant_count = 3});
      } else {
        streams[region].load(in.operand, target);
      }
    });
  }
}

}  // namespace thalweg
