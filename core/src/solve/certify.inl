// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Certified minimisation of f over many regions at once: branch and bound in waves.
//
//   wave 0   every query is one cell          f(centre), reach  ->  separated / witness / open
//   wave k   every open cell is split         children of all queries side by side in the lanes
//
// A cell with centre c and reach r has min f >= f(c) - L r, or more where enclosures know the shape's parts. A deepest
// point also has far points (far_points.inl), and its wave 0 looks at each query's lowest corner before it splits one.
//
// 1. Cells are exact: dyadic coordinates within the query's region, so that children tile their parent.
// 2. A witness needs f(c) < -slack, a discard needs bound > slack: the slack covers every rounding between the real
//    function over the exact cell and the float32 number at hand.
// 3. Nothing depends on the tile: a query's cells keep the order of its own splits, its incumbent changes between
//    waves only, and of equal values the first in that order wins.
// 4. A minimum on the rim of the region is met by no centre: each wave probes one point more (probes.inl).
// 5. Queries that float32 cannot resolve go on in double (decide.h).
// 6. A wave holds at most kWaveCells cells. Queries that do not fit wait in batches of one level each.
//
// The region of a query (triangle, ball) is the template's Domain (domains.inl). Included once per SIMD target.
#if defined(THALWEG_SOLVE_CERTIFY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_CERTIFY_INL
#undef THALWEG_SOLVE_CERTIFY_INL
#else
#define THALWEG_SOLVE_CERTIFY_INL
#endif

#include <algorithm>
#include <limits>

#include "solve/decide.h"
#include "solve/depth_first.inl"
#include "solve/domains.inl"
#include "solve/far_points.inl"
#include "solve/finish.h"
#include "solve/first_wave.inl"
#include "solve/lowest_points.inl"
#include "solve/probes.inl"
#include "solve/tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

template <class Domain>
class Certifier {
 public:
  static constexpr size_t kChildren = Domain::kChildren;
  static constexpr size_t kCoordinates = Domain::kCoordinates;

  Certifier(const QueryTile& tile, TileScratch& scratch)
      : tile_(tile), limits_(*tile.limits), scratch_(scratch), lowest_points_(tile, domain_, state_) {
    Arena& arena = scratch.arena;
    arena.reset();
    const size_t room = padded(tile.count);
    state_ = QueryState::make(arena, tile.tape->dimension, room);
    domain_.take(arena, room);
    const size_t wave_room = kWaveCells + kChildren * kColumnPadding;
    wave_.take(arena, wave_room, kCoordinates, Domain::kEdgeColumns);
    open_.take(arena, wave_room, kCoordinates);
    next_.take(arena, wave_room, kCoordinates);
    for (float** column : {&threshold_, &open_lower_, &closed_lower_, &cell_open_, &kept_}) {
      *column = arena.take<float>(wave_room);
    }
    probes_.take(arena, wave_room);
    far_points_.take(tile, domain_, state_, arena, wave_room);
    lowest_points_.take(arena, wave_, far_points_, wave_room);
    progress_ = arena.take<Progress>(room);
    touched_ = arena.take<uint32_t>(std::max(room, wave_room) + kColumnPadding);
    hard_ = arena.take<uint32_t>(room);
    for (uint32_t** column : {&probing_, &asked_}) *column = arena.take<uint32_t>(wave_room);
    depth_first_.take(arena, far_points_);
    kernel_scratch_ = arena.take<float>(scratch_floats(*tile.tape));
    tolerance_ = static_cast<float>(limits_.tolerance);
    scratch.waiting.clear();
  }

  void run() {
    FirstWave<Domain> first_wave(tile_, scratch_);
    QueryTile searched = tile_;
    if (!wants_deepest()) {
      searched.count = first_wave.run(kernel_scratch_);
      searched.rows = first_wave.rows();
      if (searched.count == 0) return;
    }
    domain_.load(searched, state_);
    const uint32_t spent = wants_deepest() ? 0 : 1;
    begin_search(lowest_points_.run(searched.count, spent, touched_, kernel_scratch_));
    while (refill()) {
      ++level_;
      bound_children(tile_, domain_, state_.slack, open_, wave_, kernel_scratch_);
      take_incumbents();
      probe();
      close_cells();
      conclude();
      compact();
    }
    for (size_t i = 0; i < hard_count_; ++i) {
      decide_in_double(domain_.region(searched, hard_[i]), limits_, state_, hard_[i], scratch_);
    }
    finish(searched, first_wave.open());
  }

