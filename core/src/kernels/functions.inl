// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The functions of formulas on lanes, beside the arithmetic of lanes.inl: elementary functions from Highway's vector
// mathematics, within its range of arguments; outside of it, and for what it does not have, lane by lane in double.
// A function whose real counterpart is not defined gives NaN, also where IEEE arithmetic has an infinity (1/0, log 0),
// and NaN stays NaN. Each is a call of its own: inlined four vectors at a time they would fill the dispatch.
// Included once per SIMD target.
#if defined(THALWEG_KERNELS_FUNCTIONS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_KERNELS_FUNCTIONS_INL
#undef THALWEG_KERNELS_FUNCTIONS_INL
#else
#define THALWEG_KERNELS_FUNCTIONS_INL
#endif

#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/lanes.inl"
// after highway.h
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// What a lane type computes with.
template <class T>
struct Precision {
  static constexpr double kUnit = 0x1p-24;  ///< unit roundoff
  static constexpr double kLargest = std::numeric_limits<float>::max();
  static constexpr double kSmallest = std::numeric_limits<float>::min();  ///< normal
};
template <>
struct Precision<Real> {
  static constexpr double kUnit = 0x1p-53;
  static constexpr double kLargest = std::numeric_limits<double>::max();
  static constexpr double kSmallest = std::numeric_limits<double>::min();
};

template <class T>
HWY_INLINE T not_a_number() {
  return Make<T>::set(std::numeric_limits<double>::quiet_NaN());
}
template <class T>
HWY_INLINE auto is_number(T a) {
  return a == a;
}

// --- in double -------------------------------------------------------------------------------------------------------

struct InDouble {
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  static double log(double x) { return x > 0 ? std::log(x) : kNan; }
  /// Halves away from zero.
  static double round(double x) { return std::round(x); }
  /// atan2 without a sign of zero.
  static double atan2(double y, double x) { return std::atan2(y + 0.0, x + 0.0); }
  /// a - |b| floor(a / |b|), in [0, |b|).
  static double modulo(double a, double b) {
    if (b == 0) return kNan;
    const double rest = std::fmod(a, b);
    return rest < 0 ? rest + std::fabs(b) : rest;
  }
  /// Real powers of positive numbers, whole ones of negative numbers; 0^0 is 1.
  static double pow(double a, double b) {
    const bool undefined = std::isnan(a) || std::isnan(b) || (a == 0 && b < 0);
    return undefined ? kNan : std::pow(a, b);
  }
};

/// No call is made for a result that nobody wants (the cosine for the slope of a sine).
#define THALWEG_CALL HWY_NOINLINE __attribute__((const))

// --- on one vector ---------------------------------------------------------------------------------------------------

/// Lanes of `y` where `m` is set are computed again from those of `a` and `b`, in double.
template <class V, class F>
HWY_NOINLINE V lane_by_lane(V a, V b, V y, V m, F f) {
  const F32 d;
  HWY_ALIGN float lanes[4][hn::MaxLanes(F32())];
  hn::Store(a, d, lanes[0]);
  hn::Store(b, d, lanes[1]);
  hn::Store(y, d, lanes[2]);
  hn::Store(m, d, lanes[3]);
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    if (lanes[3][i] == 0) continue;
    lanes[2][i] = static_cast<float>(f(static_cast<double>(lanes[0][i]), static_cast<double>(lanes[1][i])));
  }
  return hn::Load(d, lanes[2]);
}
template <class V, class F>
HWY_INLINE V repaired(V a, V b, V y, M32 m, F f) {
  const F32 d;
  if (hn::AllFalse(d, m)) return y;
  return lane_by_lane(a, b, y, hn::IfThenElseZero(m, hn::Set(d, 1.0F)), f);
}

/// Highway's reduction of sines and cosines holds up to here.
inline constexpr float kMostAngle = 39000;

