// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What generated models are made of: one vector in flight of the widest SIMD target that the compiler flags allow.
// Included by the generated file alone.
#pragma once

// No dispatch: the target is what the flags of this one translation unit allow.
#define HWY_COMPILE_ONLY_STATIC
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>

#include "baselines/native_vm.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg::bench::native {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<float>;
using Vector = hn::Vec<Tag>;

HWY_INLINE Vector number(float a) { return hn::Set(Tag(), a); }
HWY_INLINE Vector load(const float* from) { return hn::Load(Tag(), from); }
HWY_INLINE void store(Vector a, float* to) { hn::Store(a, Tag(), to); }

HWY_INLINE Vector add(Vector a, Vector b) { return hn::Add(a, b); }
HWY_INLINE Vector sub(Vector a, Vector b) { return hn::Sub(a, b); }
HWY_INLINE Vector mul(Vector a, Vector b) { return hn::Mul(a, b); }
HWY_INLINE Vector div(Vector a, Vector b) { return hn::Div(a, b); }
HWY_INLINE Vector min(Vector a, Vector b) { return hn::Min(a, b); }
HWY_INLINE Vector max(Vector a, Vector b) { return hn::Max(a, b); }
HWY_INLINE Vector neg(Vector a) { return hn::Neg(a); }
HWY_INLINE Vector abs(Vector a) { return hn::Abs(a); }
HWY_INLINE Vector sqrt(Vector a) { return hn::Sqrt(a); }
HWY_INLINE Vector square(Vector a) { return hn::Mul(a, a); }
HWY_INLINE Vector floor(Vector a) { return hn::Floor(a); }
HWY_INLINE Vector ceil(Vector a) { return hn::Ceil(a); }
HWY_INLINE Vector sin(Vector a) { return hn::Sin(Tag(), a); }
HWY_INLINE Vector cos(Vector a) { return hn::Cos(Tag(), a); }
HWY_INLINE Vector tan(Vector a) { return hn::Div(sin(a), cos(a)); }
HWY_INLINE Vector asin(Vector a) { return hn::Asin(Tag(), a); }
HWY_INLINE Vector acos(Vector a) { return hn::Acos(Tag(), a); }
HWY_INLINE Vector atan(Vector a) { return hn::Atan(Tag(), a); }
HWY_INLINE Vector exp(Vector a) { return hn::Exp(Tag(), a); }
HWY_INLINE Vector ln(Vector a) { return hn::Log(Tag(), a); }

HWY_INLINE Vector atan2(Vector y, Vector x) {
  const Tag tag;
  const Vector ax = abs(x), ay = abs(y), pi = number(3.14159265F);
  const Vector least = min(ax, ay), most = max(ax, ay);
  const Vector turn = hn::IfThenZeroElse(hn::Eq(most, hn::Zero(tag)), hn::Atan(tag, div(least, most)));
  const Vector octant = hn::IfThenElse(hn::Gt(ay, ax), sub(number(1.57079633F), turn), turn);
  return hn::CopySign(hn::IfThenElse(hn::Lt(x, hn::Zero(tag)), sub(pi, octant), octant), y);
}

template <class Model, int D>
HWY_INLINE Vector value_turn(const float* points, float* kept) {
  const Tag tag;
  Vector x, y, z = hn::Zero(tag);
  if constexpr (D == 2) {
    hn::LoadInterleaved2(tag, points, x, y);
  } else {
    hn::LoadInterleaved3(tag, points, x, y, z);
  }
  return Model::field(x, y, z, kept);
}

/// Runs a model over points as callers have them, row by row.
template <class Model, int D>
void value(const float* points, size_t count, float* out) {
  const Tag tag;
  const size_t width = hn::Lanes(tag);
  HWY_ALIGN float kept[Model::kKept * hn::MaxLanes(tag)];
  size_t i = 0;
  for (; i + width <= count; i += width) hn::StoreU(value_turn<Model, D>(points + D * i, kept), tag, out + i);
  if (i == count) return;
  float tail[D * hn::MaxLanes(tag)] = {};
  HWY_ALIGN float answers[hn::MaxLanes(tag)];
  std::copy(points + D * i, points + D * count, tail);
  hn::Store(value_turn<Model, D>(tail, kept), tag, answers);
  std::copy_n(answers, count - i, out + i);
}

}  // namespace
}  // namespace thalweg::bench::native
HWY_AFTER_NAMESPACE();
