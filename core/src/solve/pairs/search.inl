// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The certified search for one pair of shapes and one pose, and its first part: explore() cuts the region's box in
// waves until every cell is proven empty or settled, proven to lie in {g <= e}.
//
// 1. A cell that is dropped has g > 0 all over, so every common point lies in a settled cell.
// 2. A verdict alone settles nothing: the first witness ends the search.
// 3. A witness needs g < -slack, a drop needs a bound > slack; what float32 cannot tell goes on in double.
// 4. The budget bounds the cells ever held. A search that it ends keeps what is proven: open cells count as settled,
//    and `converged` says that they are not.
// 5. Nothing but the query's own numbers is used. Included once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_SEARCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_SEARCH_INL
#undef THALWEG_SOLVE_PAIRS_SEARCH_INL
#else
#define THALWEG_SOLVE_PAIRS_SEARCH_INL
#endif

#include <cmath>

#include "solve/pairs/bounds.inl"
#include "solve/pairs/polish.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Cells that one search may hold, whatever its budget.
inline constexpr size_t kMostPairCells = size_t{1} << 18;
/// A search begins with at most this many cells.
inline constexpr int64_t kMostRoots = 64;
/// From this level on cells without a witness get the joint bound, which costs about four values.
inline constexpr uint32_t kFirstJointLevel = 2;
/// Cells of this level are exact in float32; what is smaller goes to double.
inline constexpr uint32_t kLastLevel = 17;
/// Once touching is proven, one part in this many of the budget may have gone into proving more.
inline constexpr uint32_t kTouchingShare = 4;

/// Cells found to belong together, and what is known of them. Tables are padded: lanes gather from them.
template <int D>
struct PairRegions {
  size_t count = 0;
  float* limit = nullptr;  ///< cells with a bound above it are closed
  float* value = nullptr;  ///< of `best`
  float* far_a = nullptr;
  float* far_b = nullptr;
  float* open_lower = nullptr;  ///< least bound of a cell left open
  bool* improved = nullptr;     ///< `best` is a new centre
  PairState<D>* best = nullptr;

  void take(Arena& arena, size_t regions, float far) {
    count = regions;
    for (float** column : {&limit, &value, &far_a, &far_b, &open_lower}) *column = arena.take<float>(padded(count));
    improved = arena.take<bool>(count);
    best = arena.take<PairState<D>>(count);
    for (size_t j = 0; j < count; ++j) {
      limit[j] = 0;
      value[j] = open_lower[j] = kNoBound;
      far_a[j] = far_b[j] = far;
      improved[j] = false;
    }
  }
};

template <int D>
class PairExplorer {
 public:
  static constexpr size_t kChildren = size_t{1} << D;

  PairExplorer(const PairTile& tile, PairScratch& scratch) : tile_(tile), scratch_(scratch) {
    scratch.arena.reset();
    most_cells_ = std::min<size_t>(std::max<size_t>(tile.options->budget, kMostRoots), kMostPairCells);
    const size_t room = padded(most_cells_) + kColumnPadding;
    for (PairCells* cells : {&wave_, &open_, &settled_, &shallow_, &parents_})
      cells->template take<D>(scratch.arena, room);
    points_.template take<D>(scratch.arena, room);
    far_points_.template take<D>(scratch.arena, room);
    polisher_.take(scratch.arena);
  }

