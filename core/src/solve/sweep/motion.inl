// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Where moving queries are, seen from the scene: q(t) = R(-t angle) (p + t move), the vertices of a triangle each with
// a move of its own, the centre of a ball. Included once per SIMD target.
#if defined(THALWEG_SOLVE_SWEEP_MOTION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_SWEEP_MOTION_INL
#undef THALWEG_SOLVE_SWEEP_MOTION_INL
#else
#define THALWEG_SOLVE_SWEEP_MOTION_INL
#endif

#include <algorithm>
#include <cmath>

#include "kernels/functions.inl"
#include "solve/domains.inl"
#include "solve/sweep/path.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Slacks of a bracket: f is told from 0 within one on either side, and pieces are as coarse as the rest allows.
inline constexpr float kSlacks = 6;
/// Units in the last place that placing a point takes: of a sum and a product, and of a turn.
inline constexpr double kPlaceError = 16, kTurnError = 48;

/// The vectors that say where a query is at one time, and how fast they change: of a triangle its first vertex and the
/// two edges from there, of a ball its centre.
template <int D, size_t kParts>
struct Placed {
  V32 part[kParts][D];
  V32 change[kParts][D];  ///< by their own move, turned
  V32 axis[3];            ///< times the scene's angular speed
};

template <int D, size_t kParts>
class Motion {
 public:
  static constexpr size_t kWidth = kParts == 3 ? 3 * D : D + 1;  ///< numbers of a row

  void take(Arena& arena, size_t count) {
    const size_t room = padded(count);
    for (float*& column : at_) column = arena.take<float>(room);
    for (float*& column : move_) column = arena.take<float>(room);
    for (float*& column : axis_) column = arena.take<float>(room);
    for (float** column : {&per_value_, &slack_, &tolerance_, &furthest_, &farthest_, &bend_, &largest_, &bad_})
      *column = arena.take<float>(room);
  }

  /// Reads a tile's rows; marks those that cannot be answered.
  void load(const SweepTile& tile, float* is_bad) {
    turns_ = false;
    read(tile.queries.rows, tile.queries.count, at_, std::make_index_sequence<kWidth>());
    tile.queries.ends != nullptr ? load_ends(tile) : load_motions(tile);
    for (size_t q = 0; q < tile.queries.count; ++q) set_path(tile, q, is_bad);
    for (size_t i = 0; i < tile.queries.count; i += vector_lanes()) {
      if constexpr (kParts == 3) to_edges(i);
    }
  }

  /// Time in which f may change by 1 over any cell of the query, and rounding slack; of each query.
  [[nodiscard]] const float* per_value() const { return per_value_; }
  [[nodiscard]] const float* slack() const { return slack_; }
  /// Of each query, how narrow a bracket is asked for: float32 cannot prove a contact within less than a few slacks.
  [[nodiscard]] const float* tolerance() const { return tolerance_; }
  /// Of each query, the greatest distance from the origin that it gets to.
  [[nodiscard]] const float* furthest() const { return furthest_; }
  /// Bound of the acceleration of any point of the query, as seen from the scene.
  [[nodiscard]] const float* bend() const { return bend_; }
  /// How far from it a point may be asked for.
  [[nodiscard]] const float* farthest() const { return farthest_; }
  [[nodiscard]] const float* radius() const { return at_[D]; }

  /// The queries of one vector at their times.
  HWY_INLINE Placed<D, kParts> place(const uint32_t* query, V32 time) const {
    Placed<D, kParts> placed;
    for (size_t part = 0; part < kParts; ++part) {
      for (size_t axis = 0; axis < D; ++axis) {
        const auto move = gather(move_[part * D + axis], query);
        placed.change[part][axis] = move;
        placed.part[part][axis] = hn::MulAdd(time, move, gather(at_[part * D + axis], query));
      }
    }
    for (size_t axis = 0; axis < 3; ++axis) placed.axis[axis] = hn::Zero(F32());
    if (turns_) turn(query, time, placed);
    return placed;
  }

  /// The speed of a point of the scene's frame whose own part of it is `change`.
  static HWY_INLINE void add_turn(const Placed<D, kParts>& placed, const V32* point, V32* change) {
    const V32* const w = placed.axis;
    // The scene turns by +w, so what is seen from it turns by -w.
    change[0] = hn::MulAdd(w[2], point[1], change[0]);
    change[1] = hn::NegMulAdd(w[2], point[0], change[1]);
    if constexpr (D == 3) {
      change[0] = hn::NegMulAdd(w[1], point[2], change[0]);
      change[1] = hn::MulAdd(w[0], point[2], change[1]);
      change[2] = hn::MulAdd(w[1], point[0], hn::NegMulAdd(w[0], point[1], change[2]));
    }
  }

 private:
  /// Row-major rows to columns; zeros where a row cannot be answered.
  template <size_t... kColumn>
  void read(const float* rows, size_t count, float* const* columns, std::index_sequence<kColumn...>) {
    QueryTile tile;
    tile.rows = rows;
    tile.count = count;
    load_rows<sizeof...(kColumn)>(tile, columns, largest_, bad_);
  }

  void load_ends(const SweepTile& tile) {
    const F32 d;
    if constexpr (kParts == 3) {
      read(tile.queries.ends, tile.queries.count, move_, std::make_index_sequence<kWidth>());
      for (size_t i = 0; i < tile.queries.count; i += hn::Lanes(d)) {
        for (size_t k = 0; k < kWidth; ++k) {
          hn::StoreU(hn::Sub(hn::LoadU(d, move_[k] + i), hn::LoadU(d, at_[k] + i)), d, move_[k] + i);
        }
      }
    }
  }

