// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Which pieces of a row are one region. With L the Lipschitz constant of g, a point of value v has g <= e all over the
// ball of radius (e - v) / L around it; two points whose balls meet are joined by a path with g <= e.
//
// A piece is a cell with centre c, g(c) <= e, and a reach r with L r <= 2 e + delta - g(c). Any point x of it that is
// deep, g(x) <= -delta, has a ball of radius (e + delta) / L, which meets the centre's: all that is deep in a piece is
// joined to its centre. So
//
//   1. pieces whose balls meet are one region, and so are all that a chain of such pieces leads to;
//   2. two regions may share a component of {g <= -delta} only across pieces that touch. Where the bounds of both
//      pieces leave no deep point in what they share they do not; where they leave one, part() is false.
//
// Included once per SIMD target.
#if defined(THALWEG_SOLVE_PAIRS_COHORT_PIECES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_COHORT_PIECES_INL
#undef THALWEG_SOLVE_PAIRS_COHORT_PIECES_INL
#else
#define THALWEG_SOLVE_PAIRS_COHORT_PIECES_INL
#endif

#include <numeric>

#include "solve/pairs/cohort_row.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Balls side by side.
template <int D>
struct PieceBalls {
  float* at[D] = {};
  float* radius = nullptr;
  uint32_t* piece = nullptr;
  size_t count = 0;

  void take(Arena& arena) {
    for (float*& column : at) column = arena.take<float>(kMostPieces + kColumnPadding);
    radius = arena.take<float>(kMostPieces + kColumnPadding);
    piece = arena.take<uint32_t>(kMostPieces + kColumnPadding);
  }
};

template <int D>
class PieceJoiner {
 public:
  void take(Arena& arena) {
    left_.take(arena);
    joined_.take(arena);
  }

  /// Numbers the regions that the row's pieces belong to: those known, by their best points, and new ones, whose best
  /// points are the deep centres of their deepest pieces, yet to be evaluated. What no chain leads to is in doubt.
  /// False when there are too many regions.
  bool label(CohortRow<D>& row, PairCells& pieces) {
    // Of one region what was joined stays so.
    const size_t labelled = row.regions == 1 ? row.labelled : 0;
    lay_balls(row, pieces, 0, labelled, joined_);
    lay_balls(row, pieces, labelled, row.pieces, left_);
    row.labelled = row.pieces;
    size_t next = 0;
    const size_t known = row.regions;
    for (uint32_t j = 0; left_.count > 0; ++j) {
      const size_t first = joined_.count;
      if (j < known) {
        absorb(row.best[j].point, row.radius(row.best[j].value()));
      } else if (!begins_region(row, pieces)) {
        break;
      }
      for (; left_.count > kFew && next < joined_.count; ++next) absorb_around(next);
      absorb_hubs(j == 0 ? 0 : first);
      if (left_.count <= kFew) absorb_few(j == 0 ? 0 : first);
      next = joined_.count;
      for (size_t i = first; i < joined_.count; ++i) pieces.component[row.first_piece + joined_.piece[i]] = j;
      if (row.regions == kDoubtful) return false;
    }
    for (size_t i = 0; i < left_.count; ++i) pieces.component[row.first_piece + left_.piece[i]] = kDoubtful;
    row.in_doubt = left_.count > 0;
    return true;
  }

  /// Joins regions that lead to one another, and puts in doubt the pieces across which two may share a component.
  static void part(CohortRow<D>& row, PairCells& pieces) {
    if (row.regions == 1) return;
    uint32_t into[kMostRegions];
    std::iota(into, into + row.regions, 0U);
    for (uint32_t j = 1; j < row.regions; ++j) {
      for (uint32_t k = 0; k < j && into[j] == j; ++k) {
        if (into[k] == k && leads(row, pieces, j, k)) into[j] = k;
      }
    }
    merge(row, pieces, into);
    std::iota(into, into + row.regions, 0U);
    if (row.regions == 1) return;
    const RegionBoxes boxes(row, pieces);
    for (size_t i = row.first_piece; i < row.first_piece + row.pieces; ++i) {
      // One of two regions is not the first.
      const uint32_t j = pieces.component[i];
      if (j != 0 && j != kDoubtful && boxes.meets_other(pieces, i, row.regions)) doubt_around(row, pieces, i, into);
    }
    merge(row, pieces, into);
  }

 private:
  /// So many balls left are held against the joined, not the other way round.
  static constexpr size_t kFew = 64;
  static constexpr int kHubs = 4;

