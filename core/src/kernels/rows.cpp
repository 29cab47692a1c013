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
#include "kernels/scalars.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Stores a chunk of rows of `width` numbers, of which `count` are left.
template <class Store>
HWY_INLINE void store_lanes(float* to, size_t count, size_t lanes, size_t width, Store&& store_all) {
  if (HWY_LIKELY(count >= lanes)) {
    store_all(to);
    return;
  }
  float tail[3 * kMostChunkLanes];
  store_all(tail);
  std::copy_n(tail, count * width, to);
}

/// Rows in and answers out; counts the rows that cannot be answered.
template <class T, int D>
struct RowColumns {
  const float* points;
  size_t count;
  float* value;
  float* gradient;
  bool has_formulas;  ///< which may be undefined at good points
  size_t bad_rows = 0;

  /// Stores the chunk of points from row `first` on at a machine's position 0. Whether all can be answered.
  HWY_INLINE bool take(size_t first, float* position) const {
    Point<T, D> p = load_rows<T, D>(points + first * D, count - first);
    const bool all_good = all_answerable(p);
    if (HWY_UNLIKELY(!all_good)) p = select(is_answerable(p), p, splat<T, D>(zero<T>()));
    store_point(p, position);
    return all_good;
  }
  HWY_INLINE void give(size_t first, bool all_good, T f) {
    if (HWY_UNLIKELY(!all_good || (has_formulas && !all_numbers(f))))
      f = select(good_rows(first, f), f, not_a_number<T>());
    if (value == nullptr) return;
    store_lanes(value + first, count - first, lanes_of<T>(), 1, [&](float* to) HWY_ATTR { store(f, to); });
  }
  HWY_INLINE void give(size_t first, bool all_good, Field<T, D> f) {
    const size_t left = count - first;
    if (has_formulas) f.gradient = finite_or_zero(f.gradient);
    if (HWY_UNLIKELY(!all_good || (has_formulas && !all_numbers(f.value)))) {
      const auto good = good_rows(first, f.value);
      f = {select(good, f.value, not_a_number<T>()), select(good, f.gradient, splat<T, D>(not_a_number<T>()))};
    }
    const size_t lanes = lanes_of<T>();
    if (value != nullptr) store_lanes(value + first, left, lanes, 1, [&](float* to) HWY_ATTR { store(f.value, to); });
    store_lanes(gradient + first * D, left, lanes, D, [&](float* to) HWY_ATTR { store_interleaved(f.gradient, to); });
  }

 private:
  HWY_INLINE auto good_rows(size_t first, T f) {
    auto good = is_answerable(load_rows<T, D>(points + first * D, count - first));
    if (has_formulas) good = both(good, is_number(f));
    bad_rows += count_bad(good, count - first);
    return good;
  }
  /// Of the rows that are left.
  template <class M>
  static HWY_INLINE size_t count_bad(M good, size_t left) {
    if (HWY_LIKELY(left >= lanes_of<T>())) return lanes_of<T>() - count_true(good);
    float flags[kMostChunkLanes];
    store(select(good, zero<T>(), one<T>()), flags);
    return static_cast<size_t>(std::count(flags, flags + left, 1.0F));
  }
};

template <int D>
size_t values_of(const Tape& tape, const float* points, size_t count, float* value, float* scratch) {
  using T = Pack<kValueWidth>;
  size_t i = 0, bad_rows = 0;
  if (tape.only_scalars) {
    // What one chunk of fewer lanes can take is left to it.
    RowColumns<ScalarChunk, D> rows{points, count, value, nullptr, true};
    const ScalarMachine m = value_machine(tape, scratch);
    const size_t lanes = lanes_of<ScalarChunk>();
    HWY_ALIGN float memory[kMostChunkLanes];
    for (; i + lanes_of<T>() < count; i += lanes) {
      const bool all_good = rows.take(i, m.positions);
      const bool goes_out = value != nullptr && i + lanes <= count;
      float* const f = goes_out ? value + i : memory;
      if (HWY_LIKELY(run_scalars(m, D, f) && all_good && goes_out)) continue;
      rows.give(i, all_good, Make<ScalarChunk>::load(f));
    }
    bad_rows = rows.bad_rows;
  }
  const Machine<T> m = machine_for<ValueMode<T, D>>(tape, scratch);
  RowColumns<T, D> rows{points, count, value, nullptr, tape.has_formulas};
  for (; i < count; i += lanes_of<T>()) {
    const bool all_good = rows.take(i, m.positions);
    rows.give(i, all_good, run(ValueMode<T, D>{}, m).value);
  }
  return bad_rows + rows.bad_rows;
}

template <class Mode>
size_t gradients_by(const Tape& tape, const float* points, size_t count, float* value, float* gradient,
                    float* scratch) {
  using T = typename Mode::T;
  constexpr int D = Mode::D;
  const Machine<T> m = machine_for<Mode>(tape, scratch);
  RowColumns<T, D> rows{points, count, value, gradient, tape.has_formulas};
  for (size_t i = 0; i < count; i += lanes_of<T>()) {
    const bool all_good = rows.take(i, m.positions);
    rows.give(i, all_good, divided(run(Mode{}, m)));
  }
  return rows.bad_rows;
}

template <int D>
size_t gradients_of(const Tape& tape, const float* points, size_t count, float* value, float* gradient,
                    float* scratch) {
  using T = Pack<kPlainGradientWidth>;
  const auto by_mode = tape.only_scalars ? gradients_by<ScalarGradientMode<T, D>> : gradients_by<GradientMode<T, D>>;
  return by_mode(tape, points, count, value, gradient, scratch);
}

size_t rows_kernel(const Tape& tape, const float* points, size_t count, float* value, float* gradient, float* scratch) {
  if (gradient == nullptr) {
    return tape.dimension == 2 ? values_of<2>(tape, points, count, value, scratch)
                               : values_of<3>(tape, points, count, value, scratch);
  }
  return tape.dimension == 2 ? gradients_of<2>(tape, points, count, value, gradient, scratch)
                             : gradients_of<3>(tape, points, count, value, gradient, scratch);
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
