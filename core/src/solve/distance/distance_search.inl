// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The certified distance of one pair of shapes at one pose.
//
// Let a and b be nearest points. On the segment between them f_a <= L_a |p - a| and f_b <= L_b |p - b|, and somewhere
// on it the two fields are equal, to v. So v / L_a + v / L_b <= |a - b|: with g = max(f_a, f_b) and m the least g over
// a region that every such p lies in,
//
//   distance >= (1 / L_a + 1 / L_b) m.
//
// Where the fields are distances outside this is an equality, and unlike the sum of the fields, which is the same all
// along the segment, g has its least value in its middle. The upper end of the bracket is |a - b| for two points that
// are proven to be of the shapes (witnesses.h). Cells are those of the search for common points (cells.inl,
// bounds.inl), and are closed once they cannot lower the bracket by more than the tolerance.
// Included once per SIMD target.
#if defined(THALWEG_SOLVE_DISTANCE_SEARCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_DISTANCE_SEARCH_INL
#undef THALWEG_SOLVE_DISTANCE_SEARCH_INL
#else
#define THALWEG_SOLVE_DISTANCE_SEARCH_INL
#endif

#include <algorithm>
#include <cmath>

#include "solve/distance/distance_tile.h"
#include "solve/distance/witnesses.h"
#include "solve/pairs/bounds.inl"
#include "solve/pairs/finish_pairs.h"
#include "solve/pairs/polish.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <int D>
class DistanceSearch {
 public:
  DistanceSearch(const DistanceTile& tile, PairScratch& scratch) : tile_(tile), scratch_(scratch) {
    scratch.arena.reset();
    most_cells_ = std::clamp<size_t>(tile.options->budget, kMostRoots, kMostCells);
    const size_t room = padded(most_cells_) + kColumnPadding;
    for (PairCells* cells : {&wave_, &open_, &parents_}) cells->template take<D>(scratch.arena, room);
    points_.template take<D>(scratch.arena, room);
    far_points_.template take<D>(scratch.arena, room);
    polisher_.take(scratch.arena);
    for (float** table : {&limit_, &far_a_, &far_b_}) *table = scratch.arena.take<float>(padded(1));
  }

  void run(size_t row) {
    if (!prepare(*tile_.pairs.queries, *tile_.pairs.options, row, problem_)) return write_bad_distance(tile_, row);
    if (problem_.a->facts.bounds.empty(D) || problem_.b->facts.bounds.empty(D)) return write_empty_distance(tile_, row);
    const double size = problem_.limits.size;
    tolerance_ = tile_.options->tolerance > 0 ? tile_.options->tolerance : 1e-2 * size;
    begin();
    Witnesses witnesses(problem_, twins_of(tile_.pairs, row, scratch_));
    witnesses_ = &witnesses;
    improve();
    double lower = 0;
    if (!witnesses.is_common() && lay_roots()) lower = std::max(scale_ * static_cast<double>(least_bound()), 0.0);
    write_distance(tile_, row, finding(lower));
  }

 private:
  static constexpr size_t kChildren = size_t{1} << D;
  static constexpr size_t kMostCells = size_t{1} << 16;
  static constexpr size_t kMostRoots = 64;
  /// Cells of this level are exact in float32.
  static constexpr uint32_t kLastLevel = 17;
  /// New incumbents from which witnesses are looked for.
  static constexpr uint32_t kMostImprovements = 6;

  /// The fields, and a first incumbent between the two boxes.
  void begin() {
    scratch_.query.reset();
    evaluations_ = level_ = improvements_ = 0;
    fields_.begin(tile_.pairs, problem_, scratch_.query);
    PairFrame<D>& frame = fields_.frame;
    box_a_ = problem_.a->facts.bounds;
    box_b_ = problem_.pose.to_a(problem_.b->facts.bounds, D);
    double gap = 0;
    for (int axis = 0; axis < D; ++axis) {
      const double lo = std::max(box_a_.lo[axis], box_b_.lo[axis]), hi = std::min(box_a_.hi[axis], box_b_.hi[axis]);
      best_.point[axis] = static_cast<float>((lo + hi) / 2);
      gap += std::max(lo - hi, 0.0);
      frame.translation[axis] = static_cast<float>(problem_.pose.translation[axis]);
      for (int column = 0; column < D; ++column) {
        frame.rotation[axis][column] = static_cast<float>(problem_.pose.rotation[3 * axis + column]);
      }
    }
    frame.lipschitz_a = static_cast<float>(problem_.a->facts.lipschitz * (1 + 1e-6));
    frame.lipschitz_b = static_cast<float>(problem_.b->facts.lipschitz * (1 + 1e-6));
    scale_ = 1 / problem_.a->facts.lipschitz + 1 / problem_.b->facts.lipschitz;
    frame.slack = 0;
    farthest_ = static_cast<float>(0.5 * problem_.limits.size + gap);
    far_a_[0] = far_b_[0] = farthest_ / 4;
    polisher_.stop_below(static_cast<float>(tolerance_ / 50));
    value_ = kNoBound;
  }

