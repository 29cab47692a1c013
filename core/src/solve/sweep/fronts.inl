// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Time of impact by fronts: for each piece of a query, the time up to which it is proven not to touch the shape.
//
// A look at a piece at one time says for how long around it the piece is clear (second_looks.inl): from t - l / (L v)
// to t + l / (L v), where v bounds the speed of the query's points as seen from the scene and l is a lower bound of f
// over the piece, or for longer where the field is straight. A front at time tau moves on when a look ahead, at tau +
// s, is clear back to tau. Otherwise the look was too far, and s shrinks; or the piece is too large for its bound to
// say much, and is cut. A front that cannot move by a part of the tolerance leaves that time open and steps over it. A
// point with f < 0 is a contact: what comes later, or less than the tolerance before it, need not be looked at.
//
// It is conservative advancement (Mirtich 1996), looking both ways, with a front for each piece instead of one for the
// whole and proven bounds instead of distances. Each lane walks one query's pieces depth first, the piece down the
// gradient first; what it does depends on its query alone. Included once per SIMD target.
#if defined(THALWEG_SOLVE_SWEEP_FRONTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_SWEEP_FRONTS_INL
#undef THALWEG_SOLVE_SWEEP_FRONTS_INL
#else
#define THALWEG_SOLVE_SWEEP_FRONTS_INL
#endif

#include <bit>
#include <cstring>

#include "solve/sweep/second_looks.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <class Cell>
class Fronts {
 public:
  static constexpr int kAxes = Cell::kAxes;
  static constexpr size_t kCoordinates = Cell::kCoordinates;
  /// Queries in flight: a chunk of the widest value.
  static constexpr size_t kLanes = 64;
  /// Pieces that wait; a query with more is left undecided.
  static constexpr size_t kStackDepth = 96;
  static constexpr size_t kEntry = kCoordinates + 2;
  /// Evaluations of a look, at most: the bound of a piece, and two points more where that is too low.
  static constexpr uint32_t kCost = 3;

  Fronts(const SweepTile& tile, SweepScratch& scratch) : tile_(tile) {
    Arena& arena = scratch.arena;
    arena.reset();
    constexpr size_t kRoom = kLanes + kColumnPadding;
    motion_.take(arena, tile.queries.count);
    state_ = SweepState::make(arena, padded(tile.queries.count));
    wave_.take(arena, kRoom);
    second_looks_.take(arena, kLanes);
    for (float** column :
         {&front_, &step_, &time_, &upper_, &value_, &open_lower_, &open_upper_, &uv_[0], &uv_[1], &point_[0],
          &point_[1], &tolerance_, &end_, &before_, &after_, &gap_, &far_factor_, &point_[2]}) {
      *column = arena.take<float>(kRoom);
    }
    query_ = arena.take<uint32_t>(kRoom);
    evaluations_ = arena.take<uint32_t>(kRoom);
    depth_ = arena.take<uint32_t>(kRoom);
    stack_ = arena.take<float>(kLanes * kStackDepth * kEntry);
    kernel_scratch_ = arena.take<float>(scratch_floats(*tile.tape));
  }

  void run(SweepScratch& scratch) {
    motion_.load(tile_, state_.is_bad);
    size_t next = 0;
    count_ = 0;
    while (count_ < kLanes && begin_next(next, count_)) ++count_;
    while (count_ > 0) {
      look();
      uint64_t waiting = 0;
      full_lanes_ = 0;
      for (size_t i = 0; i < count_; i += vector_lanes()) waiting |= advance(i) << i;
      waiting |= full_lanes_;
      // From the last one down, so that a lane that is moved was looked at.
      for (; waiting != 0; waiting &= ~(uint64_t{1} << (63 - std::countl_zero(waiting)))) {
        const auto i = static_cast<size_t>(63 - std::countl_zero(waiting));
        if (i >= count_ || goes_on(i)) continue;
        leave(i);
        if (begin_next(next, i)) continue;
        if (--count_ != i) move(count_, i);
      }
    }
    finish_sweeps(tile_, state_, kernel_scratch_, scratch.arena);
  }

