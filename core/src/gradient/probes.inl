// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The strategies that only need values (Luneau 2025, section 2.3), over one chunk of points: every probe is one pass of
// the chunk through the tape, and what is kept between passes stays in vectors. Included once per SIMD target.
#if defined(THALWEG_GRADIENT_PROBES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_GRADIENT_PROBES_INL
#undef THALWEG_GRADIENT_PROBES_INL
#else
#define THALWEG_GRADIENT_PROBES_INL
#endif

#include "gradient/angles.h"
#include "gradient/strategies.h"
#include "kernels/interpreter.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <class T, int D>
HWY_INLINE Point<T, D> no_direction() {
  if constexpr (D == 2) {
    return {zero<T>(), zero<T>()};
  } else {
    return {zero<T>(), zero<T>(), zero<T>()};
  }
}
template <class T>
HWY_INLINE T largest_size(Point<T, 2> a) {
  return max(abs(a.x), abs(a.y));
}
template <class T>
HWY_INLINE T largest_size(Point<T, 3> a) {
  return max(abs(a.x), max(abs(a.y), abs(a.z)));
}

/// A unit vector along a difference however small that is; zero stays zero.
template <class T, int D>
HWY_INLINE Point<T, D> normalised(Point<T, D> g) {
  const T size = largest_size(g);
  const auto is_none = size == zero<T>();
  // A power of ten times the least normal number has a finite reciprocal.
  const T scale = one<T>() / max(size, Make<T>::set(1e-37F));
  const Point<T, D> near_one = scaled(g, scale);
  const T square = select(is_none, one<T>(), dot(near_one, near_one));
  return scaled(near_one, one<T>() / sqrt(square));
}

HWY_INLINE Pack<1> gather(const float* table, Pack<1> index) {
  const hn::RebindToSigned<F32> d;
  return {hn::GatherIndex(F32(), table, hn::ConvertTo(d, index.v))};
}
template <int W>
HWY_INLINE Pack<W> gather(const float* table, Pack<W> index) {
  return {gather(table, index.lo), gather(table, index.hi)};
}

/// f around the points of one chunk.
template <class T, int D>
class Surroundings {
 public:
  HWY_INLINE Surroundings(const Machine<T>& machine, Point<T, D> at) : machine_(machine), at_(at) {}

  HWY_INLINE void reach(T offset) { offset_ = offset; }
  HWY_INLINE T here() const { return value_at(at_); }
  HWY_INLINE T along_axis(int axis, float sign) const {
    const T step = offset_ * Make<T>::set(sign);
    Point<T, D> p = at_;
    if (axis == 0) p.x = p.x + step;
    if (axis == 1) p.y = p.y + step;
    if constexpr (D == 3) {
      if (axis == 2) p.z = p.z + step;
    }
    return value_at(p);
  }
  /// The product is rounded before the sum, as in the published code.
  HWY_INLINE T along(Point<T, D> direction) const { return value_at(at_ + scaled(direction, offset_)); }

 private:
  /// One copy of the machine serves all probes.
  static HWY_NOINLINE void run_values(const Machine<T>& m, float* value) {
    store(run(ValueMode<T, D>{}, m).value, value);
  }
  HWY_INLINE T value_at(Point<T, D> p) const {
    HWY_ALIGN float value[kMostChunkLanes];
    store_point(p, machine_.positions);
    run_values(machine_, value);
    return Make<T>::load(value);
  }

  const Machine<T>& machine_;
  Point<T, D> at_;
  T offset_ = zero<T>();
};

template <class T, int D, class Entry>
HWY_INLINE Point<T, D> for_each_axis(Entry&& entry) {
  if constexpr (D == 2) {
    const T x = entry(0);
    return {x, entry(1)};
  } else {
    const T x = entry(0);
    const T y = entry(1);
    return {x, y, entry(2)};
  }
}

