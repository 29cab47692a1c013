// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The limit that `thalweg stress` holds evaluation against, where there is one: native code of the same field.
#pragma once

#include <cstddef>
#include <span>

#include "thalweg/tape.h"

namespace thalweg::cli {

/// f at `count` points, rows (N,2) in C order.
using NativeValue = void (*)(const float* points, std::size_t count, float* value);

/// The native code among the benches' that gives the tape's values at all these points, within rounding, or null: the
/// scene is none of theirs, or the build has no benches.
[[nodiscard]] NativeValue native_code_of(const Tape& tape, std::span<const float> points);

}  // namespace thalweg::cli
