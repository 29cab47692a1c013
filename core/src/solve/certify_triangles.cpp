// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The certified search over triangles.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/certify_triangles.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "solve/certify.inl"
#include "solve/range_search.inl"
#include "solve/triangle_domain.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

void certify_triangles(const TriangleTile& tile, TileScratch& scratch) {
  if (tile.tape->has_formulas) {
    tile.tape->dimension == 2 ? RangeSearch<TriangleDomain<2>>(tile, scratch).run()
                              : RangeSearch<TriangleDomain<3>>(tile, scratch).run();
  } else if (tile.tape->dimension == 2) {
    Certifier<TriangleDomain<2>>(tile, scratch).run();
  } else {
    Certifier<TriangleDomain<3>>(tile, scratch).run();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(certify_triangles);
TriangleSolver certify_triangles_entry(std::int64_t target) { return THALWEG_ENTRY_OF(certify_triangles, target); }
}  // namespace thalweg
#endif