 protected:
  /// Everything that depends on the row.
  void begin() {
    scratch_.query.reset();
    wants_regions_ = problem_.limits.goal == Goal::deepest || tile_.contacts.found != nullptr;
    evaluations_ = level_ = 0;
    closed_lower_ = kNoBound;
    resolved_ = true;
    for (PairCells* cells : {&wave_, &open_, &settled_, &shallow_, &parents_}) cells->count = 0;
    fields_.begin(tile_, problem_, scratch_.query);
    tolerance_ = static_cast<float>(0.999 * problem_.limits.tolerance);
    farthest_ = static_cast<float>(0.5 * problem_.limits.size);
    polisher_.stop_below(tolerance_ / 20);
    PairFrame<D>& frame = fields_.frame;
    for (int axis = 0; axis < D; ++axis) {
      frame.translation[axis] = static_cast<float>(problem_.pose.translation[axis]);
      for (int column = 0; column < D; ++column) {
        frame.rotation[axis][column] = static_cast<float>(problem_.pose.rotation[3 * axis + column]);
      }
    }
    frame.lipschitz_a = static_cast<float>(problem_.a->facts.lipschitz * (1 + 1e-6));
    frame.lipschitz_b = static_cast<float>(problem_.b->facts.lipschitz * (1 + 1e-6));
    frame.slack = 0;
    regions_.take(scratch_.query, 1, farthest_ / 4);
  }

  /// Cells whose halves have, after some levels, just the size at which all that is not empty is settled.
  void lay_roots() {
    const PairProblem& p = problem_;
    PairFrame<D>& frame = fields_.frame;
    double largest = 0;
    for (int axis = 0; axis < D; ++axis) {
      largest = std::max({largest, std::fabs(p.lo[axis]), std::fabs(p.hi[axis])});
      frame.origin[axis] = static_cast<float>((p.lo[axis] + p.hi[axis]) / 2);
    }
    const double rough_slack = p.slack(2 * largest + static_cast<double>(farthest_));
    const double stretch = std::max(p.a->facts.lipschitz, p.b->facts.lipschitz);
    // With this reach a cell is settled, g(c) + reach + slack <= e, or g > -e all over.
    const double reach = std::max(p.limits.region - 4 * rough_slack, p.limits.region / 8) / stretch;
    double half = 0.99999 * reach / static_cast<double>(PairFrame<D>::kDiagonal);
    int64_t count[3] = {1, 1, 1};
    const auto fits = [&] {
      for (int axis = 0; axis < D; ++axis) {
        const double extent = 1.00001 * (p.hi[axis] - p.lo[axis]) + 1e-6 * largest;
        const double cells = std::ceil(extent / (2 * half));
        if (!(cells <= static_cast<double>(kMostRoots))) return false;
        count[axis] = std::max<int64_t>(static_cast<int64_t>(cells), 1);
      }
      return count[0] * count[1] * count[2] <= kMostRoots;
    };
    for (settle_level_ = 0; !fits(); ++settle_level_) half *= 2;
    frame.extent = static_cast<float>(half);
    largest_ = 0;
    for (int axis = 0; axis < D; ++axis) {
      const double side = static_cast<double>(count[axis]) * half;
      largest_ = std::max(largest_, std::fabs(static_cast<double>(frame.origin[axis])) + side);
    }
    frame.slack = static_cast<float>(p.slack(largest_ + static_cast<double>(farthest_)) * (1 + 1e-6));
    fill_roots(count);
  }

  /// Drops or settles the cells of the wave; a verdict's witness ends it early. Where regions are wanted, what is left
  /// at the level `last` is handed to shallow_.
  void explore(uint32_t last) {
    PairSieve sieve{.limits = regions_.limit, .ceiling = static_cast<float>(problem_.limits.region)};
    while (true) {
      evaluate_wave();
      if (level_ > 0 && !has_witness() && regions_.improved[0] && affords(kWitnessSteps * kRungs)) polish(0);
      if (!wants_regions_ && has_witness()) return;
      open_.count = 0;
      sift<D>(fields_.frame, wave_, sieve, open_, wants_regions_ ? &settled_ : nullptr);
      const bool is_last = wants_regions_ && level_ == last;
      const bool raises = !has_witness() && level_ >= kFirstJointLevel && !is_last;
      PairCells& left = raises ? raise(sieve) : open_;
      closed_lower_ = std::min(closed_lower_, sieve.closed_lower);
      wave_.count = 0;
      if (left.count == 0) return;
      if (is_last) return move_to(shallow_, left);
      if (!may_split(left) || tells_no_more(left)) return leave_open(left);
      split_cells<D>(left, wave_);
      ++level_;
    }
  }