 private:
  /// Of the tolerance: steps that a front takes at the least.
  static constexpr float kLeastStep = 0.125F;
  static constexpr float kNever = std::numeric_limits<float>::infinity();
  /// Of times up to 1, a few roundings.
  static constexpr float kTimeRounding = 4e-7F;

  bool begin_next(size_t& next, size_t lane) {
    while (next < tile_.queries.count && state_.is_bad[next] != 0) ++next;
    if (next == tile_.queries.count) return false;
    query_[lane] = static_cast<uint32_t>(next++);
    for (size_t k = 0; k < kCoordinates; ++k) wave_.at[k][lane] = Cell::kRoot[k];
    front_[lane] = 0;
    step_[lane] = 0.5F;
    tolerance_[lane] = motion_.tolerance()[query_[lane]];
    far_factor_[lane] = SecondLooks<Cell>::kFirstFactor;
    upper_[lane] = open_lower_[lane] = kNever;
    open_upper_[lane] = 0;
    evaluations_[lane] = 0;
    depth_[lane] = 0;
    return true;
  }

  void move(size_t from, size_t to) {
    query_[to] = query_[from];
    evaluations_[to] = evaluations_[from];
    depth_[to] = depth_[from];
    for (size_t k = 0; k < kCoordinates; ++k) wave_.at[k][to] = wave_.at[k][from];
    for (float* column : {front_, step_, tolerance_, far_factor_, upper_, value_, open_lower_, open_upper_, uv_[0],
                          uv_[1], point_[0], point_[1], point_[2]}) {
      column[to] = column[from];
    }
    std::copy_n(stack_ + from * kStackDepth * kEntry, depth_[to] * kEntry, stack_ + to * kStackDepth * kEntry);
  }

  /// Bounds over the lanes' cells at the times they look at, and values at the probes.
  void look() {
    const F32 d;
    const size_t lanes = vector_lanes();
    for (size_t i = count_; i < (count_ + lanes - 1) / lanes * lanes; ++i) {
      query_[i] = query_[0];
      front_[i] = step_[i] = 0;
      depth_[i] = 0;
      for (size_t k = 0; k < kCoordinates; ++k) wave_.at[k][i] = Cell::kRoot[k];
    }
    for (size_t i = 0; i < count_; i += lanes) {
      const auto time = hn::Add(hn::LoadU(d, front_ + i), hn::LoadU(d, step_ + i));
      hn::StoreU(time, d, time_ + i);
      hn::StoreU(limit_of(i), d, end_ + i);
      Cell::place(motion_, query_ + i, motion_.place(query_ + i, time), wave_, i);
    }
    tile_.kernels->gradient(*tile_.tape, wave_.centre, count_, wave_.value, wave_.gradient, kernel_scratch_);
    second_looks_.run(tile_, motion_, {query_, time_, end_, before_, after_, gap_, far_factor_, evaluations_, count_},
                      wave_, kernel_scratch_);
  }

  static HWY_INLINE void blend(M32 m, V32 yes, float* column) {
    const F32 d;
    hn::StoreU(hn::IfThenElse(m, yes, hn::LoadU(d, column)), d, column);
  }

  /// Keeps the earliest contact of each lane.
  HWY_INLINE void take_contacts(size_t i, V32 slack) {
    const F32 d;
    const auto centre = hn::LoadU(d, wave_.value + i), probe = hn::LoadU(d, wave_.probe_value + i);
    const auto best = hn::Min(centre, probe);
    const auto time = hn::LoadU(d, time_ + i);
    const auto earlier = hn::And(hn::Lt(best, hn::Neg(slack)), hn::Lt(time, hn::LoadU(d, upper_ + i)));
    if (hn::AllFalse(d, earlier)) return;
    const auto at_probe = hn::Lt(probe, centre);
    blend(earlier, time, upper_ + i);
    blend(earlier, best, value_ + i);
    for (size_t axis = 0; axis < kAxes; ++axis) {
      const auto x =
          hn::IfThenElse(at_probe, hn::LoadU(d, wave_.probe[axis] + i), hn::LoadU(d, wave_.centre[axis] + i));
      blend(earlier, x, point_[axis] + i);
    }
    V32 uv[2];
    Cell::centre_coordinates(wave_, i, uv);
    for (size_t c = 0; c < 2; ++c) {
      blend(earlier, hn::IfThenElse(at_probe, hn::LoadU(d, wave_.probe_uv[c] + i), uv[c]), uv_[c] + i);
    }
  }

