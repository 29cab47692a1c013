// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The regions that a certified search can cut up: how a row becomes a root cell, how a cell is split, and where a
// cell's centre, reach and extent lie. Included once per SIMD target.
#if defined(THALWEG_SOLVE_DOMAINS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_DOMAINS_INL
#undef THALWEG_SOLVE_DOMAINS_INL
#else
#define THALWEG_SOLVE_DOMAINS_INL
#endif

#include "kernels/lanes.inl"
#include "solve/decide.h"
#include "solve/finish.h"
#include "solve/tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Columns of one wave's cells.
struct WaveColumns {
  uint32_t* query = nullptr;
  float* u = nullptr;
  float* v = nullptr;
  float* w = nullptr;
  float* size = nullptr;
  float* centre[3] = {};
  float* reach = nullptr;
  float* edges[9] = {};
  float* value = nullptr;
  float* lower = nullptr;

  void take(Arena& arena, size_t count, size_t edge_columns) {
    const size_t room = padded(count);
    query = arena.take<uint32_t>(room);
    for (float** column : {&u, &v, &w, &size, &centre[0], &centre[1], &centre[2], &reach, &value, &lower}) {
      *column = arena.take<float>(room);
    }
    for (size_t i = 0; i < edge_columns; ++i) edges[i] = arena.take<float>(room);
  }
};

/// Reach of a cell without a point of the query: puts its bound above every value and keeps all arithmetic finite.
inline constexpr float kMisses = -1e30F;

using IndexLanes = hn::RebindToSigned<F32>;

/// Entries of a column picked by the cells' queries.
HWY_INLINE V32 gather(const float* column, const uint32_t* index) {
  const IndexLanes di;
  return hn::GatherIndex(F32(), column, hn::LoadU(di, reinterpret_cast<const int32_t*>(index)));
}

/// Row-major rows of `width` numbers to columns, with the largest magnitude of each row; rows with a number that is
/// not finite or too large are marked and replaced by zeros.
template <size_t Width>
HWY_INLINE void load_rows(const QueryTile& tile, float* const* columns, float* largest, uint8_t* is_bad) {
  const F32 d;
  const IndexLanes di;
  const size_t lanes = hn::Lanes(d);
  const auto first = hn::Mul(hn::Iota(di, 0), hn::Set(di, static_cast<int32_t>(Width)));
  const auto limit = hn::Set(d, kLargestCoordinate);
  for (size_t i = 0; i < tile.count; i += lanes) {
    const float* rows = tile.rows + i * Width;
    float tail[Width * hn::MaxLanes(F32())];
    if (tile.count - i < lanes) {
      std::fill_n(tail, Width * lanes, 0.0F);
      std::copy_n(rows, (tile.count - i) * Width, tail);
      rows = tail;
    }
    auto most = hn::Zero(d);
    auto good = hn::Eq(most, most);
    for (size_t k = 0; k < Width; ++k) {
      const auto x = hn::GatherIndex(d, rows + k, first);
      const auto size = hn::Abs(x);
      good = hn::And(good, hn::Le(size, limit));
      most = hn::Max(most, size);
      hn::StoreU(x, d, columns[k] + i);
    }
    hn::StoreU(hn::IfThenElseZero(good, most), d, largest + i);
    if (hn::AllTrue(d, good)) {
      std::fill_n(is_bad + i, lanes, uint8_t{0});
      continue;
    }
    for (size_t k = 0; k < Width; ++k) {
      hn::StoreU(hn::IfThenElseZero(good, hn::LoadU(d, columns[k] + i)), d, columns[k] + i);
    }
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, good, bits);
    for (size_t lane = 0; lane < lanes; ++lane) is_bad[i + lane] = (bits[lane / 8] >> (lane % 8) & 1) != 0 ? 0 : 1;
  }
}

template <int D>
class TriangleDomain {
 public:
  static constexpr size_t kChildren = 4;
  static constexpr int kAxes = D;
  static constexpr size_t kEdgeColumns = 3 * D;
  static constexpr bool kIsBall = false;
  static constexpr float kRoot = 0;

  void take(Arena& arena, size_t count) {
    for (float*& column : corners_) column = arena.take<float>(padded(count));
    reach_ = arena.take<float>(padded(count));
    largest_ = arena.take<float>(padded(count));
  }
  [[nodiscard]] const float* reach() const { return reach_; }
  [[nodiscard]] const float* largest() const { return largest_; }

