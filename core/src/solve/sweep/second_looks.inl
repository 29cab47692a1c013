// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What two points more say of a moving cell where its value and reach alone do not clear it to the end.
//
// A far point p = c + s u, u the unit gradient at the centre c, bounds f in space and time at once:
// f(x) >= f(p) - L |x - p| for every x, so the cell is clear for as long as all of its corners stay within f(p) / L of
// p. Each corner moves on a straight line, or bends from it by no more than half of its greatest acceleration times the
// time squared, and the times for which a line stays within a ball are an interval. Where the field is straight along
// u, what is lost by that are r^2 / (2 s) and what the corners move across u, y^2 / (2 s): a front comes to a contact
// at once, and slides along a face.
//
// A probe, where f may be lower than at the centre, is asked for a contact. Included once per SIMD target.
#if defined(THALWEG_SOLVE_SWEEP_SECOND_LOOKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_SWEEP_SECOND_LOOKS_INL
#undef THALWEG_SOLVE_SWEEP_SECOND_LOOKS_INL
#else
#define THALWEG_SOLVE_SWEEP_SECOND_LOOKS_INL
#endif

#include "solve/sweep/moving_cells.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// The lanes of a look, and for how long around it each cell is clear: from time + `before` (at most 0) to time +
/// `after`. Where it is not clear at the time itself, before > after.
struct Looks {
  const uint32_t* query;
  const float* time;
  const float* end;  ///< up to where it is to be cleared
  float* before;
  float* after;
  float* gap;             ///< bound of f at the time itself, less slack
  float* far_factor;      ///< of the distance of far points, learnt by each lane
  uint32_t* evaluations;  ///< counted up
  size_t count;
};

template <class Cell>
class SecondLooks {
 public:
  static constexpr size_t kAxes = static_cast<size_t>(Cell::kAxes);
  static constexpr float kFirstFactor = 8;
  using Moved = Motion<Cell::kAxes, Cell::kParts>;

  /// For looks of at most `lanes` lanes.
  void take(Arena& arena, size_t lanes) {
    const size_t room = 2 * lanes + kColumnPadding;
    for (size_t axis = 0; axis < kAxes; ++axis) {
      point_[axis] = arena.take<float>(room);
      step_[axis] = arena.take<float>(lanes + kColumnPadding);
    }
    value_ = arena.take<float>(room);
    for (float** column : {&far_value_, &distance_}) *column = arena.take<float>(lanes + kColumnPadding);
    cell_ = arena.take<uint32_t>(room);
  }

  /// What value and reach say, then far points and probes where that is not enough.
  void run(const SweepTile& tile, const Moved& motion, const Looks& looks, MovingWave& wave, float* scratch) {
    const F32 d;
    count_ = 0;
    for (size_t i = 0; i < looks.count; i += hn::Lanes(d)) {
      hn::StoreU(hn::Set(d, std::numeric_limits<float>::infinity()), d, wave.probe_value + i);
      hn::StoreU(hn::Set(d, -std::numeric_limits<float>::infinity()), d, far_value_ + i);
      clear_by_reach(tile, motion, looks, wave, i);
      const auto open = is_open(looks, i);
      if (!hn::AllFalse(d, open)) add_far_points(tile, motion, looks, wave, i, open);
    }
    far_ = count_;
    for (size_t i = 0; i < looks.count; i += hn::Lanes(d)) {
      const auto open = is_open(looks, i);
      if (!hn::AllFalse(d, open)) add_probes(motion, looks, wave, i, open);
    }
    if (count_ == 0) return;
    tile.kernels->value(*tile.tape, point_, count_, value_, scratch);
    for (size_t j = 0; j < count_; ++j) ++looks.evaluations[cell_[j]];
    for (size_t j = 0; j < far_; ++j) far_value_[cell_[j]] = value_[j];
    for (size_t j = far_; j < count_; ++j) wave.probe_value[cell_[j]] = value_[j];
    for (size_t i = 0; i < looks.count && far_ > 0; i += hn::Lanes(d))
      clear_by_far_points(tile, motion, looks, wave, i);
  }

 private:
  static constexpr float kMostFactor = 64;

  static HWY_INLINE V32 lipschitz_of(const SweepTile& tile) {
    return hn::Set(F32(), static_cast<float>(tile.tape->facts.lipschitz * (1 + 1e-6)));
  }

