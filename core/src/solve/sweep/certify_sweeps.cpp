// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Certified times of impact of triangles and balls.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/sweep/certify_sweeps.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include "solve/sweep/fronts.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

void sweep_triangles(const TriangleSweepTile& tile, SweepScratch& scratch) {
  tile.tape->dimension == 2 ? Fronts<MovingTriangle<2>>(tile, scratch).run(scratch)
                            : Fronts<MovingTriangle<3>>(tile, scratch).run(scratch);
}

void sweep_balls(const BallSweepTile& tile, SweepScratch& scratch) {
  tile.tape->dimension == 2 ? Fronts<MovingBall<2>>(tile, scratch).run(scratch)
                            : Fronts<MovingBall<3>>(tile, scratch).run(scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(sweep_triangles);
HWY_EXPORT(sweep_balls);
TriangleSweeper sweep_triangles_entry(std::int64_t target) { return THALWEG_ENTRY_OF(sweep_triangles, target); }
BallSweeper sweep_balls_entry(std::int64_t target) { return THALWEG_ENTRY_OF(sweep_balls, target); }
}  // namespace thalweg
#endif
