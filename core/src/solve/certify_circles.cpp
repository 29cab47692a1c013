// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The certified search over circles (2D) and spheres (3D), filled.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/certify_circles.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "solve/ball_domain.inl"
#include "solve/certify.inl"
#include "solve/range_search.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

void certify_circles(const CircleTile& tile, TileScratch& scratch) {
  if (tile.tape->has_formulas) {
    tile.tape->dimension == 2 ? RangeSearch<BallDomain<2>>(tile, scratch).run()
                              : RangeSearch<BallDomain<3>>(tile, scratch).run();
  } else if (tile.tape->dimension == 2) {
    Certifier<BallDomain<2>>(tile, scratch).run();
  } else {
    Certifier<BallDomain<3>>(tile, scratch).run();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(certify_circles);
CircleSolver certify_circles_entry(std::int64_t target) { return THALWEG_ENTRY_OF(certify_circles, target); }
}  // namespace thalweg
#endif
