// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The last part of cohort.inl: cells that may hold a point deeper than their region's are cut until none may. Included
// once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_COHORT_REFINE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_COHORT_REFINE_INL
#undef THALWEG_SOLVE_PAIRS_COHORT_REFINE_INL
#else
#define THALWEG_SOLVE_PAIRS_COHORT_REFINE_INL
#endif

#include "solve/pairs/cohort_explore.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Waves of refine().
inline constexpr uint32_t kMostRefined = 12;
/// Cells of this depth are exact in float32.
inline constexpr uint32_t kLastDepth = 17;
/// About what a descent and its far distances take.
inline constexpr uint32_t kDescentCost = kDeepestSteps * kCohortRungs + kFarRungs + 1;
/// Evaluations after which a row without a witness is left over: it may be for double to tell.
inline constexpr uint32_t kMostApart = 2560;

template <int D>
class CohortRefiner : protected CohortExplorer<D> {
  using Base = CohortExplorer<D>;

 public:
  using Base::Base;

 protected:
  using Base::bounds_, Base::count_, Base::descents_, Base::far_, Base::fields_, Base::joiner_, Base::open_,
      Base::pieces_, Base::points_, Base::rows_, Base::spans_, Base::tile_, Base::wave_;

  using Base::kChildren;

  void refine() {
    gather_pieces();
    for (uint32_t wave = 0; spans_.count > 0; ++wave) {
      this->evaluate(true);
      improve();
      aim();
      bound(wave == kMostRefined);
    }
  }

  void aim() {
    const size_t count = spans_.cells();
    const bool bends_a = !fields_.a.facts().convex, bends_b = !fields_.b.facts().convex;
    for (const Span& span : spans_) {
      CohortRow<D>& row = rows_[span.row];
      row.set_far(row.reach * wave_.size[span.begin]);
      row.far_a[kDoubtful] = row.far_a[0];
      row.far_b[kDoubtful] = row.far_b[0];
      const AimedField<D> a(row.far_a, points_.a, points_.gradient_a, far_.a, far_.gradient_a);
      const AimedField<D> b(row.far_b, points_.b, points_.gradient_b, far_.b, far_.gradient_b);
      for (size_t i = span.begin; i < span.end; i += hn::Lanes(F32())) {
        if (bends_a) a.aim(row, wave_, i);
        if (bends_b) b.aim(row, wave_, i);
      }
      if (bends_a || bends_b) row.count(span.end - span.begin);
    }
    if (bends_a) fields_.a.values(far_.a, count, far_.value_a);
    if (bends_b) fields_.b.values(far_.b, count, far_.value_b);
  }

  /// The wave becomes the children of its cells that the joint bound leaves open.
  void bound(bool is_last) {
    const BoundPass<D> pass{&fields_, &points_, &far_};
    Spans left;
    bounds_.count = 0;
    for (const Span& span : spans_) {
      CohortRow<D>& row = rows_[span.row];
      if (row.stage == Stage::alone) continue;
      const size_t begin = bounds_.count;
      bound_span<D>(pass, row, wave_, span, bounds_);
      const size_t open = bounds_.count - begin;
      const bool is_spent = !(row.deep > 0) && row.evaluations > kMostApart;
      if (open > 0 && (is_last || is_spent || ++row.depth > kLastDepth || kChildren * open > kMostInWave)) {
        row.stage = Stage::alone;
        bounds_.count = begin;
      }
      left.add(span.row, begin, bounds_.count);
    }
    spans_.count = open_.count = 0;
    for (const Span& span : left) {
      const size_t begin = open_.count;
      CohortRow<D>& row = rows_[span.row];
      split_open<D>(row, wave_, bounds_, span, open_);
      const size_t cost = 2 * (open_.count - begin) + kDescentCost * row.regions;
      if (row.stage == Stage::refines && row.deep > 0 && row.evaluations + cost > row.problem.limits.budget) {
        leave_open(row, begin);
      }
      spans_.add(span.row, begin, open_.count);
    }
    std::swap(wave_, open_);
    pad_components(wave_);
  }