  /// Descends from the incumbent and looks for witnesses there.
  void improve() {
    PairState<D> state;
    evaluations_ += polisher_.descend(fields_, best_.point, farthest_, kDeepestSteps, state);
    if (state.value() <= value_) {
      best_ = state;
      value_ = state.value();
    }
    double point[3] = {};
    std::copy_n(best_.point, D, point);
    const uint32_t before = witnesses_->evaluations();
    witnesses_->look_near(point);
    evaluations_ += witnesses_->evaluations() - before;
    ++improvements_;
  }

  /// The region: nearest points are no further apart than the witnesses, and each shape is within its box. False when
  /// no witness says how far a shape without a box must be looked for.
  bool lay_roots() {
    const double upper = witnesses_->distance();
    const bool boxed = box_a_.finite(D) && box_b_.finite(D);
    if (!boxed && !std::isfinite(upper)) return false;
    double lo[3], hi[3], largest = 0, shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (int axis = 0; axis < D; ++axis) {
      lo[axis] =
          std::max({std::min(box_a_.lo[axis], box_b_.lo[axis]), box_a_.lo[axis] - upper, box_b_.lo[axis] - upper});
      hi[axis] =
          std::min({std::max(box_a_.hi[axis], box_b_.hi[axis]), box_a_.hi[axis] + upper, box_b_.hi[axis] + upper});
      largest = std::max({largest, std::fabs(lo[axis]), std::fabs(hi[axis])});
    }
    for (int axis = 0; axis < D; ++axis) {
      const double room = 1e-9 * largest + 1e-6 * problem_.limits.size;
      lo[axis] -= room, hi[axis] += room;
      shortest = std::min(shortest, hi[axis] - lo[axis]);
      longest = std::max(longest, hi[axis] - lo[axis]);
      fields_.frame.origin[axis] = static_cast<float>((lo[axis] + hi[axis]) / 2);
    }
    const double reached = fill_roots(lo, hi, std::max(shortest, longest / 32), largest);
    fields_.frame.slack = static_cast<float>(problem_.slack(reached + static_cast<double>(farthest_)) * (1 + 1e-6));
    return true;
  }

  /// Returns the greatest coordinate of any root.
  double fill_roots(const double* lo, const double* hi, double side, double largest) {
    size_t count[3] = {1, 1, 1};
    const auto fits = [&] {
      size_t all = 1;
      for (int axis = 0; axis < D; ++axis) {
        // The middle is rounded.
        const double extent = 1.00001 * (hi[axis] - lo[axis]) + 1e-6 * largest;
        count[axis] = std::max<size_t>(static_cast<size_t>(std::ceil(extent / side)), 1);
        all *= count[axis];
      }
      return all <= kMostRoots;
    };
    while (!fits()) side *= 1.25;
    fields_.frame.extent = static_cast<float>(side / 2 * (1 + 1e-6));
    wave_.count = 0;
    for (size_t i = 0; i < count[0] * count[1] * count[2]; ++i) {
      const size_t index[3] = {i % count[0], i / count[0] % count[1], i / (count[0] * count[1])};
      for (int axis = 0; axis < D; ++axis) {
        wave_.at[axis][i] = static_cast<float>(2 * index[axis] + 1) - static_cast<float>(count[axis]);
      }
      wave_.size[i] = 1;
      wave_.component[i] = 0;
      ++wave_.count;
    }
    double reached = 0;
    for (int axis = 0; axis < D; ++axis) {
      const double half = static_cast<double>(count[axis]) * static_cast<double>(fields_.frame.extent);
      reached = std::max(reached, std::fabs(static_cast<double>(fields_.frame.origin[axis])) + half);
    }
    return reached;
  }

  /// Proven to be at most g all over the region.
  float least_bound() {
    PairSieve sieve{.limits = limit_};
    while (true) {
      evaluate_wave();
      if (witnesses_->is_common()) return 0;
      limit_[0] = limit();
      open_.count = 0;
      sift<D>(fields_.frame, wave_, sieve, open_, nullptr);
      PairCells* left = &open_;
      if (affords(3 * open_.count) && open_.count > 0) {
        raise_bounds();
        parents_.count = 0;
        sift<D>(fields_.frame, open_, sieve, parents_, nullptr);
        left = &parents_;
      }
      if (left->count == 0) return sieve.closed_lower;
      const float lower = *std::min_element(left->lower, left->lower + left->count);
      if (!affords(kChildren * left->count) || kChildren * left->count > most_cells_ || tells_no_more(lower)) {
        return std::min(sieve.closed_lower, lower);
      }
      split_cells<D>(*left, wave_);
      ++level_;
    }
  }

