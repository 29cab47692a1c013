// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The searches of many queries side by side: each lane walks the splits of one query depth first, the child of least
// value before its siblings, and takes the next query when it is done. Most open queries need a handful of splits, and
// a split here is decided within vector registers. For a deepest point a lane also probes for lower values, and asks
// far points of the children that stay open.
//
// What a lane does depends on its own query alone. A query that is not decided after so many splits, or by float32,
// leaves with its findings and its open cells, which the search goes on with in waves (certify.inl). Included once per
// SIMD target.
#if defined(THALWEG_SOLVE_DEPTH_FIRST_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_DEPTH_FIRST_INL
#undef THALWEG_SOLVE_DEPTH_FIRST_INL
#else
#define THALWEG_SOLVE_DEPTH_FIRST_INL
#endif

#include <algorithm>
#include <span>
#include <vector>

#include "solve/far_points.inl"
#include "solve/probes.inl"
#include "solve/wave.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <class Domain>
class DepthFirst {
 public:
  static constexpr size_t kChildren = Domain::kChildren;
  static constexpr size_t kCoordinates = Domain::kCoordinates;
  static constexpr size_t kAxes = Domain::kAxes;
  /// Queries in flight: a chunk of the widest value, for the probes.
  static constexpr size_t kLanes = 64;
  static constexpr uint32_t kMostSplits = kChildren == 2 ? 48 : 16;
  /// For a verdict. The few queries that need more would hold the lanes for themselves, where a wave takes all their
  /// cells at once (measured, growth/primitives).
  static constexpr uint32_t kMostSplitsForVerdict = kChildren == 2 ? 5 : 16;
  static constexpr size_t kStackDepth = kMostSplits * (kChildren - 1) + 1;
  /// What a split takes, probe and far points included.
  static constexpr uint32_t kCost = 2 * kChildren + 1;
  /// With less, the budget might end within the lanes or before the first wave after them.
  static constexpr uint32_t kLeastBudget = 5 + kCost * (kMostSplits + kStackDepth);

  void take(Arena& arena, FarPoints<Domain>& far_points) {
    constexpr size_t kRoom = kLanes + kColumnPadding;
    far_points_ = &far_points;
    wave_.take(arena, kChildren * kRoom, kCoordinates, Domain::kEdgeColumns);
    open_.take(arena, kRoom, kCoordinates);
    probes_.take(arena, kRoom);
    for (float** column : {&value_, &lower_, &stacked_lower_, &limit_, &ends_, &uv_[0], &uv_[1]}) {
      *column = arena.take<float>(kRoom);
    }
    for (size_t axis = 0; axis < kAxes; ++axis) point_[axis] = arena.take<float>(kRoom);
    for (uint32_t** column : {&splits_, &extra_, &asked_, &probed_}) *column = arena.take<uint32_t>(kRoom);
    depth_ = arena.take<int32_t>(kRoom);
    std::fill_n(depth_, kRoom, 0);
    std::fill_n(limit_, kRoom, 0.0F);
    for (float*& plane : stack_) plane = arena.take<float>(kStackDepth * kLanes + kColumnPadding);
  }

  /// Searches for each query of a list from its root cell on. Open cells of those that are not decided go to `waiting`.
  void run(const QueryTile& tile, const Domain& domain, QueryState& state, std::span<const uint32_t> queries,
           std::vector<WaitingCell>& waiting, float* scratch) {
    const bool deepest = tile.limits->goal == Goal::deepest;
    most_splits_ = deepest ? kMostSplits : kMostSplitsForVerdict;
    size_t next = 0;
    open_.count = 0;
    while (next < queries.size() && open_.count < kLanes) begin(state, queries[next++], open_.count++);
    while (open_.count > 0) {
      bound_children(tile, domain, state.slack, open_, wave_, scratch);
      // The last vector's lanes beyond the queries repeat one of them; their stacks must stay within bounds.
      std::fill(depth_ + open_.count, depth_ + wave_.stride, 0);
      for (size_t i = 0; i < open_.count; i += vector_lanes()) improve(i);
      look_around(tile, domain, state, scratch);
      for (size_t i = 0; i < open_.count; i += vector_lanes()) advance(state, i, deepest);
      for (size_t i = open_.count; i-- > 0;) {
        ++splits_[i];
        if (ends_[i] == 0 && splits_[i] < most_splits_) continue;
        leave(state, i, waiting);
        if (next < queries.size()) {
          begin(state, queries[next++], i);
        } else if (--open_.count != i) {
          move(open_.count, i);
        }
      }
    }
  }

