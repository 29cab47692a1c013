// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Values of tapes whose instructions are all scalar (Tape::only_scalars), compiled once per SIMD target.
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

/// Runs the tape over one chunk whose points are at position 0.
void run_scalars(const ScalarMachine& m, int dimension, float* value);

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
