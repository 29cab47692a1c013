// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The second part of the certified search: settled cells that touch are one overlap region, and all regions are refined
// at once until each has its deepest point and a bound no further below it than the tolerance.
//
// A connected set of common points passes from cell to touching cell, so it belongs to one region; and any two cells of
// a region are joined by a path of settled cells, on all of which g <= e. Included once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_REGIONS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_REGIONS_INL
#undef THALWEG_SOLVE_PAIRS_REGIONS_INL
#else
#define THALWEG_SOLVE_PAIRS_REGIONS_INL
#endif

#include "solve/pairs/components.inl"
#include "solve/pairs/decide_pairs.h"
#include "solve/pairs/finish_pairs.h"
#include "solve/pairs/search.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <int D>
class PairSearch : private PairExplorer<D> {
  using Base = PairExplorer<D>;
  using Base::evaluations_, Base::fields_, Base::level_, Base::open_, Base::parents_, Base::points_, Base::polisher_,
      Base::problem_, Base::regions_, Base::scratch_, Base::settled_, Base::shallow_, Base::tile_, Base::wave_;

 public:
  using Base::Base;

  /// `spent` evaluations of the row's budget are gone.
  void run(size_t row, uint32_t spent) {
    if (!prepare(*tile_.queries, *tile_.options, row, problem_)) return write_bad_row(tile_, row, D);
    this->begin();
    evaluations_ = spent;
    row_ = {};
    found_ = lowest_ = {};
    row_index_ = row;
    any_open_ = false;
    if (problem_.empty()) return finish_apart(row);
    this->lay_roots();
    this->explore(this->settle_level_);
    if (this->wants_regions_) {
      join();
      refine();
    }
    conclude(row);
  }

 private:
  static constexpr uint32_t kNowhere = ~uint32_t{0};

  // --- regions
  // -----------------------------------------------------------------------------------------------------------

  /// Settled cells that touch are one region, and shallow cells that a chain of such cells leads to belong to it:
  /// nothing in them is deeper than -e. Other shallow cells may hold overlaps of their own: they are cut until they,
  /// too, are settled or empty, and touch nothing of what came before.
  void join() {
    uint32_t count = join_cells(0, 0);
    part_shallow(count);
    if (open_.count > 0) {
      const size_t before = settled_.count;
      this->explore_on();
      count += join_cells(before, count);
    }
    const PairState<D> deepest = regions_.best[0];
    const bool had_witness = this->has_witness();
    std::copy_n(deepest.point, D, lowest_.point);
    lowest_.value = regions_.value[0];
    regions_.take(scratch_.query, count, this->farthest_ / 4);
    this->move_to(settled_, shallow_);
    for (size_t i = 0; i < settled_.count; ++i) {
      const uint32_t j = settled_.component[i];
      if (!(settled_.value[i] < regions_.value[j])) continue;
      regions_.value[j] = settled_.value[i];
      place_best(regions_.best[j], i);
    }
    if (had_witness) keep_witness(deepest);
    for (size_t j = 0; j < count; ++j) descend_in(j);
  }

  [[nodiscard]] static CellBoxes boxes_of(const PairCells& cells, size_t first) {
    CellBoxes boxes;
    boxes.dimension = D;
    for (int axis = 0; axis < D; ++axis) boxes.at[axis] = cells.at[axis] + first;
    boxes.size = cells.size + first;
    boxes.count = cells.count - first;
    return boxes;
  }

  /// Numbers the regions of the settled cells from `first` on, from `number` on; returns how many there are.
  uint32_t join_cells(size_t first, uint32_t number) {
    const CellBoxes boxes = boxes_of(settled_, first);
    if (boxes.count == 0) return 0;
    const TouchingCells touching(boxes, settled_.component + first, scratch_.query);
    if (number > 0) {
      for (size_t i = first; i < settled_.count; ++i) settled_.component[i] += number;
    }
    return touching.count();
  }