 private:
  /// Why a lane ends; 0: it does not.
  static constexpr float kDecided = 1;
  static constexpr float kBeyondFloat32 = 2;

  void begin(const QueryState& state, uint32_t q, size_t lane) {
    open_.query[lane] = q;
    for (size_t k = 0; k < kCoordinates; ++k) open_.at[k][lane] = Domain::kRoot[k];
    value_[lane] = state.value[q];
    lower_[lane] = stacked_lower_[lane] = kInfinite;
    for (size_t k = 0; k < 2; ++k) uv_[k][lane] = state.barycentric[k][q];
    for (size_t axis = 0; axis < kAxes; ++axis) point_[axis][lane] = state.point[axis][q];
    depth_[lane] = 0;
    splits_[lane] = 0;
    extra_[lane] = 0;
  }

  void move(size_t from, size_t to) {
    open_.query[to] = open_.query[from];
    for (size_t k = 0; k < kCoordinates; ++k) open_.at[k][to] = open_.at[k][from];
    for (float* column : {value_, lower_, stacked_lower_, uv_[0], uv_[1]}) column[to] = column[from];
    for (size_t axis = 0; axis < kAxes; ++axis) point_[axis][to] = point_[axis][from];
    depth_[to] = depth_[from];
    splits_[to] = splits_[from];
    extra_[to] = extra_[from];
    for (float* plane : stack_) {
      for (size_t level = 0; level < static_cast<size_t>(depth_[to]); ++level) {
        plane[level * kLanes + to] = plane[level * kLanes + from];
      }
    }
  }

  /// A cell of each lane: its coordinates and the value at its centre.
  struct Cells {
    V32 at[kCoordinates];
    V32 value;
  };

  HWY_INLINE Cells child(size_t at) const {
    const F32 d;
    Cells cells;
    for (size_t k = 0; k < kCoordinates; ++k) cells.at[k] = hn::LoadU(d, wave_.at[k] + at);
    cells.value = hn::LoadU(d, wave_.value + at);
    return cells;
  }

