// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Tapes whose instructions are all scalar (Tape::only_scalars).
// Included once per SIMD target.
#if defined(THALWEG_KERNELS_SCALARS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_KERNELS_SCALARS_H
#undef THALWEG_KERNELS_SCALARS_H
#else
#define THALWEG_KERNELS_SCALARS_H
#endif

#include "kernels/interpreter.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

using ScalarChunk = Pack<kScalarWidth>;
using ScalarMachine = Machine<ScalarChunk>;

/// Points, by rows as callers have them or by padded columns, and where their values go.
struct ScalarBatch {
  const float* rows = nullptr;
  const float* const* columns = nullptr;
  size_t count = 0;
  float* value = nullptr;  ///< of rows: may be null
  size_t done = 0;         ///< points answered: chunks of few points are left to narrower ones
  size_t bad_rows = 0;     ///< among them
};
/// Values by the tape's value program, where it has one.
void run_scalars(const Tape& tape, ScalarBatch& batch, float* scratch);

/// The machine's mode for f and its gradient: unlike fields, formulas leave nothing to divide.
template <class T_, int D_>
struct ScalarGradientMode {
  using T = T_;
  static constexpr int D = D_;
  static constexpr size_t kComponents = 1 + D;
  static constexpr bool kHasScalars = true;
  static constexpr bool kHasFields = false;
  using Register = Field<T, D>;

  template <class Declared>
  HWY_INLINE Register leaf(const Machine<T>&, const Instruction&, Point<T, D> p, Constants<T> c) const {
    return Declared::leaf(p, c);
  }
  template <class Declared>
  HWY_INLINE Register unary(const Machine<T>&, const Instruction&, const Register& a) const {
    return Declared::apply(a);
  }
  template <class Declared>
  HWY_INLINE Register binary(const Machine<T>&, const Instruction&, const Register& a, const Register& b) const {
    return Declared::apply(a, b);
  }
  static HWY_INLINE Register immediate(Constants<T> c) { return without_slope<T, D>(c[0]); }
  template <class S>
  static HWY_INLINE Register load(const S* from) {
    return {Make<T>::load(from), load_point<T, D>(from + lanes_of<T>())};
  }
  template <class S>
  static HWY_INLINE void save(const Register& a, S* to) {
    store(a.value, to);
    store_point(a.gradient, to + lanes_of<T>());
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
