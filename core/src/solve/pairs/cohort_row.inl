// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A cohort is a few rows that are searched side by side, so that the lanes stay full while each row has but a few dozen
// cells in flight. Here: one row of it, and what is asked of a span of its cells. Nothing that a row computes depends
// on its neighbours. Included once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_COHORT_ROW_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_COHORT_ROW_INL
#undef THALWEG_SOLVE_PAIRS_COHORT_ROW_INL
#else
#define THALWEG_SOLVE_PAIRS_COHORT_ROW_INL
#endif

#include <cmath>

#include "solve/pairs/bounds.inl"
#include "solve/pairs/polish.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

inline constexpr size_t kCohortRows = 32;
/// A row with more regions, pieces, or cells in a wave is searched alone.
inline constexpr size_t kMostRegions = 16;
/// The number of pieces that no region is known to hold.
inline constexpr uint32_t kDoubtful = kMostRegions - 1;
inline constexpr size_t kMostPieces = 512;
inline constexpr size_t kPieceRoom = kMostPieces + kColumnPadding;
inline constexpr size_t kMostInWave = 1024;

enum class Stage : uint8_t {
  explores,
  refines,
  alone,  ///< left to the search of one row
};

template <int D>
struct CohortRow {
  PairProblem problem;
  PairFrame<D> frame;
  float half[D];  ///< half extents of a root cell
  float reach;    ///< of a root cell, rounded up
  float stretch;  ///< the Lipschitz constant of g
  float level;    ///< e less what rounding takes
  float deep;     ///< delta: components of {g <= -deep} are told apart
  float tolerance, farthest;
  float closed_lower;
  uint32_t depth, evaluations;
  size_t index;  ///< of the queries
  Stage stage;
  size_t first_piece, pieces;
  size_t labelled;  ///< pieces whose region is known
  // Regions; before there are any, the row as a whole.
  size_t regions;
  bool is_uniform;  ///< all cells of the wave are of region 0
  bool in_doubt;    ///< some piece is in doubt
  PairState<D> best[kMostRegions];
  // Tables that lanes gather from.
  float value[kMostRegions];  ///< of `best`
  float limit[kMostRegions];  ///< cells with a bound above it are closed
  float far_a[kMostRegions], far_b[kMostRegions];
  float open_lower[kMostRegions];  ///< least bound of a cell left open
  /// What a far distance loses at `best` because the field is not straight, for each rung.
  float bend_a[kMostRegions][kFarRungs], bend_b[kMostRegions][kFarRungs];

  [[nodiscard]] bool is_witness(size_t region) const { return best[region].value() < -frame.slack; }
  /// The far distances that lose least over cells of this reach.
  void set_far(float cell_reach) {
    for (size_t j = 0; j < regions; ++j) {
      far_a[j] = best_far(bend_a[j], frame.lipschitz_a, cell_reach);
      far_b[j] = best_far(bend_b[j], frame.lipschitz_b, cell_reach);
    }
  }
  [[nodiscard]] float best_far(const float* bends, float lipschitz, float cell_reach) const {
    float chosen = farthest, least = kNoBound, length = farthest;
    for (size_t i = 0; i < kFarRungs; ++i, length *= 0.5F) {
      const float loss = bends[i] + lipschitz * cell_reach * cell_reach / (2 * length);
      if (!(loss < least)) continue;
      least = loss;
      chosen = length;
    }
    return chosen;
  }
  void count(size_t more) { evaluations += static_cast<uint32_t>(more); }
  /// Within this of a point where g is `at`, g <= e.
  [[nodiscard]] float radius(float at) const { return (level - at) / stretch * 0.99999F; }
};

/// Cells of one row in the columns of all.
struct Span {
  uint32_t row;
  uint32_t begin, end;
};

struct Spans {
  Span of[kCohortRows];
  size_t count = 0;
  void add(uint32_t row, size_t begin, size_t end) {
    if (begin < end) of[count++] = {row, static_cast<uint32_t>(begin), static_cast<uint32_t>(end)};
  }
  [[nodiscard]] const Span* begin() const { return of; }
  [[nodiscard]] const Span* end() const { return of + count; }
  [[nodiscard]] size_t cells() const { return count == 0 ? 0 : of[count - 1].end; }
};

