// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Certified minimisation of f over many regions at once: branch and bound in waves.
//
//   wave 0   every query is one cell          f(centre), reach  ->  separated / witness / open
//   wave k   every open cell is split         children of all queries side by side in the lanes
//
// A cell with centre c and reach r has min f >= f(c) - L r, or more where enclosures know the shape's parts.
//
// 1. Cells are exact: dyadic coordinates within the query's region, so that children tile their parent.
// 2. A witness needs f(c) < -slack, a discard needs bound > slack: the slack covers every rounding between the real
//    function over the exact cell and the float32 number at hand.
// 3. Nothing depends on the tile: a query's cells keep the order of its own splits, its incumbent changes between
//    waves only, and of equal values the first in that order wins.
// 4. The incumbent is polished by one probe down its gradient, because a minimum on the rim of the region is met by
//    no centre.
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
#include "solve/finish.h"
#include "solve/tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Children that one wave may hold.
inline constexpr size_t kWaveCells = 8192;
/// From this level on enclosures are used where they can say more than f(c) - L r: they cost about two values.
inline constexpr uint32_t kFirstEnclosureLevel = 2;
/// From this level on a verdict's incumbents are polished; a deepest point's are from the start.
inline constexpr uint32_t kFirstProbeLevel = 4;

template <class Domain>
class Certifier {
 public:
  static constexpr size_t kChildren = Domain::kChildren;
  static constexpr size_t kCoordinates = Domain::kCoordinates;

  Certifier(const QueryTile& tile, TileScratch& scratch) : tile_(tile), limits_(*tile.limits), scratch_(scratch) {
    Arena& arena = scratch.arena;
    arena.reset();
    const size_t room = padded(tile.count);
    state_ = QueryState::make(arena, tile.tape->dimension, tile.count);
    domain_.take(arena, tile.count);
    const size_t wave_room = kWaveCells + kChildren * kColumnPadding;
    wave_.take(arena, wave_room, kCoordinates, Domain::kEdgeColumns);
    open_.take(arena, wave_room, kCoordinates);
    next_.take(arena, wave_room, kCoordinates);
    for (float*& column : cell_) column = arena.take<float>(room);
    for (float** column : {&threshold_, &open_lower_, &kept_}) *column = arena.take<float>(wave_room);
    closed_lower_ = arena.take<float>(wave_room);
    cell_lower_ = arena.take<float>(wave_room);
    cell_open_ = arena.take<float>(wave_room);
    progress_ = arena.take<Progress>(room);
    touched_ = arena.take<uint32_t>(std::max(room, wave_room) + kColumnPadding);
    hard_ = arena.take<uint32_t>(room);
    depth_first_.take(arena);
    kernel_scratch_ = arena.take<float>(scratch_floats(*tile.tape));
    tolerance_ = static_cast<float>(limits_.tolerance);
    scratch.waiting.clear();
  }

  void run() {
    domain_.load(tile_, state_);
    first_wave();
    while (refill()) {
      ++level_;
      const bool encloses = level_ >= kFirstEnclosureLevel && (tile_.tape->has_support || wants_deepest());
      bound_children(tile_, domain_, state_.slack, open_, wave_, encloses, kernel_scratch_);
      take_incumbents();
      if (limits_.goal == Goal::deepest || level_ >= kFirstProbeLevel) probe();
      close_cells();
      conclude();
      compact();
    }
    for (size_t i = 0; i < hard_count_; ++i) {
      decide_in_double(domain_.region(tile_, hard_[i]), limits_, state_, hard_[i], scratch_);
    }
    tile_.kernels->finish(tile_, state_, kernel_scratch_, scratch_.arena);
  }

 private:
  /// What one wave learns of a query; valid for the level that it names.
  struct Progress {
    uint32_t level;
    uint32_t open;     ///< open cells
    float open_lower;  ///< least bound over them
    bool improved;     ///< the incumbent is of this wave
    bool unresolved;   ///< some open cell is too small for float32
    bool keeps;        ///< the query goes on in the next wave
  };

  [[nodiscard]] bool wants_deepest() const { return limits_.goal == Goal::deepest; }

  // --- wave 0
  // ---------------------------------------------------------------------------------------------------------