template <class T, int D>
HWY_INLINE Point<T, D> central(const Surroundings<T, D>& f) {
  return normalised(for_each_axis<T, D>([&](int axis) HWY_ATTR {
    const T ahead = f.along_axis(axis, 1);
    return ahead - f.along_axis(axis, -1);
  }));
}

template <class T, int D>
HWY_INLINE Point<T, D> forward(const Surroundings<T, D>& f, T here) {
  return normalised(for_each_axis<T, D>([&](int axis) HWY_ATTR { return f.along_axis(axis, 1) - here; }));
}

/// The vertices of a regular simplex around the origin, of length 1.
template <class T, int D>
HWY_INLINE Point<T, D> simplex_vertex(int index) {
  static constexpr float kFlat[3][2] = {{1, 0}, {-0.5F, 0.8660254F}, {-0.5F, -0.8660254F}};
  static constexpr float kThird = 0.57735027F;
  static constexpr float kSpace[4][3] = {
      {kThird, kThird, kThird}, {kThird, -kThird, -kThird}, {-kThird, kThird, -kThird}, {-kThird, -kThird, kThird}};
  if constexpr (D == 2) {
    return {Make<T>::set(kFlat[index][0]), Make<T>::set(kFlat[index][1])};
  } else {
    return {Make<T>::set(kSpace[index][0]), Make<T>::set(kSpace[index][1]), Make<T>::set(kSpace[index][2])};
  }
}

/// The vertices sum to zero, so the vertices weighted by the values sum to the gradient up to a factor.
template <class T, int D>
HWY_INLINE Point<T, D> simplex(const Surroundings<T, D>& f) {
  Point<T, D> sum = no_direction<T, D>();
  for (int index = 0; index <= D; ++index) {
    const Point<T, D> vertex = simplex_vertex<T, D>(index);
    sum = sum + scaled(vertex, f.along(vertex));
  }
  return normalised(sum);
}

/// The direction of greatest f on a small circle: the best of three thirds, then eight halvings that give up the end
/// with the smaller value. `verbatim` looks for the greatest |f|, as the published code does, and turns the direction
/// to the one in which f itself grows. Directions are whole numbers (angles.h).
template <class T>
HWY_INLINE Point<T, 2> dichotomy(const Surroundings<T, 2>& f, T here, bool verbatim) {
  const Directions& table = directions();
  const auto direction = [&](T index) HWY_ATTR {
    return Point<T, 2>{gather(table.cosine.data(), index), gather(table.sine.data(), index)};
  };
  const auto probe = [&](T index) HWY_ATTR {
    const T value = f.along(direction(index));
    return verbatim ? abs(value) : value;
  };
  const auto number = [](size_t index) HWY_ATTR { return Make<T>::set(static_cast<float>(index)); };
  const T first = probe(number(0));
  const T second = probe(number(kStepsPerThird));
  const T third = probe(number(2 * kStepsPerThird));

  T best = first + second;
  T from = number(0);
  T at_from = first;
  T at_to = second;
  const auto better = [&](T sum, size_t index, T value, T next) HWY_ATTR {
    const auto is_better = best < sum;
    best = select(is_better, sum, best);
    from = select(is_better, number(index), from);
    at_from = select(is_better, value, at_from);
    at_to = select(is_better, next, at_to);
  };
  better(second + third, kStepsPerThird, second, third);
  better(third + first, 2 * kStepsPerThird, third, first);

  size_t half = kStepsPerThird / 2;
  for (int step = 0; step < kBisections; ++step, half /= 2) {
    const T middle = from + number(half);
    const T value = probe(middle);
    const auto moves_first = at_from < at_to;
    from = select(moves_first, middle, from);
    at_to = select(moves_first, at_to, value);
    at_from = select(moves_first, value, at_from);
  }
  const Point<T, 2> found = direction(from + number(half));
  return verbatim ? scaled(found, select(here < zero<T>(), -one<T>(), one<T>())) : found;
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
