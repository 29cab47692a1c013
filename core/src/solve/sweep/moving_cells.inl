// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What a moving query is cut into: a piece of a triangle by the barycentric coordinates of its corners, a box about a
// ball by its centre and half size in radii. Both go with the query. Included once per SIMD target.
#if defined(THALWEG_SOLVE_SWEEP_MOVING_CELLS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_SWEEP_MOVING_CELLS_INL
#undef THALWEG_SOLVE_SWEEP_MOVING_CELLS_INL
#else
#define THALWEG_SOLVE_SWEEP_MOVING_CELLS_INL
#endif

#include "solve/sweep/motion.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Cells at their times, one a lane.
struct MovingWave {
  float* at[kMostCoordinates] = {};  ///< which piece of the query
  float* centre[3] = {};
  float* reach = nullptr;
  float* edges[9] = {};
  float* middle[3] = {};    ///< of balls: their centres from the cells'
  float* radius = nullptr;  ///< of balls
  float* gradient[3] = {};
  float* value = nullptr;
  float* speed[3] = {};   ///< of the centre
  float* speeds[9] = {};  ///< of corners, as edges
  float* probe[3] = {};   ///< a point of the cell where f may be lower
  float* probe_value = nullptr;
  float* probe_uv[2] = {};

  void take(Arena& arena, size_t room) {
    for (float*& column : at) column = arena.take<float>(room);
    for (float*& column : edges) column = arena.take<float>(room);
    for (float*& column : speeds) column = arena.take<float>(room);
    for (size_t axis = 0; axis < 3; ++axis) {
      for (float** column : {&centre[axis], &gradient[axis], &speed[axis], &probe[axis], &middle[axis]})
        *column = arena.take<float>(room);
    }
    for (float** column : {&reach, &radius, &value, &probe_value, &probe_uv[0], &probe_uv[1]}) {
      *column = arena.take<float>(room);
    }
  }
  [[nodiscard]] HWY_INLINE V32 along_gradient(size_t i, const V32* vector, int dimension) const {
    auto sum = hn::Zero(F32());
    for (int axis = 0; axis < dimension; ++axis) {
      sum = hn::MulAdd(hn::LoadU(F32(), gradient[axis] + i), vector[axis], sum);
    }
    return sum;
  }
};

template <int D>
struct MovingTriangle {
  static constexpr int kAxes = D;
  static constexpr size_t kParts = 3, kChildren = 2, kCoordinates = 6;
  static constexpr float kRoot[kCoordinates] = {0, 0, 1, 0, 0, 1};
  static constexpr bool kIsBall = false;
  using Frame = Placed<D, kParts>;

