// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The cells of one shape-against-shape search in columns, and what is asked of all of them at once: where they lie in
// both frames, both fields at their centres, which are closed, and their children.
//
// Cells are boxes in A's frame given by exact dyadic numbers, so that children tile their parent: in units of the half
// extent H of a root cell, `at` is the centre from the middle of the region and `size` the half extent.
// Included once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_CELLS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_CELLS_INL
#undef THALWEG_SOLVE_PAIRS_CELLS_INL
#else
#define THALWEG_SOLVE_PAIRS_CELLS_INL
#endif

#include <algorithm>
#include <limits>

#include "kernels/lanes.inl"
#include "solve/pairs/problem.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

inline constexpr float kNoBound = std::numeric_limits<float>::infinity();

/// Cells side by side; columns are padded for the kernels.
struct PairCells {
  float* at[3] = {};
  float* size = nullptr;
  float* value = nullptr;         ///< g at the centre
  float* lower = nullptr;         ///< proven lower bound of g over the cell
  uint32_t* component = nullptr;  ///< the region that the cell belongs to
  size_t count = 0;

  template <int D>
  void take(Arena& arena, size_t room) {
    for (int axis = 0; axis < D; ++axis) at[axis] = arena.take<float>(room);
    for (float** column : {&size, &value, &lower}) *column = arena.take<float>(room);
    component = arena.take<uint32_t>(room);
  }
};

/// What one pair of fields, pose and region mean for float32 lanes.
template <int D>
struct PairFrame {
  float origin[D];  ///< middle of the region
  float extent;     ///< H
  float rotation[D][D];
  float translation[D];
  float lipschitz_a, lipschitz_b;
  float slack;  ///< of a bound or a value of either field

  /// The reach of a cell of this size, in scene units.
  static constexpr float kDiagonal = D == 2 ? 1.4142140F : 1.7320512F;

  HWY_INLINE void to_b(const V32* p, V32* q) const {
    const F32 d;
    V32 from[D];
    for (int axis = 0; axis < D; ++axis) from[axis] = hn::Sub(p[axis], hn::Set(d, translation[axis]));
    for (int column = 0; column < D; ++column) {
      auto sum = hn::Mul(from[0], hn::Set(d, rotation[0][column]));
      for (int row = 1; row < D; ++row) sum = hn::MulAdd(from[row], hn::Set(d, rotation[row][column]), sum);
      q[column] = sum;
    }
  }
  HWY_INLINE void turn_to_a(const V32* u, V32* v) const {
    const F32 d;
    for (int row = 0; row < D; ++row) {
      auto sum = hn::Mul(u[0], hn::Set(d, rotation[row][0]));
      for (int column = 1; column < D; ++column) sum = hn::MulAdd(u[column], hn::Set(d, rotation[row][column]), sum);
      v[row] = sum;
    }
  }
};

/// Points in both frames, and the fields there.
struct PairPoints {
  float* a[3] = {};
  float* b[3] = {};
  float* value_a = nullptr;
  float* value_b = nullptr;
  float* gradient_a[3] = {};  ///< in A's frame
  float* gradient_b[3] = {};  ///< in B's frame

  template <int D>
  void take(Arena& arena, size_t room) {
    for (int axis = 0; axis < D; ++axis) {
      for (float** column : {&a[axis], &b[axis], &gradient_a[axis], &gradient_b[axis]}) {
        *column = arena.take<float>(room);
      }
    }
    for (float** column : {&value_a, &value_b}) *column = arena.take<float>(room);
  }
};

/// Both frames' coordinates of the centres.
template <int D>
void place_cells(const PairFrame<D>& frame, const PairCells& cells, PairPoints& points) {
  const F32 d;
  const auto extent = hn::Set(d, frame.extent);
  for (size_t i = 0; i < cells.count; i += hn::Lanes(d)) {
    V32 p[D], q[D];
    for (int axis = 0; axis < D; ++axis) {
      p[axis] = hn::MulAdd(hn::LoadU(d, cells.at[axis] + i), extent, hn::Set(d, frame.origin[axis]));
    }
    frame.to_b(p, q);
    for (int axis = 0; axis < D; ++axis) {
      hn::StoreU(p[axis], d, points.a[axis] + i);
      hn::StoreU(q[axis], d, points.b[axis] + i);
    }
  }
}

/// B's coordinates of points given in A's.
template <int D>
void place_points(const PairFrame<D>& frame, PairPoints& points, size_t count) {
  const F32 d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    V32 p[D], q[D];
    for (int axis = 0; axis < D; ++axis) p[axis] = hn::LoadU(d, points.a[axis] + i);
    frame.to_b(p, q);
    for (int axis = 0; axis < D; ++axis) hn::StoreU(q[axis], d, points.b[axis] + i);
  }
}

