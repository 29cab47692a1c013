// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Wave 0 of verdicts: every query is one cell. Blocks of rows that stay in the first-level cache are loaded, evaluated
// at their centroids and written to the result columns; the few rows that this does not decide are put side by side for
// the search. Included once per SIMD target.
#if defined(THALWEG_SOLVE_FIRST_WAVE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_FIRST_WAVE_INL
#undef THALWEG_SOLVE_FIRST_WAVE_INL
#else
#define THALWEG_SOLVE_FIRST_WAVE_INL
#endif

#include <algorithm>

#include "solve/plan.h"
#include "solve/wave.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Rows that wave 0 works on at a time: a chunk of values. All their columns stay in the first-level cache, which those
/// of 512 rows overflow (measured on an Intel Xeon: 96 million triangles a second, 92 with 128 rows, 75 with 512).
inline constexpr size_t kBlockRows = 64;

/// A part of a slack as a float: it is a claim.
inline float rounded_up(double x) { return static_cast<float>(x * (1 + 1e-6)); }

template <class Domain>
class FirstWave {
 public:
  FirstWave(const QueryTile& tile, TileScratch& scratch) : tile_(tile), scratch_(scratch) {
    state_ = QueryState::make(scratch.arena, tile.tape->dimension, kBlockRows);
    domain_.take(scratch.arena, kBlockRows);
    open_ = scratch.arena.take<uint32_t>(padded(tile.count) + kColumnPadding);
    rows_ = scratch.arena.take<float>(padded(tile.count) * Domain::kWidth);
  }

  /// Answers what it can; returns how many queries stay open.
  size_t run(float* scratch) {
    size_t open_count = 0;
    for (size_t first = 0; first < tile_.count; first += kBlockRows) {
      QueryTile block = tile_;
      block.count = std::min(kBlockRows, tile_.count - first);
      block.rows += first * Domain::kWidth;
      block.columns = columns_from(tile_.columns, first, tile_.tape->dimension);
      domain_.load(block, state_);
      tile_.kernels->value(*tile_.tape, state_.point, block.count, state_.value, scratch);
      open_count = bound(first, block.count, open_count);
      scratch_.block_arena.reset();
      tile_.kernels->finish(block, state_, scratch, scratch_.block_arena);
    }
    for (size_t i = 0; i < open_count; ++i) {
      std::copy_n(tile_.rows + open_[i] * Domain::kWidth, Domain::kWidth, rows_ + i * Domain::kWidth);
    }
    return open_count;
  }

  /// The queries that stay open: which rows of the tile they are, and those rows side by side.
  [[nodiscard]] const uint32_t* open() const { return open_; }
  [[nodiscard]] const float* rows() const { return rows_; }

 private:
  /// What the centroids prove.
  size_t bound(size_t first, size_t count, size_t open_count) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const QueryState& s = state_;
    const auto slack_a = hn::Set(d, rounded_up(tile_.limits->slack.a));
    const auto slack_b = hn::Set(d, rounded_up(tile_.limits->slack.b));
    const auto lipschitz = hn::Set(d, static_cast<float>(tile_.tape->facts.lipschitz));
    const auto one = hn::Set(d, 1.0F);
    const float* const next = tile_.rows + (first + kBlockRows) * Domain::kWidth;
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
      // Into the second-level cache: the first holds this block.
      for (size_t k = 0; k < Domain::kWidth; ++k)
        __builtin_prefetch(next + i * Domain::kWidth + k * hn::Lanes(d), 0, 2);
      const auto slack = hn::MulAdd(slack_b, hn::LoadU(d, domain_.largest() + i), slack_a);
      const auto f = hn::LoadU(d, s.value + i);
      const auto lower = hn::Sub(hn::NegMulAdd(lipschitz, hn::LoadU(d, domain_.reach() + i), f), slack);
      const auto witness = hn::Lt(f, hn::Neg(slack));
      const auto bad = hn::Gt(hn::LoadU(d, s.is_bad + i), hn::Zero(d));
      const auto closed = hn::Or(hn::Or(bad, witness), hn::Gt(lower, hn::Zero(d)));
      hn::StoreU(slack, d, s.slack + i);
      hn::StoreU(lower, d, s.lower + i);
      hn::StoreU(hn::IfThenElseZero(witness, one), d, s.witness + i);
      hn::StoreU(hn::IfThenElseZero(closed, one), d, s.converged + i);
      hn::StoreU(hn::Set(du, 1), du, s.evaluations + i);
      hn::StoreU(hn::Zero(du), du, s.iterations + i);
      const auto here = hn::FirstN(d, HWY_MIN(count - i, hn::Lanes(d)));
      const auto stays = hn::RebindMask(du, hn::AndNot(closed, here));
      const auto row = hn::Iota(du, static_cast<uint32_t>(first + i));
      hn::StoreU(hn::Compress(row, stays), du, open_ + open_count);
      open_count += hn::CountTrue(du, stays);
    }
    return open_count;
  }

  const QueryTile& tile_;
  TileScratch& scratch_;
  Domain domain_;
  QueryState state_;
  uint32_t* open_ = nullptr;
  float* rows_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