 private:
  static void set_limits(CohortRow<D>& row) {
    for (size_t j = 0; j < row.regions; ++j) {
      row.value[j] = row.best[j].value();
      row.limit[j] = row.is_witness(j) ? row.value[j] - row.tolerance : 0;
    }
  }

  void gather_pieces() {
    spans_.count = wave_.count = 0;
    for (uint32_t k = 0; k < count_; ++k) {
      CohortRow<D>& row = rows_[k];
      if (row.stage != Stage::refines) continue;
      set_limits(row);
      row.is_uniform = row.regions == 1;
      const size_t begin = wave_.count;
      gather(row);
      if (wave_.count - begin > kMostInWave ||
          row.evaluations + 2 * (wave_.count - begin) > row.problem.limits.budget) {
        row.stage = Stage::alone;
        wave_.count = begin;
      }
      spans_.add(k, begin, wave_.count);
    }
    pad_components(wave_);
  }

  void gather(const CohortRow<D>& row) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const size_t end = row.first_piece + row.pieces;
    for (size_t i = row.first_piece; i < end; i += hn::Lanes(d)) {
      const auto here = hn::FirstN(d, HWY_MIN(end - i, hn::Lanes(d)));
      const auto component = hn::And(hn::LoadU(du, pieces_.component + i), hn::Set(du, kMostRegions - 1));
      const auto limit = hn::GatherIndex(d, row.limit, hn::BitCast(hn::RebindToSigned<F32>(), component));
      const auto lower = hn::LoadU(d, pieces_.lower + i);
      const auto stays = hn::AndNot(hn::Gt(lower, limit), here);
      for (int axis = 0; axis < D; ++axis) {
        pack(hn::LoadU(d, pieces_.at[axis] + i), stays, wave_.at[axis] + wave_.count);
      }
      pack(hn::LoadU(d, pieces_.size + i), stays, wave_.size + wave_.count);
      pack(lower, stays, wave_.lower + wave_.count);
      wave_.count += pack(component, hn::RebindMask(du, stays), wave_.component + wave_.count);
    }
  }

  /// Centres deeper than their region's point begin a descent.
  void improve() {
    const F32 d;
    descents_.clear();
    for (const Span& span : spans_) {
      CohortRow<D>& row = rows_[span.row];
      uint32_t better = 0;
      for (size_t i = span.begin; i < span.end; i += hn::Lanes(d)) {
        const auto here = hn::FirstN(d, HWY_MIN(span.end - i, hn::Lanes(d)));
        const auto value = hn::Max(hn::LoadU(d, points_.value_a + i), hn::LoadU(d, points_.value_b + i));
        const auto deeper = hn::And(here, hn::Lt(value, of_component(row.value, wave_.component + i)));
        if (hn::AllFalse(d, deeper)) continue;
        for (size_t k = i; k < std::min<size_t>(span.end, i + hn::Lanes(d)); ++k) better |= adopt(row, k);
      }
      for (uint32_t j = 0; j < row.regions; ++j) {
        if ((better >> j & 1) == 0) continue;
        descents_.add({span.row, j, row.farthest, row.tolerance / 20, row.deep > 0});
      }
    }
    if (descents_.empty()) return;
    descents_.run(fields_, rows_, kDeepestSteps);
    descents_.choose_far(fields_, rows_);
    for (const Span& span : spans_) {
      CohortRow<D>& row = rows_[span.row];
      // What was dropped before there was a witness says nothing of its region.
      if (!(row.deep > 0) && row.is_witness(0)) row.stage = Stage::alone;
      set_limits(row);
    }
  }

  uint32_t adopt(CohortRow<D>& row, size_t i) const {
    const uint32_t j = wave_.component[i];
    const float value = std::max(points_.value_a[i], points_.value_b[i]);
    if (!(value < row.value[j])) return 0;
    row.value[j] = value;
    for (int axis = 0; axis < D; ++axis) row.best[j].point[axis] = points_.a[axis][i];
    return uint32_t{1} << j;
  }

  /// The budget is spent: the cells of open_ from `begin` on stay open.
  void leave_open(CohortRow<D>& row, size_t begin) {
    for (size_t i = begin; i < open_.count; ++i) {
      float& lower = row.open_lower[open_.component[i]];
      lower = std::min(lower, open_.lower[i]);
    }
    open_.count = begin;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