  void first_wave() {
    const size_t n = tile_.count;
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    // Rounded up: the slack is a claim.
    const auto slack_a = hn::Set(d, static_cast<float>(limits_.slack.a * (1 + 1e-6)));
    const auto slack_b = hn::Set(d, static_cast<float>(limits_.slack.b * (1 + 1e-6)));
    tile_.kernels->value(*tile_.tape, state_.point, n, state_.value, kernel_scratch_);
    const auto lipschitz = hn::Set(d, static_cast<float>(tile_.tape->facts.lipschitz));
    const auto tolerance = hn::Set(d, wants_deepest() ? tolerance_ : kInfinite);
    const auto one = hn::Set(d, 1.0F);
    size_t open_count = 0;
    for (size_t i = 0; i < n; i += hn::Lanes(d)) {
      const auto slack = hn::MulAdd(slack_b, hn::LoadU(d, domain_.largest() + i), slack_a);
      const auto f = hn::LoadU(d, state_.value + i);
      const auto lower = hn::Sub(hn::NegMulAdd(lipschitz, hn::LoadU(d, domain_.reach() + i), f), slack);
      const auto witness = hn::Lt(f, hn::Neg(slack));
      const auto known = hn::Or(witness, hn::Gt(lower, hn::Zero(d)));
      const auto closed = hn::And(known, hn::Ge(lower, hn::Sub(f, tolerance)));
      const auto bad = hn::Gt(hn::LoadU(d, state_.is_bad + i), hn::Zero(d));
      const auto here = hn::FirstN(d, HWY_MIN(n - i, hn::Lanes(d)));
      const auto open = hn::AndNot(hn::Or(closed, bad), here);
      hn::StoreU(slack, d, state_.slack + i);
      hn::StoreU(lower, d, state_.lower + i);
      hn::StoreU(hn::IfThenElseZero(witness, one), d, state_.witness + i);
      hn::StoreU(hn::IfThenElse(open, hn::Zero(d), one), d, state_.converged + i);
      hn::StoreU(hn::Set(du, 1), du, state_.evaluations + i);
      hn::StoreU(hn::Zero(du), du, state_.iterations + i);
      const auto index = hn::Iota(du, static_cast<uint32_t>(i));
      hn::StoreU(hn::Compress(index, hn::RebindMask(du, open)), du, touched_ + open_count);
      open_count += hn::CountTrue(d, open);
    }
    begin_search(open_count);
  }

  /// The queries in touched_ are open as a whole.
  void begin_search(size_t open_count) {
    if (!wants_deepest() && limits_.budget >= DepthFirst<Domain>::kLeastBudget) {
      depth_first_.run(tile_, domain_, state_, {touched_, open_count}, scratch_.waiting, kernel_scratch_);
      for (const WaitingCell& cell : scratch_.waiting) progress_[cell.query].level = 0;
      return;
    }
    for (size_t i = 0; i < open_count; ++i) {
      const uint32_t q = touched_[i];
      for (size_t k = 0; k < kCoordinates; ++k) cell_[k][q] = Domain::kRoot[k];
      progress_[q] = {0, 1, state_.lower[q], true, false, true};
    }
    touched_count_ = open_count;
    if (wants_deepest()) probe();
    for (size_t i = open_count; i-- > 0;) {
      const uint32_t q = touched_[i];
      if (state_.evaluations[q] + kChildren > limits_.budget) {
        state_.converged[q] = goal_reached(limits_, state_, q, state_.lower[q]) ? 1 : 0;
        continue;
      }
      WaitingCell cell{q, 0, 0, {}};
      std::copy_n(Domain::kRoot, kCoordinates, cell.at);
      scratch_.waiting.push_back(cell);
      state_.lower[q] = kInfinite;
    }
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
    for (size_t i = 0; i < open_.count; ++i) {
      const uint32_t q = open_.query[i];
      if (progress_[q].level != level_) {
        progress_[q] = {level_, 0, kInfinite, false, false, false};
        state_.iterations[q] = level_;
        touched_[touched_count_++] = q;
      }
      state_.evaluations[q] += kChildren;
      if (wave_.best[i] < state_.value[q]) adopt(q, i);
    }
  }

