// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// FNV-1a 64 over all result columns of each workload, one for the targets with fused multiply-add and one for those
// without. A change of any of them is a change of results: it goes with a line in CHANGELOG.md that says why.
//
// Debug and release give the same. The rows marked libm ask the C library for sines of float32 angles (the table of
// gradient `dichotomy`); they are glibc's on a machine with fused multiply-add. All others use the library when a tape
// is compiled, in double, and never again.
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
    {"triangles2_verdict", 0x7f45684cf0a5be2b, 0x4e67340210791a45},
    {"triangles2_deepest", 0x0935238d2f1fbd21, 0x1e118f1be376eded},
    {"triangles3_verdict", 0x4c5b854ede5b2181, 0x2bd7be58f569785b},
    {"triangles3_deepest", 0x51b93177689a9616, 0x9397430d8b6b84dc},
    {"circles2_verdict", 0x667986e3dad185c4, 0xbba369469653c4e3},
    {"circles2_deepest", 0x61ca29ac6ab055c8, 0x18d099c49a77def2},
    {"spheres3_verdict", 0xad0bd0c3512a4141, 0xe026965652e738ae},
    {"spheres3_deepest", 0x27688007d8dd55c8, 0xf855e08a95711db2},
    {"circles2_published", 0xbcf2f14f62a97878, 0x768e0b6dca761dbc},
    {"triangles2_thesis", 0xe677931f234b05d7, 0x8dab8e9a6d08c6bf},  // libm
    {"triangles2_projected", 0x566c3eb4166a0264, 0xa2ed38bfcfe26b18},
    {"triangles3_projected", 0x507b40da6e5b28e3, 0x3798d4bf25868131},
    {"eval2_autodiff", 0x1895b069cc53363d, 0xd3b4cea434aa9d65},
    {"eval3_autodiff", 0x8e649ea305ce7a9a, 0x1c85ba1cb15d9ee5},
    {"eval2_central", 0x7e03138e9c1e26f6, 0x64988fe56363e011},
    {"eval3_forward", 0xf78cc89a1513f82a, 0xdf49bbeef74ad840},
    {"eval3_simplex", 0xd81c7bd810857423, 0x7d0001e3aa60f2c2},
    {"eval2_dichotomy", 0xd8ae6c9d81abc6e8, 0x7f1361b3efff557b},  // libm
};
// clang-format on

}  // namespace thalweg::determinism