template <class V>
THALWEG_CALL V sin_of(V x) {
  const auto far = hn::Gt(hn::Abs(x), hn::Set(F32(), kMostAngle));
  return repaired(x, x, hn::Sin(F32(), x), far, [](double a, double) { return std::sin(a); });
}
template <class V>
THALWEG_CALL V cos_of(V x) {
  const auto far = hn::Gt(hn::Abs(x), hn::Set(F32(), kMostAngle));
  return repaired(x, x, hn::Cos(F32(), x), far, [](double a, double) { return std::cos(a); });
}
template <class V>
THALWEG_CALL V tan_of(V x) {
  const auto far = hn::Gt(hn::Abs(x), hn::Set(F32(), kMostAngle));
  const auto near = hn::Div(hn::Sin(F32(), x), hn::Cos(F32(), x));
  return repaired(x, x, near, far, [](double a, double) { return std::tan(a); });
}
template <class V>
THALWEG_CALL V asin_of(V x) {
  const auto inside = hn::Le(hn::Abs(x), hn::Set(F32(), 1.0F));
  return hn::IfThenElse(inside, hn::Asin(F32(), x), hn::NaN(F32()));
}
template <class V>
THALWEG_CALL V acos_of(V x) {
  const auto inside = hn::Le(hn::Abs(x), hn::Set(F32(), 1.0F));
  return hn::IfThenElse(inside, hn::Acos(F32(), x), hn::NaN(F32()));
}
template <class V>
THALWEG_CALL V atan_of(V x) {
  return hn::IfThenElse(hn::Eq(x, x), hn::Atan(F32(), x), x);
}
template <class V>
THALWEG_CALL V exp_of(V x) {
  // Infinite from 89 on; the reduction holds up to 104.
  const auto most = hn::Set(F32(), 100.0F);
  const auto y = hn::Exp(F32(), hn::IfThenElse(hn::Lt(x, most), x, most));
  return hn::IfThenElse(hn::Eq(x, x), y, x);
}
template <class V>
THALWEG_CALL V log_of(V x) {
  const F32 d;
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto y = hn::IfThenElse(hn::Lt(x, infinite), hn::Log(d, x), infinite);
  return hn::IfThenElse(hn::Gt(x, hn::Zero(d)), y, hn::NaN(d));
}
/// From the arc tangent of the smaller coordinate by the greater.
template <class V>
THALWEG_CALL V atan2_of(V y, V x) {
  const F32 d;
  const auto zero = hn::Zero(d);
  const auto across = hn::Abs(y);
  const auto along = hn::Abs(x);
  const auto steep = hn::Gt(across, along);
  const auto greater = hn::IfThenElse(steep, across, along);
  const auto ratio = hn::Div(hn::IfThenElse(steep, along, across), greater);
  auto angle = hn::Atan(d, hn::IfThenElse(hn::Eq(greater, zero), zero, ratio));
  angle = hn::IfThenElse(steep, hn::Sub(hn::Set(d, 1.57079632679489661923F), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, zero), hn::Sub(hn::Set(d, 3.14159265358979323846F), angle), angle);
  angle = hn::IfThenElse(hn::Lt(y, zero), hn::Neg(angle), angle);
  // Two infinities, or NaN.
  const auto odd = hn::Not(hn::Lt(hn::Abs(hn::Mul(hn::Set(d, 0.0F), hn::Add(x, y))), hn::Set(d, 1.0F)));
  return repaired(y, x, angle, odd, &InDouble::atan2);
}
/// Exact: the quotient is taken in float32, its product with b is subtracted without rounding while it is small, and
/// a quotient that was one off is put right.
template <class V>
THALWEG_CALL V modulo_of(V a, V b) {
  const F32 d;
  const auto zero = hn::Zero(d);
  const auto size = hn::Abs(b);
  const auto quotient = hn::Floor(hn::Div(a, size));
  const auto rest = hn::NegMulAdd(quotient, size, a);
  // In [0, |b|) and from whole numbers of few bits: exact, fused or not.
  const auto good = hn::And(hn::And(hn::Ge(rest, zero), hn::Lt(rest, size)),
                            hn::Le(hn::Abs(quotient), hn::Set(d, HWY_NATIVE_FMA ? 4194304.0F : 1.0F)));
  return repaired(a, b, rest, hn::Not(good), &InDouble::modulo);
}
template <class V>
THALWEG_CALL V pow_of(V a, V b) {
  return repaired(a, b, a, hn::Eq(hn::Zero(F32()), hn::Zero(F32())), &InDouble::pow);
}
template <class V>
HWY_INLINE V round_of(V x) {
  const F32 d;
  const auto size = hn::Abs(x);
  const auto whole = hn::Floor(size);
  const auto up = hn::IfThenElseZero(hn::Ge(hn::Sub(size, whole), hn::Set(d, 0.5F)), hn::Set(d, 1.0F));
  return hn::CopySign(hn::Add(whole, up), x);
}

