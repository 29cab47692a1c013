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

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/lanes.inl"
#include "solve/decide.h"
#include "solve/finish.h"
#include "solve/tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// At most this many numbers say which piece of its query's region a cell is.
inline constexpr size_t kMostCoordinates = 6;

/// Open cells, one entry each: whose they are and which piece of the region.
struct CellList {
  uint32_t* query = nullptr;
  float* at[kMostCoordinates] = {};
  size_t count = 0;

  void take(Arena& arena, size_t room, size_t coordinates) {
    query = arena.take<uint32_t>(room);
    for (size_t i = 0; i < coordinates; ++i) at[i] = arena.take<float>(room);
  }
};

/// The children of one wave in planes: child k of parent i is entry k * stride + i. The parents' queries are theirs.
struct WaveColumns {
  size_t stride = 0;
  float* at[kMostCoordinates] = {};
  float* centre[3] = {};
  float* reach = nullptr;
  float* edges[9] = {};
  float* value = nullptr;
  float* lower = nullptr;
  float* best = nullptr;  ///< per parent: the least value of its children

  void take(Arena& arena, size_t room, size_t coordinates, size_t edge_columns) {
    for (size_t i = 0; i < coordinates; ++i) at[i] = arena.take<float>(room);
    for (float** column : {&centre[0], &centre[1], &centre[2], &reach, &value, &lower, &best}) {
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

/// One vector of row-major rows of `Width` numbers as columns.
template <size_t Width>
HWY_INLINE void transpose_rows(const float* rows, V32 (&columns)[Width]) {
  const F32 d;
  if constexpr (Width == 3) {
    hn::LoadInterleaved3(d, rows, columns[0], columns[1], columns[2]);
  } else if constexpr (Width == 4) {
    hn::LoadInterleaved4(d, rows, columns[0], columns[1], columns[2], columns[3]);
#if HWY_TARGET != HWY_SCALAR
  } else if constexpr (Width == 6) {
    // Every third number twice over: columns k and k + 3 side by side.
    V32 low[3], high[3];
    hn::LoadInterleaved3(d, rows, low[0], low[1], low[2]);
    hn::LoadInterleaved3(d, rows + 3 * hn::Lanes(d), high[0], high[1], high[2]);
    for (size_t k = 0; k < 3; ++k) {
      columns[k] = hn::ConcatEven(d, high[k], low[k]);
      columns[k + 3] = hn::ConcatOdd(d, high[k], low[k]);
    }
#endif
  } else {
    const IndexLanes di;
    const auto first = hn::Mul(hn::Iota(di, 0), hn::Set(di, static_cast<int32_t>(Width)));
    for (size_t k = 0; k < Width; ++k) columns[k] = hn::GatherIndex(d, rows + k, first);
  }
}

/// Row-major rows of `Width` numbers to columns, with the largest magnitude of each row; rows with a number that is
/// not finite or too large are marked and replaced by zeros.
template <size_t Width>
HWY_INLINE void load_rows(const QueryTile& tile, float* const* columns, float* largest, float* is_bad) {
  const F32 d;
  const size_t lanes = hn::Lanes(d);
  const auto limit = hn::Set(d, kLargestCoordinate);
  for (size_t i = 0; i < tile.count; i += lanes) {
    const float* rows = tile.rows + i * Width;
    float tail[Width * hn::MaxLanes(F32())];
    if (tile.count - i < lanes) {
      std::fill_n(tail, Width * lanes, 0.0F);
      std::copy_n(rows, (tile.count - i) * Width, tail);
      rows = tail;
    }
    V32 x[Width];
    transpose_rows(rows, x);
    auto most = hn::Zero(d);
    auto good = hn::Eq(most, most);
    for (size_t k = 0; k < Width; ++k) {
      const auto size = hn::Abs(x[k]);
      good = hn::And(good, hn::Le(size, limit));
      most = hn::Max(most, size);
    }
    for (size_t k = 0; k < Width; ++k) hn::StoreU(hn::IfThenElseZero(good, x[k]), d, columns[k] + i);
    hn::StoreU(hn::IfThenElseZero(good, most), d, largest + i);
    hn::StoreU(hn::IfThenElse(good, hn::Zero(d), hn::Set(d, 1.0F)), d, is_bad + i);
  }
}

/// A cell's centre in the coordinates of its query.
template <class Domain>
HWY_INLINE void centre_coordinates(const float* cell, float* uv) {
  V32 at[kMostCoordinates];
  for (size_t k = 0; k < Domain::kCoordinates; ++k) at[k] = hn::Set(F32(), cell[k]);
  V32 centre[2];
  Domain::centre_coordinates(at, centre);
  for (size_t k = 0; k < 2; ++k) uv[k] = hn::GetLane(centre[k]);
}

/// Triangles, halved across their longest edge: a cell is its three corners in barycentric coordinates (u, v) of the
/// second and third corner of the query, dyadic and so exact. Slivers become compact in as few splits as any.
template <int D>
class TriangleDomain {
 public:
  static constexpr size_t kChildren = 2;
  static constexpr int kAxes = D;
  static constexpr size_t kCoordinates = 6;  ///< u0 v0 u1 v1 u2 v2
  static constexpr float kRoot[kCoordinates] = {0, 0, 1, 0, 0, 1};
  static constexpr size_t kEdgeColumns = 3 * D;
  static constexpr bool kIsBall = false;

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

  /// Splits a list of cells into the two planes of a wave.
  void split(const CellList& open, WaveColumns& wave, bool with_edges) const {
    const F32 d;
    const auto half = hn::Set(d, 0.5F);
    for (size_t i = 0; i < open.count; i += hn::Lanes(d)) {
      const Frame frame = frame_of(open.query + i);
      Corner corner[3];
      for (size_t k = 0; k < 3; ++k) {
        corner[k] = frame.corner(hn::LoadU(d, open.at[2 * k] + i), hn::LoadU(d, open.at[2 * k + 1] + i));
      }
      // Rotate the corners so that the longest edge runs from the first to the second; of equal ones the first.
      const auto s01 = square_between(corner[0], corner[1]);
      const auto s12 = square_between(corner[1], corner[2]);
      const auto s20 = square_between(corner[2], corner[0]);
      const auto is_12 = hn::And(hn::Gt(s12, s01), hn::Ge(s12, s20));
      const auto is_20 = hn::And(hn::Gt(s20, s01), hn::Gt(s20, s12));
      const Corner p = pick(is_20, corner[2], pick(is_12, corner[1], corner[0]));
      const Corner q = pick(is_20, corner[0], pick(is_12, corner[2], corner[1]));
      const Corner r = pick(is_20, corner[1], pick(is_12, corner[0], corner[2]));
      const Corner m = frame.corner(hn::Mul(hn::Add(p.u, q.u), half), hn::Mul(hn::Add(p.v, q.v), half));
      write(wave, i, p, m, r, with_edges);
      write(wave, wave.stride + i, m, q, r, with_edges);
    }
  }

  /// Where f may be lower than at a cell's centre: the cell's corner furthest against the gradient.
  void probe(uint32_t query, const float* cell, const float*, const float* gradient, float* point, float* uv) const {
    float slope_b = 0;
    float slope_c = 0;
    for (size_t axis = 0; axis < D; ++axis) {
      slope_b += gradient[axis] * corners_[D + axis][query];
      slope_c += gradient[axis] * corners_[2 * D + axis][query];
    }
    float least = std::numeric_limits<float>::infinity();
    for (size_t k = 0; k < 3; ++k) {
      const float height = cell[2 * k] * slope_b + cell[2 * k + 1] * slope_c;
      if (!(height < least)) continue;
      least = height;
      uv[0] = cell[2 * k];
      uv[1] = cell[2 * k + 1];
    }
    for (size_t axis = 0; axis < D; ++axis) {
      point[axis] = corners_[axis][query] + (uv[0] * corners_[D + axis][query] + uv[1] * corners_[2 * D + axis][query]);
    }
  }

  static HWY_INLINE void centre_coordinates(const V32* cell, V32* uv) {
    const auto three = hn::Set(F32(), 3.0F);
    for (size_t k = 0; k < 2; ++k) uv[k] = hn::Div(hn::Add(hn::Add(cell[k], cell[k + 2]), cell[k + 4]), three);
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
  /// A corner of a cell: its coordinates, and where it is.
  struct Corner {
    V32 u, v;
    V32 x[D];
  };
  /// First corner and edges of the queries of one vector of cells.
  struct Frame {
    V32 a[D], ab[D], ac[D];
    HWY_INLINE Corner corner(V32 u, V32 v) const {
      Corner c{u, v, {}};
      for (size_t axis = 0; axis < D; ++axis) c.x[axis] = hn::MulAdd(u, ab[axis], hn::MulAdd(v, ac[axis], a[axis]));
      return c;
    }
  };

  HWY_INLINE Frame frame_of(const uint32_t* query) const {
    Frame frame;
    for (size_t axis = 0; axis < D; ++axis) {
      frame.a[axis] = gather(corners_[axis], query);
      frame.ab[axis] = gather(corners_[D + axis], query);
      frame.ac[axis] = gather(corners_[2 * D + axis], query);
    }
    return frame;
  }
  static HWY_INLINE V32 square_between(const Corner& p, const Corner& q) {
    V32 sum = hn::Zero(F32());
    for (size_t axis = 0; axis < D; ++axis) {
      const auto x = hn::Sub(p.x[axis], q.x[axis]);
      sum = hn::MulAdd(x, x, sum);
    }
    return sum;
  }
  static HWY_INLINE Corner pick(M32 m, const Corner& yes, const Corner& no) {
    Corner c{hn::IfThenElse(m, yes.u, no.u), hn::IfThenElse(m, yes.v, no.v), {}};
    for (size_t axis = 0; axis < D; ++axis) c.x[axis] = hn::IfThenElse(m, yes.x[axis], no.x[axis]);
    return c;
  }

  static HWY_INLINE void write(WaveColumns& wave, size_t at, const Corner& p, const Corner& q, const Corner& r,
                               bool with_edges) {
    const F32 d;
    const Corner* corners[3] = {&p, &q, &r};
    const auto third = hn::Set(d, 1.0F / 3.0F);
    V32 square[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (size_t axis = 0; axis < D; ++axis) {
      const auto centre =
          hn::MulAdd(hn::Add(hn::Sub(q.x[axis], p.x[axis]), hn::Sub(r.x[axis], p.x[axis])), third, p.x[axis]);
      hn::StoreU(centre, d, wave.centre[axis] + at);
      for (size_t k = 0; k < 3; ++k) {
        const auto edge = hn::Sub(corners[k]->x[axis], centre);
        square[k] = hn::MulAdd(edge, edge, square[k]);
        if (with_edges) hn::StoreU(edge, d, wave.edges[k * D + axis] + at);
      }
    }
    const auto most = hn::Max(square[0], hn::Max(square[1], square[2]));
    hn::StoreU(hn::Mul(hn::Sqrt(most), hn::Set(d, 1.000001F)), d, wave.reach + at);
    for (size_t k = 0; k < 3; ++k) {
      hn::StoreU(corners[k]->u, d, wave.at[2 * k] + at);
      hn::StoreU(corners[k]->v, d, wave.at[2 * k + 1] + at);
    }
  }

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
  static constexpr size_t kCoordinates = D + 1;  ///< centre of the box from that of the ball, and half size; in radii
  static constexpr float kRoot[4] = {0, 0, D == 2 ? 1 : 0, 1};
  static constexpr size_t kEdgeColumns = D;
  static constexpr bool kIsBall = true;

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

  void split(const CellList& open, WaveColumns& wave, bool) const {
    const F32 d;
    const auto half = hn::Set(d, 0.5F);
    for (size_t i = 0; i < open.count; i += hn::Lanes(d)) {
      const auto radius = gather(rows_[D], open.query + i);
      const auto size = hn::Mul(hn::LoadU(d, open.at[D] + i), half);
      for (size_t child = 0; child < kChildren; ++child) {
        V32 offset[D];
        for (size_t axis = 0; axis < D; ++axis) {
          const auto step = (child >> axis & 1) != 0 ? size : hn::Neg(size);
          offset[axis] = hn::Add(hn::LoadU(d, open.at[axis] + i), step);
        }
        write(wave, child * wave.stride + i, open.query + i, {offset, size, radius});
      }
    }
  }

  /// Where f may be lower than at a cell's centre: a cell's length further down the gradient, within the ball.
  void probe(uint32_t query, const float* cell, const float* from, const float* gradient, float* point,
             float* uv) const {
    const float radius = rows_[D][query];
    float offset[D];
    float square = 0;
    for (size_t axis = 0; axis < D; ++axis) {
      offset[axis] = from[axis] - rows_[axis][query] - 2 * radius * cell[D] * gradient[axis];
      square += offset[axis] * offset[axis];
    }
    const float length = std::sqrt(square);
    const float inward = length > radius ? 0.9999999F * radius / length : 1;
    for (size_t axis = 0; axis < D; ++axis) point[axis] = rows_[axis][query] + inward * offset[axis];
    uv[0] = uv[1] = 0;
  }

  static HWY_INLINE void centre_coordinates(const V32*, V32* uv) { uv[0] = uv[1] = hn::Zero(F32()); }

  [[nodiscard]] Region64 region(const QueryTile& tile, size_t q) const {
    Region64 region;
    region.dimension = D;
    region.is_ball = true;
    for (size_t axis = 0; axis < D; ++axis) region.corner[0][axis] = tile.rows[q * (D + 1) + axis];
    region.radius = tile.rows[q * (D + 1) + D];
    return region;
  }

 private:
  struct Box {
    const V32* offset;
    V32 size, radius;
  };

  void write(WaveColumns& wave, size_t at, const uint32_t* query, const Box& box) const {
    const F32 d;
    const auto one = hn::Set(d, 1.0F);
    const auto diagonal = hn::Set(d, D == 2 ? 1.4142137F : 1.7320509F);
    auto square = hn::Zero(d);
    for (size_t axis = 0; axis < D; ++axis) square = hn::MulAdd(box.offset[axis], box.offset[axis], square);
    const auto distance = hn::Sqrt(square);
    const auto inward = hn::IfThenElse(hn::Gt(distance, one), hn::Div(hn::Set(d, 0.9999999F), distance), one);
    const auto half = hn::Mul(box.size, box.radius);
    for (size_t axis = 0; axis < D; ++axis) {
      const auto offset = hn::Mul(box.offset[axis], box.radius);
      const auto moved = hn::Mul(offset, inward);
      hn::StoreU(hn::Add(gather(rows_[axis], query), moved), d, wave.centre[axis] + at);
      hn::StoreU(hn::Add(half, hn::Abs(hn::Sub(offset, moved))), d, wave.edges[axis] + at);
      hn::StoreU(box.offset[axis], d, wave.at[axis] + at);
    }
    hn::StoreU(box.size, d, wave.at[D] + at);
    // A box that misses the ball holds no point of the query.
    const auto corner = hn::Mul(box.size, diagonal);
    const auto misses = hn::Gt(hn::Sub(distance, corner), hn::Set(d, 1.00001F));
    hn::StoreU(hn::IfThenElse(misses, hn::Set(d, kMisses), hn::Mul(half, diagonal)), d, wave.reach + at);
  }

  float* rows_[D + 1] = {};
  float* largest_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
