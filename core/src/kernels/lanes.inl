// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The lane types that the op templates are written over, with one vocabulary:
//   Pack<W>  W vectors of float32 in flight, of the SIMD target under compilation
//   Real     one double: the twin of the float32 kernels
// Included once per SIMD target; everything lives in that target's namespace. Packs are split in halves with names,
// not arrays: compilers keep those in registers.
#if defined(THALWEG_KERNELS_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_KERNELS_LANES_INL
#undef THALWEG_KERNELS_LANES_INL
#else
#define THALWEG_KERNELS_LANES_INL
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F32 = hn::ScalableTag<float>;
using V32 = hn::Vec<F32>;
using M32 = hn::Mask<F32>;

template <int W>
struct Pack {
  Pack<W / 2> lo, hi;
};
template <>
struct Pack<1> {
  V32 v;
};

template <int W>
struct PackMask {
  PackMask<W / 2> lo, hi;
};
template <>
struct PackMask<1> {
  M32 m;
};

struct Real {
  double v;
};

HWY_INLINE size_t vector_lanes() { return hn::Lanes(F32()); }
template <int W>
HWY_INLINE size_t pack_lanes() {
  return static_cast<size_t>(W) * hn::Lanes(F32());
}

// --- making and storing -------------------------------------------------------------------------------------------

template <class T>
struct Make;
template <>
struct Make<Real> {
  static HWY_INLINE Real set(double v) { return {v}; }
  static HWY_INLINE Real load(const double* p) { return {*p}; }
};
template <>
struct Make<Pack<1>> {
  static HWY_INLINE Pack<1> set(double v) { return {hn::Set(F32(), static_cast<float>(v))}; }
  static HWY_INLINE Pack<1> set(float v) { return {hn::Set(F32(), v)}; }
  static HWY_INLINE Pack<1> load(const float* p) { return {hn::LoadU(F32(), p)}; }
};
template <int W>
struct Make<Pack<W>> {
  // A named half, used twice, would be kept in memory by g++ 12.
  static HWY_INLINE Pack<W> set(double v) { return {Make<Pack<W / 2>>::set(v), Make<Pack<W / 2>>::set(v)}; }
  static HWY_INLINE Pack<W> set(float v) { return {Make<Pack<W / 2>>::set(v), Make<Pack<W / 2>>::set(v)}; }
  static HWY_INLINE Pack<W> load(const float* p) {
    return {Make<Pack<W / 2>>::load(p), Make<Pack<W / 2>>::load(p + pack_lanes<W / 2>())};
  }
};

HWY_INLINE void store(Real a, double* p) { *p = a.v; }
HWY_INLINE void store(Pack<1> a, float* p) { hn::StoreU(a.v, F32(), p); }
template <int W>
HWY_INLINE void store(Pack<W> a, float* p) {
  store(a.lo, p);
  store(a.hi, p + pack_lanes<W / 2>());
}

// --- arithmetic: each line is one op on Real, on one vector and, by halves, on wider packs ---------------------------

#define THALWEG_LANE_1(NAME, REAL, VECTOR)                \
  HWY_INLINE Real NAME(Real a) { return {REAL}; }         \
  HWY_INLINE Pack<1> NAME(Pack<1> a) { return {VECTOR}; } \
  template <int W>                                        \
  HWY_INLINE Pack<W> NAME(Pack<W> a) {                    \
    return {NAME(a.lo), NAME(a.hi)};                      \
  }
#define THALWEG_LANE_2(NAME, REAL, VECTOR)                           \
  HWY_INLINE Real NAME(Real a, Real b) { return {REAL}; }            \
  HWY_INLINE Pack<1> NAME(Pack<1> a, Pack<1> b) { return {VECTOR}; } \
  template <int W>                                                   \
  HWY_INLINE Pack<W> NAME(Pack<W> a, Pack<W> b) {                    \
    return {NAME(a.lo, b.lo), NAME(a.hi, b.hi)};                     \
  }
#define THALWEG_LANE_3(NAME, REAL, VECTOR)                                      \
  HWY_INLINE Real NAME(Real a, Real b, Real c) { return {REAL}; }               \
  HWY_INLINE Pack<1> NAME(Pack<1> a, Pack<1> b, Pack<1> c) { return {VECTOR}; } \
  template <int W>                                                              \
  HWY_INLINE Pack<W> NAME(Pack<W> a, Pack<W> b, Pack<W> c) {                    \
    return {NAME(a.lo, b.lo, c.lo), NAME(a.hi, b.hi, c.hi)};                    \
  }
#define THALWEG_LANE_COMPARE(NAME, REAL, VECTOR)                         \
  HWY_INLINE bool NAME(Real a, Real b) { return REAL; }                  \
  HWY_INLINE PackMask<1> NAME(Pack<1> a, Pack<1> b) { return {VECTOR}; } \
  template <int W>                                                       \
  HWY_INLINE PackMask<W> NAME(Pack<W> a, Pack<W> b) {                    \
    return {NAME(a.lo, b.lo), NAME(a.hi, b.hi)};                         \
  }
