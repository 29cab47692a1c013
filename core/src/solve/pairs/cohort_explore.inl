// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The first two parts of cohort.inl: a coarse grid of roots with a descent for each row, and the waves that drop cells
// or keep them as pieces. Included once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_COHORT_EXPLORE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_COHORT_EXPLORE_INL
#undef THALWEG_SOLVE_PAIRS_COHORT_EXPLORE_INL
#else
#define THALWEG_SOLVE_PAIRS_COHORT_EXPLORE_INL
#endif

#include "solve/pairs/cohort_bounds.inl"
#include "solve/pairs/cohort_descents.inl"
#include "solve/pairs/cohort_pieces.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Reach of a root cell in units of e / L.
inline constexpr double kRootReach = 3.5;
inline constexpr int64_t kMostCohortRoots = 64;
/// Waves after which a row is no longer worth the company.
inline constexpr uint32_t kMostExplored = 6;
/// A row with less of a budget is searched alone from the start.
inline constexpr uint32_t kLeastBudget = 2048;

template <int D>
class CohortExplorer {
 public:
  static constexpr size_t kChildren = size_t{1} << D;

  CohortExplorer(const PairTile& tile, PairScratch& scratch) : tile_(tile) {
    Arena& arena = scratch.cohort;
    arena.reset();
    const size_t room = padded(kCohortRows * kMostInWave) + kColumnPadding;
    for (PairCells* cells : {&wave_, &open_}) cells->template take<D>(arena, room);
    pieces_.template take<D>(arena, padded(kCohortRows * kPieceRoom) + kColumnPadding);
    points_.template take<D>(arena, room);
    far_.template take<D>(arena, room);
    bounds_.take(arena, room);
    rows_ = arena.take<CohortRow<D>>(kCohortRows);
    descents_.take(arena);
    joiner_.take(arena);
  }

 protected:
  void begin(size_t first, size_t count, PairScratch& scratch) {
    scratch.query.reset();
    count_ = count;
    wave_.count = 0;
    spans_.count = 0;
    for (size_t k = 0; k < count; ++k) {
      CohortRow<D>& row = rows_[k];
      row.index = tile_.row(first + k);
      row.evaluations = 0;
      row.stage = Stage::alone;
      if (!prepare(*tile_.queries, *tile_.options, row.index, row.problem) || row.problem.empty()) continue;
      if (!set_frame(row)) continue;
      row.first_piece = k * kPieceRoom;
      row.pieces = row.labelled = 0;
      const size_t begin = wave_.count;
      if (!lay_roots(row)) continue;
      row.stage = Stage::explores;
      spans_.add(static_cast<uint32_t>(k), begin, wave_.count);
    }
    if (spans_.count == 0) return;
    fields_.begin(tile_, rows_[spans_.of[0].row].problem, scratch.query);
    evaluate(false);
    descents_.clear();
    for (const Span& span : spans_) descend_from_best(span, true);
    descents_.run(fields_, rows_, kDeepestSteps);
    descents_.choose_far(fields_, rows_);
    for (const Span& span : spans_) set_aim(rows_[span.row]);
  }

  void explore() {
    for (uint32_t wave = 0; spans_.count > 0; ++wave) {
      Spans left;
      open_.count = 0;
      for (const Span& span : spans_) {
        CohortRow<D>& row = rows_[span.row];
        const size_t begin = open_.count;
        if (!sift(row, span)) row.stage = Stage::alone;
        const size_t open = open_.count - begin;
        if (row.stage == Stage::explores && !row.is_witness(0) && wave > 0) hand_over(row, begin);
        const size_t cost = kChildren * open;
        const bool too_many = wave == kMostExplored || cost > kMostInWave || row.evaluations + cost > kLeastBudget;
        if (row.stage == Stage::explores && open > 0 && too_many) row.stage = Stage::alone;
        if (row.stage != Stage::explores) open_.count = begin;
        left.add(span.row, begin, open_.count);
      }
      cut(left);
      if (spans_.count == 0) return;
      evaluate(false);
      seek_witnesses();
    }
  }

  /// Both fields at the centres of the spans' cells.
  void evaluate(bool gradients) {
    for (const Span& span : spans_) {
      place_centres(rows_[span.row], wave_, span, points_);
      rows_[span.row].count(span.end - span.begin);
    }
    gradients ? fields_.gradients(points_, spans_.cells()) : fields_.values(points_, spans_.cells());
  }

