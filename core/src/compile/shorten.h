// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Shortened tapes (Keeter 2020; Barbier et al. 2025): what cannot decide the value anywhere in a region is left out.
// Over that region the short tape returns the bits of the full one, in every mode.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/kernels.h"
#include "solve/arena.h"
#include "thalweg/tape.h"

namespace thalweg {

/// A ball that holds all points at which a short tape will be evaluated.
struct Region {
  float centre[3] = {};
  float reach = 0;
  /// Radius of the largest cell whose bound is asked of the short tape; 0: values and gradients alone. Operands must be
  /// further apart than it, or a bound of the one left out might have been the lower.
  float cell_reach = 0;
};

class Shortener {
 public:
  explicit Shortener(const Tape& full);

  /// Analyses regions together. `from` is the full tape, or one shortened over a region that holds them all.
  void analyse(const Tape& from, const Kernels& kernels, std::span<const Region> regions);
  /// What float32 computes for f lies within [lower, upper] all over a region that was analysed.
  [[nodiscard]] float lower(std::size_t region) const { return columns_.lower[region]; }
  [[nodiscard]] float upper(std::size_t region) const { return columns_.upper[region]; }
  /// The tape for one of the analysed regions: written to `to`, which began as a copy of the full tape.
  void shorten(const Tape& from, std::size_t region, Tape& to);

 private:
  /// Numbers from lo to hi; none when lo > hi.
  struct Range {
    double lo, hi;
  };
  /// Which operands a combining instruction needs, and which of their values matter.
  struct Needs {
    bool accumulator = true, operand = true;
    Range accumulator_range, operand_range;
  };

  void trace_sources(const Tape& from);
  [[nodiscard]] Range interval(std::uint32_t instruction, std::size_t region) const;
  [[nodiscard]] Needs needs(const Tape& from, std::size_t instruction, std::size_t region, Range matters) const;
  void require(std::uint16_t slot, Range range);

  Affine slack_;
  Arena arena_;
  RegionColumns columns_;
  std::vector<float> gap_;  ///< per region: how far apart operands must be
  float* record_ = nullptr;
  /// Per instruction: the ones whose results it finds in the accumulator and in its operand.
  std::vector<std::uint32_t> accumulator_source_, operand_source_;
  std::vector<std::uint32_t> writer_;  ///< per register
  std::vector<Range> register_range_;  ///< values that matter to what comes later
  std::vector<std::uint8_t> position_used_;
};

}  // namespace thalweg