 private:
  /// Writes the results of what was searched, which are all rows or those that wave 0 left open.
  void finish(QueryTile searched, const uint32_t* rows) {
    if (searched.count != tile_.count) {
      searched.columns = scratch_.results.take(tile_.columns, searched.count, tile_.tape->dimension);
    }
    tile_.kernels->finish(searched, state_, kernel_scratch_, scratch_.arena);
    if (searched.count != tile_.count) {
      scratch_.results.scatter({rows, searched.count}, tile_.columns, tile_.tape->dimension);
    }
  }

  /// What one wave learns of a query; valid for the level that it names.
  struct Progress {
    uint32_t level;
    uint32_t open;     ///< open cells
    float open_lower;  ///< least bound over them
    float least;       ///< of the linear model of f over a cell
    uint32_t parent;   ///< that cell's
    bool unresolved;   ///< some open cell is too small for float32
    bool keeps;        ///< the query goes on in the next wave
  };

  [[nodiscard]] bool wants_deepest() const { return limits_.goal == Goal::deepest; }

  /// The queries in touched_ are open as a whole.
  void begin_search(size_t open_count) {
    if (limits_.budget >= DepthFirst<Domain>::kLeastBudget) {
      depth_first_.run(tile_, domain_, state_, {touched_, open_count}, scratch_.waiting, kernel_scratch_);
      for (const WaitingCell& cell : scratch_.waiting) progress_[cell.query].level = 0;
      return;
    }
    for (size_t i = open_count; i-- > 0;) {
      const uint32_t q = touched_[i];
      if (cost_of(1) > limits_.budget - state_.evaluations[q]) {
        state_.converged[q] = goal_reached(limits_, state_, q, state_.lower[q]) ? 1 : 0;
        continue;
      }
      WaitingCell cell{q, 0, 0, {}};
      std::copy_n(Domain::kRoot, kCoordinates, cell.at);
      scratch_.waiting.push_back(cell);
      progress_[q].level = 0;
      state_.lower[q] = kInfinite;
    }
  }

  /// What a wave may take for so many open cells of a query: their children, a far point each, a probe.
  [[nodiscard]] uint32_t cost_of(uint32_t cells) const {
    return static_cast<uint32_t>(kChildren) * cells * (wants_deepest() ? 2 : 1) + 1;
  }

  // --- wave k
  // ---------------------------------------------------------------------------------------------------------

  /// The open cells of the next wave: those left by the last one, or a batch that waits. False at the end.
  bool refill() {
    if (open_.count == 0) {
      auto& waiting = scratch_.waiting;
      if (waiting.empty()) return false;
      // The stack holds whole queries, last ones first; a batch is of one level.
      level_ = waiting.back().level;
      while (!waiting.empty() && waiting.back().level == level_) {
        size_t run = 1;
        const uint32_t q = waiting.back().query;
        while (run < waiting.size() && waiting[waiting.size() - 1 - run].query == q) ++run;
        if ((open_.count + run) * kChildren > kWaveCells) break;
        for (; run > 0; --run) {
          open_.query[open_.count] = q;
          for (size_t k = 0; k < kCoordinates; ++k) open_.at[k][open_.count] = waiting.back().at[k];
          ++open_.count;
          waiting.pop_back();
        }
      }
    }
    return true;
  }

  void take_incumbents() {
    touched_count_ = 0;
    probes_.look(domain_, open_, wave_);
    for (size_t i = 0; i < open_.count; ++i) {
      const uint32_t q = open_.query[i];
      if (progress_[q].level != level_) {
        progress_[q] = {level_, 0, kInfinite, kInfinite, 0, false, false};
        state_.iterations[q] = level_;
        touched_[touched_count_++] = q;
      }
      state_.evaluations[q] += kChildren;
      if (wave_.best[i] < state_.value[q]) adopt(q, i);
      if (probes_.least[i] < progress_[q].least) {
        progress_[q].least = probes_.least[i];
        progress_[q].parent = static_cast<uint32_t>(i);
      }
    }
  }

  void adopt(uint32_t q, size_t parent) {
    size_t at = parent;
    while (wave_.value[at] != wave_.best[parent]) at += wave_.stride;
    float cell[kMostCoordinates];
    for (size_t k = 0; k < kCoordinates; ++k) cell[k] = wave_.at[k][at];
    float uv[2];
    centre_coordinates<Domain>(cell, uv);
    for (int axis = 0; axis < Domain::kAxes; ++axis) state_.point[axis][q] = wave_.centre[axis][at];
    set_incumbent(state_, q, wave_.best[parent], uv);
  }

