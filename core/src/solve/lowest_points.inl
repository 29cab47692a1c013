// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What wave 0 leaves open is looked at once more as a whole, all queries side by side: the gradients at the centroids
// lead to each query's lowest corner (of a ball: its lowest point), and value, enclosure and a far point from there
// settle most queries before any is split. Included once per SIMD target.
#if defined(THALWEG_SOLVE_LOWEST_POINTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_LOWEST_POINTS_INL
#undef THALWEG_SOLVE_LOWEST_POINTS_INL
#else
#define THALWEG_SOLVE_LOWEST_POINTS_INL
#endif

#include <algorithm>

#include "solve/far_points.inl"
#include "solve/first_wave.inl"
#include "solve/wave.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Children that one wave may hold.
inline constexpr size_t kWaveCells = 8192;

template <class Domain>
class LowestPoints {
 public:
  /// Gradient, corner, far point.
  static constexpr uint32_t kCost = 3;

  LowestPoints(const QueryTile& tile, const Domain& domain, QueryState& state)
      : tile_(tile), domain_(domain), state_(state), deepest_(tile.limits->goal == Goal::deepest) {}

  void take(Arena& arena, WaveColumns& wave, FarPoints<Domain>& far_points, size_t wave_room) {
    wave_ = &wave;
    far_points_ = &far_points;
    const size_t room = padded(tile_.count);
    for (int axis = 0; axis < Domain::kAxes; ++axis) gradient_[axis] = arena.take<float>(room);
    value_ = arena.take<float>(room);
    limit_ = arena.take<float>(wave_room);
    for (uint32_t** column : {&query_, &asked_}) *column = arena.take<uint32_t>(wave_room);
  }

  /// Looks at queries 0 to `count`, lists those that stay open and returns how many. Each has had `spent` evaluations.
  size_t run(size_t count, uint32_t spent, uint32_t* open, float* scratch) {
    tile_.kernels->gradient(*tile_.tape, state_.point, count, value_, gradient_, scratch);
    // Without the budget for it the gradient counts for nothing, and nothing is had of it but the value.
    const bool is_paid_for = tile_.limits->budget >= kCost + spent;
    take_centroids(count, is_paid_for || spent == 0 ? spent + 1 : spent);
    size_t open_count = 0;
    for (size_t first = 0; first < count; first += kWaveCells) {
      const Run run{first, std::min(kWaveCells, count - first)};
      if (is_paid_for) {
        try_lowest_points(run, scratch);
      } else {
        std::copy_n(state_.lower + first, run.count, wave_->lower);
        for (size_t i = 0; i < run.count; ++i) limit_[i] = state_.converged[first + i] > 0 ? -kInfinite : kInfinite;
      }
      open_count = settle(run, open, open_count);
    }
    return open_count;
  }

 private:
  /// Queries of one block: as many as a wave holds.
  struct Run {
    size_t first, count;
  };

