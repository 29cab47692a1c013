// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The descents of polish.inl for many regions of many rows at once. A descent that is told to stay in its region takes
// only steps between points whose balls of g <= e meet. Included once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_COHORT_DESCENTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_COHORT_DESCENTS_INL
#undef THALWEG_SOLVE_PAIRS_COHORT_DESCENTS_INL
#else
#define THALWEG_SOLVE_PAIRS_COHORT_DESCENTS_INL
#endif

#include "solve/pairs/cohort_row.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Step lengths that a descent tries at once: they span 400 : 1, and follow the length that was best.
inline constexpr size_t kCohortRungs = 8;
inline constexpr float kCohortRungRatio = 2.35F;
static_assert(kCohortRungs == kFarRungs);

/// One descent: of a region of a row, from its best point.
struct DescentJob {
  uint32_t row, region;
  float longest;  ///< step
  float least_gain;
  bool stays;
};

template <int D>
class CohortDescents {
 public:
  void take(Arena& arena) {
    lengths_ = arena.take<float>(padded(kCohortRungs));
    float length = 1;
    for (size_t i = 0; i < padded(kCohortRungs); ++i, length /= kCohortRungRatio) lengths_[i] = length;
    jobs_ = arena.take<DescentJob>(kMost);
    active_ = arena.take<DescentJob>(kMost);
    points_.take<D>(arena, kMost * kCohortRungs + kColumnPadding);
    far_points_.take<D>(arena, kMost * kFarRungs + kColumnPadding);
  }

  void clear() { count_ = 0; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  void add(const DescentJob& job) { jobs_[count_++] = job; }

  /// Runs what was added, at most `steps` steps each; of a row's region only the best point need be set.
  void run(const PairFields<D>& fields, CohortRow<D>* rows, uint32_t steps) {
    if (count_ == 0) return;
    evaluate_starts(fields, rows);
    std::copy_n(jobs_, count_, active_);
    size_t active = count_;
    for (uint32_t k = 0; k < steps && active > 0; ++k) {
      for (size_t j = 0; j < active; ++j) {
        CohortRow<D>& row = rows[active_[j].row];
        take_steps(row.best[active_[j].region], active_[j].longest, j * kCohortRungs);
        place_in_b<D>(row.frame, points_.a, points_.b, j * kCohortRungs, (j + 1) * kCohortRungs);
        row.count(kCohortRungs);
      }
      fields.gradients(points_, active * kCohortRungs);
      size_t left = 0;
      for (size_t j = 0; j < active; ++j) {
        DescentJob job = active_[j];
        if (goes_on(rows[job.row], job, j * kCohortRungs, k)) active_[left++] = job;
      }
      active = left;
    }
  }

  /// The far distances of regions' best points; only `row` and `region` of the jobs count.
  void choose_far(const PairFields<D>& fields, CohortRow<D>* rows) {
    if (count_ == 0) return;
    for (size_t j = 0; j < count_; ++j) {
      CohortRow<D>& row = rows[jobs_[j].row];
      lay_far(row.best[jobs_[j].region], row.farthest, j * kFarRungs);
      place_in_b<D>(row.frame, far_points_.a, points_.b, j * kFarRungs, (j + 1) * kFarRungs);
      row.count(kFarRungs);
    }
    const size_t most = count_ * kFarRungs;
    fields.values(points_, most);
    for (size_t j = 0; j < count_; ++j) {
      CohortRow<D>& row = rows[jobs_[j].row];
      const uint32_t region = jobs_[j].region;
      const PairState<D>& at = row.best[region];
      float length = row.farthest;
      for (size_t i = 0; i < kFarRungs; ++i, length *= 0.5F) {
        row.bend_a[region][i] = at.a + row.frame.lipschitz_a * length - points_.value_a[j * kFarRungs + i];
        row.bend_b[region][i] = at.b + row.frame.lipschitz_b * length - points_.value_b[j * kFarRungs + i];
      }
    }
  }

 private:
  /// The longest of the next steps over the last.
  static constexpr float kNextStep = 6;
  static constexpr size_t kMost = kMostRegions * kCohortRows;

  void evaluate_starts(const PairFields<D>& fields, CohortRow<D>* rows) {
    for (size_t j = 0; j < count_; ++j) {
      CohortRow<D>& row = rows[jobs_[j].row];
      for (size_t axis = 0; axis < D; ++axis) points_.a[axis][j] = row.best[jobs_[j].region].point[axis];
      place_in_b<D>(row.frame, points_.a, points_.b, j, j + 1);
      row.count(1);
    }
    fields.gradients(points_, count_);
    for (size_t j = 0; j < count_; ++j) {
      CohortRow<D>& row = rows[jobs_[j].row];
      row.best[jobs_[j].region] = state_at(row.frame, points_, j);
    }
  }

  void take_steps(const PairState<D>& s, float longest, size_t first) const {
    const F32 d;
    float square = 0;
    float along = 0;
    for (size_t axis = 0; axis < D; ++axis) {
      const float difference = s.gradient_a[axis] - s.gradient_b[axis];
      square += difference * difference;
      along += difference * s.gradient_b[axis];
    }
    const bool flat = !(square > 1e-8F);
    const auto one = hn::Set(d, 1.0F);
    for (size_t i = 0; i < kCohortRungs; i += hn::Lanes(d)) {
      const auto length = hn::Mul(hn::Set(d, longest), hn::LoadU(d, lengths_ + i));
      const auto pull = hn::Sub(hn::Div(hn::Set(d, s.a - s.b), length), hn::Set(d, along));
      auto weight = hn::Min(one, hn::Max(hn::Zero(d), hn::Div(pull, hn::Set(d, flat ? 1.0F : square))));
      if (flat) weight = s.a > s.b ? one : hn::Zero(d);
      const auto other = hn::Sub(one, weight);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto slope =
            hn::MulAdd(weight, hn::Set(d, s.gradient_a[axis]), hn::Mul(other, hn::Set(d, s.gradient_b[axis])));
        hn::StoreU(hn::NegMulAdd(length, slope, hn::Set(d, s.point[axis])), d, points_.a[axis] + first + i);
      }
    }
  }