  /// Up to where fronts must come: the end, or the tolerance before the earliest contact.
  [[nodiscard]] HWY_INLINE V32 limit_of(size_t i) const {
    const F32 d;
    return hn::Min(hn::Set(d, 1.0F), hn::Sub(hn::LoadU(d, upper_ + i), hn::LoadU(d, tolerance_ + i)));
  }

  /// Moves the fronts of one vector of lanes, or cuts their cells. Returns the lanes that need a new cell, or are at
  /// the end of their budget, bit by bit.
  HWY_INLINE uint64_t advance(size_t i) {
    const F32 d;
    const auto one = hn::Set(d, 1.0F), half = hn::Set(d, 0.5F);
    const auto tolerance = hn::LoadU(d, tolerance_ + i);
    // Long past a time that stays open only an earlier contact is of use, and coarse looks find it.
    const auto late = hn::Ge(hn::LoadU(d, front_ + i), hn::Add(hn::LoadU(d, open_lower_ + i), tolerance));
    const auto least = hn::Mul(tolerance, hn::IfThenElse(late, half, hn::Set(d, kLeastStep)));
    const auto slack = gather(motion_.slack(), query_ + i);
    const auto per_value = gather(motion_.per_value(), query_ + i);
    take_contacts(i, slack);
    const auto front = hn::LoadU(d, front_ + i), time = hn::LoadU(d, time_ + i), step = hn::Sub(time, front);
    const auto rounding = hn::Set(d, kTimeRounding);
    const auto after = hn::Sub(hn::LoadU(d, after_ + i), rounding);
    const auto before = hn::Neg(hn::LoadU(d, before_ + i));
    const auto clears = hn::And(hn::Gt(after, hn::Zero(d)), hn::Ge(before, step));
    // In units of time: the least f seen in the cell, how far below the bound is, and how fast f falls.
    const auto seen = hn::Min(hn::LoadU(d, wave_.value + i), hn::LoadU(d, wave_.probe_value + i));
    const auto value = hn::Mul(hn::Sub(seen, slack), per_value);
    const auto loss = hn::Sub(value, hn::Mul(hn::LoadU(d, gap_ + i), per_value));
    V32 speed[kAxes];
    for (size_t axis = 0; axis < kAxes; ++axis) speed[axis] = hn::LoadU(d, wave_.speed[axis] + i);
    const auto fall = hn::Mul(hn::Neg(wave_.along_gradient(i, speed, kAxes)), per_value);
    const auto a = hn::Min(one, hn::Max(hn::Set(d, -1.0F), fall));
    const auto tries = hn::Le(step, hn::Mul(least, hn::Set(d, 1.001F)));
    // What is lost delays the proof of a contact by loss / a, and two slacks do.
    const auto allowed = hn::Mul(a, hn::Mul(tolerance, hn::Set(d, 0.7F)));
    const auto precise = hn::Max(least, hn::NegMulAdd(hn::Set(d, 2.0F), hn::Mul(slack, per_value), allowed));
    const auto harmless = hn::IfThenElse(late, tolerance, precise);
    const auto is_small = hn::Or(hn::Le(loss, harmless), hn::Le(hn::Abs(hn::LoadU(d, wave_.reach + i)), slack));
    const auto gives_up = hn::And(hn::AndNot(clears, tries), is_small);
    const auto passed = hn::Max(time, hn::MulAdd(slack, per_value, front));
    leave_open(i, gives_up, front, hn::Min(passed, one));
    const auto reached = hn::IfThenElse(clears, hn::Add(time, after), hn::IfThenElse(gives_up, passed, front));
    // The same where the front stands now, if it goes on as it does.
    const auto at_front = hn::NegMulAdd(a, hn::Sub(reached, time), value);
    const auto too_large = hn::Gt(hn::Mul(hn::Set(d, 1.3F), loss), at_front);
    const auto limit = limit_of(i);
    const auto goes_on = hn::Lt(reached, limit);
    const auto splits = hn::And(goes_on, hn::AndNot(is_small, hn::Or(too_large, hn::AndNot(clears, tries))));
    // Where the look was within the shape it says nothing of how far to look.
    const auto back = hn::IfThenElse(hn::Gt(value, hn::Zero(d)), hn::Mul(step, half), least);
    const auto wanted = hn::Max(hn::IfThenElse(clears, step_ahead(a, at_front, hn::Add(after, step)), back), least);
    // The middle of what is left is enough.
    const auto middle = hn::Max(hn::Mul(hn::Sub(limit, reached), hn::Set(d, 0.50001F)), hn::Mul(least, half));
    hn::StoreU(reached, d, front_ + i);
    hn::StoreU(hn::Min(wanted, middle), d, step_ + i);
    if (!hn::AllFalse(d, splits)) split(i, bits_of(splits));
    return bits_of(hn::Or(count_looks(i), hn::Not(goes_on)));
  }

