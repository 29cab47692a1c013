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

// One row a line, as the failing test prints it.
// clang-format off
inline constexpr Golden kGolden[] = {
    {"triangles2_verdict", 0x321a9af654a16a06, 0x4e0d52fc3d5b31d8},
    {"triangles2_deepest", 0x667967960c69cd6b, 0x5d3f52e51e1ea2ae},
    {"triangles3_verdict", 0x9330fdc4244b6efa, 0x3e34594ed9df99f6},
    {"triangles3_deepest", 0x4782a3b4b476a9b0, 0xb5e72654f8cf0983},
    {"circles2_verdict", 0x64fb6f8a59f72bdf, 0x1f0070fe63a3d6bb},
    {"circles2_deepest", 0x6db9ed0edeccd4e5, 0xb80c5560d2abea85},
    {"spheres3_verdict", 0x3e2f8489231d39d6, 0xe3b4031734abcb4d},
    {"spheres3_deepest", 0x4ffebc94a23b55f7, 0xb5e039eb5fb730ef},
    {"circles2_published", 0x2e20c3e16211d66d, 0xde5397f40b4e3f29},
    {"triangles2_thesis", 0xe677931f234b05d7, 0x8dab8e9a6d08c6bf},  // libm
    {"triangles2_projected", 0x566c3eb4166a0264, 0xa2ed38bfcfe26b18},
    {"triangles3_projected", 0x507b40da6e5b28e3, 0x3798d4bf25868131},
    {"eval2_autodiff", 0x1895b069cc53363d, 0xd3b4cea434aa9d65},
    {"eval3_autodiff", 0x8e649ea305ce7a9a, 0x1c85ba1cb15d9ee5},
    {"eval2_central", 0xd63bb138ff1d7830, 0x94fe94ed3b8069b8},
    {"eval3_simplex", 0x9a653943ee9f37d4, 0x44abb23db1ddf0d6},
    {"eval2_dichotomy", 0xde8a081d2629922e, 0xf441306c49e3be6f},  // libm
};
// clang-format on

}  // namespace thalweg::determinism
