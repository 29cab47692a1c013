// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Incumbents besides cells' centres. A minimum on the rim of the region is met by no centre, so one more point is
// evaluated where the linear model of f is least over the children of a cell, if that is below the incumbent.
// Included once per SIMD target.
#if defined(THALWEG_SOLVE_PROBES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PROBES_INL
#undef THALWEG_SOLVE_PROBES_INL
#else
#define THALWEG_SOLVE_PROBES_INL
#endif

#include <limits>

#include "solve/domains.inl"
#include "solve/finish.h"
#include "solve/tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// A probe of a deepest point must promise more than this part of the tolerance.
inline constexpr float kProbeGain = 0.1F;

/// Makes a point the incumbent of query q; the caller moves `state.point`.
inline void set_incumbent(QueryState& state, uint32_t q, float value, const float* uv) {
  state.value[q] = value;
  state.barycentric[0][q] = uv[0];
  state.barycentric[1][q] = uv[1];
  if (value < -state.slack[q]) state.witness[q] = 1;
}

/// One point for every parent of a wave.
template <class Domain>
struct Probes {
  float* least = nullptr;  ///< of the linear models of f over the parent's children
  float* point[3] = {};    ///< where that is
  float* uv[2] = {};
  float* value = nullptr;  ///< f there, once it is evaluated

  void take(Arena& arena, size_t room) {
    for (size_t axis = 0; axis < Domain::kAxes; ++axis) point[axis] = arena.take<float>(room);
    for (float** column : {&least, &value, &uv[0], &uv[1]}) *column = arena.take<float>(room);
  }

  /// Finds the points for the parents `open`, whose children are in the wave.
  void look(const Domain& domain, const CellList& open, const WaveColumns& wave) {
    const F32 d;
    for (size_t i = 0; i < open.count; i += hn::Lanes(d)) {
      auto best = domain.lowest(wave, i, open.query + i);
      best.slope = hn::Add(best.slope, hn::LoadU(d, wave.value + i));
      for (size_t k = 1; k < Domain::kChildren; ++k) {
        const size_t at = k * wave.stride + i;
        const auto other = domain.lowest(wave, at, open.query + i);
        const auto model = hn::Add(other.slope, hn::LoadU(d, wave.value + at));
        const auto lower = hn::Lt(model, best.slope);
        best.slope = hn::IfThenElse(lower, model, best.slope);
        for (size_t axis = 0; axis < Domain::kAxes; ++axis) {
          best.point[axis] = hn::IfThenElse(lower, other.point[axis], best.point[axis]);
        }
        for (size_t c = 0; c < 2; ++c) best.uv[c] = hn::IfThenElse(lower, other.uv[c], best.uv[c]);
      }
      hn::StoreU(best.slope, d, least + i);
      for (size_t axis = 0; axis < Domain::kAxes; ++axis) hn::StoreU(best.point[axis], d, point[axis] + i);
      for (size_t c = 0; c < 2; ++c) hn::StoreU(best.uv[c], d, uv[c] + i);
    }
  }

  /// Moves what was found for a parent to the front.
  void keep(size_t parent, size_t to) {
    for (size_t axis = 0; axis < Domain::kAxes; ++axis) point[axis][to] = point[axis][parent];
    for (float* column : uv) column[to] = column[parent];
  }

  void evaluate(const QueryTile& tile, size_t count, float* scratch) {
    tile.kernels->value(*tile.tape, point, count, value, scratch);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
