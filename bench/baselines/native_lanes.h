// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Two vectors in flight of the widest SIMD target that the compiler flags allow (16 lanes each on AVX-512, 8 on
// AVX2), with operators, for straight-line native code. Only native.cpp includes this.
#pragma once

// No dispatch: the target is what the flags of this one translation unit allow.
#define HWY_COMPILE_ONLY_STATIC
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace thalweg::bench::native {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<float>;
using Vector = hn::Vec<Tag>;
using VectorMask = hn::Mask<Tag>;

struct Mask {
  VectorMask a, b;
};

struct Lanes {
  Vector a, b;

  HWY_INLINE Lanes(Vector first, Vector second) : a(first), b(second) {}
  /// A constant in every lane; after inlining it is an immediate in memory, shared by both vectors.
  HWY_INLINE Lanes(float constant) : a(hn::Set(Tag(), constant)), b(a) {}  // NOLINT(google-explicit-constructor)
};

HWY_INLINE Lanes operator+(Lanes x, Lanes y) { return {hn::Add(x.a, y.a), hn::Add(x.b, y.b)}; }
HWY_INLINE Lanes operator-(Lanes x, Lanes y) { return {hn::Sub(x.a, y.a), hn::Sub(x.b, y.b)}; }
HWY_INLINE Lanes operator*(Lanes x, Lanes y) { return {hn::Mul(x.a, y.a), hn::Mul(x.b, y.b)}; }
HWY_INLINE Lanes operator/(Lanes x, Lanes y) { return {hn::Div(x.a, y.a), hn::Div(x.b, y.b)}; }
HWY_INLINE Lanes operator-(Lanes x) { return {hn::Neg(x.a), hn::Neg(x.b)}; }
/// x * y + z and z - x * y, fused where the target can.
HWY_INLINE Lanes mul_add(Lanes x, Lanes y, Lanes z) { return {hn::MulAdd(x.a, y.a, z.a), hn::MulAdd(x.b, y.b, z.b)}; }
HWY_INLINE Lanes neg_mul_add(Lanes x, Lanes y, Lanes z) {
  return {hn::NegMulAdd(x.a, y.a, z.a), hn::NegMulAdd(x.b, y.b, z.b)};
}
HWY_INLINE Lanes min(Lanes x, Lanes y) { return {hn::Min(x.a, y.a), hn::Min(x.b, y.b)}; }
HWY_INLINE Lanes max(Lanes x, Lanes y) { return {hn::Max(x.a, y.a), hn::Max(x.b, y.b)}; }
HWY_INLINE Lanes abs(Lanes x) { return {hn::Abs(x.a), hn::Abs(x.b)}; }
HWY_INLINE Lanes sqrt(Lanes x) { return {hn::Sqrt(x.a), hn::Sqrt(x.b)}; }
/// Magnitude of x with the sign of y.
HWY_INLINE Lanes copysign(Lanes x, Lanes y) { return {hn::CopySign(x.a, y.a), hn::CopySign(x.b, y.b)}; }
HWY_INLINE Lanes clamp(Lanes x, Lanes least, Lanes most) { return min(max(x, least), most); }

HWY_INLINE Mask operator<(Lanes x, Lanes y) { return {hn::Lt(x.a, y.a), hn::Lt(x.b, y.b)}; }
HWY_INLINE Mask operator<=(Lanes x, Lanes y) { return {hn::Le(x.a, y.a), hn::Le(x.b, y.b)}; }
HWY_INLINE Mask both(Mask x, Mask y) { return {hn::And(x.a, y.a), hn::And(x.b, y.b)}; }
HWY_INLINE Mask either(Mask x, Mask y) { return {hn::Or(x.a, y.a), hn::Or(x.b, y.b)}; }
HWY_INLINE Lanes select(Mask m, Lanes yes, Lanes no) {
  return {hn::IfThenElse(m.a, yes.a, no.a), hn::IfThenElse(m.b, yes.b, no.b)};
}
/// x where m, else 0.
HWY_INLINE Lanes keep(Mask m, Lanes x) { return {hn::IfThenElseZero(m.a, x.a), hn::IfThenElseZero(m.b, x.b)}; }

HWY_INLINE size_t lanes_per_turn() { return 2 * hn::Lanes(Tag()); }

/// Columns of 2 * Lanes() interleaved points.
struct Pair {
  Lanes x, y;
};
HWY_INLINE Pair load_points(const float* rows) {
  const Tag tag;
  const size_t width = hn::Lanes(tag);
  Vector x0, y0, x1, y1;
  hn::LoadInterleaved2(tag, rows, x0, y0);
  hn::LoadInterleaved2(tag, rows + 2 * width, x1, y1);
  return {{x0, x1}, {y0, y1}};
}
HWY_INLINE void store_points(Pair p, float* rows) {
  const Tag tag;
  const size_t width = hn::Lanes(tag);
  hn::StoreInterleaved2(p.x.a, p.y.a, tag, rows);
  hn::StoreInterleaved2(p.x.b, p.y.b, tag, rows + 2 * width);
}
HWY_INLINE void store(Lanes v, float* out) {
  const Tag tag;
  hn::StoreU(v.a, tag, out);
  hn::StoreU(v.b, tag, out + hn::Lanes(tag));
}

}  // namespace thalweg::bench::native
HWY_AFTER_NAMESPACE();