  /// What the centroids prove.
  void take_centroids(size_t count, uint32_t evaluations) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const auto slack_a = hn::Set(d, rounded_up(tile_.limits->slack.a));
    const auto slack_b = hn::Set(d, rounded_up(tile_.limits->slack.b));
    const auto lipschitz = hn::Set(d, static_cast<float>(tile_.tape->facts.lipschitz));
    const auto tolerance = hn::Set(d, deepest_ ? static_cast<float>(tile_.limits->tolerance) : kInfinite);
    const auto one = hn::Set(d, 1.0F);
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
      const auto slack = hn::MulAdd(slack_b, hn::LoadU(d, domain_.largest() + i), slack_a);
      const auto f = hn::LoadU(d, value_ + i);
      const auto lower = hn::Sub(hn::NegMulAdd(lipschitz, hn::LoadU(d, domain_.reach() + i), f), slack);
      const auto witness = hn::Lt(f, hn::Neg(slack));
      const auto known = hn::Or(witness, hn::Gt(lower, hn::Zero(d)));
      const auto bad = hn::Gt(hn::LoadU(d, state_.is_bad + i), hn::Zero(d));
      const auto closed = hn::Or(bad, hn::And(known, hn::Ge(lower, hn::Sub(f, tolerance))));
      hn::StoreU(slack, d, state_.slack + i);
      hn::StoreU(f, d, state_.value + i);
      hn::StoreU(lower, d, state_.lower + i);
      hn::StoreU(hn::IfThenElseZero(witness, one), d, state_.witness + i);
      hn::StoreU(hn::IfThenElseZero(closed, one), d, state_.converged + i);
      hn::StoreU(hn::Set(du, evaluations), du, state_.evaluations + i);
      hn::StoreU(hn::Zero(du), du, state_.iterations + i);
    }
  }

  void try_lowest_points(Run run, float* scratch) {
    const auto [first, count] = run;
    domain_.aim(first, count, gradient_, *wave_);
    wave_->stride = count;
    if constexpr (Domain::kIsBall) {
      tile_.kernels->value(*tile_.tape, wave_->centre, count, wave_->value, scratch);
      std::copy_n(state_.lower + first, count, wave_->lower);
    } else {
      evaluate_cells<Domain>(tile_, *wave_, count, scratch);
    }
    take_lowest_points(run);
    if constexpr (!Domain::kIsBall) {
      far_points_->raise_bounds({query_, limit_, asked_, count, 1}, *wave_, scratch);
      for (size_t i = 0; i < count; ++i) state_.evaluations[first + i] += asked_[i];
    }
  }

  /// The points just evaluated, as incumbents; then what is to be proven, and what is so far. Queries that are answered
  /// already have nothing left to prove.
  void take_lowest_points(Run run) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const auto one = hn::Set(d, 1.0F);
    const auto tolerance = hn::Set(d, deepest_ ? static_cast<float>(tile_.limits->tolerance) : kInfinite);
    for (size_t i = 0; i < run.count; i += hn::Lanes(d)) {
      const size_t q = run.first + i;
      const auto is_open = hn::Eq(hn::LoadU(d, state_.converged + q), hn::Zero(d));
      const auto f = hn::LoadU(d, wave_->value + i);
      const auto slack = hn::LoadU(d, state_.slack + q);
      const auto lower = hn::And(is_open, hn::Lt(f, hn::LoadU(d, state_.value + q)));
      hn::BlendedStore(f, lower, d, state_.value + q);
      for (size_t axis = 0; axis < Domain::kAxes; ++axis) {
        hn::BlendedStore(hn::LoadU(d, wave_->centre[axis] + i), lower, d, state_.point[axis] + q);
      }
      for (size_t k = 0; k < 2; ++k) {
        hn::BlendedStore(hn::LoadU(d, wave_->at[k] + i), lower, d, state_.barycentric[k] + q);
      }
      hn::BlendedStore(one, hn::And(lower, hn::Lt(f, hn::Neg(slack))), d, state_.witness + q);
      const auto witness = hn::Gt(hn::LoadU(d, state_.witness + q), hn::Zero(d));
      const auto limit = hn::Sub(hn::LoadU(d, state_.value + q), tolerance);
      const auto proves = hn::IfThenElse(witness, limit, hn::Max(limit, hn::Zero(d)));
      hn::StoreU(hn::IfThenElse(is_open, proves, hn::Set(d, -kInfinite)), d, limit_ + i);
      const auto bound =
          Domain::kIsBall ? hn::LoadU(d, wave_->lower + i) : hn::Sub(hn::LoadU(d, wave_->lower + i), slack);
      hn::StoreU(hn::Max(bound, hn::LoadU(d, state_.lower + q)), d, wave_->lower + i);
      hn::StoreU(hn::Iota(du, static_cast<uint32_t>(q)), du, query_ + i);
      const auto evaluations = hn::LoadU(du, state_.evaluations + q);
      hn::BlendedStore(hn::Add(evaluations, hn::Set(du, 1)), hn::RebindMask(du, is_open), du, state_.evaluations + q);
    }
  }

  size_t settle(Run run, uint32_t* list, size_t open_count) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    for (size_t i = 0; i < run.count; i += hn::Lanes(d)) {
      const size_t q = run.first + i;
      const auto lower = hn::LoadU(d, wave_->lower + i);
      const auto here = hn::FirstN(d, HWY_MIN(run.count - i, hn::Lanes(d)));
      const auto closed = hn::Gt(lower, hn::LoadU(d, limit_ + i));
      hn::StoreU(lower, d, state_.lower + q);
      hn::BlendedStore(hn::Set(d, 1.0F), closed, d, state_.converged + q);
      const auto open = hn::RebindMask(du, hn::AndNot(closed, here));
      hn::StoreU(hn::Compress(hn::Iota(du, static_cast<uint32_t>(q)), open), du, list + open_count);
      open_count += hn::CountTrue(du, open);
    }
    return open_count;
  }

  const QueryTile& tile_;
  const Domain& domain_;
  QueryState& state_;
  const bool deepest_;
  WaveColumns* wave_ = nullptr;
  FarPoints<Domain>* far_points_ = nullptr;
  float* gradient_[3] = {};    ///< per query: at its centroid
  float* value_ = nullptr;     ///< per query: there
  float* limit_ = nullptr;     ///< per query of a run: what is to be proven
  uint32_t* query_ = nullptr;  ///< per query of a run: itself
  uint32_t* asked_ = nullptr;  ///< per query of a run: far points
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
