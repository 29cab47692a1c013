// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Chunks of row-major points, in and out of the lanes. Rows that cannot be answered (a coordinate that is not finite,
// or beyond kLargestCoordinate) are evaluated at the origin and written as NaN. Included once per SIMD target.
#if defined(THALWEG_KERNELS_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_KERNELS_ROWS_INL
#undef THALWEG_KERNELS_ROWS_INL
#else
#define THALWEG_KERNELS_ROWS_INL
#endif

#include <algorithm>
#include <limits>

#include "kernels/interleaved.inl"
#include "kernels/interpreter.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

HWY_INLINE void load_interleaved(const float* rows, Point<Pack<1>, 2>& p) {
  V32 columns[2];
  load_interleaved(rows, columns);
  p = {{columns[0]}, {columns[1]}};
}
HWY_INLINE void load_interleaved(const float* rows, Point<Pack<1>, 3>& p) {
  V32 columns[3];
  load_interleaved(rows, columns);
  p = {{columns[0]}, {columns[1]}, {columns[2]}};
}
HWY_INLINE void store_interleaved(const Point<Pack<1>, 2>& p, float* rows) {
  hn::StoreInterleaved2(p.x.v, p.y.v, F32(), rows);
}
HWY_INLINE void store_interleaved(const Point<Pack<1>, 3>& p, float* rows) {
  hn::StoreInterleaved3(p.x.v, p.y.v, p.z.v, F32(), rows);
}
template <int W>
HWY_INLINE void load_interleaved(const float* rows, Point<Pack<W>, 2>& p) {
  Point<Pack<W / 2>, 2> lo, hi;
  load_interleaved(rows, lo);
  load_interleaved(rows + 2 * pack_lanes<W / 2>(), hi);
  p = {{lo.x, hi.x}, {lo.y, hi.y}};
}
template <int W>
HWY_INLINE void load_interleaved(const float* rows, Point<Pack<W>, 3>& p) {
  Point<Pack<W / 2>, 3> lo, hi;
  load_interleaved(rows, lo);
  load_interleaved(rows + 3 * pack_lanes<W / 2>(), hi);
  p = {{lo.x, hi.x}, {lo.y, hi.y}, {lo.z, hi.z}};
}
template <int W>
HWY_INLINE void store_interleaved(const Point<Pack<W>, 2>& p, float* rows) {
  store_interleaved(Point<Pack<W / 2>, 2>{p.x.lo, p.y.lo}, rows);
  store_interleaved(Point<Pack<W / 2>, 2>{p.x.hi, p.y.hi}, rows + 2 * pack_lanes<W / 2>());
}
template <int W>
HWY_INLINE void store_interleaved(const Point<Pack<W>, 3>& p, float* rows) {
  store_interleaved(Point<Pack<W / 2>, 3>{p.x.lo, p.y.lo, p.z.lo}, rows);
  store_interleaved(Point<Pack<W / 2>, 3>{p.x.hi, p.y.hi, p.z.hi}, rows + 3 * pack_lanes<W / 2>());
}

template <class T, int D>
HWY_INLINE Point<T, D> splat(T a) {
  if constexpr (D == 2) {
    return {a, a};
  } else {
    return {a, a, a};
  }
}
HWY_INLINE V32 sum_of_vectors(Pack<1> a) { return a.v; }
template <int W>
HWY_INLINE V32 sum_of_vectors(Pack<W> a) {
  return hn::Add(sum_of_vectors(a.lo), sum_of_vectors(a.hi));
}
/// `sum` and the squares of the vectors.
HWY_INLINE V32 add_squares(Pack<1> a, V32 sum) { return hn::MulAdd(a.v, a.v, sum); }
template <int W>
HWY_INLINE V32 add_squares(Pack<W> a, V32 sum) {
  return add_squares(a.hi, add_squares(a.lo, sum));
}
/// In two chains, neither of which is long.
HWY_INLINE V32 sum_of_squares(Pack<1> a) { return hn::Mul(a.v, a.v); }
template <int W>
HWY_INLINE V32 sum_of_squares(Pack<W> a) {
  const auto none = hn::Zero(F32());
  return hn::Add(add_squares(a.lo, none), add_squares(a.hi, none));
}
/// Whether every point of a chunk is answerable, told from a sum of squares that NaN and infinity spoil; a chunk with
/// points further than kLargestCoordinate from the origin may not be told.
template <class T, int D>
HWY_INLINE bool all_answerable(Point<T, D> p) {
  const F32 d;
  V32 squares = hn::Add(sum_of_squares(p.x), sum_of_squares(p.y));
  if constexpr (D == 3) squares = hn::Add(squares, sum_of_squares(p.z));
  return hn::AllTrue(d, hn::Le(squares, hn::Set(d, kLargestCoordinate * kLargestCoordinate)));
}
/// Told from a sum that NaN spoils; infinities of both signs may spoil it too.
template <class T>
HWY_INLINE bool all_numbers(T f) {
  const auto sum = sum_of_vectors(f);
  return hn::AllTrue(F32(), hn::Eq(sum, sum));
}
/// A comparison with NaN is false, so each coordinate is asked on its own.
template <class T>
HWY_INLINE auto is_answerable(Point<T, 2> p) {
  const T limit = Make<T>::set(kLargestCoordinate);
  return both(abs(p.x) <= limit, abs(p.y) <= limit);
}
template <class T>
HWY_INLINE auto is_answerable(Point<T, 3> p) {
  const T limit = Make<T>::set(kLargestCoordinate);
  return both(abs(p.x) <= limit, both(abs(p.y) <= limit, abs(p.z) <= limit));
}

HWY_INLINE size_t count_true(PackMask<1> m) { return hn::CountTrue(F32(), m.m); }
template <int W>
HWY_INLINE size_t count_true(PackMask<W> m) {
  return count_true(m.lo) + count_true(m.hi);
}

/// The next chunk of row-major points, of which `count` are left; the last, partial one is padded with zeros.
template <class T, int D>
HWY_INLINE Point<T, D> load_rows(const float* rows, size_t count) {
  Point<T, D> p;
  if (HWY_LIKELY(count >= lanes_of<T>())) {
    load_interleaved(rows, p);
  } else {
    float tail[D * kMostChunkLanes] = {};
    std::copy_n(rows, count * D, tail);
    load_interleaved(tail, p);
  }
  return p;
}

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

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