#define THALWEG_LANE_LOGIC(NAME, REAL, VECTOR)                                   \
  HWY_INLINE bool NAME(bool a, bool b) { return REAL; }                          \
  HWY_INLINE PackMask<1> NAME(PackMask<1> a, PackMask<1> b) { return {VECTOR}; } \
  template <int W>                                                               \
  HWY_INLINE PackMask<W> NAME(PackMask<W> a, PackMask<W> b) {                    \
    return {NAME(a.lo, b.lo), NAME(a.hi, b.hi)};                                 \
  }

THALWEG_LANE_1(operator-, -a.v, hn::Neg(a.v))
THALWEG_LANE_1(abs, std::fabs(a.v), hn::Abs(a.v))
THALWEG_LANE_1(sqrt, std::sqrt(a.v), hn::Sqrt(a.v))
THALWEG_LANE_1(floor, std::floor(a.v), hn::Floor(a.v))
THALWEG_LANE_2(operator+, a.v + b.v, hn::Add(a.v, b.v))
THALWEG_LANE_2(operator-, a.v - b.v, hn::Sub(a.v, b.v))
THALWEG_LANE_2(operator*, a.v* b.v, hn::Mul(a.v, b.v))
THALWEG_LANE_2(operator/, a.v / b.v, hn::Div(a.v, b.v))
/// min and max return the second operand when it is NaN, on every target.
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
THALWEG_LANE_2(min, a.v < b.v ? a.v : b.v, hn::IfThenElse(hn::Lt(a.v, b.v), a.v, b.v))
THALWEG_LANE_2(max, a.v > b.v ? a.v : b.v, hn::IfThenElse(hn::Gt(a.v, b.v), a.v, b.v))
#else
THALWEG_LANE_2(min, a.v < b.v ? a.v : b.v, hn::Min(a.v, b.v))
THALWEG_LANE_2(max, a.v > b.v ? a.v : b.v, hn::Max(a.v, b.v))
#endif
/// Magnitude of a with the sign of b.
THALWEG_LANE_2(copysign, std::copysign(a.v, b.v), hn::CopySign(a.v, b.v))
/// a with its sign turned where b is negative.
THALWEG_LANE_2(times_sign, std::signbit(b.v) ? -a.v : a.v, hn::Xor(a.v, hn::And(hn::SignBit(F32()), b.v)))
/// a * b + c, c - a * b and a * b - c, fused where the target can.
THALWEG_LANE_3(mul_add, a.v* b.v + c.v, hn::MulAdd(a.v, b.v, c.v))
THALWEG_LANE_3(neg_mul_add, c.v - a.v * b.v, hn::NegMulAdd(a.v, b.v, c.v))
THALWEG_LANE_3(mul_sub, a.v* b.v - c.v, hn::MulSub(a.v, b.v, c.v))
THALWEG_LANE_COMPARE(operator<, a.v < b.v, hn::Lt(a.v, b.v))
THALWEG_LANE_COMPARE(operator<=, a.v <= b.v, hn::Le(a.v, b.v))
THALWEG_LANE_COMPARE(operator==, a.v == b.v, hn::Eq(a.v, b.v))
THALWEG_LANE_LOGIC(both, a&& b, hn::And(a.m, b.m))
THALWEG_LANE_LOGIC(either, a || b, hn::Or(a.m, b.m))
THALWEG_LANE_LOGIC(differ, a != b, hn::Xor(a.m, b.m))

#undef THALWEG_LANE_1
#undef THALWEG_LANE_2
#undef THALWEG_LANE_3
#undef THALWEG_LANE_COMPARE
#undef THALWEG_LANE_LOGIC

template <class T>
HWY_INLINE auto operator>(T a, T b) -> decltype(b < a) {
  return b < a;
}
template <class T>
HWY_INLINE auto operator>=(T a, T b) -> decltype(b <= a) {
  return b <= a;
}

HWY_INLINE Real select(bool m, Real yes, Real no) { return m ? yes : no; }
HWY_INLINE Pack<1> select(PackMask<1> m, Pack<1> yes, Pack<1> no) { return {hn::IfThenElse(m.m, yes.v, no.v)}; }
template <int W>
HWY_INLINE Pack<W> select(PackMask<W> m, Pack<W> yes, Pack<W> no) {
  return {select(m.lo, yes.lo, no.lo), select(m.hi, yes.hi, no.hi)};
}

// --- points and fields
// ------------------------------------------------------------------------------------------------

template <class T, int D>
struct Point;
template <class T>
struct Point<T, 2> {
  T x, y;
};
template <class T>
struct Point<T, 3> {
  T x, y, z;
};

/// The value of a field and its gradient. Templates fill both; where only the value is used the compiler drops the
/// rest.
template <class T, int D>
struct Field {
  T value;
  Point<T, D> gradient;
};

/// A field whose gradient is not divided yet: it is toward / length, and 0 where the length is 0. A primitive knows the
/// way from its closest point and how long it is; where one of two operands is chosen the division waits, so that a
/// tape of many primitives divides once, at its end.
template <class T, int D>
struct Ray {
  T value;
  Point<T, D> toward;
  T length;
};

