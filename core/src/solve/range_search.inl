// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Certified minimisation over many regions at once for tapes with formulas, which have no Lipschitz constant and whose
// rounding is known afterwards only. Every bound is the range that intervals give for a cell (kernels/ranges.inl), and
// a witness is a point whose own range, that of a cell of no size, lies below 0.
//
// Branch and bound in waves, breadth first, as certify.inl does it, and with its rules: cells are exact, what is done
// with a query depends on its own cells alone, incumbents change between waves. What is different is that a formula
// costs far more than the handling of a cell, which is therefore not vectorised, and that an incumbent's `slack` is the
// proven error of its own value. Queries go through in groups, each to its end, so that memory stays bounded.
// Included once per SIMD target.
#if defined(THALWEG_SOLVE_RANGE_SEARCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_RANGE_SEARCH_INL
#undef THALWEG_SOLVE_RANGE_SEARCH_INL
#else
#define THALWEG_SOLVE_RANGE_SEARCH_INL
#endif

#include <algorithm>
#include <limits>

#include "solve/decide.h"
#include "solve/domains.inl"
#include "solve/finish.h"
#include "solve/prove.h"
#include "solve/tile.h"
#include "solve/wave.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <class Domain>
class RangeSearch {
 public:
  static constexpr size_t kChildren = Domain::kChildren;
  static constexpr size_t kCoordinates = Domain::kCoordinates;
  static constexpr size_t kAxes = Domain::kAxes;
  /// Queries under way at once.
  static constexpr size_t kGroup = 64;
  /// Open cells of one query; one that needs more goes on in double.
  static constexpr size_t kMostOpen = 1024;
  /// Cells that one pass splits.
  static constexpr size_t kParents = 2048;
  /// A point that is proven, and one found by a probe.
  static constexpr uint32_t kPolish = 4;

  RangeSearch(const QueryTile& tile, TileScratch& scratch) : tile_(tile), limits_(*tile.limits), scratch_(scratch) {
    Arena& arena = scratch.arena;
    arena.reset();
    state_ = QueryState::make(arena, tile.tape->dimension, tile.count);
    domain_.take(arena, tile.count);
    const size_t room = kChildren * (kParents + kColumnPadding);
    wave_.take(arena, room, kCoordinates, Domain::kEdgeColumns);
    upper_ = arena.take<float>(room);
    wave_place_ = arena.take<float>(room);
    parents_.take(arena, kParents + kColumnPadding, kCoordinates);
    open_.take(arena, kGroup * kMostOpen, kCoordinates);
    next_.take(arena, kGroup * kMostOpen, kCoordinates);
    points_.take(arena, kGroup, tile.tape->dimension);
    place_ = arena.take<float>(padded(tile.count));
    coarse_ = arena.take<float>(padded(tile.count));
    hard_ = arena.take<uint32_t>(padded(tile.count));
    kernel_scratch_ = arena.take<float>(scratch_floats(*tile.tape));
  }

  void run() {
    domain_.load(tile_, state_);
    tile_.kernels->value(*tile_.tape, state_.point, tile_.count, state_.value, kernel_scratch_);
    for (size_t q = 0; q < tile_.count; ++q) begin(q);
    for (size_t first = 0; first < tile_.count; first += kGroup) {
      search_group(first, std::min(first + kGroup, tile_.count));
    }
    for (size_t i = 0; i < hard_count_; ++i) {
      decide_in_double(domain_.region(tile_, hard_[i]), limits_, state_, hard_[i], scratch_);
    }
    for (size_t q = 0; q < tile_.count; ++q) conclude_undefined(state_, q);
    tile_.kernels->finish(tile_, state_, kernel_scratch_, scratch_.arena);
  }

 private:
  [[nodiscard]] bool wants_deepest() const { return limits_.goal == Goal::deepest; }