  /// The lanes' times from `front` to `passed` stay open.
  HWY_INLINE void leave_open(size_t i, M32 lanes, V32 front, V32 passed) {
    const F32 d;
    blend(lanes, hn::Min(hn::LoadU(d, open_lower_ + i), front), open_lower_ + i);
    blend(lanes, hn::Max(hn::LoadU(d, open_upper_ + i), passed), open_upper_ + i);
  }

  /// Some of the way to a contact, which is f over the rate `a` away, or as far as the front just came (measured: half
  /// the way costs as much).
  static HWY_INLINE V32 step_ahead(V32 a, V32 at_front, V32 came) {
    const F32 d;
    const auto falls = hn::Gt(a, hn::Set(d, 0.05F));
    const auto to_contact = hn::Div(hn::Mul(hn::Set(d, 0.15F), at_front), hn::IfThenElse(falls, a, hn::Set(d, 1.0F)));
    return hn::IfThenElse(falls, hn::Min(to_contact, came), came);
  }

  /// Counts the look of one vector of lanes. Returns those that have no budget for another.
  HWY_INLINE M32 count_looks(size_t i) {
    const hn::RebindToUnsigned<F32> du;
    const auto looks = hn::Add(hn::LoadU(du, evaluations_ + i), hn::Set(du, 1));
    hn::StoreU(looks, du, evaluations_ + i);
    return hn::RebindMask(F32(), hn::Gt(looks, hn::Set(du, tile_.budget - kCost)));
  }

  static HWY_INLINE uint64_t bits_of(M32 mask) {
    const F32 d;
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    uint64_t bits = 0;
    std::memcpy(&bits, bytes, sizeof(bits));
    return bits & (~uint64_t{0} >> (64 - hn::Lanes(d)));
  }