  /// The same for the cells of open_, whose values are known.
  void explore_on() {
    PairSieve sieve{.limits = regions_.limit};
    PairCells& left = raise(sieve);
    closed_lower_ = std::min(closed_lower_, sieve.closed_lower);
    if (left.count == 0) return;
    if (!may_split(left) || tells_no_more(left)) return leave_open(left);
    split_cells<D>(left, wave_);
    ++level_;
    explore(kLastLevel + 1);
  }

  // --- shared by both parts
  // ---------------------------------------------------------------------------------------------

  [[nodiscard]] bool has_witness() const {
    for (size_t j = 0; j < regions_.count; ++j) {
      if (is_witness(j)) return true;
    }
    return false;
  }
  [[nodiscard]] bool is_witness(size_t region) const { return regions_.value[region] < -fields_.frame.slack; }
  [[nodiscard]] bool affords(size_t evaluations) const {
    return evaluations <= problem_.limits.budget && evaluations_ <= problem_.limits.budget - evaluations;
  }
  [[nodiscard]] bool may_split(const PairCells& cells) const {
    const size_t children = kChildren * cells.count;
    return affords(children) && settled_.count + shallow_.count + children <= most_cells_ && level_ < kLastLevel;
  }

  /// Fields, values and bounds at the cells of the wave; new incumbents of their regions.
  void evaluate_wave() {
    place_cells(fields_.frame, wave_, points_);
    fields_.values(points_, wave_.count);
    evaluations_ += static_cast<uint32_t>(wave_.count);
    bound_cells(fields_.frame, points_, wave_);
    pad_components(wave_);
    const F32 d;
    for (size_t i = 0; i < wave_.count; i += hn::Lanes(d)) {
      const auto value = hn::LoadU(d, wave_.value + i);
      const auto here = hn::FirstN(d, HWY_MIN(wave_.count - i, hn::Lanes(d)));
      const auto better = hn::And(here, hn::Lt(value, of_component(regions_.value, wave_.component + i)));
      if (hn::AllFalse(d, better)) continue;
      const size_t end = std::min(wave_.count, i + hn::Lanes(d));
      for (size_t k = i; k < end; ++k) {
        if (wave_.value[k] < regions_.value[wave_.component[k]]) adopt(k);
      }
    }
  }

  void adopt(size_t cell) {
    const uint32_t j = wave_.component[cell];
    PairState<D>& best = regions_.best[j];
    for (int axis = 0; axis < D; ++axis) best.point[axis] = points_.a[axis][cell];
    best.a = points_.value_a[cell];
    best.b = points_.value_b[cell];
    regions_.value[j] = wave_.value[cell];
    regions_.improved[j] = true;
  }

  /// Descends from a region's best point, and chooses its far distances there.
  void polish(size_t region) {
    PairState<D> state;
    const uint32_t steps = wants_regions_ ? kDeepestSteps : kWitnessSteps;
    evaluations_ += polisher_.descend(fields_, regions_.best[region].point, farthest_, steps, state);
    regions_.improved[region] = false;
    if (state.value() <= regions_.value[region]) {
      regions_.best[region] = state;
      regions_.value[region] = state.value();
    }
    const float reach = static_cast<float>(problem_.limits.region) / 4;
    evaluations_ +=
        polisher_.choose_far(fields_, state, farthest_, reach, &regions_.far_a[region], &regions_.far_b[region]);
  }

  /// The cells of open_ that the joint bound leaves open.
  PairCells& raise(PairSieve& sieve) {
    if (!affords(2 * open_.count)) return open_;
    raise_open();
    parents_.count = 0;
    sift<D>(fields_.frame, open_, sieve, parents_, nullptr);
    return parents_;
  }