  /// Drops cells, keeps pieces, and appends the others to open_. False when there are too many pieces.
  bool sift(CohortRow<D>& row, Span span) {
    if (row.pieces + (span.end - span.begin) > kMostPieces) return false;
    const F32 d;
    const bool witness = row.deep > 0;
    const auto slack = hn::Set(d, row.frame.slack);
    const auto limit = hn::Set(d, row.deep > 0 ? -row.deep : 0.0F);
    const auto level = hn::Set(d, row.level);
    const auto twice = hn::Set(d, 2 * row.level + row.deep);
    auto closed_lower = hn::Set(d, row.closed_lower);
    size_t piece = row.first_piece + row.pieces;
    for (size_t i = span.begin; i < span.end; i += hn::Lanes(d)) {
      const auto here = hn::FirstN(d, HWY_MIN(span.end - i, hn::Lanes(d)));
      const auto a = hn::LoadU(d, points_.value_a + i), b = hn::LoadU(d, points_.value_b + i);
      const auto reach = hn::Mul(hn::LoadU(d, wave_.size + i), hn::Set(d, row.reach));
      const auto lower_a = hn::NegMulAdd(hn::Set(d, row.frame.lipschitz_a), reach, a);
      const auto lower_b = hn::NegMulAdd(hn::Set(d, row.frame.lipschitz_b), reach, b);
      const auto lower = hn::Sub(hn::Max(lower_a, lower_b), slack);
      const auto closed = hn::Gt(lower, limit);
      closed_lower = hn::Min(closed_lower, hn::IfThenElse(hn::And(here, closed), lower, hn::Set(d, kNoBound)));
      auto stays = hn::AndNot(closed, here);
      if (hn::AllFalse(d, stays)) continue;
      if (witness) {
        // g(c) <= e, and L r <= 2 e + delta - g(c).
        const auto value = hn::Max(a, b);
        const auto least = hn::NegMulAdd(hn::Set(d, row.stretch * 1.00001F), reach, twice);
        const auto is_piece = hn::And(stays, hn::Le(value, hn::Min(level, least)));
        keep_columns(i, is_piece, lower, pieces_, piece);
        piece += pack(value, is_piece, pieces_.value + piece);
        stays = hn::AndNot(is_piece, stays);
      }
      keep_columns(i, stays, lower, open_, open_.count);
      open_.count += hn::CountTrue(d, stays);
    }
    row.closed_lower = hn::GetLane(hn::MinOfLanes(d, closed_lower));
    row.pieces = piece - row.first_piece;
    return true;
  }

  HWY_INLINE void keep_columns(size_t i, M32 which, V32 lower, PairCells& to, size_t at) const {
    const F32 d;
    for (int axis = 0; axis < D; ++axis) {
      pack(hn::LoadU(d, wave_.at[axis] + i), which, to.at[axis] + at);
    }
    pack(hn::LoadU(d, wave_.size + i), which, to.size + at);
    pack(lower, which, to.lower + at);
  }

  const PairTile& tile_;
  PairFields<D> fields_;
  CohortDescents<D> descents_;
  PieceJoiner<D> joiner_;
  CohortRow<D>* rows_ = nullptr;
  size_t count_ = 0;
  Spans spans_;  ///< of wave_
  PairCells wave_, open_;
  PairCells pieces_;  ///< kPieceRoom for each row; without a witness, what refine() begins with
  PairPoints points_, far_;
  ChildBounds<D> bounds_;

 private:
  // --- roots
  // ------------------------------------------------------------------------------------------------------------

  static bool set_frame(CohortRow<D>& row) {
    const PairProblem& p = row.problem;
    PairFrame<D>& frame = row.frame;
    if (p.limits.budget < kLeastBudget) return false;
    if (!std::isfinite(p.a->facts.lipschitz) || !std::isfinite(p.b->facts.lipschitz)) return false;
    for (int axis = 0; axis < D; ++axis) {
      frame.origin[axis] = static_cast<float>((p.lo[axis] + p.hi[axis]) / 2);
      frame.translation[axis] = static_cast<float>(p.pose.translation[axis]);
      for (int column = 0; column < D; ++column) {
        frame.rotation[axis][column] = static_cast<float>(p.pose.rotation[3 * axis + column]);
      }
    }
    frame.lipschitz_a = static_cast<float>(p.a->facts.lipschitz * (1 + 1e-6));
    frame.lipschitz_b = static_cast<float>(p.b->facts.lipschitz * (1 + 1e-6));
    row.stretch = std::max(frame.lipschitz_a, frame.lipschitz_b);
    row.tolerance = static_cast<float>(0.999 * p.limits.tolerance);
    row.farthest = static_cast<float>(0.5 * p.limits.size);
    row.closed_lower = kNoBound;
    std::fill_n(row.open_lower, kMostRegions, kNoBound);
    row.depth = 0;
    row.regions = 1;
    return row.stretch > 0;
  }

