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
#include "solve/sweep/sweep_tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// A turn by more says less than its rounding.
inline constexpr float kMostTurn = 1e4F;
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
    for (float** column : {&per_value_, &slack_, &furthest_, &bend_, &largest_, &bad_})
      *column = arena.take<float>(room);
  }

  /// Reads a tile's rows; marks those that cannot be answered.
  void load(const SweepTile& tile, float* is_bad) {
    turns_ = false;
    read(tile.queries.rows, tile.queries.count, at_, is_bad, std::make_index_sequence<kWidth>());
    tile.queries.ends != nullptr ? load_ends(tile, is_bad) : load_motions(tile, is_bad);
    for (size_t i = 0; i < tile.queries.count; i += vector_lanes()) {
      if constexpr (kParts == 3) to_edges(i);
    }
    for (size_t q = 0; q < tile.queries.count; ++q) set_limits(tile, q, is_bad);
  }

  /// Time in which f may change by 1 over any cell of the query, and rounding slack; of each query.
  [[nodiscard]] const float* per_value() const { return per_value_; }
  [[nodiscard]] const float* slack() const { return slack_; }
  /// Of each query, the greatest distance from the origin that it gets to.
  [[nodiscard]] const float* furthest() const { return furthest_; }
  /// Bound of the acceleration of any point of the query, as seen from the scene.
  [[nodiscard]] const float* bend() const { return bend_; }
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
  /// Row-major rows to columns.
  template <size_t... kColumn>
  void read(const float* rows, size_t count, float* const* columns, float* is_bad, std::index_sequence<kColumn...>) {
    QueryTile tile;
    tile.rows = rows;
    tile.count = count;
    load_rows<sizeof...(kColumn)>(tile, columns, largest_, is_bad);
  }

  void load_ends(const SweepTile& tile, float* is_bad) {
    const F32 d;
    if constexpr (kParts == 3) {
      read(tile.queries.ends, tile.queries.count, move_, bad_, std::make_index_sequence<kWidth>());
      for (size_t i = 0; i < tile.queries.count; i += hn::Lanes(d)) {
        hn::StoreU(hn::Max(hn::LoadU(d, is_bad + i), hn::LoadU(d, bad_ + i)), d, is_bad + i);
        for (size_t k = 0; k < kWidth; ++k) {
          hn::StoreU(hn::Sub(hn::LoadU(d, move_[k] + i), hn::LoadU(d, at_[k] + i)), d, move_[k] + i);
        }
      }
    }
  }

  void load_motions(const SweepTile& tile, float* is_bad) {
    constexpr size_t kMotionWidth = D == 2 ? 3 : 7;
    for (size_t q = 0; q < tile.queries.count; ++q) {
      const float* const motion = tile.queries.motions + q * kMotionWidth;
      for (size_t k = 0; k < kMotionWidth; ++k) {
        if (!(std::fabs(motion[k]) <= kLargestCoordinate)) is_bad[q] = 1;
      }
      double axis[3] = {0, 0, 1}, angle = D == 2 ? static_cast<double>(motion[2]) : 0;
      if constexpr (D == 3) {
        if (is_bad[q] == 0 && !axis_and_angle(motion + 3, axis, angle)) is_bad[q] = 1;
      }
      if (!(std::fabs(angle) <= static_cast<double>(kMostTurn))) is_bad[q] = 1;
      if (is_bad[q] != 0) angle = 0;
      turns_ = turns_ || angle != 0;
      for (size_t k = 0; k < 3; ++k) axis_[k][q] = static_cast<float>(axis[k] * angle);
      for (size_t part = 0; part < kParts; ++part) {
        for (size_t k = 0; k < D; ++k) move_[part * D + k][q] = is_bad[q] == 0 ? -motion[k] : 0;
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

  /// Speed and slack of one query, rounded up.
  void set_limits(const SweepTile& tile, size_t q, float* is_bad) {
    double fastest = 0, furthest = 0;
    for (size_t vertex = 0; vertex < kParts; ++vertex) {
      double speed = 0, now = 0, then = 0;
      for (size_t axis = 0; axis < D; ++axis) {
        double at = at_[axis][q], move = move_[axis][q];
        if (vertex > 0) at += at_[vertex * D + axis][q], move += move_[vertex * D + axis][q];
        speed += move * move;
        now += at * at;
        then += (at + move) * (at + move);
      }
      fastest = std::max(fastest, speed);
      furthest = std::max({furthest, now, then});
    }
    fastest = std::sqrt(fastest) * (1 + 1e-5);
    furthest = std::sqrt(furthest) * (1 + 1e-5);
    if constexpr (kParts == 1) {
      if (at_[D][q] < 0) is_bad[q] = 1, at_[D][q] = 0;
      furthest += at_[D][q];
    }
    const double lipschitz = tile.tape->facts.lipschitz;
    double places = kPlaceError, bend = 0;
    if (turns_) {
      double square = 0;
      for (const float* column : axis_) square += static_cast<double>(column[q]) * static_cast<double>(column[q]);
      const double angle = std::sqrt(square) * (1 + 1e-5);
      bend = angle * (angle * furthest + 2 * fastest);
      fastest += angle * furthest;
      places += kTurnError + 4 * angle;
    }
    furthest_[q] = static_cast<float>(furthest);
    bend_[q] = static_cast<float>(bend);
    slack_[q] = static_cast<float>((tile.tape->search_slack(furthest) + places * kUnitRoundoff * lipschitz * furthest) *
                                   (1 + 1e-6));
    per_value_[q] = static_cast<float>(std::min(1 / (lipschitz * fastest), 1e20) * (1 - 1e-6));
  }

  /// Rodrigues' formula, by -t times the angle.
  HWY_INLINE void turn(const uint32_t* query, V32 time, Placed<D, kParts>& placed) const {
    const F32 d;
    V32 w[3];
    for (size_t k = 0; k < 3; ++k) w[k] = placed.axis[k] = gather(axis_[k], query);
    if constexpr (D == 2) {
      const auto angle = hn::Mul(w[2], time);
      const auto sine = sin_of(angle), cosine = cos_of(angle);
      for (auto* vectors : {placed.part, placed.change}) {
        for (size_t part = 0; part < kParts; ++part) {
          const auto x = vectors[part][0], y = vectors[part][1];
          vectors[part][0] = hn::MulAdd(cosine, x, hn::Mul(sine, y));
          vectors[part][1] = hn::NegMulAdd(sine, x, hn::Mul(cosine, y));
        }
      }
    } else {
      const auto square = hn::MulAdd(w[0], w[0], hn::MulAdd(w[1], w[1], hn::Mul(w[2], w[2])));
      const auto angle = hn::Sqrt(square);
      const auto inverse = hn::IfThenElseZero(hn::Gt(square, hn::Zero(d)), hn::Div(hn::Set(d, 1.0F), angle));
      for (auto& component : w) component = hn::Mul(component, inverse);
      const auto sine = sin_of(hn::Mul(angle, time)), cosine = cos_of(hn::Mul(angle, time));
      for (auto* vectors : {placed.part, placed.change}) {
        for (size_t part = 0; part < kParts; ++part) turn_vector(w, sine, cosine, vectors[part]);
      }
    }
  }
  static HWY_INLINE void turn_vector(const V32* n, V32 sine, V32 cosine, V32* p) {
    const F32 d;
    const auto along = hn::MulAdd(n[0], p[0], hn::MulAdd(n[1], p[1], hn::Mul(n[2], p[2])));
    const auto rest = hn::Mul(along, hn::Sub(hn::Set(d, 1.0F), cosine));
    const V32 cross[3] = {hn::MulSub(n[1], p[2], hn::Mul(n[2], p[1])), hn::MulSub(n[2], p[0], hn::Mul(n[0], p[2])),
                          hn::MulSub(n[0], p[1], hn::Mul(n[1], p[0]))};
    for (size_t k = 0; k < 3; ++k) {
      p[k] = hn::MulAdd(n[k], rest, hn::NegMulAdd(sine, cross[k], hn::Mul(cosine, p[k])));
    }
  }

  static constexpr size_t kColumns = kParts == 3 ? 3 * D : D + 1;
  float* at_[kColumns] = {};
  float* move_[kColumns] = {};
  float* axis_[3] = {};  ///< times the angle
  float *per_value_ = nullptr, *slack_ = nullptr, *furthest_ = nullptr, *bend_ = nullptr, *largest_ = nullptr,
        *bad_ = nullptr;
  bool turns_ = false;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
