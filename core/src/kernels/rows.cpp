// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// f, with or without its gradient, over row-major points as callers have them.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/rows.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "kernels/rows.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Stores `count` lanes; only a batch's last chunk has fewer than all.
template <class Store>
HWY_INLINE void store_lanes(float* to, size_t count, size_t lanes, size_t width, Store&& store_all) {
  if (count == lanes) {
    store_all(to);
    return;
  }
  float tail[3 * kMostChunkLanes];
  store_all(tail);
  std::copy_n(tail, count * width, to);
}

template <int D, bool kWithGradient>
size_t rows_of(const Tape& tape, const float* points, size_t count, float* value, float* gradient, float* scratch) {
  constexpr int kWidth = kWithGradient ? kGradientWidth : kValueWidth;
  using RowPack = Pack<kWidth>;
  const Machine<RowPack> m = machine_for<kWidth>(tape, scratch, kWithGradient ? 1 + D : 1);
  const size_t lanes = lanes_of<RowPack>();
  const RowPack nan = Make<RowPack>::set(std::numeric_limits<float>::quiet_NaN());
  size_t answered = 0;
  for_each_chunk<RowPack, D>(points, count, [&](const float* rows, size_t at, size_t here) HWY_ATTR {
    Point<RowPack, D> p;
    load_interleaved(rows, p);
    const auto good = is_answerable(p);
    answered += count_true(good) - (lanes - here);
    store_point(select(good, p, splat<RowPack, D>(zero<RowPack>())), m.positions);
    Point<RowPack, D> g;
    RowPack f;
    if constexpr (kWithGradient) {
      const auto field = run(GradientMode<RowPack, D>{}, m);
      f = field.value;
      g = select(good, field.gradient, splat<RowPack, D>(nan));
    } else {
      f = run(ValueMode<RowPack, D>{}, m).value;
    }
    f = select(good, f, nan);
    if (value != nullptr) store_lanes(value + at, here, lanes, 1, [&](float* to) HWY_ATTR { store(f, to); });
    if constexpr (kWithGradient) {
      store_lanes(gradient + at * D, here, lanes, D, [&](float* to) HWY_ATTR { store_interleaved(g, to); });
    }
  });
  return count - answered;
}

size_t rows_kernel(const Tape& tape, const float* points, size_t count, float* value, float* gradient, float* scratch) {
  if (gradient == nullptr) {
    return tape.dimension == 2 ? rows_of<2, false>(tape, points, count, value, nullptr, scratch)
                               : rows_of<3, false>(tape, points, count, value, nullptr, scratch);
  }
  return tape.dimension == 2 ? rows_of<2, true>(tape, points, count, value, gradient, scratch)
                             : rows_of<3, true>(tape, points, count, value, gradient, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(rows_kernel);
RowsKernel rows_entry(std::int64_t target) { return THALWEG_ENTRY_OF(rows_kernel, target); }
}  // namespace thalweg
#endif