  void move_to(PairCells& to, const PairCells& from) {
    PairSieve all{.limits = &kNever};
    sift<D>(fields_.frame, from, all, to, nullptr);
  }

  /// The joint bound for all open cells.
  void raise_open() {
    if (!std::isfinite(fields_.frame.lipschitz_a) || !std::isfinite(fields_.frame.lipschitz_b)) return;
    pad_components(open_);
    place_cells(fields_.frame, open_, points_);
    fields_.gradients(points_, open_.count);
    evaluations_ += static_cast<uint32_t>(open_.count);
    FarDistances far;
    if (!fields_.a.facts().convex) {
      far.a = regions_.far_a;
      aim(fields_.frame, points_.a, points_.gradient_a, far.a, open_, far_points_.a);
      fields_.a.values(far_points_.a, open_.count, far_points_.value_a);
    }
    if (!fields_.b.facts().convex) {
      far.b = regions_.far_b;
      aim(fields_.frame, points_.b, points_.gradient_b, far.b, open_, far_points_.b);
      fields_.b.values(far_points_.b, open_.count, far_points_.value_b);
    }
    if (far.a != nullptr || far.b != nullptr) evaluations_ += static_cast<uint32_t>(open_.count);
    join_bounds(fields_.frame, points_, far, far_points_, open_);
  }

  static constexpr float kNever = kNoBound;

  const PairTile& tile_;
  PairScratch& scratch_;
  PairProblem problem_;
  PairFields<D> fields_;
  PairPolisher<D> polisher_;
  PairRegions<D> regions_;
  PairCells wave_, open_, parents_;
  PairCells settled_;  ///< proven to lie in {g <= e}
  PairCells shallow_;  ///< g > -e all over: too shallow to be settled at their size
  PairPoints points_, far_points_;
  size_t most_cells_ = 0;
  uint32_t evaluations_ = 0;
  uint32_t level_ = 0;
  uint32_t settle_level_ = 0;  ///< at which cells have the size that settles them
  float tolerance_ = 0;
  float farthest_ = 0;             ///< longest far distance and step
  float closed_lower_ = kNoBound;  ///< least bound of a closed cell
  double largest_ = 0;             ///< coordinate of any cell, in A's frame
  bool wants_regions_ = false;
  bool resolved_ = true;  ///< every settled cell lies in {g <= e}

 private:
  void fill_roots(const int64_t* count) {
    for (int64_t z = 0; z < count[2]; ++z) {
      for (int64_t y = 0; y < count[1]; ++y) {
        for (int64_t x = 0; x < count[0]; ++x) {
          const int64_t index[3] = {x, y, z};
          for (int axis = 0; axis < D; ++axis) {
            wave_.at[axis][wave_.count] = static_cast<float>(2 * index[axis] + 1 - count[axis]);
          }
          wave_.size[wave_.count] = 1;
          wave_.component[wave_.count++] = 0;
        }
      }
    }
  }

  /// Without a witness: float32 has said all it can, or touching is proven and enough has been tried.
  [[nodiscard]] bool tells_no_more(const PairCells& cells) const {
    if (has_witness()) return false;
    const PairFrame<D>& frame = fields_.frame;
    const float reach = frame.extent * PairFrame<D>::kDiagonal * std::ldexp(1.0F, -static_cast<int>(level_));
    if (reach <= frame.slack) return true;
    const float lower = *std::min_element(cells.lower, cells.lower + cells.count);
    if (lower >= regions_.value[0] - 2 * frame.slack) return true;
    const bool touching = regions_.value[0] + frame.slack <= tolerance_ && lower >= -tolerance_;
    return touching && evaluations_ > problem_.limits.budget / kTouchingShare;
  }

  /// What is left open stays so: for verdicts as the wave, for regions as if it were settled.
  void leave_open(const PairCells& cells) {
    resolved_ = false;
    move_to(wants_regions_ ? settled_ : wave_, cells);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