  /// Looks for lower values off the centres: once for each query that hopes for one. Queries are touched in the order
  /// of their cells, so that what is kept of the probes never overwrites what comes.
  void probe() {
    const float gain = wants_deepest() ? kProbeGain * tolerance_ : 0;
    size_t count = 0;
    for (size_t i = 0; i < touched_count_; ++i) {
      const uint32_t q = touched_[i];
      const bool decided = !wants_deepest() && state_.witness[q] != 0;
      if (decided || !(progress_[q].least < state_.value[q] - gain)) continue;
      probes_.keep(progress_[q].parent, count);
      probing_[count++] = q;
    }
    probes_.evaluate(tile_, count, kernel_scratch_);
    for (size_t i = 0; i < count; ++i) {
      const uint32_t q = probing_[i];
      ++state_.evaluations[q];
      if (!(probes_.value[i] < state_.value[q])) continue;
      for (int axis = 0; axis < Domain::kAxes; ++axis) state_.point[axis][q] = probes_.point[axis][i];
      const float uv[2] = {probes_.uv[0][i], probes_.uv[1][i]};
      set_incumbent(state_, q, probes_.value[i], uv);
    }
  }

  // --- what stays open
  // --------------------------------------------------------------------------------------------------

  /// A cell is closed when its bound is above this: no point of it can change the answer.
  [[nodiscard]] float threshold(uint32_t q) const {
    const bool witness = state_.witness[q] != 0;
    if (!wants_deepest()) return witness ? -kInfinite : 0;
    const float value = state_.value[q] - tolerance_;
    return witness ? value : std::max(0.0F, value);
  }

  void close_cells() {
    const F32 d;
    for (size_t i = 0; i < open_.count; ++i) threshold_[i] = threshold(open_.query[i]);
    if (wants_deepest()) {
      far_points_.raise_bounds({open_.query, threshold_, asked_, open_.count, kChildren}, wave_, kernel_scratch_);
      for (size_t i = 0; i < open_.count; ++i) state_.evaluations[open_.query[i]] += asked_[i];
    }
    const auto infinite = hn::Set(d, kInfinite);
    const auto one = hn::Set(d, 1.0F);
    for (size_t i = 0; i < open_.count; i += hn::Lanes(d)) {
      const auto limit = hn::LoadU(d, threshold_ + i);
      const auto slack = gather(state_.slack, open_.query + i);
      auto closed_least = infinite;
      auto open_least = infinite;
      auto open = hn::Zero(d);
      auto unresolved = hn::Zero(d);
      for (size_t k = 0; k < kChildren; ++k) {
        const auto lower = hn::LoadU(d, wave_.lower + k * wave_.stride + i);
        const auto is_closed = hn::Gt(lower, limit);
        const auto small = hn::Le(hn::LoadU(d, wave_.reach + k * wave_.stride + i), slack);
        closed_least = hn::Min(closed_least, hn::IfThenElse(is_closed, lower, infinite));
        open_least = hn::Min(open_least, hn::IfThenElse(is_closed, infinite, lower));
        open = hn::Add(open, hn::IfThenZeroElse(is_closed, one));
        unresolved = hn::Max(unresolved, hn::IfThenElseZero(hn::AndNot(is_closed, small), one));
      }
      hn::StoreU(closed_least, d, closed_lower_ + i);
      hn::StoreU(open_least, d, open_lower_ + i);
      hn::StoreU(open, d, cell_open_ + i);
      hn::StoreU(unresolved, d, kept_ + i);
    }
    for (size_t i = 0; i < open_.count; ++i) {
      const uint32_t q = open_.query[i];
      state_.lower[q] = std::min(state_.lower[q], closed_lower_[i]);
      progress_[q].open += static_cast<uint32_t>(cell_open_[i]);
      progress_[q].open_lower = std::min(progress_[q].open_lower, open_lower_[i]);
      progress_[q].unresolved = progress_[q].unresolved || kept_[i] != 0;
    }
  }

  /// Decides for each query of the wave whether it goes on.
  void conclude() {
    for (size_t i = 0; i < touched_count_; ++i) {
      const uint32_t q = touched_[i];
      Progress& p = progress_[q];
      if (p.open == 0) {
        state_.converged[q] = 1;
        continue;
      }
      const float lower = std::min(state_.lower[q], p.open_lower);
      // float32 can tell no more when no bound is further below the incumbent than its slack lets it seem.
      p.unresolved = p.unresolved || p.open_lower >= state_.value[q] - 2 * state_.slack[q];
      const size_t next = p.open * kChildren;
      const uint32_t cost = cost_of(p.open);
      const bool spent = cost > limits_.budget || state_.evaluations[q] > limits_.budget - cost;
      const bool reached = goal_reached(limits_, state_, q, lower);
      if (spent || (reached && state_.evaluations[q] > limits_.budget / kTouchingEffort)) {
        state_.lower[q] = lower;
        state_.converged[q] = reached ? 1 : 0;
      } else if (p.unresolved || next > kWaveCells) {
        state_.lower[q] = lower;
        state_.converged[q] = reached ? 1 : 0;
        if (can_decide(limits_.budget - state_.evaluations[q])) hard_[hard_count_++] = q;
      } else {
        p.keeps = true;
      }
    }
  }