  /// Gives each shallow cell the region that it belongs to, and moves those without one to open_.
  void part_shallow(uint32_t regions) {
    open_.count = 0;
    if (regions == 0) {
      std::swap(open_, shallow_);
      return;
    }
    const size_t settled = settled_.count;
    this->move_to(settled_, shallow_);
    auto* chain = scratch_.query.template take<uint32_t>(settled_.count);
    const CellBoxes all = boxes_of(settled_, 0);
    const TouchingCells chains(all, chain, scratch_.query);
    auto* region = scratch_.query.template take<uint32_t>(chains.count());
    std::fill_n(region, chains.count(), kNowhere);
    for (size_t i = settled; i-- > 0;) region[chain[i]] = settled_.component[i];
    settled_.count = settled;
    size_t kept = 0;
    for (size_t i = 0; i < shallow_.count; ++i) {
      const uint32_t j = region[chain[settled + i]];
      const bool alone = j == kNowhere;
      PairCells& to = alone ? open_ : shallow_;
      const size_t at = alone ? open_.count++ : kept++;
      for (int axis = 0; axis < D; ++axis) to.at[axis][at] = shallow_.at[axis][i];
      to.size[at] = shallow_.size[i];
      to.value[at] = shallow_.value[i];
      to.lower[at] = shallow_.lower[i];
      to.component[at] = alone ? 0 : j;
    }
    shallow_.count = kept;
  }

  void place_best(PairState<D>& best, size_t cell) const {
    const PairFrame<D>& frame = fields_.frame;
    for (int axis = 0; axis < D; ++axis) {
      best.point[axis] = settled_.at[axis][cell] * frame.extent + frame.origin[axis];
    }
  }

  /// A witness that explore() descended to lies in some settled cell, for all others are empty.
  void keep_witness(const PairState<D>& deepest) {
    const uint32_t j = region_of(deepest.point);
    if (j == kNowhere || !(deepest.value() < regions_.value[j])) return;
    regions_.best[j] = deepest;
    regions_.value[j] = deepest.value();
  }

  /// Polishes a region's best point; a descent that leaves the region is taken back.
  void descend_in(size_t j) {
    const PairState<D> before = regions_.best[j];
    const float value = regions_.value[j];
    this->polish(j);
    if (regions_.count == 1 || region_of(regions_.best[j].point) == j) return;
    regions_.best[j] = before;
    regions_.value[j] = value;
  }

  /// The region of the first settled cell that holds a point.
  [[nodiscard]] uint32_t region_of(const float* point) const {
    const F32 d;
    const PairFrame<D>& frame = fields_.frame;
    const auto extent = hn::Set(d, frame.extent);
    for (size_t i = 0; i < settled_.count; i += hn::Lanes(d)) {
      const auto half = hn::Mul(extent, hn::LoadU(d, settled_.size + i));
      auto holds = hn::FirstN(d, HWY_MIN(settled_.count - i, hn::Lanes(d)));
      for (int axis = 0; axis < D; ++axis) {
        const auto centre = hn::MulAdd(hn::LoadU(d, settled_.at[axis] + i), extent, hn::Set(d, frame.origin[axis]));
        holds = hn::And(holds, hn::Le(hn::Abs(hn::Sub(hn::Set(d, point[axis]), centre)), half));
      }
      const intptr_t lane = hn::FindFirstTrue(d, holds);
      if (lane >= 0) return settled_.component[i + static_cast<size_t>(lane)];
    }
    return kNowhere;
  }

  // --- deepest points
  // ----------------------------------------------------------------------------------------------------

  /// Above its limit a cell cannot change what is said of its region.
  void set_limits() {
    const bool any = this->has_witness();
    for (size_t j = 0; j < regions_.count; ++j) {
      const float shallow = any ? -this->tolerance_ : 0.0F;
      regions_.limit[j] = this->is_witness(j) ? regions_.value[j] - this->tolerance_ : shallow;
    }
  }

  void refine() {
    set_limits();
    PairSieve sieve{.limits = regions_.limit};
    open_.count = 0;
    sift<D>(fields_.frame, settled_, sieve, open_, nullptr);
    while (open_.count > 0) {
      const bool raises = this->affords(2 * open_.count);
      parents_.count = 0;
      if (raises) this->raise_open();
      sift<D>(fields_.frame, open_, sieve, parents_, nullptr);
      if (parents_.count == 0) break;
      if (!raises || !may_refine()) {
        leave_open();
        break;
      }
      split_cells<D>(parents_, wave_);
      ++level_;
      this->evaluate_wave();
      for (size_t j = 0; j < regions_.count; ++j) {
        if (regions_.improved[j] && this->affords(kDeepestSteps * kRungs)) descend_in(j);
      }
      set_limits();
      open_.count = 0;
      sift<D>(fields_.frame, wave_, sieve, open_, nullptr);
    }
    this->closed_lower_ = std::min(this->closed_lower_, sieve.closed_lower);
  }

