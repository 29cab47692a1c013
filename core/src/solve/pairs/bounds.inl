// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The bound that makes deepest points affordable. At the bottom of an overlap the two fields have equal values and
// opposite gradients: each alone falls linearly across a cell, the greater of them does not. For any weight w
//
//   g >= w f_a + (1 - w) f_b
//
// and with a linear bound of each field the slopes cancel, so that what is lost is of second order in the cell.
//
// A linear bound of a field about c comes from one more value, at a far point p = c + s u (u the unit gradient): f is
// L-Lipschitz, so f(x) >= f(p) - L |x - p|, and with y = x - c
//
//   |x - p| <= s - u . y + |y|^2 / (2 s).
//
// Where the field is straight from c to p this loses L |y|^2 / (2 s) and no more; it is sound for any u and s. Where f
// is a convex function its tangent plane is a bound, and no far point is needed. Included once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_BOUNDS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_BOUNDS_INL
#undef THALWEG_SOLVE_PAIRS_BOUNDS_INL
#else
#define THALWEG_SOLVE_PAIRS_BOUNDS_INL
#endif

#include "solve/pairs/cells.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Stands for a field that has no linear bound: low enough to lose, and finite so that no product with 0 is NaN.
inline constexpr float kHopeless = -1e30F;

/// One field's linear bound in a lane: f >= base + slope . y over the cell.
template <int D>
struct LinearBound {
  V32 base;
  V32 slope[D];
};

/// How far the far points of a field are, per region; null where the field is convex.
struct FarDistances {
  const float* a = nullptr;
  const float* b = nullptr;
};

template <int D>
HWY_INLINE V32 square_of(const V32* v) {
  auto sum = hn::Mul(v[0], v[0]);
  for (int axis = 1; axis < D; ++axis) sum = hn::MulAdd(v[axis], v[axis], sum);
  return sum;
}

/// Replaces gradients by unit vectors, in place, and `far` by c + s u. Where the gradient says too little it becomes 0.
/// A far point is no further than this many reaches of its cell: the further, the likelier is a bend on the way.
inline constexpr float kFarReaches = 32;

template <int D>
HWY_INLINE V32 far_distance(const PairFrame<D>& frame, const float* far_table, const PairCells& cells, size_t i) {
  const F32 d;
  const auto most = hn::Set(d, kFarReaches * frame.extent * PairFrame<D>::kDiagonal);
  return hn::Min(of_component(far_table, cells.component + i), hn::Mul(most, hn::LoadU(d, cells.size + i)));
}

template <int D>
void aim(const PairFrame<D>& frame, float* const* centre, float* const* gradient, const float* far_table,
         const PairCells& cells, float* const* far) {
  const F32 d;
  for (size_t i = 0; i < cells.count; i += hn::Lanes(d)) {
    V32 g[D];
    for (int axis = 0; axis < D; ++axis) g[axis] = hn::LoadU(d, gradient[axis] + i);
    const auto square = square_of<D>(g);
    const auto usable = hn::Gt(square, hn::Set(d, 0.1F));
    const auto inverse = hn::IfThenElseZero(usable, hn::Div(hn::Set(d, 1.0F), hn::Sqrt(square)));
    const auto distance = far_distance(frame, far_table, cells, i);
    for (int axis = 0; axis < D; ++axis) {
      const auto u = hn::Mul(g[axis], inverse);
      hn::StoreU(u, d, gradient[axis] + i);
      hn::StoreU(hn::MulAdd(distance, u, hn::LoadU(d, centre[axis] + i)), d, far[axis] + i);
    }
  }
}

/// The bound from a far point; `direction` is the unit vector or 0.
template <int D>
HWY_INLINE LinearBound<D> cone_bound(V32 far_value, const V32* direction, V32 distance, V32 lipschitz, V32 reach) {
  const F32 d;
  const auto bend = hn::Div(hn::Mul(hn::Mul(reach, reach), hn::Set(d, 0.5F)), distance);
  const auto base = hn::NegMulAdd(lipschitz, hn::Add(distance, bend), far_value);
  const auto usable = hn::Gt(square_of<D>(direction), hn::Set(d, 0.5F));
  LinearBound<D> bound{hn::IfThenElse(usable, base, hn::Set(d, kHopeless)), {}};
  for (int axis = 0; axis < D; ++axis) bound.slope[axis] = hn::Mul(lipschitz, direction[axis]);
  return bound;
}

