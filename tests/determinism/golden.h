// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// FNV-1a 64 over all result columns of each workload, one for the targets with fused multiply-add and one for those
// without. A change of any of them is a change of results: it goes with a line in CHANGELOG.md that says why.
//
// Debug and release give the same. The rows marked libm ask the C library for sines of float32 angles (gradient
// `dichotomy`); they are glibc's on a machine with fused multiply-add. All others use the library when a tape is
// compiled, in double, and never again.
#pragma once

#include <cstdint>
#include <string_view>

namespace thalweg::determinism {

struct Golden {
  std::string_view workload;
  std::uint64_t fused = 0;
  std::uint64_t unfused = 0;
};

inline constexpr Golden kGolden[] = {
    {"triangles2_verdict", 0x0, 0x0},
    {"triangles2_deepest", 0x0, 0x0},
    {"triangles3_verdict", 0x0, 0x0},
    {"triangles3_deepest", 0x0, 0x0},
    {"circles2_verdict", 0x0, 0x0},
    {"circles2_deepest", 0x0, 0x0},
    {"spheres3_verdict", 0x0, 0x0},
    {"spheres3_deepest", 0x0, 0x0},
    {"circles2_published", 0x0, 0x0},
    {"triangles2_thesis", 0x0, 0x0},  // libm
    {"triangles2_projected", 0x0, 0x0},
    {"triangles3_projected", 0x0, 0x0},
    {"eval2_autodiff", 0x0, 0x0},
    {"eval3_autodiff", 0x0, 0x0},
    {"eval2_central", 0x0, 0x0},
    {"eval3_simplex", 0x0, 0x0},
    {"eval2_dichotomy", 0x0, 0x0},  // libm
};

}  // namespace thalweg::determinism
