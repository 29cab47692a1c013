// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the kernel that analyses a tape over regions reads and writes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/kernels.h"

namespace thalweg {

/// Regions are analysed this many at once.
inline constexpr std::size_t kRegionLanes = 32;
/// Balls around centres, kRegionLanes of them, each cut with a box; f lies within [lower, upper] over each.
struct RegionColumns {
  float* centre[3] = {};
  float* half[3] = {};     ///< of the box, widened by rounding
  float* reach = nullptr;  ///< the same
  float* gap = nullptr;    ///< how far apart operands must be for one of them to be left out
  /// Values of f that matter: of those beyond, only on which side they lie. None when least > most.
  float *least = nullptr, *most = nullptr;
  float *lower = nullptr, *upper = nullptr;
  /// They are pieces of one region, Kernels::pieces of them at most: what one of them needs, all do.
  bool are_pieces = false;
};
/// What an instruction is needed for, a bit per region.
struct InstructionUse {
  std::uint32_t run = 0;          ///< it cannot be left out
  std::uint32_t stored = 0;       ///< its target is read later
  std::uint32_t accumulator = 0;  ///< what it finds in the accumulator can decide; without it, it is a load
  std::uint32_t operand = 0;      ///< its operand can decide; without it, it only keeps the accumulator
};
/// Memory of one analysis; `ranges` and `positions` are left as they were found.
struct RegionWork {
  float* scratch = nullptr;            ///< scratch_floats(tape)
  float* record = nullptr;             ///< 4 kRegionLanes floats an instruction
  float* ranges = nullptr;             ///< 2 kRegionLanes floats a register, all empty: +infinity, then -infinity
  std::uint32_t* positions = nullptr;  ///< one a position, all 0
  InstructionUse* use = nullptr;       ///< written: one an instruction
};

}  // namespace thalweg
