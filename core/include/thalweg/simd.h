// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The SIMD targets compiled into the library, as objects that can be listed and forced. A target is chosen per call;
// nothing is global. Targets with fused multiply-add return the same bits.
#pragma once

#include <span>
#include <string_view>

namespace thalweg {

struct Kernels;  // the entry points of one target; internal

struct Target {
  std::string_view name;
  bool fused_multiply_add = false;
  const Kernels* kernels = nullptr;
};

/// The targets this machine can run, best first.
[[nodiscard]] std::span<const Target> targets();

/// The first of targets(), or the one that the environment variable THALWEG_ISA names.
[[nodiscard]] const Target& default_target();

/// A target by name in any case, or null when this machine lacks it.
[[nodiscard]] const Target* find_target(std::string_view name);

}  // namespace thalweg