/// The least of w a + (1 - w) b over a box of half extents h.
template <int D>
HWY_INLINE V32 mixed(const LinearBound<D>& a, const LinearBound<D>& b, V32 weight, const V32* h) {
  const F32 d;
  const auto other = hn::Sub(hn::Set(d, 1.0F), weight);
  auto fall = hn::Zero(d);
  for (int axis = 0; axis < D; ++axis) {
    const auto slope = hn::Abs(hn::MulAdd(weight, a.slope[axis], hn::Mul(other, b.slope[axis])));
    fall = hn::MulAdd(h[axis], slope, fall);
  }
  return hn::Sub(hn::MulAdd(weight, a.base, hn::Mul(other, b.base)), fall);
}

/// The weight that leaves the shortest slope.
template <int D>
HWY_INLINE V32 shortest_weight(const LinearBound<D>& a, const LinearBound<D>& b) {
  const F32 d;
  V32 difference[D];
  auto along = hn::Zero(d);
  for (int axis = 0; axis < D; ++axis) {
    difference[axis] = hn::Sub(b.slope[axis], a.slope[axis]);
    along = hn::MulAdd(difference[axis], b.slope[axis], along);
  }
  const auto square = hn::Max(square_of<D>(difference), hn::Set(d, 1e-12F));
  return hn::Min(hn::Set(d, 1.0F), hn::Max(hn::Zero(d), hn::Div(along, square)));
}

/// The best of three weights: each field alone, and the one that leaves the shortest slope.
template <int D>
HWY_INLINE V32 joint_bound(const LinearBound<D>& a, const LinearBound<D>& b, const V32* h) {
  const F32 d;
  const auto one = hn::Set(d, 1.0F);
  const auto weight = shortest_weight<D>(a, b);
  const auto alone = hn::Max(mixed<D>(a, b, one, h), mixed<D>(a, b, hn::Zero(d), h));
  return hn::Max(alone, mixed<D>(a, b, weight, h));
}

/// Raises the cells' bounds. `points` holds unit gradients (of convex fields: gradients) and values at the centres,
/// `far_values` those at the far points.
template <int D>
void join_bounds(const PairFrame<D>& frame, const PairPoints& points, const FarDistances& far,
                 const PairPoints& far_points, PairCells& cells) {
  const F32 d;
  const auto slack = hn::Set(d, 2 * frame.slack);
  for (size_t i = 0; i < cells.count; i += hn::Lanes(d)) {
    const auto h = hn::Mul(hn::LoadU(d, cells.size + i), hn::Set(d, frame.extent));
    const auto reach = hn::Mul(h, hn::Set(d, PairFrame<D>::kDiagonal));
    V32 of_a[D], of_b[D], turned[D];
    for (int axis = 0; axis < D; ++axis) {
      of_a[axis] = hn::LoadU(d, points.gradient_a[axis] + i);
      of_b[axis] = hn::LoadU(d, points.gradient_b[axis] + i);
    }
    frame.turn_to_a(of_b, turned);
    LinearBound<D> a{hn::LoadU(d, points.value_a + i), {}};
    LinearBound<D> b{hn::LoadU(d, points.value_b + i), {}};
    std::copy_n(of_a, D, a.slope);
    std::copy_n(turned, D, b.slope);
    if (far.a != nullptr) {
      const auto distance = far_distance(frame, far.a, cells, i);
      a = cone_bound<D>(hn::LoadU(d, far_points.value_a + i), of_a, distance, hn::Set(d, frame.lipschitz_a), reach);
    }
    if (far.b != nullptr) {
      const auto distance = far_distance(frame, far.b, cells, i);
      b = cone_bound<D>(hn::LoadU(d, far_points.value_b + i), turned, distance, hn::Set(d, frame.lipschitz_b), reach);
    }
    V32 half[D];
    std::fill_n(half, D, h);
    const auto lower = hn::Sub(joint_bound<D>(a, b, half), slack);
    hn::StoreU(hn::Max(lower, hn::LoadU(d, cells.lower + i)), d, cells.lower + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