  /// Cells of equal size that fill the box, and how much rounding the search must allow for.
  bool lay_roots(CohortRow<D>& row) {
    const PairProblem& p = row.problem;
    double target = kRootReach * p.limits.region / static_cast<double>(row.stretch) / std::sqrt(static_cast<double>(D));
    double largest = 0;
    for (int axis = 0; axis < D; ++axis) largest = std::max({largest, std::fabs(p.lo[axis]), std::fabs(p.hi[axis])});
    int64_t count[3] = {1, 1, 1};
    double extent[3] = {};
    for (int axis = 0; axis < D; ++axis) extent[axis] = 1.00001 * (p.hi[axis] - p.lo[axis]) + 1e-6 * largest;
    const auto fits = [&] {
      for (int axis = 0; axis < D; ++axis) {
        const double cells = std::ceil(extent[axis] / (2 * target));
        if (!(cells <= static_cast<double>(kMostCohortRoots))) return false;
        count[axis] = std::max<int64_t>(static_cast<int64_t>(cells), 1);
      }
      return count[0] * count[1] * count[2] <= kMostCohortRoots;
    };
    for (int halvings = 0; !fits(); ++halvings) {
      if (halvings == 4) return false;
      target *= 1.26;
    }
    double square = 0;
    for (int axis = 0; axis < D; ++axis) {
      row.half[axis] = static_cast<float>(extent[axis] / static_cast<double>(2 * count[axis]) * (1 + 1e-6));
      square += static_cast<double>(row.half[axis]) * static_cast<double>(row.half[axis]);
      largest = std::max(largest, std::fabs(static_cast<double>(row.frame.origin[axis])) + extent[axis]);
    }
    row.reach = static_cast<float>(std::sqrt(square) * (1 + 1e-6));
    row.frame.slack = static_cast<float>(p.slack(largest + static_cast<double>(row.farthest)) * (1 + 1e-6));
    row.level = static_cast<float>(p.limits.region) * 0.99999F - 4 * row.frame.slack;
    if (!(row.level > 0.5F * static_cast<float>(p.limits.region))) return false;
    fill_roots(count);
    return true;
  }

  void fill_roots(const int64_t* count) {
    for (int64_t z = 0; z < count[2]; ++z) {
      for (int64_t y = 0; y < count[1]; ++y) {
        for (int64_t x = 0; x < count[0]; ++x) {
          const int64_t index[3] = {x, y, z};
          for (int axis = 0; axis < D; ++axis) {
            wave_.at[axis][wave_.count] = static_cast<float>(2 * index[axis] + 1 - count[axis]);
          }
          wave_.size[wave_.count++] = 1;
        }
      }
    }
  }

  /// A descent for the row from the best centre of its wave, where that is better than what it has.
  void descend_from_best(const Span& span, bool whatever) {
    CohortRow<D>& row = rows_[span.row];
    float least = 0;
    const size_t i = least_of(points_.value_a, points_.value_b, span.begin, span.end, least);
    if (!whatever && !(least < row.best[0].value())) return;
    for (int axis = 0; axis < D; ++axis) row.best[0].point[axis] = points_.a[axis][i];
    descents_.add({span.row, 0, row.farthest, row.tolerance / 20, false});
  }

  /// What is deep follows from the deepest point known.
  static void set_aim(CohortRow<D>& row) {
    row.deep = row.is_witness(0) ? std::min(row.level, -row.best[0].value() / 2) : 0;
  }

  // --- waves
  // -------------

  /// A row without a witness goes on with the joint bound.
  void hand_over(CohortRow<D>& row, size_t begin) {
    row.stage = Stage::refines;
    row.pieces = open_.count - begin;
    for (int axis = 0; axis < D; ++axis) {
      std::copy_n(open_.at[axis] + begin, row.pieces, pieces_.at[axis] + row.first_piece);
    }
    std::copy_n(open_.size + begin, row.pieces, pieces_.size + row.first_piece);
    std::copy_n(open_.lower + begin, row.pieces, pieces_.lower + row.first_piece);
    std::fill_n(pieces_.component + row.first_piece, row.pieces, 0U);
  }

  /// The children of what is open are the next wave.
  void cut(const Spans& spans) {
    const F32 d;
    spans_.count = 0;
    wave_.count = 0;
    for (const Span& span : spans) {
      const size_t begin = wave_.count;
      for (size_t child = 0; child < kChildren; ++child) {
        const size_t to = wave_.count;
        for (size_t i = span.begin; i < span.end; i += hn::Lanes(d)) {
          const auto size = hn::Mul(hn::LoadU(d, open_.size + i), hn::Set(d, 0.5F));
          hn::StoreU(size, d, wave_.size + to + (i - span.begin));
          for (int axis = 0; axis < D; ++axis) {
            const auto step = (child >> axis & 1) != 0 ? size : hn::Neg(size);
            hn::StoreU(hn::Add(hn::LoadU(d, open_.at[axis] + i), step), d, wave_.at[axis] + to + (i - span.begin));
          }
        }
        wave_.count += span.end - span.begin;
      }
      ++rows_[span.row].depth;
      spans_.add(span.row, begin, wave_.count);
    }
  }

  void seek_witnesses() {
    descents_.clear();
    for (const Span& span : spans_) {
      if (!rows_[span.row].is_witness(0)) descend_from_best(span, false);
    }
    if (descents_.empty()) return;
    descents_.run(fields_, rows_, kDeepestSteps);
    descents_.choose_far(fields_, rows_);
    for (const Span& span : spans_) {
      if (!(rows_[span.row].deep > 0)) set_aim(rows_[span.row]);
    }
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