  /// Columns of corners, then of the first corner and the two edges from it; the centroid as each query's point.
  void load(const QueryTile& tile, QueryState& state) {
    load_rows<3 * D>(tile, corners_, largest_, state.is_bad);
    const F32 d;
    const auto third = hn::Set(d, 1.0F / 3.0F);
    for (size_t i = 0; i < tile.count; i += hn::Lanes(d)) {
      V32 square[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
      for (size_t axis = 0; axis < D; ++axis) {
        const auto a = hn::LoadU(d, corners_[axis] + i);
        const auto b = hn::LoadU(d, corners_[D + axis] + i);
        const auto c = hn::LoadU(d, corners_[2 * D + axis] + i);
        const auto ab = hn::Sub(b, a);
        const auto ac = hn::Sub(c, a);
        const auto centre = hn::MulAdd(hn::Add(ab, ac), third, a);
        hn::StoreU(ab, d, corners_[D + axis] + i);
        hn::StoreU(ac, d, corners_[2 * D + axis] + i);
        hn::StoreU(centre, d, state.point[axis] + i);
        const V32 offset[3] = {hn::Sub(a, centre), hn::Sub(b, centre), hn::Sub(c, centre)};
        for (size_t corner = 0; corner < 3; ++corner) {
          square[corner] = hn::MulAdd(offset[corner], offset[corner], square[corner]);
        }
      }
      const auto most = hn::Max(square[0], hn::Max(square[1], square[2]));
      hn::StoreU(hn::Mul(hn::Sqrt(most), hn::Set(d, 1.000001F)), d, reach_ + i);
      hn::StoreU(third, d, state.barycentric[0] + i);
      hn::StoreU(third, d, state.barycentric[1] + i);
    }
  }

  /// Four similar triangles; the middle one is turned, which its negative size says.
  static HWY_INLINE OpenCell child(const OpenCell& p, size_t k) {
    const float half = p.size * 0.5F;
    OpenCell c = p;
    c.size = k == 3 ? -half : half;
    if (k == 1 || k == 3) c.u += half;
    if (k == 2 || k == 3) c.v += half;
    return c;
  }

  /// Centres and reaches of a wave, and the corners relative to the centre if bounds need them.
  void place(const WaveColumns& wave, size_t count, bool with_edges) const {
    const F32 d;
    const auto third = hn::Set(d, 1.0F / 3.0F);
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
      const auto size = hn::LoadU(d, wave.size + i);
      const auto u = hn::MulAdd(size, third, hn::LoadU(d, wave.u + i));
      const auto v = hn::MulAdd(size, third, hn::LoadU(d, wave.v + i));
      const auto step = hn::Mul(size, third);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto a = gather(corners_[axis], wave.query + i);
        const auto ab = gather(corners_[D + axis], wave.query + i);
        const auto ac = gather(corners_[2 * D + axis], wave.query + i);
        hn::StoreU(hn::MulAdd(u, ab, hn::MulAdd(v, ac, a)), d, wave.centre[axis] + i);
        if (!with_edges) continue;
        const auto two = hn::Set(d, 2.0F);
        hn::StoreU(hn::Neg(hn::Mul(hn::Add(ab, ac), step)), d, wave.edges[axis] + i);
        hn::StoreU(hn::Mul(hn::MulSub(two, ab, ac), step), d, wave.edges[D + axis] + i);
        hn::StoreU(hn::Mul(hn::MulSub(two, ac, ab), step), d, wave.edges[2 * D + axis] + i);
      }
      hn::StoreU(hn::Mul(gather(reach_, wave.query + i), hn::Abs(size)), d, wave.reach + i);
    }
  }

  [[nodiscard]] Region64 region(const QueryTile& tile, size_t q) const {
    Region64 region;
    region.dimension = D;
    for (size_t corner = 0; corner < 3; ++corner) {
      for (size_t axis = 0; axis < D; ++axis) region.corner[corner][axis] = tile.rows[(q * 3 + corner) * D + axis];
    }
    return region;
  }

 private:
  float* corners_[3 * D] = {};
  float* reach_ = nullptr;
  float* largest_ = nullptr;
};