  /// The cells of one vector: centre and its speed, corners from there, and reach.
  static HWY_INLINE void place(const Motion<D, kParts>&, const uint32_t*, const Frame& frame, MovingWave& wave,
                               size_t i) {
    const F32 d;
    const auto third = hn::Set(d, 1.0F / 3.0F);
    V32 u[3], v[3], corner[3][D], centre[D], speed[D];
    for (size_t k = 0; k < 3; ++k) {
      u[k] = hn::LoadU(d, wave.at[2 * k] + i);
      v[k] = hn::LoadU(d, wave.at[2 * k + 1] + i);
      for (size_t axis = 0; axis < D; ++axis) {
        corner[k][axis] =
            hn::MulAdd(u[k], frame.part[1][axis], hn::MulAdd(v[k], frame.part[2][axis], frame.part[0][axis]));
      }
    }
    const auto middle_u = hn::Mul(hn::Add(hn::Add(u[0], u[1]), u[2]), third);
    const auto middle_v = hn::Mul(hn::Add(hn::Add(v[0], v[1]), v[2]), third);
    for (size_t axis = 0; axis < D; ++axis) {
      const auto across = hn::Add(hn::Sub(corner[1][axis], corner[0][axis]), hn::Sub(corner[2][axis], corner[0][axis]));
      centre[axis] = hn::MulAdd(across, third, corner[0][axis]);
      hn::StoreU(centre[axis], d, wave.centre[axis] + i);
      speed[axis] = hn::MulAdd(middle_u, frame.change[1][axis],
                               hn::MulAdd(middle_v, frame.change[2][axis], frame.change[0][axis]));
    }
    Motion<D, kParts>::add_turn(frame, centre, speed);
    for (size_t axis = 0; axis < D; ++axis) hn::StoreU(speed[axis], d, wave.speed[axis] + i);
    for (size_t k = 0; k < 3; ++k) {
      V32 own[D];
      for (size_t axis = 0; axis < D; ++axis) {
        own[axis] =
            hn::MulAdd(u[k], frame.change[1][axis], hn::MulAdd(v[k], frame.change[2][axis], frame.change[0][axis]));
      }
      Motion<D, kParts>::add_turn(frame, corner[k], own);
      for (size_t axis = 0; axis < D; ++axis) hn::StoreU(own[axis], d, wave.speeds[k * D + axis] + i);
    }
    auto most = hn::Zero(d);
    for (size_t k = 0; k < 3; ++k) {
      auto square = hn::Zero(d);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto edge = hn::Sub(corner[k][axis], centre[axis]);
        square = hn::MulAdd(edge, edge, square);
        hn::StoreU(edge, d, wave.edges[k * D + axis] + i);
      }
      most = hn::Max(most, square);
    }
    hn::StoreU(hn::Mul(hn::Sqrt(most), hn::Set(d, 1.000001F)), d, wave.reach + i);
  }

  /// The corner furthest against the gradient.
  static HWY_INLINE void probe(const Motion<D, kParts>&, const uint32_t*, MovingWave& wave, size_t i) {
    const F32 d;
    auto least = hn::Set(d, std::numeric_limits<float>::infinity());
    V32 point[D], uv[2];
    for (size_t k = 0; k < 3; ++k) {
      V32 edge[D];
      for (size_t axis = 0; axis < D; ++axis) edge[axis] = hn::LoadU(d, wave.edges[k * D + axis] + i);
      const auto slope = wave.along_gradient(i, edge, D);
      const auto lower = hn::Lt(slope, least);
      least = hn::IfThenElse(lower, slope, least);
      for (size_t axis = 0; axis < D; ++axis) {
        const auto x = hn::Add(hn::LoadU(d, wave.centre[axis] + i), edge[axis]);
        point[axis] = k == 0 ? x : hn::IfThenElse(lower, x, point[axis]);
      }
      for (size_t c = 0; c < 2; ++c) {
        const auto x = hn::LoadU(d, wave.at[2 * k + c] + i);
        uv[c] = k == 0 ? x : hn::IfThenElse(lower, x, uv[c]);
      }
    }
    for (size_t axis = 0; axis < D; ++axis) hn::StoreU(point[axis], d, wave.probe[axis] + i);
    for (size_t c = 0; c < 2; ++c) hn::StoreU(uv[c], d, wave.probe_uv[c] + i);
  }

  /// Whether a cell holds nothing; its numbers are `stride` apart.
  static bool is_empty(const float*, size_t) { return false; }

  static constexpr size_t kVertices = 3;
  /// A corner from the centre, and its speed.
  static HWY_INLINE void vertex(const MovingWave& wave, size_t i, size_t k, V32* offset, V32* speed) {
    const F32 d;
    for (size_t axis = 0; axis < D; ++axis) {
      offset[axis] = hn::LoadU(d, wave.edges[k * D + axis] + i);
      speed[axis] = hn::LoadU(d, wave.speeds[k * D + axis] + i);
    }
  }

  static HWY_INLINE void centre_coordinates(const MovingWave& wave, size_t i, V32* uv) {
    const F32 d;
    for (size_t c = 0; c < 2; ++c) {
      const auto sum = hn::Add(hn::Add(hn::LoadU(d, wave.at[c] + i), hn::LoadU(d, wave.at[2 + c] + i)),
                               hn::LoadU(d, wave.at[4 + c] + i));
      uv[c] = hn::Div(sum, hn::Set(d, 3.0F));
    }
  }

  /// Halves across the longest edge, the half down the gradient first.
  static HWY_INLINE void split(const MovingWave& wave, size_t i, V32 (&child)[kChildren][kCoordinates]) {
    const F32 d;
    V32 uv[3][2], edge[3][D];
    for (size_t k = 0; k < 3; ++k) {
      for (size_t c = 0; c < 2; ++c) uv[k][c] = hn::LoadU(d, wave.at[2 * k + c] + i);
      for (size_t axis = 0; axis < D; ++axis) edge[k][axis] = hn::LoadU(d, wave.edges[k * D + axis] + i);
    }
    const auto s01 = square_between(edge[0], edge[1]);
    const auto s12 = square_between(edge[1], edge[2]);
    const auto s20 = square_between(edge[2], edge[0]);
    const auto is_12 = hn::And(hn::Gt(s12, s01), hn::Ge(s12, s20));
    const auto is_20 = hn::And(hn::Gt(s20, s01), hn::Gt(s20, s12));
    const auto pick = [&](V32 on_20, V32 on_12, V32 otherwise)
                          HWY_ATTR { return hn::IfThenElse(is_20, on_20, hn::IfThenElse(is_12, on_12, otherwise)); };
    V32 along[D];
    for (size_t axis = 0; axis < D; ++axis) {
      along[axis] =
          hn::Sub(pick(edge[0][axis], edge[2][axis], edge[1][axis]), pick(edge[2][axis], edge[1][axis], edge[0][axis]));
    }
    // Against the gradient lies the end that the first child keeps.
    const auto keeps_second = hn::Lt(wave.along_gradient(i, along, D), hn::Zero(d));
    for (size_t c = 0; c < 2; ++c) {
      const auto p = pick(uv[2][c], uv[1][c], uv[0][c]);
      const auto q = pick(uv[0][c], uv[2][c], uv[1][c]);
      const auto r = pick(uv[1][c], uv[0][c], uv[2][c]);
      const auto m = hn::Mul(hn::Add(p, q), hn::Set(d, 0.5F));
      child[0][c] = hn::IfThenElse(keeps_second, q, p);
      child[1][c] = hn::IfThenElse(keeps_second, p, q);
      for (auto& one : child) one[2 + c] = m, one[4 + c] = r;
    }
  }

 private:
  static HWY_INLINE V32 square_between(const V32* p, const V32* q) {
    auto sum = hn::Zero(F32());
    for (size_t axis = 0; axis < D; ++axis) {
      const auto x = hn::Sub(p[axis], q[axis]);
      sum = hn::MulAdd(x, x, sum);
    }
    return sum;
  }
};

