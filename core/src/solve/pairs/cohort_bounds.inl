// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The joint bound of bounds.inl for spans of cells. The linear bounds of a cell that it
// leaves open hold on its children too, and close many of those before anything is evaluated. Included once per SIMD
// target.
#if defined(THALWEG_SOLVE_PAIRS_COHORT_BOUNDS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_COHORT_BOUNDS_INL
#undef THALWEG_SOLVE_PAIRS_COHORT_BOUNDS_INL
#else
#define THALWEG_SOLVE_PAIRS_COHORT_BOUNDS_INL
#endif

#include "solve/pairs/cohort_row.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// What a child of a cell is bounded by, in columns: of each field alone and of both mixed, the bound over the child in
/// the middle, and what a step of the child's half extent along an axis adds to it.
template <int D>
struct ChildBounds {
  struct Part {
    float* middle = nullptr;
    float* step[D] = {};
  };
  Part part[3];
  float* lower = nullptr;    ///< of the cell itself
  uint32_t* open = nullptr;  ///< which cells are open
  size_t count = 0;

  void take(Arena& arena, size_t room) {
    for (Part& of : part) {
      of.middle = arena.take<float>(room);
      for (float*& column : of.step) column = arena.take<float>(room);
    }
    lower = arena.take<float>(room);
    open = arena.take<uint32_t>(room);
  }
};

/// A row's table in the lanes of entry i on.
template <int D>
HWY_INLINE V32 of_region(const CohortRow<D>& row, const float* table, const PairCells& cells, size_t i) {
  return row.is_uniform ? hn::Set(F32(), table[0]) : of_component(table, cells.component + i);
}

template <int D>
HWY_INLINE V32 far_distance(const CohortRow<D>& row, const float* far_table, const PairCells& cells, size_t i) {
  const F32 d;
  const auto most = hn::Set(d, kFarReaches * row.reach);
  return hn::Min(of_region<D>(row, far_table, cells, i), hn::Mul(most, hn::LoadU(d, cells.size + i)));
}

/// One field's columns in a pass: points and gradients in its own frame; far points and unit gradients to be. What is
/// read is not written, as a vector reaches into the next span.
template <int D>
struct AimedField {
  const float* far_table;
  const float *at[D], *gradient[D];
  float *far[D], *unit[D];

  AimedField(const float* table, float* const* points, float* const* gradients, float* const* far_points,
             float* const* units)
      : far_table(table) {
    std::copy_n(points, D, at);
    std::copy_n(gradients, D, gradient);
    std::copy_n(far_points, D, far);
    std::copy_n(units, D, unit);
  }

  /// aim() of bounds.inl for the cells from entry i on.
  HWY_INLINE void aim(const CohortRow<D>& row, const PairCells& cells, size_t i) const {
    const F32 d;
    V32 g[D];
    for (int axis = 0; axis < D; ++axis) g[axis] = hn::LoadU(d, gradient[axis] + i);
    const auto square = square_of<D>(g);
    const auto usable = hn::Gt(square, hn::Set(d, 0.1F));
    const auto inverse = hn::IfThenElseZero(usable, hn::Div(hn::Set(d, 1.0F), hn::Sqrt(square)));
    const auto distance = far_distance<D>(row, far_table, cells, i);
    for (int axis = 0; axis < D; ++axis) {
      const auto u = hn::Mul(g[axis], inverse);
      hn::StoreU(u, d, unit[axis] + i);
      hn::StoreU(hn::MulAdd(distance, u, hn::LoadU(d, at[axis] + i)), d, far[axis] + i);
    }
  }
};

