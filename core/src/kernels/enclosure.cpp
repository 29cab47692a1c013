// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A lower bound of f over columns of cells, and f at their centres.
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
  size_t offset;

  HWY_INLINE T reach() const { return Make<T>::load(columns->reach + offset); }
  HWY_INLINE T column(size_t i) const { return Make<T>::load(columns->edges[i] + offset); }
  HWY_INLINE Point<T, D> vertex(size_t first) const {
    if constexpr (D == 2) {
      return {column(first), column(first + 1)};
    } else {
      return {column(first), column(first + 1), column(first + 2)};
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
};

template <int D>
void enclosure_of(const Tape& tape, const float* const* centres, const CellColumns& cells, size_t count, float* lo,
                  float* value, float* scratch) {
  using T = Pack<kPackWidth>;
  const Machine<T> m = machine_for(tape, scratch, 3);
  const size_t lanes = lanes_of<T>();
  for (size_t i = 0; i < count; i += lanes) {
    for (int axis = 0; axis < D; ++axis) store(Make<T>::load(centres[axis] + i), m.positions + axis * lanes);
    const EnclosureMode<T, D, ColumnCell<T, D>> mode{{&cells, i}};
    const auto f = run(mode, m);
    store(f.lo, lo + i);
    store(f.value, value + i);
  }
}

void enclosure_kernel(const Tape& tape, const float* const* centres, const CellColumns& cells, size_t count, float* lo,
                      float* value, float* scratch) {
  tape.dimension == 2 ? enclosure_of<2>(tape, centres, cells, count, lo, value, scratch)
                      : enclosure_of<3>(tape, centres, cells, count, lo, value, scratch);
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
