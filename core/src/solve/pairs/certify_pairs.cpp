// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The certified search over pairs of shapes, 2D and 3D.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/pairs/certify_pairs.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "solve/pairs/cohort.inl"
#include "solve/pairs/regions.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Rows from the tile's `first` on that ask about the same two shapes, as many as make a cohort.
inline size_t cohort_size(const PairTile& tile, size_t first) {
  const auto shapes = [&](size_t i) { return shapes_of(*tile.queries, tile.row(i)); };
  size_t size = 1;
  while (size < kCohortRows && first + size < tile.count && shapes(first + size) == shapes(first)) ++size;
  return size;
}

template <int D>
void certify_pairs_of(const PairTile& tile, PairScratch& scratch) {
  const bool wants_regions = tile.options->goal == Goal::deepest || tile.contacts.found != nullptr;
  PairSearch<D> search(tile, scratch);
  PairCohort<D> cohort(tile, scratch);
  for (size_t first = 0; first < tile.count;) {
    const size_t count = cohort_size(tile, first);
    uint32_t spent[kCohortRows] = {};
    const uint32_t left = wants_regions ? cohort.run(first, count, scratch, spent) : ~uint32_t{0};
    for (size_t k = 0; k < count; ++k) {
      if ((left >> k & 1) != 0) search.run(tile.row(first + k), spent[k]);
    }
    first += count;
  }
}

void certify_pairs(const PairTile& tile, PairScratch& scratch) {
  const size_t first = shapes_of(*tile.queries, tile.row(0)).first;
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
