// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The certified search over pairs of shapes, 2D and 3D.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/pairs/certify_pairs.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "solve/pairs/regions.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <int D>
void certify_pairs_of(const PairTile& tile, PairScratch& scratch) {
  PairSearch<D> search(tile, scratch);
  for (size_t i = 0; i < tile.count; ++i) search.run(tile.begin + i);
}

void certify_pairs(const PairTile& tile, PairScratch& scratch) {
  const size_t first = shapes_of(*tile.queries, tile.begin).first;
  tile.queries->shapes[first]->dimension == 2 ? certify_pairs_of<2>(tile, scratch) : certify_pairs_of<3>(tile, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(certify_pairs);
PairSolver certify_pairs_entry(std::int64_t target) { return THALWEG_ENTRY_OF(certify_pairs, target); }
}  // namespace thalweg
#endif