  void adopt(uint32_t q, size_t parent) {
    size_t at = parent;
    while (wave_.value[at] != wave_.best[parent]) at += wave_.stride;
    float cell[kMostCoordinates];
    for (size_t k = 0; k < kCoordinates; ++k) cell_[k][q] = cell[k] = wave_.at[k][at];
    float uv[2];
    centre_coordinates<Domain>(cell, uv);
    for (int axis = 0; axis < Domain::kAxes; ++axis) state_.point[axis][q] = wave_.centre[axis][at];
    set_incumbent(q, wave_.best[parent], uv);
    progress_[q].improved = true;
  }

  void set_incumbent(uint32_t q, float value, const float* uv) {
    state_.value[q] = value;
    state_.barycentric[0][q] = uv[0];
    state_.barycentric[1][q] = uv[1];
    if (value < -state_.slack[q]) state_.witness[q] = 1;
  }

  // --- probes
  // -----------------------------------------------------------------------------------------------------------

  /// Looks once for a lower value near each new incumbent.
  void probe() {
    const size_t room = kWaveCells;
    for (size_t first = 0; first < touched_count_;) {
      size_t count = 0;
      for (; first < touched_count_ && count < room; ++first) {
        const uint32_t q = touched_[first];
        const bool decided = !wants_deepest() && state_.witness[q] != 0;
        if (!progress_[q].improved || decided || state_.evaluations[q] + 2 > limits_.budget) continue;
        next_.query[count] = q;
        for (int axis = 0; axis < Domain::kAxes; ++axis) next_.at[axis][count] = state_.point[axis][q];
        ++count;
      }
      probe_list(count);
    }
  }

  /// next_ lends its columns: it is empty between compactions. The wave's edges and reach have been used.
  void probe_list(size_t count) {
    constexpr size_t kAxes = Domain::kAxes;
    float* points[3] = {next_.at[0], next_.at[1], kAxes == 3 ? next_.at[2] : nullptr};
    float* gradient[3] = {threshold_, open_lower_, kAxes == 3 ? kept_ : nullptr};
    tile_.kernels->gradient(*tile_.tape, points, count, closed_lower_, gradient, kernel_scratch_);
    float* u = cell_lower_;
    float* v = cell_open_;
    for (size_t i = 0; i < count; ++i) {
      const uint32_t q = next_.query[i];
      float cell[kMostCoordinates];
      for (size_t k = 0; k < kCoordinates; ++k) cell[k] = cell_[k][q];
      float from[3] = {};
      float slope[3] = {};
      for (size_t axis = 0; axis < kAxes; ++axis) {
        from[axis] = points[axis][i];
        slope[axis] = gradient[axis][i];
      }
      float to[3] = {};
      float uv[2] = {};
      domain_.probe(q, cell, from, slope, to, uv);
      for (size_t axis = 0; axis < kAxes; ++axis) points[axis][i] = to[axis];
      u[i] = uv[0];
      v[i] = uv[1];
    }
    tile_.kernels->value(*tile_.tape, points, count, closed_lower_, kernel_scratch_);
    for (size_t i = 0; i < count; ++i) {
      const uint32_t q = next_.query[i];
      state_.evaluations[q] += 2;
      if (!(closed_lower_[i] < state_.value[q])) continue;
      for (size_t axis = 0; axis < kAxes; ++axis) state_.point[axis][q] = points[axis][i];
      const float uv[2] = {u[i], v[i]};
      set_incumbent(q, closed_lower_[i], uv);
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
      const bool spent = next > limits_.budget || state_.evaluations[q] > limits_.budget - next;
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
  float* cell_[kCoordinates] = {};  ///< per query: the cell whose centre is, or led to, the incumbent
  Progress* progress_ = nullptr;    ///< per query
  uint32_t* touched_ = nullptr;     ///< queries of the wave
  size_t touched_count_ = 0;
  uint32_t* hard_ = nullptr;  ///< queries that go on in double
  size_t hard_count_ = 0;
  // Per parent of the wave; probes borrow them.
  float* threshold_ = nullptr;
  float* closed_lower_ = nullptr;
  float* open_lower_ = nullptr;
  float* cell_lower_ = nullptr;
  float* cell_open_ = nullptr;
  float* kept_ = nullptr;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
