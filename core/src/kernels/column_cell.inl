// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Cells in columns, as the modes of bounds see them. Included once per SIMD target.
#if defined(THALWEG_KERNELS_COLUMN_CELL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_KERNELS_COLUMN_CELL_INL
#undef THALWEG_KERNELS_COLUMN_CELL_INL
#else
#define THALWEG_KERNELS_COLUMN_CELL_INL
#endif

#include "kernels/interpreter.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// A cell of the chunk that starts at `offset`; its columns are read where they are needed.
template <class T, int D>
struct ColumnCell {
  const CellColumns* columns;
  size_t first;

  HWY_INLINE T reach() const { return Make<T>::load(columns->reach + first); }
  HWY_INLINE T column(size_t i) const { return Make<T>::load(columns->edges[i] + first); }
  HWY_INLINE Point<T, D> vertex(size_t from) const {
    if constexpr (D == 2) {
      return {column(from), column(from + 1)};
    } else {
      return {column(from), column(from + 1), column(from + 2)};
    }
  }
  HWY_INLINE T least_slope(Point<T, D> g) const {
    if (columns->is_box) {
      const Point<T, D> half = vertex(0);
      T sum = mul_add(abs(g.x), half.x, abs(g.y) * half.y);
      if constexpr (D == 3) sum = mul_add(abs(g.z), half.z, sum);
      return -sum;
    }
    return min(dot(g, vertex(0)), min(dot(g, vertex(D)), dot(g, vertex(2 * D))));
  }
  HWY_INLINE T most_distance(Point<T, D> offset) const {
    if (columns->is_box) {
      const Point<T, D> half = vertex(0);
      if constexpr (D == 2) {
        return length(Point<T, 2>{abs(offset.x) + half.x, abs(offset.y) + half.y});
      } else {
        return length(Point<T, 3>{abs(offset.x) + half.x, abs(offset.y) + half.y, abs(offset.z) + half.z});
      }
    }
    const auto square = [&](size_t from) HWY_ATTR {
      const Point<T, D> w = vertex(from) + offset;
      return dot(w, w);
    };
    return sqrt(max(square(0), max(square(D), square(2 * D))));
  }
  /// From where to where the cell reaches along an axis, from its centre.
  HWY_INLINE Interval<T> offset(int axis) const {
    const auto k = static_cast<size_t>(axis);
    if (columns->is_box) return {-column(k), column(k)};
    const T a = column(k), b = column(D + k), c = column(2 * D + k);
    return {min(a, min(b, c)), max(a, max(b, c))};
  }
  HWY_INLINE T place() const { return Make<T>::load(columns->place + first); }
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