#undef THALWEG_CALL

// --- on lanes --------------------------------------------------------------------------------------------------------

#define THALWEG_FUNCTION_1(NAME, REAL, VECTOR)            \
  HWY_INLINE Real NAME(Real a) { return {REAL}; }         \
  HWY_INLINE Pack<1> NAME(Pack<1> a) { return {VECTOR}; } \
  template <int W>                                        \
  HWY_INLINE Pack<W> NAME(Pack<W> a) {                    \
    return {NAME(a.lo), NAME(a.hi)};                      \
  }
#define THALWEG_FUNCTION_2(NAME, REAL, VECTOR)                       \
  HWY_INLINE Real NAME(Real a, Real b) { return {REAL}; }            \
  HWY_INLINE Pack<1> NAME(Pack<1> a, Pack<1> b) { return {VECTOR}; } \
  template <int W>                                                   \
  HWY_INLINE Pack<W> NAME(Pack<W> a, Pack<W> b) {                    \
    return {NAME(a.lo, b.lo), NAME(a.hi, b.hi)};                     \
  }
THALWEG_FUNCTION_1(ceil, std::ceil(a.v), hn::Ceil(a.v))
THALWEG_FUNCTION_1(round, InDouble::round(a.v), round_of(a.v))
THALWEG_FUNCTION_1(sin, std::sin(a.v), sin_of(a.v))
THALWEG_FUNCTION_1(cos, std::cos(a.v), cos_of(a.v))
THALWEG_FUNCTION_1(tan, std::tan(a.v), tan_of(a.v))
THALWEG_FUNCTION_1(asin, std::asin(a.v), asin_of(a.v))
THALWEG_FUNCTION_1(acos, std::acos(a.v), acos_of(a.v))
THALWEG_FUNCTION_1(atan, std::atan(a.v), atan_of(a.v))
THALWEG_FUNCTION_1(exp, std::exp(a.v), exp_of(a.v))
THALWEG_FUNCTION_1(log, InDouble::log(a.v), log_of(a.v))
THALWEG_FUNCTION_2(atan2, InDouble::atan2(a.v, b.v), atan2_of(a.v, b.v))
THALWEG_FUNCTION_2(modulo, InDouble::modulo(a.v, b.v), modulo_of(a.v, b.v))
THALWEG_FUNCTION_2(pow, InDouble::pow(a.v, b.v), pow_of(a.v, b.v))
#undef THALWEG_FUNCTION_1
#undef THALWEG_FUNCTION_2

/// Slopes that overflow on the way count as 0, so that finite values have finite gradients. Zeros come out positive.
template <class T>
HWY_INLINE Point<T, 2> finite_or_zero(Point<T, 2> g) {
  const T most = Make<T>::set(Precision<T>::kLargest);
  const T none = zero<T>();
  return {select(abs(g.x) <= most, g.x + none, none), select(abs(g.y) <= most, g.y + none, none)};
}
template <class T>
HWY_INLINE Point<T, 3> finite_or_zero(Point<T, 3> g) {
  const Point<T, 2> flat = finite_or_zero(Point<T, 2>{g.x, g.y});
  return {flat.x, flat.y, finite_or_zero(Point<T, 2>{g.z, g.z}).x};
}

/// min and max that NaN passes through, whichever operand it is.
template <class T>
HWY_INLINE T least(T a, T b) {
  return select(is_number(a), min(a, b), a);
}
template <class T>
HWY_INLINE T greatest(T a, T b) {
  return select(is_number(a), max(a, b), a);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
