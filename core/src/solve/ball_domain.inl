// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Discs and balls as regions of a certified search. Included once per SIMD target.
#if defined(THALWEG_SOLVE_BALL_DOMAIN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_BALL_DOMAIN_INL
#undef THALWEG_SOLVE_BALL_DOMAIN_INL
#else
#define THALWEG_SOLVE_BALL_DOMAIN_INL
#endif

#include "solve/domains.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Discs and balls, cut into boxes. A box is evaluated at its centre moved into the ball, which brings no point of
/// box and ball further away.
template <int D>
class BallDomain {
 public:
  static constexpr size_t kChildren = size_t{1} << D;
  static constexpr int kAxes = D;
  static constexpr size_t kWidth = D + 1;        ///< numbers of a row
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

  void split(const CellList& open, WaveColumns& wave) const {
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

  /// Where f may be lower than at the centres of one vector of cells: a cell's length further down the gradient, within
  /// the ball.
  [[nodiscard]] HWY_INLINE Lowest<D> lowest(const WaveColumns& wave, size_t at, const uint32_t* query) const {
    const F32 d;
    Lowest<D> low{hn::Zero(d), {}, {hn::Zero(d), hn::Zero(d)}};
    const auto radius = gather(rows_[D], query);
    const auto length = hn::Mul(hn::Mul(hn::Set(d, 2.0F), radius), hn::LoadU(d, wave.at[D] + at));
    V32 offset[D];
    auto square = hn::Zero(d);
    for (size_t axis = 0; axis < D; ++axis) {
      const auto g = hn::LoadU(d, wave.gradient[axis] + at);
      low.slope = hn::NegMulAdd(hn::Abs(g), hn::LoadU(d, wave.edges[axis] + at), low.slope);
      offset[axis] = hn::Sub(hn::LoadU(d, wave.centre[axis] + at), gather(rows_[axis], query));
      offset[axis] = hn::NegMulAdd(length, g, offset[axis]);
      square = hn::MulAdd(offset[axis], offset[axis], square);
    }
    const auto distance = hn::Sqrt(square);
    const auto outside = hn::Gt(distance, radius);
    const auto one = hn::Set(d, 1.0F);
    const auto onto = hn::Div(hn::Mul(hn::Set(d, 0.9999999F), radius), hn::IfThenElse(outside, distance, one));
    const auto inward = hn::IfThenElse(outside, onto, one);
    for (size_t axis = 0; axis < D; ++axis) {
      low.point[axis] = hn::MulAdd(inward, offset[axis], gather(rows_[axis], query));
    }
    return low;
  }

  /// The points of queries `first` and on that are furthest against the gradients at their centres.
  void aim(size_t first, size_t count, const float* const* gradient, WaveColumns& wave) const {
    const F32 d;
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
      auto square = hn::Zero(d);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto g = hn::LoadU(d, gradient[axis] + first + i);
        square = hn::MulAdd(g, g, square);
      }
      const auto rises = hn::Gt(square, hn::Set(d, 1e-12F));
      const auto radius = hn::Mul(hn::LoadU(d, rows_[D] + first + i), hn::Set(d, 0.9999999F));
      const auto length = hn::Sqrt(hn::IfThenElse(rises, square, hn::Set(d, 1.0F)));
      const auto step = hn::IfThenElseZero(rises, hn::Div(radius, length));
      for (size_t axis = 0; axis < D; ++axis) {
        const auto g = hn::LoadU(d, gradient[axis] + first + i);
        hn::StoreU(hn::NegMulAdd(step, g, hn::LoadU(d, rows_[axis] + first + i)), d, wave.centre[axis] + i);
      }
      for (size_t k = 0; k < 2; ++k) hn::StoreU(hn::Zero(d), d, wave.at[k] + i);
    }
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