  /// Takes the best rung; false when the descent is at its end.
  bool goes_on(CohortRow<D>& row, DescentJob& job, size_t first, uint32_t step) {
    PairState<D>& best = row.best[job.region];
    if (job.stays) refuse_far_steps(row, best, first);
    float least = 0;
    const size_t i = least_of(points_.value_a, points_.value_b, first, first + kCohortRungs, least);
    const float gain = best.value() - least;
    if (!(gain > 0)) {
      // Every step was too long, or this is the bottom.
      if (step > 0) return false;
      job.longest *= 0.001F;
      return true;
    }
    best = state_at(row.frame, points_, i);
    // The next step is about as long as this one.
    job.longest = std::min(job.longest, kNextStep * job.longest * lengths_[i - first]);
    return gain > job.least_gain;
  }

  void refuse_far_steps(const CohortRow<D>& row, const PairState<D>& from, size_t first) {
    const hn::CappedTag<float, kCohortRungs> d;  // what follows belongs to another job
    const float radius = row.radius(from.value());
    for (size_t i = first; i < first + kCohortRungs; i += hn::Lanes(d)) {
      auto square = hn::Zero(d);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto x = hn::Sub(hn::LoadU(d, points_.a[axis] + i), hn::Set(d, from.point[axis]));
        square = hn::MulAdd(x, x, square);
      }
      const auto a = hn::LoadU(d, points_.value_a + i);
      const auto value = hn::Max(a, hn::LoadU(d, points_.value_b + i));
      const auto own = hn::Mul(hn::Sub(hn::Set(d, row.level), value), hn::Set(d, 0.99999F / row.stretch));
      const auto reach = hn::Add(own, hn::Set(d, radius));
      const auto meets = hn::And(hn::Ge(own, hn::Zero(d)), hn::Le(square, hn::Mul(reach, reach)));
      hn::StoreU(hn::IfThenElse(meets, a, hn::Set(d, kNoBound)), d, points_.value_a + i);
    }
  }

  void lay_far(const PairState<D>& at, float longest, size_t first) {
    float length = longest;
    for (size_t i = 0; i < kFarRungs; ++i, length *= 0.5F) {
      for (size_t axis = 0; axis < D; ++axis) {
        points_.a[axis][first + i] = at.point[axis] + length * at.gradient_a[axis];
        far_points_.a[axis][first + i] = at.point[axis] + length * at.gradient_b[axis];
      }
    }
  }

  DescentJob* jobs_ = nullptr;
  DescentJob* active_ = nullptr;
  size_t count_ = 0;
  float* lengths_ = nullptr;
  PairPoints points_, far_points_;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
