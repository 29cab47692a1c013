// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the regions that a certified search can cut up have in common (triangle_domain.inl, ball_domain.inl). A domain
// says how a row becomes a root cell, how a cell is split, and where a cell's centre, reach and extent lie. Included
// once per SIMD target.
#if defined(THALWEG_SOLVE_DOMAINS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_DOMAINS_INL
#undef THALWEG_SOLVE_DOMAINS_INL
#else
#define THALWEG_SOLVE_DOMAINS_INL
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/interleaved.inl"
#include "solve/decide.h"
#include "solve/finish.h"
#include "solve/tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// At most this many numbers say which piece of its query's region a cell is.
inline constexpr size_t kMostCoordinates = 6;

/// Open cells, one entry each: whose they are and which piece of the region.
struct CellList {
  uint32_t* query = nullptr;
  float* at[kMostCoordinates] = {};
  size_t count = 0;

  void take(Arena& arena, size_t room, size_t coordinates) {
    query = arena.take<uint32_t>(room);
    for (size_t i = 0; i < coordinates; ++i) at[i] = arena.take<float>(room);
  }
};

/// The children of one wave in planes: child k of parent i is entry k * stride + i. The parents' queries are theirs.
struct WaveColumns {
  size_t stride = 0;
  float* at[kMostCoordinates] = {};
  float* centre[3] = {};
  float* reach = nullptr;
  float* edges[9] = {};
  float* gradient[3] = {};  ///< at the centres
  float* value = nullptr;
  float* lower = nullptr;
  float* best = nullptr;  ///< per parent: the least value of its children

  void take(Arena& arena, size_t room, size_t coordinates, size_t edge_columns) {
    for (size_t i = 0; i < coordinates; ++i) at[i] = arena.take<float>(room);
    for (float** column : {&centre[0], &centre[1], &centre[2], &gradient[0], &gradient[1], &gradient[2]}) {
      *column = arena.take<float>(room);
    }
    for (float** column : {&reach, &value, &lower, &best}) *column = arena.take<float>(room);
    for (size_t i = 0; i < edge_columns; ++i) edges[i] = arena.take<float>(room);
  }
};

/// A point of each cell of a vector, and how far the linear model of f falls over the cells.
template <int D>
struct Lowest {
  V32 slope;
  V32 point[D];
  V32 uv[2];
};

/// Reach of a cell without a point of the query: puts its bound above every value and keeps all arithmetic finite.
inline constexpr float kMisses = -1e30F;

using IndexLanes = hn::RebindToSigned<F32>;

/// Entries of a column picked by the cells' queries.
HWY_INLINE V32 gather(const float* column, const uint32_t* index) {
  const IndexLanes di;
  return hn::GatherIndex(F32(), column, hn::LoadU(di, reinterpret_cast<const int32_t*>(index)));
}

/// Row-major rows of `Width` numbers to columns, with the largest magnitude of each row; rows with a number that is
/// not finite or too large are marked and replaced by zeros.
template <size_t Width>
HWY_INLINE void load_rows(const QueryTile& tile, float* const* columns, float* largest, float* is_bad) {
  const F32 d;
  const size_t lanes = hn::Lanes(d);
  const auto limit = hn::Set(d, kLargestCoordinate);
  for (size_t i = 0; i < tile.count; i += lanes) {
    const float* rows = tile.rows + i * Width;
    float tail[Width * hn::MaxLanes(F32())];
    if (tile.count - i < lanes) {
      std::fill_n(tail, Width * lanes, 0.0F);
      std::copy_n(rows, (tile.count - i) * Width, tail);
      rows = tail;
    }
    V32 x[Width];
    load_interleaved(rows, x);
    auto most = hn::Zero(d);
    auto good = hn::Eq(most, most);
    for (size_t k = 0; k < Width; ++k) {
      const auto size = hn::Abs(x[k]);
      good = hn::And(good, hn::Le(size, limit));
      most = hn::Max(most, size);
    }
    for (size_t k = 0; k < Width; ++k) hn::StoreU(hn::IfThenElseZero(good, x[k]), d, columns[k] + i);
    hn::StoreU(hn::IfThenElseZero(good, most), d, largest + i);
    hn::StoreU(hn::IfThenElse(good, hn::Zero(d), hn::Set(d, 1.0F)), d, is_bad + i);
  }
}

/// A cell's centre in the coordinates of its query.
template <class Domain>
HWY_INLINE void centre_coordinates(const float* cell, float* uv) {
  V32 at[kMostCoordinates];
  for (size_t k = 0; k < Domain::kCoordinates; ++k) at[k] = hn::Set(F32(), cell[k]);
  V32 centre[2];
  Domain::centre_coordinates(at, centre);
  for (size_t k = 0; k < 2; ++k) uv[k] = hn::GetLane(centre[k]);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