  void compact() {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    for (size_t i = 0; i < open_.count; ++i) kept_[i] = progress_[open_.query[i]].keeps ? 1 : 0;
    size_t kept = 0;
    for (size_t k = 0; k < kChildren; ++k) {
      for (size_t i = 0; i < open_.count; i += hn::Lanes(d)) {
        const size_t at = k * wave_.stride + i;
        const auto keeps = hn::Gt(hn::LoadU(d, kept_ + i), hn::Zero(d));
        const auto is_closed = hn::Gt(hn::LoadU(d, wave_.lower + at), hn::LoadU(d, threshold_ + i));
        const auto here = hn::FirstN(d, HWY_MIN(open_.count - i, hn::Lanes(d)));
        const auto stays = hn::And(here, hn::AndNot(is_closed, keeps));
        if (hn::AllFalse(d, stays)) continue;
        for (size_t c = 0; c < kCoordinates; ++c) {
          hn::CompressStore(hn::LoadU(d, wave_.at[c] + at), stays, d, next_.at[c] + kept);
        }
        kept += hn::CompressStore(hn::LoadU(du, open_.query + i), hn::RebindMask(du, stays), du, next_.query + kept);
      }
    }
    next_.count = kept;
    if (kept * kChildren > kWaveCells) put_off();
    std::swap(open_, next_);
    next_.count = 0;
  }

  /// Keeps as many whole queries as the next wave can hold, in order; the others wait.
  void put_off() {
    size_t taken = 0;
    for (size_t i = 0; i < touched_count_; ++i) {
      Progress& p = progress_[touched_[i]];
      if (!p.keeps) continue;
      p.keeps = (taken + p.open) * kChildren <= kWaveCells;
      if (p.keeps) taken += p.open;
    }
    auto& waiting = scratch_.waiting;
    const size_t before = waiting.size();
    size_t kept = 0;
    for (size_t i = 0; i < next_.count; ++i) {
      const uint32_t q = next_.query[i];
      if (progress_[q].keeps) {
        next_.query[kept] = q;
        for (size_t k = 0; k < kCoordinates; ++k) next_.at[k][kept] = next_.at[k][i];
        ++kept;
      } else {
        WaitingCell cell{q, level_, static_cast<uint32_t>(i), {}};
        for (size_t k = 0; k < kCoordinates; ++k) cell.at[k] = next_.at[k][i];
        waiting.push_back(cell);
      }
    }
    next_.count = kept;
    // Whole queries side by side, each in the order of its cells when taken from the end.
    std::sort(waiting.begin() + static_cast<std::ptrdiff_t>(before), waiting.end(),
              [](const WaitingCell& a, const WaitingCell& b) {
                return a.query != b.query ? a.query > b.query : a.order > b.order;
              });
  }

  const QueryTile& tile_;
  const SolveLimits& limits_;
  TileScratch& scratch_;
  Domain domain_;
  QueryState state_;
  DepthFirst<Domain> depth_first_;
  WaveColumns wave_;
  CellList open_;  ///< parents of the wave
  CellList next_;  ///< parents of the next one
  uint32_t level_ = 0;
  float tolerance_ = 0;
  float* kernel_scratch_ = nullptr;
  Progress* progress_ = nullptr;  ///< per query
  uint32_t* touched_ = nullptr;   ///< queries of the wave
  size_t touched_count_ = 0;
  uint32_t* probing_ = nullptr;  ///< queries whose probes are evaluated
  uint32_t* asked_ = nullptr;    ///< far points, per parent
  uint32_t* hard_ = nullptr;     ///< queries that go on in double
  size_t hard_count_ = 0;
  Probes<Domain> probes_;
  FarPoints<Domain> far_points_;
  LowestPoints<Domain> lowest_points_;
  // Per parent of the wave.
  float* threshold_ = nullptr;
  float* closed_lower_ = nullptr;
  float* open_lower_ = nullptr;
  float* cell_open_ = nullptr;
  float* kept_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