  static void lay_balls(const CohortRow<D>& row, const PairCells& pieces, size_t begin, size_t end, PieceBalls<D>& to) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    for (size_t i = begin; i < end; i += hn::Lanes(d)) {
      const size_t from = row.first_piece + i, at = i - begin;
      for (int axis = 0; axis < D; ++axis) {
        const auto p = hn::MulAdd(hn::LoadU(d, pieces.at[axis] + from), hn::Set(d, row.half[axis]),
                                  hn::Set(d, row.frame.origin[axis]));
        hn::StoreU(p, d, to.at[axis] + at);
      }
      const auto height = hn::Sub(hn::Set(d, row.level), hn::LoadU(d, pieces.value + from));
      hn::StoreU(hn::Mul(height, hn::Set(d, 0.99999F / row.stretch)), d, to.radius + at);
      hn::StoreU(hn::Iota(du, static_cast<uint32_t>(i)), du, to.piece + at);
    }
    to.count = end - begin;
  }

  /// Moves the balls left that meet the given one to the joined.
  void absorb(const float* at, float radius) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    size_t kept = 0;
    for (size_t i = 0; i < left_.count; i += hn::Lanes(d)) {
      const auto here = hn::FirstN(d, HWY_MIN(left_.count - i, hn::Lanes(d)));
      V32 p[D];
      auto square = hn::Zero(d);
      for (int axis = 0; axis < D; ++axis) {
        p[axis] = hn::LoadU(d, left_.at[axis] + i);
        const auto x = hn::Sub(p[axis], hn::Set(d, at[axis]));
        square = hn::MulAdd(x, x, square);
      }
      const auto own = hn::LoadU(d, left_.radius + i);
      const auto piece = hn::LoadU(du, left_.piece + i);
      const auto reach = hn::Add(own, hn::Set(d, radius));
      const auto meets = hn::And(here, hn::Le(square, hn::Mul(reach, reach)));
      const auto stays = hn::AndNot(meets, here);
      if (hn::AllFalse(d, meets) && kept == i) {
        kept += hn::CountTrue(d, here);
        continue;
      }
      for (int axis = 0; axis < D; ++axis) {
        pack(p[axis], meets, joined_.at[axis] + joined_.count);
        pack(p[axis], stays, left_.at[axis] + kept);
      }
      pack(own, meets, joined_.radius + joined_.count);
      pack(own, stays, left_.radius + kept);
      joined_.count += pack(piece, hn::RebindMask(du, meets), joined_.piece + joined_.count);
      kept += pack(piece, hn::RebindMask(du, stays), left_.piece + kept);
    }
    left_.count = kept;
  }

  /// Large balls that are left and meet a joined one take others along, many at once.
  void absorb_hubs(size_t first) {
    for (int hubs = 0; hubs < kHubs && left_.count > 0; ++hubs) {
      const size_t hub = largest_left();
      if (!meets_joined(hub, first)) return;
      float at[D];
      for (int axis = 0; axis < D; ++axis) at[axis] = left_.at[axis][hub];
      absorb(at, left_.radius[hub]);
    }
  }

  [[nodiscard]] size_t largest_left() const {
    const F32 d;
    auto largest = hn::Set(d, -kNoBound);
    for (size_t i = 0; i < left_.count; i += hn::Lanes(d)) {
      const auto here = hn::FirstN(d, HWY_MIN(left_.count - i, hn::Lanes(d)));
      largest = hn::Max(largest, hn::IfThenElse(here, hn::LoadU(d, left_.radius + i), hn::Set(d, -kNoBound)));
    }
    largest = hn::MaxOfLanes(d, largest);
    for (size_t i = 0; i < left_.count; i += hn::Lanes(d)) {
      const intptr_t lane = hn::FindFirstTrue(d, hn::Eq(hn::LoadU(d, left_.radius + i), largest));
      if (lane >= 0) return i + static_cast<size_t>(lane);
    }
    return 0;
  }

  /// What absorb_around() each of the joined from `first` on comes to, for few balls left: each is held against all.
  void absorb_few(size_t first) {
    size_t met[kFew];  // each has been held against the joined up to here
    std::fill_n(met, left_.count, first);
    for (bool more = true; more;) {
      more = false;
      for (size_t i = 0; i < left_.count;) {
        const size_t from = met[i];
        met[i] = joined_.count;
        if (!meets_joined(i, from)) {
          ++i;
          continue;
        }
        more = true;
        copy_ball(left_, i, joined_, joined_.count++);
        copy_ball(left_, --left_.count, left_, i);
        met[i] = met[left_.count];
      }
    }
  }

  bool meets_joined(size_t k, size_t first) const {
    const F32 d;
    const PieceBalls<D> joined = joined_;
    const auto radius = hn::Set(d, left_.radius[k]);
    for (size_t i = first; i < joined.count; i += hn::Lanes(d)) {
      auto square = hn::Zero(d);
      for (int axis = 0; axis < D; ++axis) {
        const auto x = hn::Sub(hn::LoadU(d, joined.at[axis] + i), hn::Set(d, left_.at[axis][k]));
        square = hn::MulAdd(x, x, square);
      }
      const auto reach = hn::Add(hn::LoadU(d, joined.radius + i), radius);
      const auto meets = hn::Le(square, hn::Mul(reach, reach));
      const intptr_t lane = hn::FindFirstTrue(d, meets);
      if (lane >= 0 && i + static_cast<size_t>(lane) < joined.count) return true;
    }
    return false;
  }

  static void copy_ball(const PieceBalls<D>& from, size_t i, PieceBalls<D>& to, size_t j) {
    for (int axis = 0; axis < D; ++axis) to.at[axis][j] = from.at[axis][i];
    to.radius[j] = from.radius[i];
    to.piece[j] = from.piece[i];
  }

  void absorb_around(size_t i) {
    float at[D];
    for (int axis = 0; axis < D; ++axis) at[axis] = joined_.at[axis][i];
    absorb(at, joined_.radius[i]);
  }

  /// A region around the deepest ball left; false when that is not deep.
  bool begins_region(CohortRow<D>& row, const PairCells& pieces) {
    const size_t deepest = largest_left();
    const float value = pieces.value[row.first_piece + left_.piece[deepest]];
    if (!(value <= -row.deep)) return false;
    PairState<D>& best = row.best[row.regions++];
    for (int axis = 0; axis < D; ++axis) best.point[axis] = left_.at[axis][deepest];
    best.a = best.b = value;
    absorb(best.point, left_.radius[deepest]);
    return true;
  }

  /// True when a ball around the best point of one region meets that of the other, or a piece's.
  static bool leads(const CohortRow<D>& row, const PairCells& pieces, uint32_t j, uint32_t k) {
    const PairState<D>&a = row.best[j], &b = row.best[k];
    float square = 0;
    for (int axis = 0; axis < D; ++axis) square += (a.point[axis] - b.point[axis]) * (a.point[axis] - b.point[axis]);
    const float reach = row.radius(a.value()) + row.radius(b.value());
    return square <= reach * reach || meets_pieces(row, pieces, a, k) || meets_pieces(row, pieces, b, j);
  }

  static bool meets_pieces(const CohortRow<D>& row, PairCells pieces, const PairState<D>& from, uint32_t region) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const auto radius = hn::Set(d, row.radius(from.value()));
    const size_t end = row.first_piece + row.pieces;
    for (size_t i = row.first_piece; i < end; i += hn::Lanes(d)) {
      auto square = hn::Zero(d);
      for (int axis = 0; axis < D; ++axis) {
        const auto at = hn::MulAdd(hn::LoadU(d, pieces.at[axis] + i), hn::Set(d, row.half[axis]),
                                   hn::Set(d, row.frame.origin[axis]));
        const auto x = hn::Sub(at, hn::Set(d, from.point[axis]));
        square = hn::MulAdd(x, x, square);
      }
      const auto height = hn::Sub(hn::Set(d, row.level), hn::LoadU(d, pieces.value + i));
      const auto reach = hn::MulAdd(height, hn::Set(d, 0.99999F / row.stretch), radius);
      const auto is_of = hn::RebindMask(d, hn::Eq(hn::LoadU(du, pieces.component + i), hn::Set(du, region)));
      const auto meets = hn::And(hn::Le(square, hn::Mul(reach, reach)), hn::FirstN(d, HWY_MIN(end - i, hn::Lanes(d))));
      if (!hn::AllFalse(d, hn::And(meets, is_of))) return true;
    }
    return false;
  }

  /// Renumbers regions; the deeper point stays.
  static void merge(CohortRow<D>& row, PairCells& pieces, const uint32_t* into) {
    uint32_t number[kMostRegions];
    uint32_t count = 0;
    for (uint32_t j = 0; j < row.regions; ++j) {
      if (into[j] == j) {
        number[j] = count;
        take_best(row, count, j);
        ++count;
      } else {
        number[j] = number[into[j]];
        if (row.best[j].value() < row.best[number[j]].value()) take_best(row, number[j], j);
      }
    }
    if (count == row.regions) return;
    row.regions = count;
    for (size_t i = 0; i < row.pieces; ++i) {
      uint32_t& component = pieces.component[row.first_piece + i];
      if (component != kDoubtful) component = number[component];
    }
  }

  static void take_best(CohortRow<D>& row, uint32_t to, uint32_t from) {
    if (to == from) return;
    row.best[to] = row.best[from];
    std::copy_n(row.bend_a[from], kFarRungs, row.bend_a[to]);
    std::copy_n(row.bend_b[from], kFarRungs, row.bend_b[to]);
  }

  /// The box around each region's pieces.
  struct RegionBoxes {
    float lo[kMostRegions][D], hi[kMostRegions][D];

    RegionBoxes(const CohortRow<D>& row, const PairCells& pieces) {
      for (size_t j = 0; j < row.regions; ++j) {
        std::fill_n(lo[j], D, kNoBound);
        std::fill_n(hi[j], D, -kNoBound);
      }
      for (size_t i = row.first_piece; i < row.first_piece + row.pieces; ++i) {
        const uint32_t j = pieces.component[i];
        if (j == kDoubtful) continue;
        for (int axis = 0; axis < D; ++axis) {
          lo[j][axis] = std::min(lo[j][axis], pieces.at[axis][i] - pieces.size[i]);
          hi[j][axis] = std::max(hi[j][axis], pieces.at[axis][i] + pieces.size[i]);
        }
      }
    }
    [[nodiscard]] bool meets_other(const PairCells& pieces, size_t i, size_t regions) const {
      for (uint32_t k = 0; k < regions; ++k) {
        bool meets = k != pieces.component[i];
        for (int axis = 0; axis < D; ++axis) {
          const float x = pieces.at[axis][i], r = pieces.size[i];
          meets = meets && x - r <= hi[k][axis] && lo[k][axis] <= x + r;
        }
        if (meets) return true;
      }
      return false;
    }
  };

  /// Of two pieces that may share a deep point: those that lie in {g <= e} all over join their regions, others are in
  /// doubt.
  static void doubt(CohortRow<D>& row, PairCells& pieces, size_t i, size_t l, uint32_t* into) {
    const uint32_t j = pieces.component[i], k = pieces.component[l];
    if (j == k || j == kDoubtful || k == kDoubtful || !shares(row, pieces, i, l)) return;
    const bool settled_i = settled(row, pieces, i), settled_l = settled(row, pieces, l);
    if (settled_i && settled_l) {
      const uint32_t least = std::min(into[j], into[k]);
      into[j] = into[k] = least;
      return;
    }
    row.in_doubt = true;
    if (!settled_i) pieces.component[i] = kDoubtful;
    if (!settled_l) pieces.component[l] = kDoubtful;
  }

  /// doubt() with all pieces that touch piece i.
  static void doubt_around(CohortRow<D>& row, PairCells& pieces, size_t i, uint32_t* into) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const size_t end = row.first_piece + row.pieces;
    for (size_t l = row.first_piece; l < end; l += hn::Lanes(d)) {
      const auto component = hn::LoadU(du, pieces.component + l);
      auto touches = hn::RebindMask(d, hn::Ne(component, hn::Set(du, pieces.component[i])));
      touches = hn::And(touches, hn::FirstN(d, HWY_MIN(end - l, hn::Lanes(d))));
      const auto sizes = hn::Add(hn::LoadU(d, pieces.size + l), hn::Set(d, pieces.size[i]));
      for (int axis = 0; axis < D; ++axis) {
        const auto x = hn::Abs(hn::Sub(hn::LoadU(d, pieces.at[axis] + l), hn::Set(d, pieces.at[axis][i])));
        touches = hn::And(touches, hn::Le(x, sizes));
      }
      if (hn::AllFalse(d, touches)) continue;
      for (size_t k = l; k < std::min(end, l + hn::Lanes(d)); ++k) doubt(row, pieces, i, k, into);
    }
  }

  static bool settled(const CohortRow<D>& row, const PairCells& pieces, size_t i) {
    return pieces.value[i] + row.stretch * row.reach * pieces.size[i] * 1.00001F <= row.level;
  }

  /// Two pieces touch, and their bounds leave a deep point in what they share.
  static bool shares(const CohortRow<D>& row, const PairCells& pieces, size_t i, size_t l) {
    float of_i = 0, of_l = 0;
    for (int axis = 0; axis < D; ++axis) {
      const float x = pieces.at[axis][i], y = pieces.at[axis][l];
      const float r = pieces.size[i], s = pieces.size[l];
      const float lo = std::max(x - r, y - s), hi = std::min(x + r, y + s);
      if (lo > hi) return false;  // exact: cells are dyadic
      const float from_i = std::max(std::fabs(lo - x), std::fabs(hi - x)) * row.half[axis];
      const float from_l = std::max(std::fabs(lo - y), std::fabs(hi - y)) * row.half[axis];
      of_i += from_i * from_i;
      of_l += from_l * from_l;
    }
    const float lower_i = pieces.value[i] - row.stretch * std::sqrt(of_i) * 1.00001F;
    const float lower_l = pieces.value[l] - row.stretch * std::sqrt(of_l) * 1.00001F;
    return std::max(lower_i, lower_l) - row.frame.slack <= -row.deep;
  }

  PieceBalls<D> left_, joined_;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
