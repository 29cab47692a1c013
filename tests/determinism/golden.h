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
    {"triangles2_verdict", 0xeacd8a61d5fbf8ba, 0xca5525fe5c494be3},
    {"triangles2_deepest", 0xc81c6e8c28ee4cfc, 0x48e202b1dc60eada},
    {"triangles3_verdict", 0x855f5284e708f10a, 0x03b2e7a8060fe46e},
    {"triangles3_deepest", 0xe841cf1f817c2a3f, 0x4fcdcc8ff239ca81},
    {"circles2_verdict", 0xa2ac082fea44dee1, 0x30626f6a127aded3},
    {"circles2_deepest", 0xed90de8e1dcc591b, 0xf85f61099bdc4fae},
    {"spheres3_verdict", 0xd26456339894f4cb, 0x2abd1e96a9f92dc1},
    {"spheres3_deepest", 0xfe059452c9aecae8, 0xae29b2f0b5dc5c26},
    {"circles2_published", 0x567e18570b028a40, 0x1e0cd9b836480b94},
    {"triangles2_thesis", 0x93930670b1a7ba0e, 0x3ad64def9a7af8d7},  // libm
    {"triangles2_projected", 0x593dd47312eaf9eb, 0x8d910f2cfaab35f3},
    {"triangles3_projected", 0xe2eccaa4ad3e56cb, 0x63b4e75fa7f8fbc9},
    {"triangles2_accelerated", 0x952d91d174667131, 0xf406c95b96e08c0b},
    {"triangles3_accelerated", 0x8b164b679bc7486a, 0x3b5b9f073cb5b91e},
    {"triangles2_frank_wolfe", 0xa53d64d53b130c55, 0x51e9fbac17f53f70},
    {"triangles3_frank_wolfe_search", 0xd46cf33e3b3aaeff, 0xc7279a0c10f50721},
    {"triangles2_golden_section", 0xab4eb032ece9be6c, 0x09d9c1c85c161c26},
    {"triangles3_distance_step", 0x5a17fc579e1b96b9, 0x23095720814d1d55},
    {"eval2_autodiff", 0x1b4511cee599fe3d, 0xa7bf7738bef428e5},
    {"eval3_autodiff", 0x35054dcabeb7ab9a, 0xbea6b7e8fe0856e5},
    {"eval2_central", 0x7e03138e9c1e26f6, 0x64988fe56363e011},
    {"eval2_closest_point", 0x87316a0256290979, 0x1520ac90a36cad48},
    {"eval3_closest_point", 0x975b5ff2901ad8fc, 0xa10752f35e9205b9},
    {"eval3_forward", 0xf78cc89a1513f82a, 0xdf49bbeef74ad840},
    {"eval3_simplex", 0xd81c7bd810857423, 0x7d0001e3aa60f2c2},
    {"grid2_all", 0x2b329b4bd07b9b5d, 0x4873d9b6f89c4ad6},
    {"grid3_all", 0x3c17cf3478366e6e, 0x0eea2c5ecf0c2de2},
    {"eval2_dichotomy", 0xd8ae6c9d81abc6e8, 0x7f1361b3efff557b},  // libm
};
// clang-format on

}  // namespace thalweg::determinism
