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

/// Whether the machine for values runs a program of its own, whose coordinates must not be -0: in the tape they are
/// sums.
HWY_INLINE bool has_value_program(const Tape& tape) { return !tape.values.instructions.empty(); }
ScalarMachine value_machine(const Tape& tape, float* scratch);

/// Runs it over one chunk whose points are at position 0. Whether all values are numbers: if not told so, ask each.
bool run_scalars(const ScalarMachine& m, int dimension, float* value);

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