/// A node's derived constants, broadcast to the lanes.
template <class T>
struct ConstantsOf {
  using Scalar = float;
};
template <>
struct ConstantsOf<Real> {
  using Scalar = double;
};
template <class T>
struct Constants {
  using Scalar = typename ConstantsOf<T>::Scalar;
  const Scalar* pool;
  size_t count;
  HWY_INLINE T operator[](size_t i) const { return Make<T>::set(pool[i]); }
};

template <class T>
HWY_INLINE T zero() {
  return Make<T>::set(0.0);
}
template <class T>
HWY_INLINE T one() {
  return Make<T>::set(1.0);
}
template <class T>
HWY_INLINE T clamp(T a, T least, T most) {
  return min(max(a, least), most);
}
template <class T>
HWY_INLINE T dot(Point<T, 2> a, Point<T, 2> b) {
  return mul_add(a.x, b.x, a.y * b.y);
}
template <class T>
HWY_INLINE T dot(Point<T, 3> a, Point<T, 3> b) {
  return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
template <class T, int D>
HWY_INLINE T length(Point<T, D> a) {
  return sqrt(dot(a, a));
}
template <class T>
HWY_INLINE Point<T, 2> scaled(Point<T, 2> a, T s) {
  return {a.x * s, a.y * s};
}
template <class T>
HWY_INLINE Point<T, 3> scaled(Point<T, 3> a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
HWY_INLINE Point<T, 2> operator+(Point<T, 2> a, Point<T, 2> b) {
  return {a.x + b.x, a.y + b.y};
}
template <class T>
HWY_INLINE Point<T, 3> operator+(Point<T, 3> a, Point<T, 3> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
HWY_INLINE Point<T, 2> operator-(Point<T, 2> a, Point<T, 2> b) {
  return {a.x - b.x, a.y - b.y};
}
template <class T>
HWY_INLINE Point<T, 3> operator-(Point<T, 3> a, Point<T, 3> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
HWY_INLINE Point<T, 2> times_sign(Point<T, 2> a, T sign) {
  return {times_sign(a.x, sign), times_sign(a.y, sign)};
}
template <class T>
HWY_INLINE Point<T, 3> times_sign(Point<T, 3> a, T sign) {
  return {times_sign(a.x, sign), times_sign(a.y, sign), times_sign(a.z, sign)};
}
/// a s + b t
template <class T>
HWY_INLINE Point<T, 2> sum_of(Point<T, 2> a, T s, Point<T, 2> b, T t) {
  return {mul_add(a.x, s, b.x * t), mul_add(a.y, s, b.y * t)};
}
template <class T>
HWY_INLINE Point<T, 3> sum_of(Point<T, 3> a, T s, Point<T, 3> b, T t) {
  return {mul_add(a.x, s, b.x * t), mul_add(a.y, s, b.y * t), mul_add(a.z, s, b.z * t)};
}
/// c - a s
template <class T>
HWY_INLINE Point<T, 2> neg_mul_add(Point<T, 2> a, T s, Point<T, 2> c) {
  return {neg_mul_add(a.x, s, c.x), neg_mul_add(a.y, s, c.y)};
}
template <class T>
HWY_INLINE Point<T, 3> neg_mul_add(Point<T, 3> a, T s, Point<T, 3> c) {
  return {neg_mul_add(a.x, s, c.x), neg_mul_add(a.y, s, c.y), neg_mul_add(a.z, s, c.z)};
}
template <class T, class M>
HWY_INLINE Point<T, 2> select(M m, Point<T, 2> yes, Point<T, 2> no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y)};
}
template <class T, class M>
HWY_INLINE Point<T, 3> select(M m, Point<T, 3> yes, Point<T, 3> no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}

/// 1 / a for a length, and 0 where it is 0 or so short that its square has lost digits: never NaN, and a residual
/// scaled by it is never longer than 1.
template <class T>
HWY_INLINE T reciprocal_or_zero(T a) {
  return select(Make<T>::set(0x1p-62) < a, one<T>() / a, zero<T>());
}

/// sign(a) as +-1, never 0.
template <class T>
HWY_INLINE T sign_of(T a) {
  return copysign(one<T>(), a);
}

/// Zeros come out positive, so that no product with 0 on the way shows.
template <class T, int D>
HWY_INLINE Field<T, D> divided(const Ray<T, D>& f) {
  const T inverse = reciprocal_or_zero(f.length);
  const T none = zero<T>();
  if constexpr (D == 2) {
    return {f.value, {mul_add(f.toward.x, inverse, none), mul_add(f.toward.y, inverse, none)}};
  } else {
    return {
        f.value,
        {mul_add(f.toward.x, inverse, none), mul_add(f.toward.y, inverse, none), mul_add(f.toward.z, inverse, none)}};
  }
}
template <class T, int D>
HWY_INLINE const Field<T, D>& divided(const Field<T, D>& f) {
  return f;
}
template <class T, int D>
HWY_INLINE Ray<T, D> undivided(const Field<T, D>& f) {
  return {f.value, f.gradient, one<T>()};
}
template <class T, int D>
HWY_INLINE const Ray<T, D>& undivided(const Ray<T, D>& f) {
  return f;
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