  /// f >= f(c) - L r, and no point of the query changes it by more than 1 in `per_value`.
  static HWY_INLINE void clear_by_reach(const SweepTile& tile, const Moved& motion, const Looks& looks,
                                        const MovingWave& wave, size_t i) {
    const F32 d;
    const auto value = hn::Sub(hn::LoadU(d, wave.value + i), gather(motion.slack(), looks.query + i));
    const auto gap = hn::NegMulAdd(lipschitz_of(tile), hn::LoadU(d, wave.reach + i), value);
    const auto clear = hn::Mul(gap, gather(motion.per_value(), looks.query + i));
    hn::StoreU(gap, d, looks.gap + i);
    hn::StoreU(clear, d, looks.after + i);
    hn::StoreU(hn::Neg(clear), d, looks.before + i);
  }
  static HWY_INLINE M32 is_open(const Looks& looks, size_t i) {
    const F32 d;
    const auto here = hn::FirstN(d, HWY_MIN(looks.count - i, hn::Lanes(d)));
    const auto end = hn::Add(hn::LoadU(d, looks.time + i), hn::LoadU(d, looks.after + i));
    return hn::AndNot(hn::Gt(end, hn::LoadU(d, looks.end + i)), here);
  }

  HWY_INLINE void add(M32 which, size_t i, const V32* point) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    for (size_t axis = 0; axis < kAxes; ++axis) hn::CompressStore(point[axis], which, d, point_[axis] + count_);
    const auto lane = hn::Iota(du, static_cast<uint32_t>(i));
    count_ += hn::CompressStore(lane, hn::RebindMask(du, which), du, cell_ + count_);
  }

  HWY_INLINE void add_probes(const Moved& motion, const Looks& looks, MovingWave& wave, size_t i, M32 which) {
    Cell::probe(motion, looks.query + i, wave, i);
    V32 point[kAxes];
    for (size_t axis = 0; axis < kAxes; ++axis) point[axis] = hn::LoadU(F32(), wave.probe[axis] + i);
    add(which, i, point);
  }

  HWY_INLINE void add_far_points(const SweepTile& tile, const Moved& motion, const Looks& looks, const MovingWave& wave,
                                 size_t i, M32 which) {
    const F32 d;
    const auto lipschitz = lipschitz_of(tile);
    V32 u[kAxes], point[kAxes];
    for (size_t axis = 0; axis < kAxes; ++axis) u[axis] = hn::LoadU(d, wave.gradient[axis] + i);
    const auto square = wave.along_gradient(i, u, Cell::kAxes);
    const auto value = hn::LoadU(d, wave.value + i);
    // A field that rises by much less than L a unit cannot pay for the way.
    auto asks = hn::And(which, hn::Gt(value, hn::Zero(d)));
    asks = hn::And(asks, hn::Gt(square, hn::Mul(hn::Set(d, 0.64F), hn::Mul(lipschitz, lipschitz))));
    if (hn::AllFalse(d, asks)) return;
    const auto length = hn::Sqrt(hn::IfThenElse(asks, square, hn::Set(d, 1.0F)));
    const auto size = hn::Max(hn::LoadU(d, wave.reach + i), hn::Div(value, lipschitz));
    const auto wanted = hn::Mul(hn::LoadU(d, looks.far_factor + i), size);
    const auto s = hn::Min(wanted, gather(motion.farthest(), looks.query + i));
    const auto along = hn::Div(s, length);
    for (size_t axis = 0; axis < kAxes; ++axis) {
      const auto step = hn::Mul(along, u[axis]);
      hn::StoreU(step, d, step_[axis] + i);
      point[axis] = hn::Add(hn::LoadU(d, wave.centre[axis] + i), step);
    }
    hn::StoreU(s, d, distance_ + i);
    add(asks, i, point);
  }

  HWY_INLINE void clear_by_far_points(const SweepTile& tile, const Moved& motion, const Looks& looks,
                                      const MovingWave& wave, size_t i) {
    const F32 d;
    const auto far_value = hn::LoadU(d, far_value_ + i);
    const auto asked = hn::Gt(far_value, hn::Set(d, -std::numeric_limits<float>::infinity()));
    if (hn::AllFalse(d, asked)) return;
    const auto lipschitz = lipschitz_of(tile);
    const auto slack = gather(motion.slack(), looks.query + i);
    // Of the way there and of the distance, besides what the slack of the query covers.
    const auto far = hn::Add(gather(motion.furthest(), looks.query + i), hn::LoadU(d, distance_ + i));
    const auto of_tape = hn::Set(d, static_cast<float>(tile.tape->search_slack.b * (1 + 1e-6)));
    const auto rounding = hn::MulAdd(hn::MulAdd(lipschitz, hn::Set(d, 0x1p-18F), of_tape), far, slack);
    const auto radius = hn::Div(hn::Sub(far_value, rounding), hn::Mul(lipschitz, hn::Set(d, 1.000001F)));
    const auto bend = gather(motion.bend(), looks.query + i);
    auto room = take(looks, i, asked, lipschitz, clear_of_corners(wave, i, radius, bend));
    if constexpr (Cell::kIsBall) {
      room = hn::Max(room, take(looks, i, asked, lipschitz, clear_of_ball(wave, i, radius, bend)));
    }
    // Further where little was lost of the value or, of a triangle, no more than twice the r / (2 factor) of a straight
    // field; else nearer. Corners of boxes lose more than that where they stick out of their ball.
    const auto factor = hn::LoadU(d, looks.far_factor + i);
    const auto seen = hn::Min(hn::LoadU(d, wave.value + i), hn::LoadU(d, wave.probe_value + i));
    const auto lost = hn::NegMulAdd(room, lipschitz, hn::Sub(seen, slack));
    const auto straight = hn::Lt(hn::Mul(lost, factor), hn::Mul(lipschitz, hn::Abs(hn::LoadU(d, wave.reach + i))));
    const auto little = hn::Gt(hn::Mul(hn::Add(room, room), lipschitz), hn::Sub(hn::LoadU(d, wave.value + i), slack));
    const auto good = Cell::kIsBall ? little : hn::Or(straight, little);
    const auto next = hn::IfThenElse(good, hn::Min(hn::Mul(factor, hn::Set(d, 1.5F)), hn::Set(d, kMostFactor)),
                                     hn::Max(hn::Mul(factor, hn::Set(d, 0.5F)), hn::Set(d, 1.0F)));
    hn::StoreU(hn::IfThenElse(asked, next, factor), d, looks.far_factor + i);
  }

  /// How far within a far point's radius a cell is, and for how long it stays there; of no use where room <= 0.
  struct Clear {
    V32 room, before, after;
  };

  /// Adds what a far point says to what is known. Returns the room.
  static HWY_INLINE V32 take(const Looks& looks, size_t i, M32 asked, V32 lipschitz, const Clear& clear) {
    const F32 d;
    const auto own = hn::Set(d, 0.99999F);
    const auto old_before = hn::LoadU(d, looks.before + i), old_after = hn::LoadU(d, looks.after + i);
    const auto before = hn::Mul(clear.before, own), after = hn::Mul(clear.after, own);
    const auto use = hn::And(asked, hn::Gt(clear.room, hn::Zero(d)));
    // Two intervals that hold the time itself are one; before > after is none.
    const auto none = hn::Gt(hn::Zero(d), old_after);
    const auto least = hn::IfThenElse(none, before, hn::Min(before, old_before));
    const auto most = hn::IfThenElse(none, after, hn::Max(after, old_after));
    hn::StoreU(hn::IfThenElse(use, least, old_before), d, looks.before + i);
    hn::StoreU(hn::IfThenElse(use, most, old_after), d, looks.after + i);
    const auto gap = hn::LoadU(d, looks.gap + i);
    hn::StoreU(hn::IfThenElse(asked, hn::Max(gap, hn::Mul(clear.room, lipschitz)), gap), d, looks.gap + i);
    return clear.room;
  }

  /// A quarter of the room is for paths that bend, which limits the time.
  static HWY_INLINE Clear with_bends(V32 room, V32 bend, V32& radius) {
    const F32 d;
    const auto bends = hn::Gt(bend, hn::Zero(d));
    const auto used = hn::Max(room, hn::Zero(d));
    radius = hn::IfThenElse(bends, hn::NegMulAdd(hn::Set(d, 0.25F), used, radius), radius);
    const auto twice = hn::IfThenElse(bends, hn::Add(bend, bend), hn::Set(d, 1.0F));
    const auto longest = hn::Set(d, 2.0F);
    const auto time = hn::IfThenElse(bends, hn::Min(longest, hn::Sqrt(hn::Div(used, twice))), longest);
    return {room, hn::Neg(time), time};
  }

  HWY_INLINE Clear clear_of_corners(const MovingWave& wave, size_t i, V32 radius, V32 bend) const {
    const F32 d;
    V32 offset[Cell::kVertices][kAxes], speed[Cell::kVertices][kAxes], square[Cell::kVertices];
    auto most = hn::Zero(d);
    for (size_t k = 0; k < Cell::kVertices; ++k) {
      Cell::vertex(wave, i, k, offset[k], speed[k]);
      square[k] = to_far_point(i, offset[k]);
      most = hn::Max(most, square[k]);
    }
    Clear clear = with_bends(hn::Sub(radius, hn::Sqrt(most)), bend, radius);
    for (size_t k = 0; k < Cell::kVertices; ++k) {
      times_within(offset[k], speed[k], hn::NegMulAdd(radius, radius, square[k]), clear);
    }
    return clear;
  }

  /// No point of a ball is further from a far point than its centre and radius together.
  HWY_INLINE Clear clear_of_ball(const MovingWave& wave, size_t i, V32 radius, V32 bend) const {
    const F32 d;
    V32 offset[kAxes], speed[kAxes];
    for (size_t axis = 0; axis < kAxes; ++axis) {
      offset[axis] = hn::LoadU(d, wave.middle[axis] + i);
      speed[axis] = hn::LoadU(d, wave.speed[axis] + i);
    }
    const auto square = to_far_point(i, offset);
    radius = hn::Sub(radius, hn::LoadU(d, wave.radius + i));
    Clear clear = with_bends(hn::Sub(radius, hn::Sqrt(square)), bend, radius);
    times_within(offset, speed, hn::NegMulAdd(radius, radius, square), clear);
    return clear;
  }

  /// A point is told from the lanes' far points instead of from the cells' centres. Returns its distance squared.
  HWY_INLINE V32 to_far_point(size_t i, V32* offset) const {
    auto square = hn::Zero(F32());
    for (size_t axis = 0; axis < kAxes; ++axis) {
      offset[axis] = hn::Sub(offset[axis], hn::LoadU(F32(), step_[axis] + i));
      square = hn::MulAdd(offset[axis], offset[axis], square);
    }
    return square;
  }

  /// Narrows the times to those at which offset + t speed is within the radius: `deep` is |offset|^2 less the
  /// radius squared, below 0.
  static HWY_INLINE void times_within(const V32* offset, const V32* speed, V32 deep, Clear& clear) {
    const F32 d;
    auto square = hn::Set(d, 1e-30F), along = hn::Zero(d);
    for (size_t axis = 0; axis < kAxes; ++axis) {
      square = hn::MulAdd(speed[axis], speed[axis], square);
      along = hn::MulAdd(offset[axis], speed[axis], along);
    }
    const auto root = hn::Sqrt(hn::MulAdd(along, along, hn::Neg(hn::Mul(square, deep))));
    // Without cancellation: roots are (root - along) / square and -deep / (along + root).
    const auto outward = hn::Gt(along, hn::Zero(d));
    const auto sum = hn::Add(hn::Abs(along), root);
    const auto near = hn::Div(hn::Neg(deep), hn::Max(sum, hn::Set(d, 1e-30F)));
    const auto away = hn::Div(sum, square);
    clear.after = hn::Min(clear.after, hn::IfThenElse(outward, near, away));
    clear.before = hn::Max(clear.before, hn::Neg(hn::IfThenElse(outward, away, near)));
  }

  size_t count_ = 0, far_ = 0;  ///< far points come first
  float* point_[3] = {};
  float* step_[3] = {};  ///< from the centre to the far point, by lane
  float* value_ = nullptr;
  float* far_value_ = nullptr;  ///< by lane
  float* distance_ = nullptr;   ///< by lane
  uint32_t* cell_ = nullptr;    ///< lane
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