  [[nodiscard]] bool may_refine() const {
    if (!this->may_split(parents_)) return false;
    const float least = *std::min_element(parents_.size, parents_.size + parents_.count);
    const PairFrame<D>& frame = fields_.frame;
    if (least < std::ldexp(1.0F, -static_cast<int>(kLastLevel)) || least * frame.extent <= frame.slack) return false;
    if (this->has_witness()) return true;
    const float lower = *std::min_element(parents_.lower, parents_.lower + parents_.count);
    const float value = *std::min_element(regions_.value, regions_.value + regions_.count);
    const bool touching = value + frame.slack <= this->tolerance_ && lower >= -this->tolerance_;
    return !touching || evaluations_ <= problem_.limits.budget / kTouchingShare;
  }

  void leave_open() {
    for (size_t i = 0; i < parents_.count; ++i) {
      float& lower = regions_.open_lower[parents_.component[i]];
      lower = std::min(lower, parents_.lower[i]);
    }
    any_open_ = true;
  }

  // --- results
  // -----------------------------------------------------------------------------------------------------------

  [[nodiscard]] PairFinding finding_of(size_t j) const {
    PairFinding f;
    std::copy_n(regions_.best[j].point, D, f.point);
    f.value = regions_.value[j];
    f.witness = this->is_witness(j);
    f.lower = std::min(regions_.limit[j], regions_.open_lower[j]);
    const auto width = static_cast<float>(problem_.limits.tolerance);
    f.converged = f.witness && this->resolved_ && f.value - f.lower <= width;
    return f;
  }

  void conclude(size_t row) {
    row_.evaluations = evaluations_;
    row_.iterations = level_;
    slack_ = static_cast<double>(fields_.frame.slack);
    const bool any = this->has_witness();
    bool separated = false;
    if (!any) {
      separated = conclude_without_witness();
    } else if (!this->wants_regions_) {
      found_ = finding_of(0);
      found_.lower = std::min(this->closed_lower_, least_lower(wave_));
      found_.converged = true;
    } else {
      conclude_regions();
    }
    write(row, separated);
  }

  [[nodiscard]] static float least_lower(const PairCells& cells) {
    return cells.count == 0 ? kNoBound : *std::min_element(cells.lower, cells.lower + cells.count);
  }

  /// The deepest region speaks for the row; the row's bound is the least of all.
  void conclude_regions() {
    size_t deepest = 0;
    for (size_t j = 1; j < regions_.count; ++j) {
      if (regions_.value[j] < regions_.value[deepest]) deepest = j;
    }
    found_ = finding_of(deepest);
    for (size_t j = 0; j < regions_.count; ++j) {
      const PairFinding f = finding_of(j);
      found_.lower = std::min(found_.lower, f.lower);
      found_.converged = found_.converged && (f.converged || !f.witness) && this->resolved_;
    }
    found_.converged = found_.converged && !any_open_;
  }

  /// True when the shapes are proven apart.
  bool conclude_without_witness() {
    found_ = lowest_;
    for (size_t j = 0; j < regions_.count; ++j) {
      if (regions_.value[j] <= found_.value) found_ = finding_of(j);
    }
    found_.lower = std::min(this->closed_lower_, this->wants_regions_ ? kNoBound : least_lower(wave_));
    for (size_t j = 0; j < regions_.count; ++j) found_.lower = std::min(found_.lower, regions_.open_lower[j]);
    if (found_.lower > 0) {
      found_.converged = true;
      return true;
    }
    return decide();
  }

  bool decide() {
    PairTwins twins = twins_of(tile_, row_index_, scratch_);
    const uint32_t left = problem_.limits.budget - std::min(problem_.limits.budget, evaluations_);
    const PairDecision decision = decide_in_double(problem_, found_.point, left, twins, scratch_.heap);
    row_.evaluations += decision.evaluations;
    ++row_.iterations;
    if (decision.evaluations == 0) return false;
    const float lower = std::max(found_.lower, decision.found.lower);
    found_ = decision.found;
    found_.lower = lower;
    slack_ = decision.slack;
    return lower > 0;
  }

