// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Shortened tapes (Keeter 2020; Barbier et al. 2025): what cannot decide the value anywhere in a region is left out.
// Over that region the short tape returns the bits of the full one, in every mode.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kernels/regions.h"
#include "solve/arena.h"
#include "thalweg/tape.h"

namespace thalweg {

/// Tapes from this length on are worth shortening for regions of rows.
inline constexpr std::size_t kLongTape = 128;

/// A ball that holds all points at which a short tape will be evaluated, and a box where one is known.
struct Region {
  static constexpr float kUnknown = std::numeric_limits<float>::infinity();
  float centre[3] = {};
  float half[3] = {kUnknown, kUnknown, kUnknown};
  float reach = 0;
  /// Radius of the largest cell whose bound is asked of the short tape; 0: values and gradients alone. Operands must be
  /// further apart than it, or a bound of the one left out might have been the lower.
  float cell_reach = 0;
};

class Shortener {
 public:
  /// For this tape from now on; `full` must outlive its use. Keeps the memory of the last one.
  void begin(const Tape& full);

  /// Analyses regions together and writes a tape for each. `from` is the full tape, or one shortened over a region that
  /// holds them all. With a band, values beyond [-band, band] matter only for the side on which they lie: a short tape
  /// gives another value there, on the same side of the band, and where all values are beyond it no tape is written.
  void analyse(const Tape& from, const Kernels& kernels, std::span<const Region> regions,
               float band = std::numeric_limits<float>::infinity());
  /// The same for one region that is given as up to Kernels::pieces pieces. Their intervals are narrower than its own,
  /// so more can be left out than by looking at it as a whole.
  void analyse_pieces(const Tape& from, const Kernels& kernels, std::span<const Region> pieces);
  /// What float32 computes for f lies within [lower, upper] all over a region that was analysed.
  [[nodiscard]] float lower(std::size_t region) const { return groups_[region / kRegionLanes].lower[lane(region)]; }
  [[nodiscard]] float upper(std::size_t region) const { return groups_[region / kRegionLanes].upper[lane(region)]; }
  /// The program for one of the analysed regions, valid until the next analysis.
  [[nodiscard]] std::span<const Instruction> program(std::size_t region) const {
    const Stream& stream = streams_[region];
    return {stream.instructions, stream.size};
  }
  /// The same as the program of `to`, which began as a copy of the full tape.
  void shorten(std::size_t region, Tape& to) const { to.shorten_to(program(region)); }

 private:
  /// A program while it is written.
  struct Stream {
    Instruction* instructions = nullptr;
    std::uint32_t size = 0;
    std::uint32_t producer = 0;  ///< one more than the index of what left the accumulator as it is; 0: nothing yet
    void add(const Instruction& in);
    void keep(std::uint16_t target);
    void load(std::uint16_t slot, std::uint16_t target);
  };

  static std::size_t lane(std::size_t region) { return region % kRegionLanes; }
  void take_memory(const Tape& from, std::size_t programs);
  [[nodiscard]] RegionColumns columns_of(std::span<const Region> regions, float band);
  void write(const Tape& from, std::span<Stream> streams);

  Affine slack_;
  Arena arena_;
  RegionWork work_;
  std::vector<RegionColumns> groups_;  ///< of kRegionLanes regions
  std::vector<Stream> streams_;
  std::vector<float> ranges_;
  std::vector<std::uint32_t> positions_;
};

}  // namespace thalweg
