// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One step of a certified search: open cells are split, and values and lower bounds of all children had in one pass.
// Included once per SIMD target.
#if defined(THALWEG_SOLVE_WAVE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_WAVE_INL
#undef THALWEG_SOLVE_WAVE_INL
#else
#define THALWEG_SOLVE_WAVE_INL
#endif

#include <algorithm>
#include <limits>

#include "solve/domains.inl"
#include "solve/finish.h"
#include "solve/tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

inline constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// Fills up the last vector of parents with copies of the first.
template <class Domain>
void pad_parents(CellList& open, WaveColumns& wave) {
  const size_t lanes = vector_lanes();
  wave.stride = (open.count + lanes - 1) / lanes * lanes;
  for (size_t i = open.count; i < wave.stride; ++i) {
    open.query[i] = open.query[0];
    for (size_t k = 0; k < Domain::kCoordinates; ++k) open.at[k][i] = open.at[k][0];
  }
}

/// Values and gradients at the first `count` cells of a wave, and lower bounds by what the shape's parts are known to
/// be.
template <class Domain>
void evaluate_cells(const QueryTile& tile, WaveColumns& wave, size_t count, float* scratch) {
  CellColumns cells;
  cells.reach = wave.reach;
  std::copy_n(wave.edges, Domain::kEdgeColumns, cells.edges);
  std::copy_n(wave.gradient, 3, cells.gradient);
  cells.is_box = Domain::kIsBall;
  tile.kernels->enclosure(*tile.tape, wave.centre, cells, count, wave.lower, wave.value, scratch);
}

/// Splits the open cells into the wave's columns: bounds come out less the queries' slack.
template <class Domain>
void bound_children(const QueryTile& tile, const Domain& domain, const float* slack_of, CellList& open,
                    WaveColumns& wave, float* scratch) {
  const F32 d;
  pad_parents<Domain>(open, wave);
  domain.split(open, wave);
  evaluate_cells<Domain>(tile, wave, Domain::kChildren * wave.stride, scratch);
  for (size_t i = 0; i < open.count; i += hn::Lanes(d)) {
    const auto slack = gather(slack_of, open.query + i);
    auto best = hn::Set(d, kInfinite);
    for (size_t k = 0; k < Domain::kChildren; ++k) {
      const size_t at = k * wave.stride + i;
      hn::StoreU(hn::Sub(hn::LoadU(d, wave.lower + at), slack), d, wave.lower + at);
      best = hn::Min(best, hn::LoadU(d, wave.value + at));
    }
    hn::StoreU(best, d, wave.best + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