  /// The first child takes the lane, the others wait with the front that they have in common.
  HWY_INLINE void split(size_t i, uint64_t lanes) {
    const F32 d;
    V32 child[Cell::kChildren][kCoordinates];
    HWY_ALIGN float stored[Cell::kChildren][kCoordinates][hn::MaxLanes(F32())];
    Cell::split(wave_, i, child);
    for (size_t k = 0; k < Cell::kChildren; ++k) {
      for (size_t c = 0; c < kCoordinates; ++c) hn::Store(child[k][c], d, stored[k][c]);
    }
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto own = static_cast<size_t>(std::countr_zero(lanes));
      const size_t lane = i + own;
      for (size_t k = Cell::kChildren - 1; k > 0; --k) {
        if (Cell::is_empty(&stored[k][0][own], hn::MaxLanes(d))) continue;
        if (depth_[lane] == kStackDepth) {
          // What has no room has the front of the child that goes on.
          full_lanes_ |= uint64_t{1} << lane;
          continue;
        }
        float* const top = stack_ + (lane * kStackDepth + depth_[lane]++) * kEntry;
        for (size_t c = 0; c < kCoordinates; ++c) top[c] = stored[k][c][own];
        top[kCoordinates] = front_[lane];
        top[kCoordinates + 1] = step_[lane];
      }
      for (size_t c = 0; c < kCoordinates; ++c) wave_.at[c][lane] = stored[0][c][own];
    }
  }

  /// Another cell for a lane whose own is clear; false when its query is done.
  bool goes_on(size_t lane) {
    const float limit = std::min(1.0F, upper_[lane] - tolerance_[lane]);
    if ((full_lanes_ >> lane & 1) != 0 || evaluations_[lane] > tile_.budget - kCost) return spend(lane, limit);
    if (front_[lane] < limit) return true;
    while (depth_[lane] > 0) {
      const float* const top = stack_ + (lane * kStackDepth + --depth_[lane]) * kEntry;
      if (!(top[kCoordinates] < limit)) continue;
      for (size_t k = 0; k < kCoordinates; ++k) wave_.at[k][lane] = top[k];
      front_[lane] = top[kCoordinates];
      const float middle = std::max(0.50001F * (limit - front_[lane]), tolerance_[lane] * kLeastStep / 2);
      step_[lane] = std::min(top[kCoordinates + 1], middle);
      return true;
    }
    return false;
  }

  /// The budget is spent: whatever waits stays open from its front on.
  bool spend(size_t lane, float limit) {
    float first = front_[lane];
    for (size_t level = 0; level < depth_[lane]; ++level) {
      first = std::min(first, stack_[(lane * kStackDepth + level) * kEntry + kCoordinates]);
    }
    const bool is_open = first < limit;
    if (is_open) {
      open_lower_[lane] = std::min(open_lower_[lane], first);
      open_upper_[lane] = 1;
    }
    state_.spent[query_[lane]] = is_open ? 1 : 0;
    return false;
  }

  void leave(size_t lane) {
    const uint32_t q = query_[lane];
    state_.upper[q] = upper_[lane];
    state_.tolerance[q] = tolerance_[lane];
    state_.open_lower[q] = open_lower_[lane];
    state_.open_upper[q] = open_upper_[lane];
    state_.value[q] = value_[lane];
    for (size_t axis = 0; axis < kAxes; ++axis) state_.point[axis][q] = point_[axis][lane];
    for (size_t c = 0; c < 2; ++c) state_.barycentric[c][q] = uv_[c][lane];
    state_.evaluations[q] = evaluations_[lane];
  }

  const SweepTile& tile_;
  Motion<kAxes, Cell::kParts> motion_;
  SweepState state_;
  MovingWave wave_;
  SecondLooks<Cell> second_looks_;
  size_t count_ = 0;
  uint64_t full_lanes_ = 0;  ///< those whose stack has no room
  uint32_t* query_ = nullptr;
  uint32_t* evaluations_ = nullptr;
  uint32_t* depth_ = nullptr;
  float *front_ = nullptr, *step_ = nullptr, *time_ = nullptr, *end_ = nullptr, *tolerance_ = nullptr;
  float *before_ = nullptr, *after_ = nullptr, *gap_ = nullptr, *far_factor_ = nullptr;
  float *upper_ = nullptr, *value_ = nullptr, *open_lower_ = nullptr, *open_upper_ = nullptr;
  float* uv_[2] = {};
  float* point_[3] = {};
  float* stack_ = nullptr;  ///< [lane][depth]: a cell, its front and its step
  float* kernel_scratch_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