  /// Cells above it are closed: what they could lower the bracket by is within the tolerance, or, where the fields
  /// understate distances, far within it below the incumbent. A gap is to be proven, so they are above 0 in any case.
  [[nodiscard]] float limit() const {
    const double of_bracket = (witnesses_->distance() - 0.98 * tolerance_) / scale_;
    const double of_incumbent = static_cast<double>(value_) - 0.05 * tolerance_ / scale_;
    return static_cast<float>(std::max(std::min(of_bracket, of_incumbent), 0.0));
  }
  [[nodiscard]] bool affords(size_t evaluations) const {
    const size_t budget = tile_.options->budget;
    return evaluations <= budget && evaluations_ <= budget - evaluations;
  }
  [[nodiscard]] float reach() const {
    return fields_.frame.extent * PairFrame<D>::kDiagonal * std::ldexp(1.0F, -static_cast<int>(level_));
  }
  /// With this least bound of the open cells, float32 has said all it can.
  [[nodiscard]] bool tells_no_more(float lower) const {
    const float slack = fields_.frame.slack;
    return level_ >= kLastLevel || reach() <= slack || lower >= value_ - 4 * slack;
  }

  void evaluate_wave() {
    place_cells(fields_.frame, wave_, points_);
    fields_.values(points_, wave_.count);
    evaluations_ += static_cast<uint32_t>(wave_.count);
    bound_cells(fields_.frame, points_, wave_);
    const auto least = static_cast<size_t>(std::min_element(wave_.value, wave_.value + wave_.count) - wave_.value);
    if (!(wave_.value[least] < value_)) return;
    for (int axis = 0; axis < D; ++axis) best_.point[axis] = points_.a[axis][least];
    if (improvements_ < kMostImprovements && affords(kDeepestSteps * kRungs)) {
      improve();
    } else {
      value_ = wave_.value[least];
    }
  }

  /// The joint bound of the open cells, with far points that suit their reach.
  void raise_bounds() {
    if (!std::isfinite(fields_.frame.lipschitz_a) || !std::isfinite(fields_.frame.lipschitz_b)) return;
    evaluations_ += polisher_.choose_far(fields_, best_, farthest_, reach(), far_a_, far_b_);
    pad_components(open_);
    place_cells(fields_.frame, open_, points_);
    fields_.gradients(points_, open_.count);
    FarDistances far;
    if (!fields_.a.facts().convex) {
      far.a = far_a_;
      aim(fields_.frame, points_.a, points_.gradient_a, far.a, open_, far_points_.a);
      fields_.a.values(far_points_.a, open_.count, far_points_.value_a);
    }
    if (!fields_.b.facts().convex) {
      far.b = far_b_;
      aim(fields_.frame, points_.b, points_.gradient_b, far.b, open_, far_points_.b);
      fields_.b.values(far_points_.b, open_.count, far_points_.value_b);
    }
    evaluations_ += static_cast<uint32_t>((far.a != nullptr || far.b != nullptr ? 2 : 1) * open_.count);
    join_bounds(fields_.frame, points_, far, far_points_, open_);
  }

  [[nodiscard]] DistanceFinding finding(double lower) const {
    DistanceFinding found;
    found.upper = witnesses_->distance();
    // The bound and the distance are both right: where rounding crosses them, they are equal.
    found.lower = std::min(lower * (1 - 1e-6), found.upper);
    found.evaluations = evaluations_;
    if (std::isfinite(found.upper)) {
      std::copy_n(witnesses_->a(), 3, found.a);
      std::copy_n(witnesses_->b(), 3, found.b);
    }
    found.converged = found.upper - found.lower <= tolerance_;
    found.status = witnesses_->is_common()     ? Status::overlapping
                   : found.lower > 0           ? Status::separated
                   : found.upper <= tolerance_ ? Status::touching
                                               : Status::undecided;
    double square = 0;
    for (int axis = 0; axis < D; ++axis) square += (found.b[axis] - found.a[axis]) * (found.b[axis] - found.a[axis]);
    if (std::sqrt(square) > 1e-6 * problem_.limits.size) {
      for (int axis = 0; axis < D; ++axis) {
        found.normal[axis] = static_cast<float>((found.b[axis] - found.a[axis]) / std::sqrt(square));
      }
    } else {
      pair_normal(best_.gradient_a, best_.gradient_b, D, found.normal);
    }
    return found;
  }

  const DistanceTile& tile_;
  PairScratch& scratch_;
  PairProblem problem_;
  PairFields<D> fields_;
  PairPolisher<D> polisher_;
  Witnesses* witnesses_ = nullptr;
  Bounds box_a_, box_b_;  ///< in A's frame
  PairCells wave_, open_, parents_;
  PairPoints points_, far_points_;
  PairState<D> best_;  ///< where g is least so far
  float value_ = kNoBound;
  float *limit_ = nullptr, *far_a_ = nullptr, *far_b_ = nullptr;  ///< tables of one region
  float farthest_ = 0;
  double tolerance_ = 0, scale_ = 2;
  size_t most_cells_ = 0;
  uint32_t evaluations_ = 0, level_ = 0, improvements_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