/// Discs and balls, cut into boxes. A box is evaluated at its centre moved into the ball, which brings no point of
/// box and ball further away.
template <int D>
class BallDomain {
 public:
  static constexpr size_t kChildren = size_t{1} << D;
  static constexpr int kAxes = D;
  static constexpr size_t kEdgeColumns = D;
  static constexpr bool kIsBall = true;
  static constexpr float kRoot = 0;

  void take(Arena& arena, size_t count) {
    for (float*& column : rows_) column = arena.take<float>(padded(count));
    largest_ = arena.take<float>(padded(count));
  }
  [[nodiscard]] const float* reach() const { return rows_[D]; }
  [[nodiscard]] const float* largest() const { return largest_; }

  void load(const QueryTile& tile, QueryState& state) {
    load_rows<D + 1>(tile, rows_, largest_, state.is_bad);
    const F32 d;
    for (size_t i = 0; i < tile.count; i += hn::Lanes(d)) {
      for (size_t axis = 0; axis < D; ++axis) hn::StoreU(hn::LoadU(d, rows_[axis] + i), d, state.point[axis] + i);
      // Points of the ball reach as far as centre and radius together.
      const auto most = hn::LoadU(d, largest_ + i);
      hn::StoreU(hn::Add(most, hn::Abs(hn::LoadU(d, rows_[D] + i))), d, largest_ + i);
      hn::StoreU(hn::Zero(d), d, state.barycentric[0] + i);
      hn::StoreU(hn::Zero(d), d, state.barycentric[1] + i);
    }
    for (size_t q = 0; q < tile.count; ++q) {
      // A negative radius is no ball.
      if (rows_[D][q] < 0) {
        state.is_bad[q] = 1;
        rows_[D][q] = 0;
      }
    }
  }

  static HWY_INLINE OpenCell child(const OpenCell& p, size_t k) {
    const float half = p.size * 0.5F;
    OpenCell c = p;
    c.size = half;
    c.u += (k & 1) != 0 ? half : -half;
    c.v += (k & 2) != 0 ? half : -half;
    if constexpr (D == 3) c.w += (k & 4) != 0 ? half : -half;
    return c;
  }

  void place(const WaveColumns& wave, size_t count, bool) const {
    const F32 d;
    const float* offsets[3] = {wave.u, wave.v, wave.w};
    const auto diagonal = hn::Set(d, D == 2 ? 1.4142137F : 1.7320509F);
    const auto one = hn::Set(d, 1.0F);
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
      const auto radius = gather(rows_[D], wave.query + i);
      const auto size = hn::LoadU(d, wave.size + i);
      auto square = hn::Zero(d);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto x = hn::LoadU(d, offsets[axis] + i);
        square = hn::MulAdd(x, x, square);
      }
      const auto distance = hn::Sqrt(square);
      const auto inward = hn::IfThenElse(hn::Gt(distance, one), hn::Div(hn::Set(d, 0.9999999F), distance), one);
      const auto half = hn::Mul(size, radius);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto offset = hn::Mul(hn::LoadU(d, offsets[axis] + i), radius);
        const auto moved = hn::Mul(offset, inward);
        hn::StoreU(hn::Add(gather(rows_[axis], wave.query + i), moved), d, wave.centre[axis] + i);
        hn::StoreU(hn::Add(half, hn::Abs(hn::Sub(offset, moved))), d, wave.edges[axis] + i);
      }
      // A box that misses the ball holds no point of the query.
      const auto corner = hn::Mul(size, diagonal);
      const auto misses = hn::Gt(hn::Sub(distance, corner), hn::Set(d, 1.00001F));
      hn::StoreU(hn::IfThenElse(misses, hn::Set(d, kMisses), hn::Mul(half, diagonal)), d, wave.reach + i);
    }
  }

  [[nodiscard]] Region64 region(const QueryTile& tile, size_t q) const {
    Region64 region;
    region.dimension = D;
    region.is_ball = true;
    for (size_t axis = 0; axis < D; ++axis) region.corner[0][axis] = tile.rows[q * (D + 1) + axis];
    region.radius = tile.rows[q * (D + 1) + D];
    return region;
  }

 private:
  float* rows_[D + 1] = {};
  float* largest_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
