// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The certified search for deepest points and regions, a cohort of rows at a time:
//
//   roots    a coarse grid over the boxes' overlap; a descent from its best point gives the row's incumbent
//   explore  cells are dropped, with g > -delta all over, kept as pieces (cohort_pieces.inl), or cut
//   part     pieces are joined into regions, each with a descent of its own
//   refine   cells that may hold a point deeper than their region's by more than the tolerance are cut until none may
//
// Without a witness cells are dropped where g > 0 all over, and what is left after the first waves goes to refine.
// A row is answered here when all of it is proven; any other is left to the search of one row, which has the whole
// budget and double behind it. Included once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_COHORT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_COHORT_INL
#undef THALWEG_SOLVE_PAIRS_COHORT_INL
#else
#define THALWEG_SOLVE_PAIRS_COHORT_INL
#endif

#include "solve/pairs/cohort_refine.inl"
#include "solve/pairs/finish_pairs.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Waves of part().
inline constexpr uint32_t kMostParted = 6;

template <int D>
class PairCohort : private CohortRefiner<D> {
  using Base = CohortRefiner<D>;
  using Base::count_, Base::descents_, Base::fields_, Base::joiner_, Base::open_, Base::pieces_, Base::points_,
      Base::rows_, Base::spans_, Base::tile_, Base::wave_;

 public:
  using Base::Base;

  /// Answers what it can of `count` rows of the tile, from its `first` on, all of the same two shapes. Returns, bit by
  /// bit, which are left over; `evaluations` says what each took.
  uint32_t run(size_t first, size_t count, PairScratch& scratch, uint32_t* evaluations) {
    this->begin(first, count, scratch);
    this->explore();
    part();
    this->refine();
    uint32_t left = 0;
    for (size_t k = 0; k < count; ++k) {
      CohortRow<D>& row = rows_[k];
      evaluations[k] = row.evaluations;
      if (row.stage == Stage::alone) {
        left |= uint32_t{1} << k;
      } else {
        finish(row);
      }
    }
    return left;
  }

 private:
  // --- regions
  // ----------------------------------------------------------------------------------------------------------

  void part() {
    for (uint32_t wave = 0; wave < kMostParted; ++wave) {
      label();
      gather_doubtful();
      if (spans_.count == 0) return;
      this->evaluate(true);
      this->aim();
      this->bound(false);
      this->evaluate(false);
      open_.count = 0;
      for (const Span& span : spans_) {
        if (!this->sift(rows_[span.row], span) || open_.count > 0) rows_[span.row].stage = Stage::alone;
        open_.count = 0;
      }
    }
    for (size_t k = 0; k < count_; ++k) {
      if (rows_[k].stage == Stage::explores) rows_[k].stage = Stage::alone;
    }
  }

  void label() {
    descents_.clear();
    for (uint32_t k = 0; k < count_; ++k) {
      CohortRow<D>& row = rows_[k];
      if (row.stage != Stage::explores) continue;
      if (!row.is_witness(0)) {
        row.stage = Stage::refines;
        continue;
      }
      const auto known = static_cast<uint32_t>(row.regions);
      if (!joiner_.label(row, pieces_)) row.stage = Stage::alone;
      for (uint32_t j = known; j < row.regions; ++j) descents_.add({k, j, row.farthest, row.tolerance / 20, true});
    }
    descents_.run(fields_, rows_, kDeepestSteps);
    descents_.choose_far(fields_, rows_);
  }

  /// The wave becomes the pieces in doubt, which leave their rows; rows without any go on to refine().
  void gather_doubtful() {
    spans_.count = wave_.count = 0;
    for (uint32_t k = 0; k < count_; ++k) {
      CohortRow<D>& row = rows_[k];
      if (row.stage != Stage::explores) continue;
      joiner_.part(row, pieces_);
      if (!row.in_doubt) {
        row.stage = Stage::refines;
        continue;
      }
      const size_t begin = wave_.count;
      size_t kept = row.first_piece;
      for (size_t i = row.first_piece; i < row.first_piece + row.pieces; ++i) {
        const bool doubtful = pieces_.component[i] == kDoubtful;
        copy_cell(pieces_, i, doubtful ? wave_ : pieces_, doubtful ? wave_.count++ : kept++);
      }
      row.pieces = row.labelled = kept - row.first_piece;
      if (wave_.count == begin) row.stage = Stage::refines;
      row.limit[kDoubtful] = -row.deep;
      row.is_uniform = false;
      spans_.add(k, begin, wave_.count);
    }
    pad_components(wave_);
  }

  static void copy_cell(const PairCells& from, size_t i, const PairCells& to, size_t j) {
    for (int axis = 0; axis < D; ++axis) to.at[axis][j] = from.at[axis][i];
    to.size[j] = from.size[i];
    to.value[j] = from.value[i];
    to.lower[j] = from.lower[i];
    to.component[j] = from.component[i];
  }

  // --- results
  // ----------------------------------------------------------------------------------------------------------

  [[nodiscard]] static PairFinding finding_of(const CohortRow<D>& row, size_t j) {
    PairFinding f;
    std::copy_n(row.best[j].point, D, f.point);
    f.value = row.best[j].value();
    f.lower = std::min(row.limit[j], row.open_lower[j]);
    f.witness = row.is_witness(j);
    f.converged = f.value - f.lower <= static_cast<float>(row.problem.limits.tolerance);
    return f;
  }

  void finish(const CohortRow<D>& row) {
    uint32_t order[kMostRegions];
    uint32_t found = 0;
    for (uint32_t j = 0; j < row.regions; ++j) {
      if (row.is_witness(j)) order[found++] = j;
    }
    std::sort(order, order + found, [&](uint32_t i, uint32_t j) {
      const float a = row.best[i].value(), b = row.best[j].value();
      return a != b ? a < b : i < j;
    });
    const uint32_t deepest = found == 0 ? 0 : order[0];
    PairFinding whole = finding_of(row, deepest);
    for (uint32_t i = 1; i < found; ++i) {
      const PairFinding f = finding_of(row, order[i]);
      whole.lower = std::min(whole.lower, f.lower);
      whole.converged = whole.converged && f.converged;
    }
    if (found == 0) {
      whole.lower = std::min(row.closed_lower, static_cast<float>(row.problem.outside * (1 - 1e-6)));
      whole.converged = true;
    }
    PairRow of;
    of.evaluations = row.evaluations;
    of.iterations = row.depth;
    of.claimed = whole.value < 0;
    of.status = status_of(whole, static_cast<double>(row.frame.slack), row.problem.limits.tolerance, found == 0);
    write_row(tile_, row.index, whole, of);
    float normal[3] = {};
    const bool ambiguous = pair_normal(row.best[deepest].gradient_a, row.best[deepest].gradient_b, D, normal);
    write_normal(tile_, row.index, normal, ambiguous, D);
    if (tile_.contacts.found == nullptr) return;
    tile_.contacts.found[row.index] = found;
    for (uint32_t i = 0; i < std::min<size_t>(found, tile_.contacts.capacity); ++i) {
      PairContact contact;
      contact.found = finding_of(row, order[i]);
      const PairState<D>& best = row.best[order[i]];
      contact.ambiguous = pair_normal(best.gradient_a, best.gradient_b, D, contact.normal);
      write_contact(tile_, row.index, i, contact, D);
    }
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