  void begin(size_t q) {
    const auto largest = static_cast<double>(domain_.largest()[q]);
    place_[q] = place_rounding(largest);
    coarse_[q] = rounded_up(tile_.tape->enclosure_slack(largest));
    if (!(std::fabs(state_.value[q]) < kInfinite)) state_.value[q] = kInfinite;
    state_.slack[q] = kInfinite;
    state_.lower[q] = kInfinite;
    state_.witness[q] = state_.converged[q] = 0;
    state_.evaluations[q] = 1;
    state_.iterations[q] = 0;
  }

  void search_group(size_t first, size_t last) {
    open_.count = 0;
    points_.count = 0;
    for (size_t q = first; q < last; ++q) {
      if (state_.is_bad[q] != 0) continue;
      for (size_t k = 0; k < kCoordinates; ++k) open_.at[k][open_.count] = Domain::kRoot[k];
      open_.query[open_.count++] = static_cast<uint32_t>(q);
      if (state_.value[q] < kInfinite && limits_.budget > 1) add_point(q, Domain::kRoot, state_.point, q);
    }
    prove();
    drop_decided();
    for (uint32_t level = 1; open_.count > 0; ++level) {
      next_.count = 0;
      for (size_t at = 0; at < open_.count;) at = take_parents(at, level);
      std::swap(open_, next_);
    }
  }

  /// Queries that are done, or may not go on, before any cell is split.
  void drop_decided() {
    size_t kept = 0;
    for (size_t i = 0; i < open_.count; ++i) {
      const uint32_t q = open_.query[i];
      const bool done = !wants_deepest() && state_.witness[q] != 0;
      if (done || state_.evaluations[q] + kChildren + kPolish > limits_.budget) {
        state_.lower[q] = -kInfinite;
        state_.converged[q] = done ? 1 : 0;
        continue;
      }
      open_.query[kept++] = q;  // roots are all alike
    }
    open_.count = kept;
  }

  // --- one pass --------------------------------------------------------------------------------------------------

  /// Splits as many whole queries from an open cell on as a pass can hold; returns where it stopped.
  size_t take_parents(size_t begin, uint32_t level) {
    parents_.count = 0;
    size_t at = begin;
    while (at < open_.count) {
      const size_t end = end_of_query(open_, at);
      if (parents_.count + (end - at) > kParents) break;
      for (; at < end; ++at, ++parents_.count) {
        parents_.query[parents_.count] = open_.query[at];
        for (size_t k = 0; k < kCoordinates; ++k) parents_.at[k][parents_.count] = open_.at[k][at];
      }
    }
    bound_wave();
    points_.count = 0;
    for (size_t i = 0; i < parents_.count; i = end_of_query(parents_, i)) find_incumbent(i);
    prove();
    if (wants_deepest()) probe();
    for (size_t i = 0; i < parents_.count; i = end_of_query(parents_, i)) conclude(i, level);
    return at;
  }

  static size_t end_of_query(const CellList& cells, size_t at) {
    size_t end = at + 1;
    while (end < cells.count && cells.query[end] == cells.query[at]) ++end;
    return end;
  }

  void bound_wave() {
    pad_parents<Domain>(parents_, wave_);
    domain_.split(parents_, wave_);
    for (size_t k = 0; k < kChildren; ++k) {
      for (size_t i = 0; i < wave_.stride; ++i) wave_place_[k * wave_.stride + i] = place_[parents_.query[i]];
    }
    CellColumns cells;
    cells.reach = wave_.reach;
    for (size_t i = 0; i < Domain::kEdgeColumns; ++i) cells.edges[i] = wave_.edges[i];
    cells.is_box = Domain::kIsBall;
    cells.place = wave_place_;
    tile_.kernels->ranges(*tile_.tape, wave_.centre, cells, kChildren * wave_.stride,
                          {wave_.lower, wave_.value, upper_}, kernel_scratch_);
    for (size_t k = 0; k < kChildren; ++k) {
      for (size_t i = 0; i < wave_.stride; ++i) {
        const size_t child = k * wave_.stride + i;
        const bool misses = wave_.reach[child] == kMisses;
        wave_.lower[child] = misses ? kInfinite : below(wave_.lower[child] - coarse_[parents_.query[i]]);
        if (misses) wave_.value[child] = kInfinite;
      }
    }
  }
  /// A difference, rounded down.
  static float below(float x) { return std::nextafter(x, -kInfinite); }

