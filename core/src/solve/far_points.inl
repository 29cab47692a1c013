// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One value more for a cell that its own values leave open. f is L-Lipschitz, so any point p bounds it from below:
//
//   f(x) >= f(p) - L |x - p| >= f(p) - L max over the cell's vertices v of |v - p|,
//
// because the distance to p is convex and so greatest at a vertex. From p = c + s u, u the unit gradient at a point c
// of the cell, the far side of the cell looks almost flat: where the field is straight from c to p, that is f(p) = f(c)
// + L s, all that is lost against the linear model of f is L |v - c|^2 / (2 s). The loss of f(c) - L r is of first
// order in the cell, this one of second. Nothing about the field is assumed: p only has to pay.
//
// s is the least that can close the cell: with w = v - c and a room of (f(c) - limit) / L above what must be proven,
// |w - s u| <= s + room means s >= (|w|^2 - room^2) / (2 (u . w + room)). A cell where u . w + room <= 0 for a vertex
// would be below the limit if f were linear, and gets no far point.
//
// Rounding. With e = 2^-24 and m_p = m + s, which bounds the coordinates of p: the value at p is off by what the slack
// allows at m_p. A vertex is off by 11 e m (certificates: half of that in the plane), its offset from c by 4 e m, p by
// 2 e m_p, and |w - s u| as computed by 5 e of itself, which is at most 4 m_p: less than 38 e m_p together. The bound
// gives up 64 e L m_p. Included once per SIMD target.
#if defined(THALWEG_SOLVE_FAR_POINTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_FAR_POINTS_INL
#undef THALWEG_SOLVE_FAR_POINTS_INL
#else
#define THALWEG_SOLVE_FAR_POINTS_INL
#endif

#include <algorithm>
#include <cmath>

#include "solve/domains.inl"
#include "solve/finish.h"
#include "solve/tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// The part of the room that a far point counts on; the rest is for the field's bends.
inline constexpr float kRoomUsed = 0.98F;

/// The cells of a wave: parent i's are entries k * stride + i.
struct CellsOfParents {
  const uint32_t* query;  ///< per parent
  const float* limit;     ///< per parent: a bound above it closes a cell
  uint32_t* asked;        ///< per parent: how many values of f were asked for
  size_t parents;
  size_t children;
};

template <class Domain>
class FarPoints {
 public:
  void take(const QueryTile& tile, const Domain& domain, const QueryState& state, Arena& arena, size_t room) {
    tile_ = &tile;
    domain_ = &domain;
    state_ = &state;
    for (size_t axis = 0; axis < kAxes; ++axis) point_[axis] = arena.take<float>(room);
    for (float** column : {&value_, &loss_}) *column = arena.take<float>(room);
    cell_ = arena.take<uint32_t>(room);
  }

  /// Raises the bounds of those cells of a wave that one value each may close.
  void raise_bounds(const CellsOfParents& cells, WaveColumns& wave, float* scratch) {
    std::fill_n(cells.asked, cells.parents, 0);
    if (!std::isfinite(tile_->tape->facts.lipschitz)) return;
    count_ = 0;
    for (size_t k = 0; k < cells.children; ++k) {
      for (size_t i = 0; i < cells.parents; i += vector_lanes()) choose(cells, wave, i, k * wave.stride + i);
    }
    tile_->kernels->value(*tile_->tape, point_, count_, value_, scratch);
    for (size_t j = 0; j < count_; ++j) {
      float& lower = wave.lower[cell_[j]];
      lower = std::max(lower, value_[j] - loss_[j]);
    }
  }

 private:
  static constexpr size_t kAxes = static_cast<size_t>(Domain::kAxes);

