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
    {"triangles2_verdict", 0x691ed10b6d2f62f5, 0xb3f4a4a2493fb0e7},
    {"triangles2_deepest", 0x40e1a85153a38928, 0xc3f220e0893e5b60},
    {"triangles3_verdict", 0x4c5b854ede5b2181, 0x2bd7be58f569785b},
    {"triangles3_deepest", 0xaa4fb69f34ee1b5b, 0xfe264bcee68db5d1},
    {"circles2_verdict", 0xa26a49e00b4800a7, 0xe10fcaf343c96f2c},
    {"circles2_deepest", 0x5d8851603fe3ab28, 0xc43c7b6f45d1db12},
    {"spheres3_verdict", 0xad0bd0c3512a4141, 0xe026965652e738ae},
    {"spheres3_deepest", 0xd4e9537b12b21d19, 0x05812bdff589fab7},
    {"circles2_published", 0x83385273c281f4c0, 0xa32c76ea69cd2e94},
    {"triangles2_thesis", 0xba3e1273ed85d28e, 0x455150324a4f2dd7},  // libm
    {"triangles2_projected", 0x3823882924250deb, 0x42bea53fdf31f7f3},
    {"triangles3_projected", 0xb2ea0ac341fb46cb, 0x0e5eedd4248cc0c9},
    {"eval2_autodiff", 0x1895b069cc53363d, 0xd3b4cea434aa9d65},
    {"eval3_autodiff", 0x8e649ea305ce7a9a, 0x1c85ba1cb15d9ee5},
    {"eval2_central", 0x7e03138e9c1e26f6, 0x64988fe56363e011},
    {"eval2_closest_point", 0xa774faaf16ca1ef9, 0x0f035abfb42e0cc8},
    {"eval3_closest_point", 0x975b5ff2901ad8fc, 0xa10752f35e9205b9},
    {"eval3_forward", 0xf78cc89a1513f82a, 0xdf49bbeef74ad840},
    {"eval3_simplex", 0xd81c7bd810857423, 0x7d0001e3aa60f2c2},
    {"eval2_dichotomy", 0xd8ae6c9d81abc6e8, 0x7f1361b3efff557b},  // libm
};
// clang-format on

}  // namespace thalweg::determinism