  /// The least value at a centre of a query's new cells, where it is the least so far. The first of equal ones.
  void find_incumbent(size_t first) {
    const uint32_t q = parents_.query[first];
    const size_t last = end_of_query(parents_, first);
    state_.evaluations[q] += static_cast<uint32_t>(kChildren * (last - first));
    float least = state_.value[q];
    size_t found = kNowhere;
    for (size_t i = first; i < last; ++i) {
      for (size_t k = 0; k < kChildren; ++k) {
        const size_t child = k * wave_.stride + i;
        if (!(wave_.value[child] < least)) continue;
        least = wave_.value[child];
        found = child;
      }
    }
    if (found == kNowhere) return;
    float cell[kMostCoordinates];
    for (size_t k = 0; k < kCoordinates; ++k) cell[k] = wave_.at[k][found];
    point_child_[points_.count] = found;
    add_point(q, cell, wave_.centre, found);
  }
  static constexpr size_t kNowhere = ~size_t{0};

  // --- incumbents ------------------------------------------------------------------------------------------------

  void add_point(size_t q, const float* cell, const float* const* from, size_t at) {
    const size_t i = points_.count++;
    points_.query[i] = static_cast<uint32_t>(q);
    points_.place[i] = place_[q];
    for (size_t axis = 0; axis < kAxes; ++axis) points_.at[axis][i] = from[axis][at];
    centre_coordinates<Domain>(cell, point_uv_[i]);
  }

  /// Proves what can be said of the points, and makes them their queries' incumbents where they are better. What is
  /// left in the list are those.
  void prove() {
    prove_points(*tile_.tape, *tile_.kernels, points_, kernel_scratch_);
    size_t kept = 0;
    for (size_t i = 0; i < points_.count; ++i) {
      const uint32_t q = points_.query[i];
      state_.evaluations[q] += 1;
      const double upper = static_cast<double>(points_.upper[i]) + static_cast<double>(coarse_[q]);
      const bool witness = upper < 0;
      const bool better = points_.value[i] <= state_.value[q] && (witness || state_.witness[q] == 0);
      if (!better) continue;
      state_.value[q] = points_.value[i];
      state_.slack[q] = rounded_up(upper - static_cast<double>(points_.value[i]));
      state_.witness[q] = witness ? 1 : 0;
      for (size_t k = 0; k < 2; ++k) state_.barycentric[k][q] = point_uv_[i][k];
      for (size_t axis = 0; axis < kAxes; ++axis) state_.point[axis][q] = points_.at[axis][i];
      keep_point(i, kept++);
    }
    points_.count = kept;
  }
  void keep_point(size_t from, size_t to) {
    points_.query[to] = points_.query[from];
    points_.place[to] = points_.place[from];
    for (size_t axis = 0; axis < kAxes; ++axis) points_.at[axis][to] = points_.at[axis][from];
    point_child_[to] = point_child_[from];
  }

  /// Looks once where the linear model of f is least over the cell of each new incumbent: a minimum on the rim of the
  /// region is met by no centre.
  void probe() {
    float* const gradient[3] = {points_.slope[0], points_.slope[1], points_.slope[2]};
    tile_.kernels->gradient(*tile_.tape, points_.at, points_.count, nullptr, gradient, kernel_scratch_);
    for (size_t i = 0; i < points_.count; ++i) {
      const size_t child = point_child_[i];
      for (size_t axis = 0; axis < kAxes; ++axis) wave_.gradient[axis][child] = gradient[axis][i];
      const auto low = domain_.lowest(wave_, child, parents_.query + child % wave_.stride);
      for (size_t axis = 0; axis < kAxes; ++axis) points_.at[axis][i] = hn::GetLane(low.point[axis]);
      for (size_t k = 0; k < 2; ++k) point_uv_[i][k] = hn::GetLane(low.uv[k]);
      state_.evaluations[points_.query[i]] += 1;
    }
    prove();
  }