  /// Lists the far points of one vector of cells.
  HWY_INLINE void choose(const CellsOfParents& cells, const WaveColumns& wave, size_t i, size_t at) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const auto zero = hn::Zero(d);
    const auto limit = hn::LoadU(d, cells.limit + i);
    const auto here = hn::FirstN(d, HWY_MIN(cells.parents - i, hn::Lanes(d)));
    const auto open = hn::AndNot(hn::Gt(hn::LoadU(d, wave.lower + at), limit), here);
    if (hn::AllFalse(d, open)) return;
    const float lipschitz = static_cast<float>(tile_->tape->facts.lipschitz);
    const uint32_t* query = cells.query + i;
    V32 u[kAxes];
    auto square = zero;
    for (size_t axis = 0; axis < kAxes; ++axis) {
      u[axis] = hn::LoadU(d, wave.gradient[axis] + at);
      square = hn::MulAdd(u[axis], u[axis], square);
    }
    // A field that rises by much less than L a unit cannot pay for the way.
    const auto rises = hn::Gt(square, hn::Set(d, 0.64F * lipschitz * lipschitz));
    const auto inverse = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(hn::IfThenElse(rises, square, hn::Set(d, 1.0F))));
    for (V32& component : u) component = hn::Mul(component, inverse);
    const auto reserve = hn::MulAdd(hn::Set(d, 2.0F), gather(state_->slack, query), limit);
    const auto room = hn::Mul(hn::Sub(hn::LoadU(d, wave.value + at), reserve), hn::Set(d, kRoomUsed / lipschitz));
    auto s = hn::Mul(hn::LoadU(d, wave.reach + at), hn::Set(d, 0.1F));
    auto pays = least_distance(wave, at, u, room, s);
    const auto most = hn::Mul(gather(domain_->reach(), query), hn::Set(d, tile_->limits->far_reaches));
    pays = hn::And(hn::And(pays, hn::Le(s, most)), hn::And(open, rises));
    if (hn::AllFalse(d, pays)) return;
    V32 step[kAxes];
    for (size_t axis = 0; axis < kAxes; ++axis) {
      step[axis] = hn::Mul(s, u[axis]);
      const auto p = hn::Add(hn::LoadU(d, wave.centre[axis] + at), step[axis]);
      hn::CompressStore(p, pays, d, point_[axis] + count_);
    }
    const auto far = hn::Add(gather(domain_->largest(), query), s);
    const auto rounding = hn::MulAdd(hn::Set(d, static_cast<float>(tile_->limits->slack.b) + 0x1p-18F * lipschitz), far,
                                     hn::Set(d, static_cast<float>(tile_->limits->slack.a)));
    const auto loss = hn::MulAdd(hn::Set(d, lipschitz), most_distance(wave, at, step), rounding);
    hn::CompressStore(hn::Mul(loss, hn::Set(d, 1.000001F)), pays, d, loss_ + count_);
    const auto lanes = hn::RebindMask(du, pays);
    hn::BlendedStore(hn::Add(hn::LoadU(du, cells.asked + i), hn::Set(du, 1)), lanes, du, cells.asked + i);
    count_ += hn::CompressStore(hn::Iota(du, static_cast<uint32_t>(at)), lanes, du, cell_ + count_);
  }

  /// A cell's vertex `corner` from its centre.
  static HWY_INLINE V32 edge(const WaveColumns& wave, size_t at, size_t corner, size_t axis) {
    return hn::LoadU(F32(), wave.edges[corner * kAxes + axis] + at);
  }

  /// Raises s to what closes the cells if the field is straight; false where nothing does.
  static HWY_INLINE M32 least_distance(const WaveColumns& wave, size_t at, const V32* u, V32 room, V32& s) {
    const F32 d;
    const auto least = hn::Set(d, 1e-30F);
    auto possible = hn::Eq(room, room);
    for (size_t corner = 0; corner < (Domain::kIsBall ? 1 : 3); ++corner) {
      auto square = hn::Neg(hn::Mul(room, room));
      auto height = room;
      for (size_t axis = 0; axis < kAxes; ++axis) {
        const auto w = edge(wave, at, corner, axis);
        square = hn::MulAdd(w, w, square);
        height = Domain::kIsBall ? hn::NegMulAdd(hn::Abs(u[axis]), w, height) : hn::MulAdd(u[axis], w, height);
      }
      const auto rises = hn::Gt(height, least);
      possible = hn::And(possible, rises);
      const auto twice = hn::Add(height, height);
      s = hn::Max(s, hn::Div(square, hn::IfThenElse(rises, twice, hn::Set(d, 1.0F))));
    }
    return possible;
  }

  /// The greatest distance from a cell's point to its centre moved by `step`.
  static HWY_INLINE V32 most_distance(const WaveColumns& wave, size_t at, const V32* step) {
    const F32 d;
    auto most = hn::Zero(d);
    for (size_t corner = 0; corner < (Domain::kIsBall ? 1 : 3); ++corner) {
      auto square = hn::Zero(d);
      for (size_t axis = 0; axis < kAxes; ++axis) {
        const auto w = edge(wave, at, corner, axis);
        const auto x = Domain::kIsBall ? hn::Add(w, hn::Abs(step[axis])) : hn::Sub(w, step[axis]);
        square = hn::MulAdd(x, x, square);
      }
      most = hn::Max(most, square);
    }
    return hn::Sqrt(most);
  }

  const QueryTile* tile_ = nullptr;
  const Domain* domain_ = nullptr;
  const QueryState* state_ = nullptr;
  size_t count_ = 0;
  float* point_[3] = {};
  float* value_ = nullptr;
  float* loss_ = nullptr;     ///< what the value is above the bound
  uint32_t* cell_ = nullptr;  ///< entry of the wave
  uint32_t* query_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
