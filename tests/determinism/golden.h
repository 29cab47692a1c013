// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// FNV-1a 64 over all result columns of each workload, one for the targets with fused multiply-add and one for those
// without. A change of any of them is a change of results: it goes with a line in CHANGELOG.md that says why.
//
// Debug and release give the same. The rows marked libm ask the C library for sines of float32 angles (the table of
// gradient `dichotomy`, and poses in 2D); they are glibc's on a machine with fused multiply-add. All others use the
// library when a tape is compiled, in double, and never again.
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
    {"triangles2_verdict", 0xd99a1cc829977e3a, 0x52f3c493be7d66d4},
    {"triangles2_deepest", 0x28cda6145ab2d146, 0x5907db96320faadc},
    {"triangles3_verdict", 0x3f15323bc7aa2e6b, 0x4d392f00828c0d73},
    {"triangles3_deepest", 0x349eb1840f265405, 0xc9e62721f0bc2d03},
    {"circles2_verdict", 0xdff05b221ef97a4c, 0x22106c33c8d22b19},
    {"circles2_deepest", 0x451887d89977e1b0, 0xdae3806a17531f05},
    {"spheres3_verdict", 0x0e35a0fcbc6d5b35, 0x79946ea2a377bc97},
    {"spheres3_deepest", 0x6e0f4b6b740d3c46, 0x8d52985e73e18a71},
    {"circles2_published", 0x5125a0c4e10b6cf2, 0xbfda426db6a2e868},
    {"triangles2_thesis", 0x35f1cc2c306b2fb1, 0x6a4e7c0afb62869b},  // libm
    {"triangles2_projected", 0xb4ab2aeb7bf27725, 0x13fee8281ea334da},
    {"triangles3_projected", 0x91aa21c464816d66, 0x15e38051ef016ab1},
    {"triangles2_accelerated", 0x2a3b95183cb0e900, 0x167d10f20bb7f7bf},
    {"triangles3_accelerated", 0x823f2e1f0ec40fa4, 0xeef67077486bfbb7},
    {"triangles2_frank_wolfe", 0x9b30faa917c48a8a, 0x8d100b98b0ac2ed2},
    {"triangles3_frank_wolfe_search", 0xeeb4913221367724, 0x4914306396433479},
    {"triangles2_golden_section", 0x8495cb5da83ba042, 0x57f6641bee94bcd9},
    {"triangles3_distance_step", 0x3a28636f7e7a0b37, 0x2cff1fc46d89989a},
    {"eval2_autodiff", 0xbb36f2333b7915a2, 0x0038d5d5e755a6d8},
    {"eval3_autodiff", 0xc7132d72fc18cb0a, 0xfbeeadaa2a6294ed},
    {"eval2_central", 0x79188c1dd9c83a6f, 0xbeb2f67bdf24ba45},
    {"eval2_closest_point", 0x5b5068a79a2cfc5a, 0x3feda75f50371c3c},
    {"eval3_closest_point", 0x24a4d9fa903bd14f, 0x203c787ff887f962},
    {"eval3_forward", 0xeb33060340d974e2, 0x731776139f9847dd},
    {"eval3_simplex", 0x56c4912dd53cb7ef, 0x869e0ca20539251e},
    {"grid2_all", 0xd1e12e506dd68c5e, 0x187f48fc0f2cdf6c},
    {"grid3_all", 0xab399306accdc1c6, 0x050cbf06e180f579},
    {"eval2_dichotomy", 0x371b4f39191ea91c, 0xfdd776ca02686143},  // libm
    {"pairs2_verdict", 0x8e202fdc4815c24d, 0x0ff73a7f02e8593f},  // libm
    {"pairs2_deepest", 0x7d36e0252fd3488e, 0x2dc00b804c83a598},  // libm
    {"pairs3_verdict", 0xb50067d8f6cc3d98, 0x4e1b8e25e7433cd6},
    {"pairs3_deepest", 0x1e0d5ec9daba3508, 0x53e27ce57af48f8c},
    {"distances2_all", 0x1922662490211ff8, 0x36825465de05b78c},  // libm
    {"distances3_all", 0x72f6b3f9d904a61f, 0x89435ac3d83a2fe4},
    {"pairs2_many", 0x2b61c3aa583b2fc4, 0x07659525eb7e57e7},  // libm
    {"distances2_many", 0x085238bf98b50180, 0x59c1fe900ee482ce},  // libm
    {"sweeps2_ends", 0x320966d5194c2a18, 0x878c76b18430f461},
    {"sweeps2_many", 0x74c2bc4935eebdfc, 0x2f48dfde6059b23a},
    {"sweeps2_motions", 0x4cb21aeece1a5f96, 0xa34292921012aa0f},  // libm
    {"sweeps2_circles", 0xcc1b646cf126b149, 0x7e714943675daab4},  // libm
    {"sweeps3_ends", 0xef36968d156b5b4e, 0xdb5f51baf474e754},
    {"sweeps3_motions", 0x033f93679bf23ca6, 0xb526d79836deccc8},  // libm
    {"sweeps3_circles", 0xdb56d82e2c73a99f, 0xed7a5baa2da9ecbd},  // libm
    {"formula2_autodiff", 0x6ce718db8ba57e10, 0x9d8d7aa02a01c7cd},
    {"formula3_autodiff", 0x55cd362815a61a12, 0xb5fc3952b8ef0295},
    {"formula2_verdict", 0x4018950446077f8e, 0xb8d0cbc6f1030ee6},
};
// clang-format on

}  // namespace thalweg::determinism