  /// Probes, then far points for what the lanes must still prove.
  void look_around(const QueryTile& tile, const Domain& domain, const QueryState& state, float* scratch) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const bool deepest = tile.limits->goal == Goal::deepest;
    const auto tolerance = hn::Set(d, deepest ? static_cast<float>(tile.limits->tolerance) : kInfinite);
    const auto gain = hn::Set(d, deepest ? kProbeGain * static_cast<float>(tile.limits->tolerance) : 0);
    probes_.look(domain, open_, wave_);
    probes_.evaluate(tile, open_.count, scratch);
    for (size_t i = 0; i < open_.count; i += hn::Lanes(d)) {
      const auto value = hn::LoadU(d, value_ + i);
      const auto f = hn::LoadU(d, probes_.value + i);
      const auto asks = hn::Lt(hn::LoadU(d, probes_.least + i), hn::Sub(value, gain));
      const auto lower = hn::And(asks, hn::Lt(f, value));
      for (size_t c = 0; c < 2; ++c) blend(lower, hn::LoadU(d, probes_.uv[c] + i), uv_[c] + i);
      for (size_t axis = 0; axis < kAxes; ++axis) {
        blend(lower, hn::LoadU(d, probes_.point[axis] + i), point_[axis] + i);
      }
      const auto best = hn::IfThenElse(lower, f, value);
      hn::StoreU(best, d, value_ + i);
      const auto witness = hn::Lt(best, hn::Neg(gather(state.slack, open_.query + i)));
      const auto limit = hn::Sub(best, tolerance);
      hn::StoreU(hn::IfThenElse(witness, limit, hn::Max(limit, hn::Zero(d))), d, limit_ + i);
      hn::StoreU(hn::IfThenElseZero(hn::RebindMask(du, asks), hn::Set(du, 1)), du, probed_ + i);
    }
    far_points_->raise_bounds({open_.query, limit_, asked_, open_.count, kChildren}, wave_, scratch);
    for (size_t i = 0; i < open_.count; ++i) extra_[i] += asked_[i] + probed_[i];
  }

  /// Takes what the children of one vector of lanes have shown, and picks the lanes' next cells.
  HWY_INLINE void advance(const QueryState& state, size_t i, bool deepest) {
    const F32 d;
    const auto zero = hn::Zero(d);
    const auto infinite = hn::Set(d, kInfinite);
    const auto slack = gather(state.slack, open_.query + i);
    const auto value = hn::LoadU(d, value_ + i);
    const auto limit = hn::LoadU(d, limit_ + i);
    auto closed = hn::LoadU(d, lower_ + i);
    auto least_open = infinite;
    auto too_small = hn::Ne(zero, zero);
    for (size_t k = 0; k < kChildren; ++k) {
      const size_t at = k * wave_.stride + i;
      const auto lower = hn::LoadU(d, wave_.lower + at);
      const auto is_closed = hn::Gt(lower, limit);
      closed = hn::Min(closed, hn::IfThenElse(is_closed, lower, infinite));
      least_open = hn::Min(least_open, hn::IfThenElse(is_closed, infinite, lower));
      too_small = hn::Or(too_small, hn::AndNot(is_closed, hn::Le(hn::LoadU(d, wave_.reach + at), slack)));
    }
    const auto stacked = hn::Min(hn::LoadU(d, stacked_lower_ + i), least_open);
    const auto witness = hn::Lt(value, hn::Neg(slack));
    const auto goes_on = choose_next(i);
    hn::StoreU(stacked, d, stacked_lower_ + i);
    // A witness ends the search for a verdict, and leaves cells open.
    const auto ends = deepest ? hn::Lt(zero, zero) : witness;
    hn::StoreU(hn::IfThenElse(ends, hn::Min(closed, stacked), closed), d, lower_ + i);
    const auto decided = hn::Or(ends, hn::Not(goes_on));
    const auto beyond = hn::IfThenElseZero(too_small, hn::Set(d, kBeyondFloat32));
    hn::StoreU(hn::IfThenElse(decided, hn::Set(d, kDecided), beyond), d, ends_ + i);
  }

  /// The lanes' least values so far; their points move where a child is lower.
  HWY_INLINE void improve(size_t i) {
    const F32 d;
    auto best = hn::LoadU(d, value_ + i);
    if (hn::AllFalse(d, hn::Lt(hn::LoadU(d, wave_.best + i), best))) return;
    for (size_t k = 0; k < kChildren; ++k) {
      const size_t at = k * wave_.stride + i;
      const Cells cells = child(at);
      const auto lower = hn::Lt(cells.value, best);
      best = hn::IfThenElse(lower, cells.value, best);
      V32 uv[2];
      Domain::centre_coordinates(cells.at, uv);
      for (size_t c = 0; c < 2; ++c) blend(lower, uv[c], uv_[c] + i);
      for (size_t axis = 0; axis < kAxes; ++axis) {
        blend(lower, hn::LoadU(d, wave_.centre[axis] + at), point_[axis] + i);
      }
    }
    hn::StoreU(best, d, value_ + i);
  }

  static HWY_INLINE void blend(M32 m, V32 yes, float* column) {
    const F32 d;
    hn::StoreU(hn::IfThenElse(m, yes, hn::LoadU(d, column)), d, column);
  }

  /// The open child of least value, else the cell on top of the stack, becomes the lane's cell; the other open
  /// children are stacked. False for lanes with nothing left.
  HWY_INLINE M32 choose_next(size_t i) {
    const F32 d;
    const IndexLanes di;
    auto depth = hn::LoadU(di, depth_ + i);
    const auto lane = hn::Iota(di, static_cast<int32_t>(i));
    Cells best = child(i);
    const auto limit = hn::LoadU(d, limit_ + i);
    auto has_one = hn::Not(hn::Gt(hn::LoadU(d, wave_.lower + i), limit));
    for (size_t k = 1; k < kChildren; ++k) {
      const size_t at = k * wave_.stride + i;
      const Cells other = child(at);
      const auto is_open = hn::Not(hn::Gt(hn::LoadU(d, wave_.lower + at), limit));
      const auto takes = hn::And(is_open, hn::Or(hn::Not(has_one), hn::Lt(other.value, best.value)));
      const auto both = hn::And(is_open, has_one);
      // Lanes that stack nothing write above their top.
      const auto top = hn::Add(hn::Mul(depth, hn::Set(di, static_cast<int32_t>(kLanes))), lane);
      for (size_t c = 0; c < kCoordinates; ++c) {
        hn::ScatterIndex(hn::IfThenElse(takes, best.at[c], other.at[c]), d, stack_[c], top);
        best.at[c] = hn::IfThenElse(takes, other.at[c], best.at[c]);
      }
      best.value = hn::IfThenElse(takes, other.value, best.value);
      depth = hn::Sub(depth, hn::VecFromMask(di, hn::RebindMask(di, both)));
      has_one = hn::Or(has_one, is_open);
    }
    const auto pops = hn::AndNot(has_one, hn::RebindMask(d, hn::Gt(depth, hn::Zero(di))));
    if (!hn::AllFalse(d, pops)) {
      depth = hn::Add(depth, hn::VecFromMask(di, hn::RebindMask(di, pops)));
      const auto top = hn::Add(hn::Mul(depth, hn::Set(di, static_cast<int32_t>(kLanes))), lane);
      for (size_t c = 0; c < kCoordinates; ++c) {
        best.at[c] = hn::IfThenElse(pops, hn::GatherIndex(d, stack_[c], top), best.at[c]);
      }
    }
    hn::StoreU(depth, di, depth_ + i);
    for (size_t c = 0; c < kCoordinates; ++c) hn::StoreU(best.at[c], d, open_.at[c] + i);
    return hn::Or(has_one, pops);
  }

  /// Writes a lane's findings. Without a proof its cells wait: those below on the stack first.
  void leave(QueryState& state, size_t lane, std::vector<WaitingCell>& waiting) {
    const uint32_t q = open_.query[lane];
    state.value[q] = value_[lane];
    state.lower[q] = lower_[lane];
    for (size_t k = 0; k < 2; ++k) state.barycentric[k][q] = uv_[k][lane];
    for (size_t axis = 0; axis < kAxes; ++axis) state.point[axis][q] = point_[axis][lane];
    state.evaluations[q] += static_cast<uint32_t>(kChildren) * splits_[lane] + extra_[lane];
    state.iterations[q] = splits_[lane];
    state.witness[q] = value_[lane] < -state.slack[q] ? 1 : 0;
    if (ends_[lane] == kDecided) {
      state.converged[q] = 1;
      return;
    }
    WaitingCell cell{q, most_splits_, 0, {}};
    for (size_t level = 0; level < static_cast<size_t>(depth_[lane]); ++level) {
      for (size_t k = 0; k < kCoordinates; ++k) cell.at[k] = stack_[k][level * kLanes + lane];
      waiting.push_back(cell);
    }
    for (size_t k = 0; k < kCoordinates; ++k) cell.at[k] = open_.at[k][lane];
    waiting.push_back(cell);
  }

  WaveColumns wave_;
  Probes<Domain> probes_;
  FarPoints<Domain>* far_points_ = nullptr;
  uint32_t most_splits_ = kMostSplits;
  CellList open_;  ///< the cells that are split next, one a lane
  float* value_ = nullptr;
  float* lower_ = nullptr;          ///< least bound over the closed cells
  float* stacked_lower_ = nullptr;  ///< least bound over all cells that were ever open
  float* limit_ = nullptr;          ///< a bound above it closes a cell
  float* ends_ = nullptr;
  float* uv_[2] = {};
  float* point_[3] = {};
  uint32_t* splits_ = nullptr;
  uint32_t* extra_ = nullptr;   ///< evaluations besides those of children
  uint32_t* asked_ = nullptr;   ///< far points of the last split
  uint32_t* probed_ = nullptr;  ///< probes of the last split
  int32_t* depth_ = nullptr;
  float* stack_[kCoordinates] = {};  ///< [depth][lane]
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