template <int D>
struct MovingBall {
  static constexpr int kAxes = D;
  static constexpr size_t kParts = 1, kChildren = size_t{1} << D, kCoordinates = D + 1;
  static constexpr float kRoot[4] = {0, 0, D == 2 ? 1 : 0, 1};
  static constexpr bool kIsBall = true;
  using Frame = Placed<D, kParts>;

  /// A box is evaluated at its centre moved into the ball. A ball looks the same however it is turned, so its boxes
  /// stay along the axes and move as its centre does.
  static HWY_INLINE void place(const Motion<D, kParts>& motion, const uint32_t* query, const Frame& frame,
                               MovingWave& wave, size_t i) {
    const F32 d;
    const auto one = hn::Set(d, 1.0F);
    const auto radius = gather(motion.radius(), query);
    const auto size = hn::LoadU(d, wave.at[D] + i);
    V32 offset[D], speed[D];
    auto square = hn::Zero(d);
    for (size_t axis = 0; axis < D; ++axis) {
      offset[axis] = hn::LoadU(d, wave.at[axis] + i);
      square = hn::MulAdd(offset[axis], offset[axis], square);
    }
    const auto distance = hn::Sqrt(square);
    const auto inward = hn::IfThenElse(hn::Gt(distance, one), hn::Div(hn::Set(d, 0.9999999F), distance), one);
    const auto half = hn::Mul(size, radius);
    for (size_t axis = 0; axis < D; ++axis) {
      const auto at = hn::Mul(offset[axis], radius);
      const auto moved = hn::Mul(at, inward);
      hn::StoreU(hn::Add(frame.part[0][axis], moved), d, wave.centre[axis] + i);
      hn::StoreU(hn::Neg(moved), d, wave.middle[axis] + i);
      hn::StoreU(hn::Add(half, hn::Abs(hn::Sub(at, moved))), d, wave.edges[axis] + i);
      speed[axis] = frame.change[0][axis];
    }
    hn::StoreU(radius, d, wave.radius + i);
    Motion<D, kParts>::add_turn(frame, frame.part[0], speed);
    for (size_t axis = 0; axis < D; ++axis) hn::StoreU(speed[axis], d, wave.speed[axis] + i);
    // A box that misses the ball holds no point of the query.
    const auto corner = hn::Mul(size, hn::Set(d, D == 2 ? 1.4142137F : 1.7320509F));
    const auto misses = hn::Gt(hn::Sub(distance, corner), hn::Set(d, 1.00001F));
    hn::StoreU(hn::IfThenElse(misses, hn::Set(d, kMisses), hn::Mul(corner, radius)), d, wave.reach + i);
  }

