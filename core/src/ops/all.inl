// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Every op of the language, numbered in order of declaration: `Op<0>`, `Op<1>`, ... An op is one THALWEG_OP block in
// one of the files below, and nothing else lists them. Included once per SIMD target; code that only reads the
// declarations uses the static target's copy.
#if defined(THALWEG_OPS_ALL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_OPS_ALL_INL
#undef THALWEG_OPS_ALL_INL
#else
#define THALWEG_OPS_ALL_INL
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "kernels/functions.inl"
#include "kernels/lanes.inl"
#include "ops/declaration.h"
#include "ops/polygon.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

using namespace thalweg::ops;  // NOLINT(google-build-using-namespace): the vocabulary of declarations

template <class T>
struct Interval {
  T lo, hi;
};

template <int I>
struct Op;

inline constexpr int kFirstOp = __COUNTER__ + 1;
#define THALWEG_OP \
  template <>      \
  struct Op<__COUNTER__ - kFirstOp>

#include "ops/primitives2.inl"
#include "ops/primitives3.inl"
#include "ops/round2.inl"
// Operators come after the primitives that they act on.
#include "ops/operators.inl"
#include "ops/placement.inl"
// Formulas: the two nodes that hold one, and what one is made of. The scalar ops are the last ones.
#include "ops/formula.inl"
#include "ops/outward.inl"
#include "ops/scalar.inl"
// The functions use the arithmetic.
#include "ops/functions.inl"

#undef THALWEG_OP
inline constexpr int kOpCount = __COUNTER__ - kFirstOp;

/// The op `rigid` of D dimensions.
template <int D>
consteval int rigid_index() {
  return []<int... I>(std::integer_sequence<int, I...>) {
    int found = 0;
    ((found = Op<I>::kDeclaration.name == "rigid" && Op<I>::kDeclaration.dimension == D ? I : found), ...);
    return found;
  }
  (std::make_integer_sequence<int, kOpCount>());
}

/// Calls `visit.template operator()<Op<I>>(I)` for every op.
template <class Visitor>
void for_each_op(Visitor&& visit) {
  [&]<int... I>(std::integer_sequence<int, I...>) { (visit.template operator()<Op<I>>(I), ...); }
  (std::make_integer_sequence<int, kOpCount>());
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
