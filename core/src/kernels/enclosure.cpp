// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A lower bound of f over columns of cells, f at their centres and, if wanted, its gradient there.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/enclosure.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

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
};

template <int D, bool kWithGradient>
void enclosure_of(const Tape& tape, const float* const* centres, const CellColumns& cells, size_t count, float* lo,
                  float* value, float* scratch) {
  using T = Pack<kGradientWidth>;
  using Mode = EnclosureMode<T, D, ColumnCell<T, D>, kWithGradient>;
  const Machine<T> m = machine_for<Mode>(tape, scratch);
  const size_t lanes = lanes_of<T>();
  for (size_t i = 0; i < count; i += lanes) {
    for (int axis = 0; axis < D; ++axis)
      store(Make<T>::load(centres[axis] + i), m.positions + static_cast<size_t>(axis) * lanes);
    const auto f = run(Mode{{&cells, i}}, m);
    store(f.lo, lo + i);
    store(f.value, value + i);
    if constexpr (kWithGradient) {
      store(f.gradient.x, cells.gradient[0] + i);
      store(f.gradient.y, cells.gradient[1] + i);
      if constexpr (D == 3) store(f.gradient.z, cells.gradient[2] + i);
    }
  }
}

void enclosure_kernel(const Tape& tape, const float* const* centres, const CellColumns& cells, size_t count, float* lo,
                      float* value, float* scratch) {
  const bool flat = tape.dimension == 2;
  const auto run_all = cells.gradient[0] == nullptr ? (flat ? enclosure_of<2, false> : enclosure_of<3, false>)
                                                    : (flat ? enclosure_of<2, true> : enclosure_of<3, true>);
  run_all(tape, centres, cells, count, lo, value, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(enclosure_kernel);
EnclosureKernel enclosure_entry(std::int64_t target) { return THALWEG_ENTRY_OF(enclosure_kernel, target); }
}  // namespace thalweg
#endif