/// Value and Lipschitz bound of g from both fields at the centres.
template <int D>
void bound_cells(const PairFrame<D>& frame, const PairPoints& points, PairCells& cells) {
  const F32 d;
  const auto diagonal = hn::Set(d, frame.extent * PairFrame<D>::kDiagonal);
  const auto slack = hn::Set(d, frame.slack);
  for (size_t i = 0; i < cells.count; i += hn::Lanes(d)) {
    const auto reach = hn::Mul(hn::LoadU(d, cells.size + i), diagonal);
    const auto fa = hn::LoadU(d, points.value_a + i);
    const auto fb = hn::LoadU(d, points.value_b + i);
    const auto lo_a = hn::NegMulAdd(hn::Set(d, frame.lipschitz_a), reach, fa);
    const auto lo_b = hn::NegMulAdd(hn::Set(d, frame.lipschitz_b), reach, fb);
    hn::StoreU(hn::Max(fa, fb), d, cells.value + i);
    hn::StoreU(hn::Sub(hn::Max(lo_a, lo_b), slack), d, cells.lower + i);
  }
}

/// Entries of a table picked by the cells' regions.
HWY_INLINE V32 of_component(const float* table, const uint32_t* component) {
  const hn::RebindToSigned<F32> di;
  return hn::GatherIndex(F32(), table, hn::LoadU(di, reinterpret_cast<const int32_t*>(component)));
}

/// Lanes beyond the last cell gather too: from region 0.
HWY_INLINE void pad_components(const PairCells& cells) {
  const hn::RebindToUnsigned<F32> du;
  hn::StoreU(hn::Zero(du), du, cells.component + cells.count);
}

/// Appends the lanes of `keep` from entry i of one list to the end of another.
template <int D>
HWY_INLINE void append(const PairCells& from, size_t i, M32 keep, PairCells& to) {
  const F32 d;
  const hn::RebindToUnsigned<F32> du;
  for (int axis = 0; axis < D; ++axis) {
    hn::CompressStore(hn::LoadU(d, from.at[axis] + i), keep, d, to.at[axis] + to.count);
  }
  hn::CompressStore(hn::LoadU(d, from.size + i), keep, d, to.size + to.count);
  hn::CompressStore(hn::LoadU(d, from.value + i), keep, d, to.value + to.count);
  hn::CompressStore(hn::LoadU(d, from.lower + i), keep, d, to.lower + to.count);
  const auto component = hn::LoadU(du, from.component + i);
  to.count += hn::CompressStore(component, hn::RebindMask(du, keep), du, to.component + to.count);
}

/// Where sift() puts cells: what is above its region's limit is closed, what lies below `ceiling` as a whole is settled
/// without being cut further, the others stay open.
struct PairSieve {
  const float* limits = nullptr;  ///< per region
  float ceiling = -kNoBound;
  float closed_lower = kNoBound;  ///< out: least bound of a closed cell
};

template <int D>
void sift(const PairFrame<D>& frame, const PairCells& cells, PairSieve& sieve, PairCells& open, PairCells* settled) {
  const F32 d;
  const auto stretch = hn::Set(d, HWY_MAX(frame.lipschitz_a, frame.lipschitz_b));
  const auto diagonal = hn::Set(d, frame.extent * PairFrame<D>::kDiagonal);
  const auto slack = hn::Set(d, frame.slack);
  const auto infinite = hn::Set(d, kNoBound);
  auto closed_lower = hn::Set(d, sieve.closed_lower);
  pad_components(cells);
  for (size_t i = 0; i < cells.count; i += hn::Lanes(d)) {
    const auto here = hn::FirstN(d, HWY_MIN(cells.count - i, hn::Lanes(d)));
    const auto lower = hn::LoadU(d, cells.lower + i);
    const auto closed = hn::Gt(lower, of_component(sieve.limits, cells.component + i));
    closed_lower = hn::Min(closed_lower, hn::IfThenElse(hn::And(here, closed), lower, infinite));
    auto stays = hn::AndNot(closed, here);
    if (hn::AllFalse(d, stays)) continue;
    if (settled != nullptr) {
      const auto reach = hn::Mul(hn::LoadU(d, cells.size + i), diagonal);
      const auto upper = hn::Add(hn::MulAdd(stretch, reach, hn::LoadU(d, cells.value + i)), slack);
      const auto is_settled = hn::And(stays, hn::Le(upper, hn::Set(d, sieve.ceiling)));
      append<D>(cells, i, is_settled, *settled);
      stays = hn::AndNot(is_settled, stays);
    }
    append<D>(cells, i, stays, open);
  }
  sieve.closed_lower = hn::GetLane(hn::MinOfLanes(d, closed_lower));
}

/// Halves every cell along every axis. Regions are kept.
template <int D>
void split_cells(const PairCells& parents, PairCells& children) {
  constexpr size_t kChildren = size_t{1} << D;
  const F32 d;
  const hn::RebindToUnsigned<F32> du;
  const auto half = hn::Set(d, 0.5F);
  children.count = kChildren * parents.count;
  for (size_t child = 0; child < kChildren; ++child) {
    const size_t first = child * parents.count;
    for (size_t i = 0; i < parents.count; i += hn::Lanes(d)) {
      const auto size = hn::Mul(hn::LoadU(d, parents.size + i), half);
      for (int axis = 0; axis < D; ++axis) {
        const auto step = (child >> axis & 1) != 0 ? size : hn::Neg(size);
        hn::StoreU(hn::Add(hn::LoadU(d, parents.at[axis] + i), step), d, children.at[axis] + first + i);
      }
      hn::StoreU(size, d, children.size + first + i);
      hn::StoreU(hn::LoadU(du, parents.component + i), du, children.component + first + i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
