// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Triangles as regions of a certified search. Included once per SIMD target.
#if defined(THALWEG_SOLVE_TRIANGLE_DOMAIN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_TRIANGLE_DOMAIN_INL
#undef THALWEG_SOLVE_TRIANGLE_DOMAIN_INL
#else
#define THALWEG_SOLVE_TRIANGLE_DOMAIN_INL
#endif

#include "solve/domains.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Triangles, halved across their longest edge: a cell is its three corners in barycentric coordinates (u, v) of the
/// second and third corner of the query, dyadic and so exact. Slivers become compact in as few splits as any.
template <int D>
class TriangleDomain {
 public:
  static constexpr size_t kChildren = 2;
  static constexpr int kAxes = D;
  static constexpr size_t kWidth = 3 * D;    ///< numbers of a row
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
  void split(const CellList& open, WaveColumns& wave) const {
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
      write(wave, i, p, m, r);
      write(wave, wave.stride + i, m, q, r);
    }
  }

  /// Where the linear model of f is least over the cells of one vector: the corner furthest against the gradient, as
  /// centre and edge give it, which is within 16 e m (e = 2^-24) of where it is exactly.
  [[nodiscard]] HWY_INLINE Lowest<D> lowest(const WaveColumns& wave, size_t at, const uint32_t*) const {
    const F32 d;
    Lowest<D> low{hn::Set(d, std::numeric_limits<float>::infinity()), {}, {}};
    for (size_t k = 0; k < 3; ++k) {
      V32 edge[D];
      auto slope = hn::Zero(d);
      for (size_t axis = 0; axis < D; ++axis) {
        edge[axis] = hn::LoadU(d, wave.edges[k * D + axis] + at);
        slope = hn::MulAdd(hn::LoadU(d, wave.gradient[axis] + at), edge[axis], slope);
      }
      const auto lower = hn::Lt(slope, low.slope);
      low.slope = hn::IfThenElse(lower, slope, low.slope);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto x = hn::Add(hn::LoadU(d, wave.centre[axis] + at), edge[axis]);
        low.point[axis] = hn::IfThenElse(lower, x, low.point[axis]);
      }
      for (size_t c = 0; c < 2; ++c) {
        low.uv[c] = hn::IfThenElse(lower, hn::LoadU(d, wave.at[2 * k + c] + at), low.uv[c]);
      }
    }
    return low;
  }

  /// Queries `first` and on as cells about their corner furthest against the gradients at their points.
  void aim(size_t first, size_t count, const float* const* gradient, WaveColumns& wave) const {
    const F32 d;
    const auto zero = hn::Zero(d);
    const auto one = hn::Set(d, 1.0F);
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
      const Frame frame = frame_at(first + i);
      auto to_b = zero;
      auto to_c = zero;
      for (size_t axis = 0; axis < D; ++axis) {
        const auto g = hn::LoadU(d, gradient[axis] + first + i);
        to_b = hn::MulAdd(g, frame.ab[axis], to_b);
        to_c = hn::MulAdd(g, frame.ac[axis], to_c);
      }
      const auto b_is_least = hn::And(hn::Lt(to_b, zero), hn::Le(to_b, to_c));
      const auto c_is_least = hn::AndNot(b_is_least, hn::Lt(to_c, zero));
      const Corner corners[3] = {frame.corner(zero, zero), frame.corner(one, zero), frame.corner(zero, one)};
      const Corner from = pick(c_is_least, corners[2], pick(b_is_least, corners[1], corners[0]));
      hn::StoreU(from.u, d, wave.at[0] + i);
      hn::StoreU(from.v, d, wave.at[1] + i);
      for (size_t axis = 0; axis < D; ++axis) hn::StoreU(from.x[axis], d, wave.centre[axis] + i);
      write_extent(wave, i, corners, from.x);
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

  HWY_INLINE Frame frame_at(size_t first) const {
    Frame frame;
    for (size_t axis = 0; axis < D; ++axis) {
      frame.a[axis] = hn::LoadU(F32(), corners_[axis] + first);
      frame.ab[axis] = hn::LoadU(F32(), corners_[D + axis] + first);
      frame.ac[axis] = hn::LoadU(F32(), corners_[2 * D + axis] + first);
    }
    return frame;
  }
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

  static HWY_INLINE void write(WaveColumns& wave, size_t at, const Corner& p, const Corner& q, const Corner& r) {
    const F32 d;
    const auto third = hn::Set(d, 1.0F / 3.0F);
    V32 centre[D];
    for (size_t axis = 0; axis < D; ++axis) {
      centre[axis] =
          hn::MulAdd(hn::Add(hn::Sub(q.x[axis], p.x[axis]), hn::Sub(r.x[axis], p.x[axis])), third, p.x[axis]);
      hn::StoreU(centre[axis], d, wave.centre[axis] + at);
    }
    const Corner corners[3] = {p, q, r};
    write_extent(wave, at, corners, centre);
    for (size_t k = 0; k < 3; ++k) {
      hn::StoreU(corners[k].u, d, wave.at[2 * k] + at);
      hn::StoreU(corners[k].v, d, wave.at[2 * k + 1] + at);
    }
  }

  /// The corners from a point of the cell, and the greatest distance to one.
  static HWY_INLINE void write_extent(WaveColumns& wave, size_t at, const Corner (&corners)[3], const V32 (&from)[D]) {
    const F32 d;
    auto most = hn::Zero(d);
    for (size_t k = 0; k < 3; ++k) {
      auto square = hn::Zero(d);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto edge = hn::Sub(corners[k].x[axis], from[axis]);
        square = hn::MulAdd(edge, edge, square);
        hn::StoreU(edge, d, wave.edges[k * D + axis] + at);
      }
      most = hn::Max(most, square);
    }
    hn::StoreU(hn::Mul(hn::Sqrt(most), hn::Set(d, 1.000001F)), d, wave.reach + at);
  }

  float* corners_[3 * D] = {};
  float* reach_ = nullptr;
  float* largest_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