/// One field's linear bound at entry i; `gradient` holds what aim() left there, or of a convex field the gradient.
template <int D>
HWY_INLINE LinearBound<D> linear_bound(const CohortRow<D>& row, bool convex, float lipschitz, const float* far_table,
                                       const PairCells& cells, size_t i, float* const* gradient, const float* value,
                                       const float* far_value) {
  const F32 d;
  V32 g[D];
  for (int axis = 0; axis < D; ++axis) g[axis] = hn::LoadU(d, gradient[axis] + i);
  if (convex) {
    LinearBound<D> bound{hn::LoadU(d, value + i), {}};
    std::copy_n(g, D, bound.slope);
    return bound;
  }
  const auto reach = hn::Mul(hn::LoadU(d, cells.size + i), hn::Set(d, row.reach));
  return cone_bound<D>(hn::LoadU(d, far_value + i), g, far_distance<D>(row, far_table, cells, i), hn::Set(d, lipschitz),
                       reach);
}

/// What a pass over one row's cells reads and writes.
template <int D>
struct BoundPass {
  const PairFields<D>* fields;
  const PairPoints* points;
  const PairPoints* far;
};

/// The parts of a cell's bound; returns the greatest over the cell. `fall` is what a linear bound loses from the middle
/// of a child to its corner; a cell is twice as large.
template <int D>
HWY_INLINE V32 store_parts(const LinearBound<D>& a, const LinearBound<D>& b, const V32* quarter, V32 slack, size_t i,
                           ChildBounds<D>& bounds) {
  const F32 d;
  const auto weight = shortest_weight<D>(a, b);
  const auto other = hn::Sub(hn::Set(d, 1.0F), weight);
  V32 base[3] = {a.base, b.base, hn::MulAdd(weight, a.base, hn::Mul(other, b.base))};
  V32 fall[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (int axis = 0; axis < D; ++axis) {
    const auto of_a = hn::Mul(a.slope[axis], quarter[axis]), of_b = hn::Mul(b.slope[axis], quarter[axis]);
    const V32 step[3] = {of_a, of_b, hn::MulAdd(weight, of_a, hn::Mul(other, of_b))};
    for (int k = 0; k < 3; ++k) {
      fall[k] = hn::Add(fall[k], hn::Abs(step[k]));
      hn::StoreU(step[k], d, bounds.part[k].step[axis] + i);
    }
  }
  auto least = hn::Set(d, kHopeless);
  for (int k = 0; k < 3; ++k) {
    const auto middle = hn::Sub(hn::Sub(base[k], fall[k]), slack);
    hn::StoreU(middle, d, bounds.part[k].middle + i);
    least = hn::Max(least, hn::Sub(middle, fall[k]));
  }
  return least;
}

/// Bounds the cells of a span, and lists those that stay open.
template <int D>
void bound_span(const BoundPass<D>& pass, CohortRow<D>& row, PairCells cells, Span span, ChildBounds<D>& out) {
  const F32 d;
  const hn::RebindToUnsigned<F32> du;
  // Copies: stores of vectors may write anything but these.
  const PairPoints at = *pass.points, far = *pass.far;
  ChildBounds<D> bounds = out;
  const bool convex_a = pass.fields->a.facts().convex, convex_b = pass.fields->b.facts().convex;
  float* const* units_a = convex_a ? at.gradient_a : far.gradient_a;
  float* const* units_b = convex_b ? at.gradient_b : far.gradient_b;
  const auto slack = hn::Set(d, row.frame.slack);
  auto closed_lower = hn::Set(d, row.closed_lower);
  for (size_t i = span.begin; i < span.end; i += hn::Lanes(d)) {
    const auto a =
        linear_bound<D>(row, convex_a, row.frame.lipschitz_a, row.far_a, cells, i, units_a, at.value_a, far.value_a);
    auto b =
        linear_bound<D>(row, convex_b, row.frame.lipschitz_b, row.far_b, cells, i, units_b, at.value_b, far.value_b);
    V32 turned[D], quarter[D];
    row.frame.turn_to_a(b.slope, turned);
    std::copy_n(turned, D, b.slope);
    const auto size = hn::LoadU(d, cells.size + i);
    for (int axis = 0; axis < D; ++axis) quarter[axis] = hn::Mul(size, hn::Set(d, 0.5F * row.half[axis]));
    const auto reach = hn::Mul(size, hn::Set(d, row.reach));
    const auto cone_a = hn::NegMulAdd(hn::Set(d, row.frame.lipschitz_a), reach, hn::LoadU(d, at.value_a + i));
    const auto cone_b = hn::NegMulAdd(hn::Set(d, row.frame.lipschitz_b), reach, hn::LoadU(d, at.value_b + i));
    auto lower = store_parts<D>(a, b, quarter, hn::Add(slack, slack), i, bounds);
    lower = hn::Max(lower, hn::Sub(hn::Max(cone_a, cone_b), slack));
    lower = hn::Max(lower, hn::LoadU(d, cells.lower + i));
    hn::StoreU(lower, d, bounds.lower + i);
    const auto here = hn::FirstN(d, HWY_MIN(span.end - i, hn::Lanes(d)));
    const auto closed = hn::Gt(lower, of_region<D>(row, row.limit, cells, i));
    closed_lower = hn::Min(closed_lower, hn::IfThenElse(hn::And(here, closed), lower, hn::Set(d, kNoBound)));
    const auto stays = hn::RebindMask(du, hn::AndNot(closed, here));
    bounds.count += pack(hn::Iota(du, static_cast<uint32_t>(i)), stays, bounds.open + bounds.count);
  }
  out.count = bounds.count;
  row.closed_lower = hn::GetLane(hn::MinOfLanes(d, closed_lower));
}

/// Halves the cells bounds.open[begin, end) of a row along every axis; children that the parts leave open are appended.
template <int D>
void split_open(CohortRow<D>& row, PairCells cells, ChildBounds<D> bounds, Span span, PairCells& out) {
  constexpr size_t kChildren = size_t{1} << D;
  const hn::CappedTag<float, kChildren> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  // The side of each child along each axis.
  alignas(64) static constexpr float kSides[3][8] = {
      {-1, 1, -1, 1, -1, 1, -1, 1}, {-1, -1, 1, 1, -1, -1, 1, 1}, {-1, -1, -1, -1, 1, 1, 1, 1}};
  auto closed_lower = hn::Set(d, row.closed_lower);
  PairCells children = out;
  for (size_t k = span.begin; k < span.end; ++k) {
    const size_t i = bounds.open[k];
    const float half = 0.5F * cells.size[i];
    const uint32_t component = cells.component[i];
    const auto limit = hn::Set(d, row.limit[component]);
    for (size_t child = 0; child < kChildren; child += hn::Lanes(d)) {
      auto lower = hn::Set(d, bounds.lower[i]);
      for (const auto& part : bounds.part) {
        auto bound = hn::Set(d, part.middle[i]);
        for (int axis = 0; axis < D; ++axis) {
          bound = hn::MulAdd(hn::Set(d, part.step[axis][i]), hn::Load(d, kSides[axis] + child), bound);
        }
        lower = hn::Max(lower, bound);
      }
      const auto closed = hn::Gt(lower, limit);
      const auto stays = hn::Not(closed);
      closed_lower = hn::Min(closed_lower, hn::IfThenElse(closed, lower, hn::Set(d, kNoBound)));
      for (int axis = 0; axis < D; ++axis) {
        const auto at = hn::MulAdd(hn::Set(d, half), hn::Load(d, kSides[axis] + child), hn::Set(d, cells.at[axis][i]));
        pack(at, stays, children.at[axis] + children.count);
      }
      hn::StoreU(hn::Set(d, half), d, children.size + children.count);
      hn::StoreU(hn::Set(du, component), du, children.component + children.count);
      children.count += pack(lower, stays, children.lower + children.count);
    }
  }
  out.count = children.count;
  row.closed_lower = hn::GetLane(hn::MinOfLanes(d, closed_lower));
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