// A pass over a span computes whole vectors. What it stores beyond the span's end belongs to the next one, which is
// stored later.

/// For each set of eight lanes: those in the set, then the others.
struct PackTable {
  uint8_t lane[256][8] = {};
  constexpr PackTable() {
    for (int set = 0; set < 256; ++set) {
      int count = 0;
      for (const int in_set : {1, 0}) {
        for (int i = 0; i < 8; ++i) {
          if ((set >> i & 1) == in_set) lane[set][count++] = static_cast<uint8_t>(i);
        }
      }
    }
  }
};
inline constexpr PackTable kPackTable;

/// The lanes of `which` side by side at `to`, where a whole vector is stored. Returns how many they are. Where there is
/// no instruction for it Highway has a table, but a local one, which compilers copy to the stack for every vector.
template <class V, class M>
HWY_INLINE size_t pack(V v, M which, hn::TFromV<V>* to) {
  const hn::DFromV<V> d;
  if constexpr (HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, which, bits);
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto lanes = hn::PromoteTo(du, hn::LoadU(hn::Rebind<uint8_t, decltype(d)>(), kPackTable.lane[bits[0]]));
    hn::StoreU(hn::TableLookupLanes(v, hn::IndicesFromVec(d, lanes)), d, to);
  } else {
    hn::StoreU(hn::Compress(v, which), d, to);
  }
  return hn::CountTrue(d, which);
}

/// B's coordinates of points in A's.
template <int D>
HWY_INLINE void place_in_b(const PairFrame<D>& frame, float* const* a, float* const* b, size_t begin, size_t end) {
  const F32 d;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    V32 p[D], q[D];
    for (int axis = 0; axis < D; ++axis) p[axis] = hn::LoadU(d, a[axis] + i);
    frame.to_b(p, q);
    for (int axis = 0; axis < D; ++axis) hn::StoreU(q[axis], d, b[axis] + i);
  }
}

template <int D>
HWY_INLINE void place_centres(const CohortRow<D>& row, PairCells cells, Span span, PairPoints points) {
  const F32 d;
  for (size_t i = span.begin; i < span.end; i += hn::Lanes(d)) {
    V32 p[D], q[D];
    for (int axis = 0; axis < D; ++axis) {
      const auto half = hn::Set(d, row.half[axis]), origin = hn::Set(d, row.frame.origin[axis]);
      p[axis] = hn::MulAdd(hn::LoadU(d, cells.at[axis] + i), half, origin);
    }
    row.frame.to_b(p, q);
    for (int axis = 0; axis < D; ++axis) {
      hn::StoreU(p[axis], d, points.a[axis] + i);
      hn::StoreU(q[axis], d, points.b[axis] + i);
    }
  }
}

/// The index of the least of max(a, b) in [begin, end); of equal ones the first.
HWY_INLINE size_t least_of(const float* a, const float* b, size_t begin, size_t end, float& least) {
  const F32 d;
  auto lowest = hn::Set(d, kNoBound);
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const auto here = hn::FirstN(d, HWY_MIN(end - i, hn::Lanes(d)));
    const auto value = hn::Max(hn::LoadU(d, a + i), hn::LoadU(d, b + i));
    lowest = hn::Min(lowest, hn::IfThenElse(here, value, hn::Set(d, kNoBound)));
  }
  least = hn::GetLane(hn::MinOfLanes(d, lowest));
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const auto value = hn::Max(hn::LoadU(d, a + i), hn::LoadU(d, b + i));
    const intptr_t lane = hn::FindFirstTrue(d, hn::Eq(value, hn::Set(d, least)));
    if (lane >= 0) return i + static_cast<size_t>(lane);
  }
  return begin;
}

/// The fields at a point of the columns; gradients in A's frame.
template <int D>
HWY_INLINE PairState<D> state_at(const PairFrame<D>& frame, const PairPoints& points, size_t i) {
  PairState<D> s;
  s.a = points.value_a[i];
  s.b = points.value_b[i];
  for (size_t row = 0; row < D; ++row) {
    s.point[row] = points.a[row][i];
    s.gradient_a[row] = points.gradient_a[row][i];
    float turned = 0;
    for (size_t column = 0; column < D; ++column) turned += frame.rotation[row][column] * points.gradient_b[column][i];
    s.gradient_b[row] = turned;
  }
  return s;
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