  /// The box of common points is empty.
  void finish_apart(size_t row) {
    double point[3] = {};
    for (int axis = 0; axis < D; ++axis) {
      const double middle = (problem_.lo[axis] + problem_.hi[axis]) / 2;
      found_.point[axis] = static_cast<float>(std::isfinite(middle) ? middle : 0.0);
      point[axis] = static_cast<double>(found_.point[axis]);
    }
    PairTwins twins = twins_of(tile_, row, scratch_);
    found_.value = static_cast<float>(evaluate_pair(problem_, twins, point));
    found_.converged = true;
    row_.evaluations = 1;
    write(row, true);
  }

  void write(size_t row, bool separated) {
    if (separated) found_.lower = std::min(found_.lower, static_cast<float>(problem_.outside * (1 - 1e-6)));
    row_.status = status_of(found_, slack_, problem_.limits.tolerance, separated);
    if (!this->wants_regions_ && row_.status == Status::touching) found_.converged = true;
    row_.claimed = found_.value < 0;
    write_row(tile_, row, found_, row_);
    const size_t count = list_contacts();
    if (tile_.columns.normal == nullptr && tile_.columns.ambiguous == nullptr && count == 0) return;
    size_t at = 0;
    put_point(found_.point, at++);
    for (size_t i = 0; i < count; ++i) put_point(contacts_[i].found.point, at++);
    place_points(fields_.frame, points_, at);
    fields_.gradients(points_, at);
    float normal[3] = {};
    const bool ambiguous = normal_at(0, normal);
    write_normal(tile_, row, normal, ambiguous, D);
    for (size_t i = 0; i < count; ++i) {
      contacts_[i].ambiguous = normal_at(i + 1, contacts_[i].normal);
      write_contact(tile_, row, i, contacts_[i], D);
    }
  }

  void put_point(const float* point, size_t at) {
    for (int axis = 0; axis < D; ++axis) points_.a[axis][at] = point[axis];
  }

  bool normal_at(size_t at, float* normal) const {
    float of_a[3] = {}, of_b[3] = {};
    for (int row = 0; row < D; ++row) {
      of_a[row] = points_.gradient_a[row][at];
      for (int column = 0; column < D; ++column) {
        of_b[row] += fields_.frame.rotation[row][column] * points_.gradient_b[column][at];
      }
    }
    return pair_normal(of_a, of_b, D, normal);
  }

  /// The deepest of the witnessed regions, deepest first, as many as there are slots for; writes how many there were.
  size_t list_contacts() {
    if (tile_.contacts.found == nullptr) return 0;
    auto* order = scratch_.query.template take<uint32_t>(regions_.count + 1);
    uint32_t found = 0;
    // As deep as e, or as half of the deepest.
    const float deep = std::min(static_cast<float>(problem_.limits.region), -found_.value / 2);
    for (uint32_t j = 0; j < regions_.count; ++j) {
      if (this->is_witness(j) && regions_.value[j] <= -deep) order[found++] = j;
    }
    std::sort(order, order + found, [this](uint32_t i, uint32_t j) {
      return regions_.value[i] != regions_.value[j] ? regions_.value[i] < regions_.value[j] : i < j;
    });
    // An overlap so thin that only double could tell it is a contact of its own.
    const bool thin = found == 0 && found_.witness;
    tile_.contacts.found[row_index_] = thin ? 1 : found;
    const size_t most = this->most_cells_ - 1;
    const size_t kept = std::min({tile_.contacts.capacity, size_t{thin ? 1U : found}, most});
    contacts_ = scratch_.query.template take<PairContact>(kept);
    for (size_t i = 0; i < kept; ++i) {
      contacts_[i] = {};
      contacts_[i].found = thin ? found_ : finding_of(order[i]);
    }
    return kept;
  }

  PairFinding found_;
  PairFinding lowest_;  ///< of explore(), before there were regions
  PairRow row_;
  PairContact* contacts_ = nullptr;
  size_t row_index_ = 0;
  double slack_ = 0;
  bool any_open_ = false;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