  /// A cell's length down the gradient, within the ball.
  static HWY_INLINE void probe(const Motion<D, kParts>& motion, const uint32_t* query, MovingWave& wave, size_t i) {
    const F32 d;
    const auto one = hn::Set(d, 1.0F);
    const auto size = hn::Mul(hn::Set(d, 2.0F), hn::LoadU(d, wave.at[D] + i));
    V32 offset[D];
    auto square = hn::Zero(d), inside = hn::Zero(d);
    for (size_t axis = 0; axis < D; ++axis) {
      const auto at = hn::LoadU(d, wave.at[axis] + i);
      inside = hn::MulAdd(at, at, inside);
    }
    // The centre was moved onto the ball.
    const auto onto = hn::IfThenElse(hn::Gt(inside, one), hn::Div(hn::Set(d, 0.9999999F), hn::Sqrt(inside)), one);
    for (size_t axis = 0; axis < D; ++axis) {
      const auto at = hn::Mul(hn::LoadU(d, wave.at[axis] + i), onto);
      offset[axis] = hn::NegMulAdd(size, hn::LoadU(d, wave.gradient[axis] + i), at);
      square = hn::MulAdd(offset[axis], offset[axis], square);
    }
    const auto inward = hn::IfThenElse(hn::Gt(square, one), hn::Div(hn::Set(d, 0.9999999F), hn::Sqrt(square)), one);
    const auto radius = gather(motion.radius(), query);
    for (size_t axis = 0; axis < D; ++axis) {
      const auto step = hn::NegMulAdd(hn::LoadU(d, wave.at[axis] + i), onto, hn::Mul(offset[axis], inward));
      hn::StoreU(hn::MulAdd(step, radius, hn::LoadU(d, wave.centre[axis] + i)), d, wave.probe[axis] + i);
    }
    for (float* column : wave.probe_uv) hn::StoreU(hn::Zero(d), d, column + i);
  }

  /// Whether a box misses the ball; its numbers are `stride` apart.
  static bool is_empty(const float* at, size_t stride) {
    float square = 0;
    for (size_t axis = 0; axis < D; ++axis) {
      const float nearest = std::max(std::fabs(at[axis * stride]) - at[D * stride], 0.0F);
      square += nearest * nearest;
    }
    return square > 1.0001F;
  }

  static constexpr size_t kVertices = kChildren;
  /// A corner from the centre; all go with the ball.
  static HWY_INLINE void vertex(const MovingWave& wave, size_t i, size_t k, V32* offset, V32* speed) {
    const F32 d;
    for (size_t axis = 0; axis < D; ++axis) {
      const auto half = hn::LoadU(d, wave.edges[axis] + i);
      offset[axis] = (k >> axis & 1) != 0 ? half : hn::Neg(half);
      speed[axis] = hn::LoadU(d, wave.speed[axis] + i);
    }
  }

  static HWY_INLINE void centre_coordinates(const MovingWave&, size_t, V32* uv) { uv[0] = uv[1] = hn::Zero(F32()); }

  /// The box down the gradient first, the one up it last.
  static HWY_INLINE void split(const MovingWave& wave, size_t i, V32 (&child)[kChildren][kCoordinates]) {
    const F32 d;
    const auto size = hn::Mul(hn::LoadU(d, wave.at[D] + i), hn::Set(d, 0.5F));
    for (size_t axis = 0; axis < D; ++axis) {
      const auto at = hn::LoadU(d, wave.at[axis] + i);
      const auto up = hn::CopySign(size, hn::LoadU(d, wave.gradient[axis] + i));
      for (size_t k = 0; k < kChildren; ++k) child[k][axis] = (k >> axis & 1) != 0 ? hn::Add(at, up) : hn::Sub(at, up);
    }
    for (auto& one : child) one[D] = size;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