  void load_motions(const SweepTile& tile) {
    constexpr size_t kMotionWidth = D == 2 ? 3 : 7;
    for (size_t q = 0; q < tile.queries.count; ++q) {
      for (size_t k = 0; k < D; ++k) {
        const float move = -tile.queries.motions[q * kMotionWidth + k];
        for (size_t part = 0; part < kParts; ++part) move_[part * D + k][q] = move;
      }
    }
  }

  /// Vertices become the first one and the edges from it, and so their moves.
  void to_edges(size_t i) {
    const F32 d;
    for (size_t axis = 0; axis < D; ++axis) {
      for (float* const* columns : {at_, move_}) {
        const auto first = hn::LoadU(d, columns[axis] + i);
        for (size_t part = 1; part < kParts; ++part) {
          float* const column = columns[part * D + axis] + i;
          hn::StoreU(hn::Sub(hn::LoadU(d, column), first), d, column);
        }
      }
    }
  }

  /// What holds for one query as a whole, in float32 and on the safe side; one that cannot be answered stands still.
  void set_path(const SweepTile& tile, size_t q, float* is_bad) {
    const Path path = path_of(tile, q, kParts == 1);
    is_bad[q] = path.is_bad ? 1 : 0;
    if (path.is_bad) {
      for (float* column : move_) {
        if (column != nullptr) column[q] = 0;
      }
    }
    turns_ = turns_ || path.angle != 0;
    for (size_t k = 0; k < 3; ++k) axis_[k][q] = static_cast<float>(path.axis[k] * path.angle);
    const double lipschitz = tile.tape->facts.lipschitz, angle = std::fabs(path.angle);
    const double places = kPlaceError + (angle > 0 ? kTurnError + 4 * angle : 0);
    furthest_[q] = static_cast<float>(path.furthest * (1 + 1e-6));
    bend_[q] = static_cast<float>(path.bend * (1 + 1e-6));
    farthest_[q] = tile.stays_near ? static_cast<float>(path.margin * (1 - 1e-5)) : 1e30F;
    const double rounding = places * kUnitRoundoff * lipschitz * path.furthest;
    slack_[q] = static_cast<float>((tile.tape->search_slack(path.furthest) + rounding) * (1 + 1e-6));
    per_value_[q] = static_cast<float>(std::min(1 / (lipschitz * path.fastest), 1e20) * (1 - 1e-6));
    tolerance_[q] = std::min(std::max(tile.tolerance, kSlacks * slack_[q] * per_value_[q]), 1.0F);
  }

  /// Rodrigues' formula, by -t times the angle.
  HWY_INLINE void turn(const uint32_t* query, V32 time, Placed<D, kParts>& placed) const {
    const F32 d;
    V32 w[3];
    for (size_t k = 0; k < 3; ++k) w[k] = placed.axis[k] = gather(axis_[k], query);
    if constexpr (D == 2) {
      // What does not turn keeps its bits, whatever its neighbours do.
      const auto turns = hn::Ne(w[2], hn::Zero(d));
      const auto angle = hn::Mul(w[2], time);
      const auto sine = sin_of(angle), cosine = cos_of(angle);
      for (auto* vectors : {placed.part, placed.change}) {
        for (size_t part = 0; part < kParts; ++part) {
          const auto x = vectors[part][0], y = vectors[part][1];
          vectors[part][0] = hn::IfThenElse(turns, hn::MulAdd(cosine, x, hn::Mul(sine, y)), x);
          vectors[part][1] = hn::IfThenElse(turns, hn::NegMulAdd(sine, x, hn::Mul(cosine, y)), y);
        }
      }
    } else {
      const auto square = hn::MulAdd(w[0], w[0], hn::MulAdd(w[1], w[1], hn::Mul(w[2], w[2])));
      const auto angle = hn::Sqrt(square);
      const auto turns = hn::Gt(square, hn::Zero(d));
      const auto inverse = hn::IfThenElseZero(turns, hn::Div(hn::Set(d, 1.0F), angle));
      for (auto& component : w) component = hn::Mul(component, inverse);
      const auto sine = sin_of(hn::Mul(angle, time)), cosine = cos_of(hn::Mul(angle, time));
      for (auto* vectors : {placed.part, placed.change}) {
        for (size_t part = 0; part < kParts; ++part) turn_vector(w, sine, cosine, turns, vectors[part]);
      }
    }
  }
  static HWY_INLINE void turn_vector(const V32* n, V32 sine, V32 cosine, M32 turns, V32* p) {
    const F32 d;
    const auto along = hn::MulAdd(n[0], p[0], hn::MulAdd(n[1], p[1], hn::Mul(n[2], p[2])));
    const auto rest = hn::Mul(along, hn::Sub(hn::Set(d, 1.0F), cosine));
    const V32 cross[3] = {hn::MulSub(n[1], p[2], hn::Mul(n[2], p[1])), hn::MulSub(n[2], p[0], hn::Mul(n[0], p[2])),
                          hn::MulSub(n[0], p[1], hn::Mul(n[1], p[0]))};
    for (size_t k = 0; k < 3; ++k) {
      const auto turned = hn::MulAdd(n[k], rest, hn::NegMulAdd(sine, cross[k], hn::Mul(cosine, p[k])));
      p[k] = hn::IfThenElse(turns, turned, p[k]);
    }
  }

  static constexpr size_t kColumns = kParts == 3 ? 3 * D : D + 1;
  float* at_[kColumns] = {};
  float* move_[kColumns] = {};
  float* axis_[3] = {};  ///< times the angle
  float *per_value_ = nullptr, *slack_ = nullptr, *tolerance_ = nullptr, *furthest_ = nullptr, *farthest_ = nullptr,
        *bend_ = nullptr, *largest_ = nullptr, *bad_ = nullptr;
  bool turns_ = false;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
