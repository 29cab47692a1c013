// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Certified distances of pairs of shapes, 2D and 3D.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/distance/certify_distances.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "solve/distance/distance_search.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <int D>
void certify_distances_of(const DistanceTile& tile, PairScratch& scratch) {
  DistanceSearch<D> search(tile, scratch);
  for (size_t i = 0; i < tile.pairs.count; ++i) search.run(tile.pairs.row(i));
}

void certify_distances(const DistanceTile& tile, PairScratch& scratch) {
  const PairQueries& queries = *tile.pairs.queries;
  const size_t first = shapes_of(queries, tile.pairs.row(0)).first;
  queries.shapes[first]->dimension == 2 ? certify_distances_of<2>(tile, scratch)
                                        : certify_distances_of<3>(tile, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(certify_distances);
DistanceSolver certify_distances_entry(std::int64_t target) { return THALWEG_ENTRY_OF(certify_distances, target); }
}  // namespace thalweg
#endif