  // --- what stays open -------------------------------------------------------------------------------------------

  /// A cell is closed when its bound is above this: no point of it can change the answer.
  [[nodiscard]] float threshold(uint32_t q) const {
    const bool witness = state_.witness[q] != 0;
    if (!wants_deepest()) return witness ? -kInfinite : 0;
    const float value = state_.value[q] - static_cast<float>(limits_.tolerance);
    return witness ? value : std::max(0.0F, value);
  }

  /// Closes what can be closed of one query's cells, and decides whether the others are split in turn.
  void conclude(size_t first, uint32_t level) {
    const uint32_t q = parents_.query[first];
    const size_t last = end_of_query(parents_, first);
    const float limit = threshold(q);
    const bool done = !wants_deepest() && state_.witness[q] != 0;
    const size_t begin = next_.count;
    float open_lower = kInfinite;
    bool is_fine = false;
    bool fits = true;
    for (size_t child = 0; child < kChildren; ++child) {
      for (size_t i = first; i < last; ++i) {
        const size_t at = child * wave_.stride + i;
        if (done || wave_.lower[at] > limit) {
          state_.lower[q] = std::min(state_.lower[q], wave_.lower[at]);
          continue;
        }
        open_lower = std::min(open_lower, wave_.lower[at]);
        is_fine = is_fine || wave_.reach[at] <= 4 * place_[q];
        fits = fits && next_.count - begin < kMostOpen;
        if (!fits) continue;
        next_.query[next_.count] = q;
        for (size_t k = 0; k < kCoordinates; ++k) next_.at[k][next_.count] = wave_.at[k][at];
        ++next_.count;
      }
    }
    state_.iterations[q] = level;
    const size_t open = next_.count - begin;
    if (!fits || !goes_on(q, open, open_lower, is_fine)) next_.count = begin;
    if (!fits) leave(q, std::min(state_.lower[q], open_lower), true);
  }

  /// What is said of a query that ends, or goes on in double.
  void leave(uint32_t q, float lower, bool is_hard) {
    state_.lower[q] = lower;
    state_.converged[q] = goal_reached(limits_, state_, q, lower) ? 1 : 0;
    if (is_hard && can_decide(limits_.budget - state_.evaluations[q], true)) hard_[hard_count_++] = q;
  }

  bool goes_on(uint32_t q, size_t open, float open_lower, bool is_fine) {
    if (open == 0) {
      state_.converged[q] = 1;
      return false;
    }
    const float lower = std::min(state_.lower[q], open_lower);
    // float32 can tell no more when no bound is further below the incumbent than its error lets it seem.
    const bool is_known = state_.slack[q] < kInfinite;
    const bool unresolved = is_fine || (is_known && open_lower >= state_.value[q] - 2 * state_.slack[q]);
    const size_t next = open * kChildren + kPolish;
    const bool spent = next > limits_.budget || state_.evaluations[q] > limits_.budget - next;
    const bool reached = goal_reached(limits_, state_, q, lower);
    const bool enough = reached && state_.evaluations[q] > limits_.budget / kTouchingEffort;
    if (!spent && !enough && !unresolved) return true;
    leave(q, lower, !spent && !enough);
    return false;
  }

  const QueryTile& tile_;
  const SolveLimits& limits_;
  TileScratch& scratch_;
  Domain domain_;
  QueryState state_;
  WaveColumns wave_;
  float* upper_ = nullptr;       ///< of the wave
  float* wave_place_ = nullptr;  ///< per child
  CellList parents_;             ///< of the wave
  CellList open_, next_;         ///< of the group, by query
  ProvenPoints points_;
  float point_uv_[kGroup][2] = {};
  size_t point_child_[kGroup] = {};  ///< whose centre it is
  float* place_ = nullptr;           ///< per query
  float* coarse_ = nullptr;          ///< per query: what its ranges leave to be added
  uint32_t* hard_ = nullptr;
  size_t hard_count_ = 0;
  float* kernel_scratch_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
