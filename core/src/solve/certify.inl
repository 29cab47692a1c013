// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Certified minimisation of f over many regions at once: branch and bound in waves.
//
//   wave 0   every query is one cell          f(centre), reach  ->  separated / witness / open
//   wave k   every open cell is split         children of all queries side by side in the lanes
//
// A cell with centre c and reach r has min f >= f(c) - L r, or more where enclosures know convex parts.
//
// 1. Cells are exact: dyadic coordinates and a signed power of two for the size, so that children tile their parent
//    and reaches are scaled, not computed again.
// 2. A witness needs f(c) < -slack, a discard needs bound > slack: the slack covers every rounding between the real
//    function over the exact cell and the float32 number at hand.
// 3. Nothing depends on the tile: a query's cells keep the order of its own splits, its incumbent changes between
//    waves only, and of equal values the first in that order wins.
// 4. Cells that float32 cannot resolve send their query to the search in double (decide.h).
// 5. A wave holds at most kWaveCells cells. Queries that do not fit wait in batches of one level each.
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
#include "solve/domains.inl"
#include "solve/finish.h"
#include "solve/tile.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Children that one wave may hold.
inline constexpr size_t kWaveCells = 8192;
/// From this level on enclosures are used where the tape has support functions: their gradients cost about twice a
/// value, and most queries end before.
inline constexpr uint32_t kFirstEnclosureLevel = 2;
/// Once touching is proven, this part of the budget may have gone into proving more.
inline constexpr uint32_t kTouchingEffort = 4;

template <class Domain>
class Certifier {
 public:
  static constexpr size_t kChildren = Domain::kChildren;

  Certifier(const QueryTile& tile, TileScratch& scratch) : tile_(tile), limits_(*tile.limits), scratch_(scratch) {
    Arena& arena = scratch.arena;
    arena.reset();
    state_ = QueryState::make(arena, tile.tape->dimension, tile.count);
    domain_.take(arena, tile.count);
    wave_.take(arena, kWaveCells, Domain::kEdgeColumns);
    kernel_scratch_ = arena.take<float>(scratch_floats(*tile.tape));
    open_ = arena.take<OpenCell>(kWaveCells);
    hard_ = arena.take<uint32_t>(tile.count);
    scratch.waiting.clear();
  }

  void run() {
    domain_.load(tile_, state_);
    first_wave();
    while (refill()) {
      ++level_;
      expand();
      evaluate();
      reduce();
    }
    for (size_t i = 0; i < hard_count_; ++i) decide_in_double(hard_[i]);
    finish(tile_, state_, kernel_scratch_, scratch_.arena);
  }

 private:
  // --- wave 0 ---------------------------------------------------------------------------------------------------------

  void first_wave() {
    const size_t n = tile_.count;
    const F32 d;
    // Rounded up: the slack is a claim.
    const auto slack_a = hn::Set(d, static_cast<float>(limits_.slack.a * (1 + 1e-6)));
    const auto slack_b = hn::Set(d, static_cast<float>(limits_.slack.b * (1 + 1e-6)));
    for (size_t i = 0; i < n; i += hn::Lanes(d)) {
      hn::StoreU(hn::MulAdd(slack_b, hn::LoadU(d, domain_.largest() + i), slack_a), d, state_.slack + i);
    }
    tile_.kernels->value(*tile_.tape, state_.point, n, state_.value, kernel_scratch_);
    const auto lipschitz = hn::Set(d, static_cast<float>(tile_.tape->facts.lipschitz));
    for (size_t i = 0; i < n; i += hn::Lanes(d)) {
      const auto f = hn::LoadU(d, state_.value + i);
      const auto bound = hn::NegMulAdd(lipschitz, hn::LoadU(d, domain_.reach() + i), f);
      hn::StoreU(hn::Sub(bound, hn::LoadU(d, state_.slack + i)), d, state_.lower + i);
    }
    for (size_t q = 0; q < n; ++q) {
      state_.evaluations[q] = 1;
      state_.iterations[q] = 0;
      state_.witness[q] = state_.value[q] < -state_.slack[q] ? 1 : 0;
      const bool open = state_.is_bad[q] == 0 && !is_closed(q, state_.lower[q]);
      state_.converged[q] = open ? 0 : 1;
      if (!open) continue;
      scratch_.waiting.push_back({static_cast<uint32_t>(q), 0, Domain::kRoot, Domain::kRoot, Domain::kRoot, 1,
                                  state_.lower[q]});
      state_.lower[q] = std::numeric_limits<float>::infinity();
    }
    std::reverse(scratch_.waiting.begin(), scratch_.waiting.end());
  }

  /// No point of a cell with this bound can change the answer to query q.
  [[nodiscard]] bool is_closed(size_t q, float lower) const {
    const bool verdict_known = lower > 0 || state_.witness[q] != 0;
    if (limits_.goal == Goal::verdict) return verdict_known;
    return verdict_known && lower >= state_.value[q] - static_cast<float>(limits_.tolerance);
  }

  // --- wave k ---------------------------------------------------------------------------------------------------------

  /// Brings the open cells of the next wave to open_: those left by the last wave, or a waiting batch. False at the end.
  bool refill() {
    if (open_count_ == 0) {
      auto& waiting = scratch_.waiting;
      if (waiting.empty()) return false;
      // A batch is a run of whole queries of one level; the stack holds them last first.
      level_ = waiting.back().level;
      while (!waiting.empty() && waiting.back().level == level_) {
        size_t run = 1;
        const uint32_t q = waiting.back().query;
        while (run < waiting.size() && waiting[waiting.size() - 1 - run].query == q) ++run;
        if ((open_count_ + run) * kChildren > kWaveCells) break;
        for (size_t i = 0; i < run; ++i) {
          open_[open_count_++] = waiting.back();
          waiting.pop_back();
        }
      }
    }
    return true;
  }

  void expand() {
    child_count_ = open_count_ * kChildren;
    for (size_t i = 0; i < open_count_; ++i) {
      for (size_t k = 0; k < kChildren; ++k) {
        const OpenCell child = Domain::child(open_[i], k);
        const size_t at = i * kChildren + k;
        wave_.query[at] = child.query;
        wave_.u[at] = child.u;
        wave_.v[at] = child.v;
        if constexpr (Domain::kAxes == 3) wave_.w[at] = child.w;
        wave_.size[at] = child.size;
      }
    }
    for (size_t i = child_count_; i < padded(child_count_); ++i) {
      wave_.query[i] = 0;
      wave_.u[i] = wave_.v[i] = wave_.w[i] = wave_.size[i] = 0;
    }
  }

  void evaluate() {
    const bool encloses = tile_.tape->has_support && level_ >= kFirstEnclosureLevel;
    domain_.place(wave_, child_count_, encloses);
    const F32 d;
    if (encloses) {
      CellColumns cells;
      cells.reach = wave_.reach;
      for (size_t i = 0; i < Domain::kEdgeColumns; ++i) cells.edges[i] = wave_.edges[i];
      cells.is_box = Domain::kIsBall;
      tile_.kernels->enclosure(*tile_.tape, wave_.centre, cells, child_count_, wave_.lower, wave_.value,
                               kernel_scratch_);
    } else {
      tile_.kernels->value(*tile_.tape, wave_.centre, child_count_, wave_.value, kernel_scratch_);
      const auto lipschitz = hn::Set(d, static_cast<float>(tile_.tape->facts.lipschitz));
      for (size_t i = 0; i < child_count_; i += hn::Lanes(d)) {
        const auto f = hn::LoadU(d, wave_.value + i);
        hn::StoreU(hn::NegMulAdd(lipschitz, hn::LoadU(d, wave_.reach + i), f), d, wave_.lower + i);
      }
    }
  }

  void reduce() {
    size_t kept = 0;
    const size_t parents = open_count_;
    open_count_ = 0;
    size_t begin = 0;
    const size_t total = parents * kChildren;
    while (begin < total) {
      size_t end = begin + kChildren;
      const uint32_t q = wave_.query[begin];
      while (end < total && wave_.query[end] == q) end += kChildren;
      take_incumbent(q, begin, end);
      kept = keep_open(q, begin, end, kept);
      begin = end;
    }
    open_count_ = kept;
    // What the next wave cannot hold waits, whole queries at a time.
    size_t fits = kept;
    while (fits * kChildren > kWaveCells) {
      const uint32_t q = open_[fits - 1].query;
      while (fits > 0 && open_[fits - 1].query == q) --fits;
    }
    for (size_t i = kept; i-- > fits;) scratch_.waiting.push_back(open_[i]);
    open_count_ = fits;
  }

  void take_incumbent(uint32_t q, size_t begin, size_t end) {
    size_t best = end;
    float least = state_.value[q];
    for (size_t i = begin; i < end; ++i) {
      if (wave_.value[i] < least) {
        least = wave_.value[i];
        best = i;
      }
    }
    state_.evaluations[q] += static_cast<uint32_t>(end - begin);
    state_.iterations[q] += 1;
    if (best == end) return;
    state_.value[q] = least;
    for (int axis = 0; axis < Domain::kAxes; ++axis) state_.point[axis][q] = wave_.centre[axis][best];
    state_.barycentric[0][q] = wave_.u[best] + wave_.size[best] / 3;
    state_.barycentric[1][q] = wave_.v[best] + wave_.size[best] / 3;
    state_.witness[q] = least < -state_.slack[q] ? 1 : 0;
  }

  /// Appends the open cells of a query to open_ unless it is done or handed on; returns the new count.
  size_t keep_open(uint32_t q, size_t begin, size_t end, size_t kept) {
    const size_t first = kept;
    const float slack = state_.slack[q];
    float closed_lower = state_.lower[q];
    float open_lower = std::numeric_limits<float>::infinity();
    bool resolved = true;
    for (size_t i = begin; i < end; ++i) {
      const float lower = wave_.lower[i] - slack;
      if (is_closed(q, lower)) {
        closed_lower = std::min(closed_lower, lower);
        continue;
      }
      open_lower = std::min(open_lower, lower);
      resolved = resolved && wave_.reach[i] > slack;
      // Children number kChildren times the parents, so the list never overtakes the cells that are read.
      open_[kept++] = {q, level_, wave_.u[i], wave_.v[i], Domain::kAxes == 3 ? wave_.w[i] : 0, wave_.size[i], lower};
    }
    state_.lower[q] = closed_lower;
    const size_t open = kept - first;
    if (open == 0) {
      state_.converged[q] = 1;
      return first;
    }
    const auto next = static_cast<uint32_t>(std::min<size_t>(open * kChildren, 0xffffffffU));
    const bool spent = next > limits_.budget || state_.evaluations[q] > limits_.budget - next;
    const auto tolerance = static_cast<float>(limits_.tolerance);
    const bool touches = limits_.goal == Goal::verdict && state_.value[q] + slack <= tolerance &&
                         std::min(closed_lower, open_lower) >= -tolerance &&
                         state_.evaluations[q] > limits_.budget / kTouchingEffort;
    if (spent || touches) {
      state_.lower[q] = std::min(closed_lower, open_lower);
      state_.converged[q] = touches ? 1 : 0;
      return first;
    }
    if (!resolved || open * kChildren > kWaveCells) {
      state_.lower[q] = std::min(closed_lower, open_lower);
      hard_[hard_count_++] = q;
      return first;
    }
    return kept;
  }

  // --- what float32 cannot decide ---------------------------------------------------------------------------------------

  void decide_in_double(uint32_t q) {
    const Region64 region = domain_.region(tile_, q);
    Decision best;
    for (int axis = 0; axis < Domain::kAxes; ++axis) best.point[axis] = state_.point[axis][q];
    best.u = state_.barycentric[0][q];
    best.v = state_.barycentric[1][q];
    const Decision found = decide(region, limits_, best, limits_.budget - state_.evaluations[q], scratch_);
    state_.evaluations[q] += found.evaluations;
    state_.iterations[q] += 1;
    if (state_.witness[q] == 0 || found.value < state_.value[q]) {
      for (int axis = 0; axis < Domain::kAxes; ++axis) state_.point[axis][q] = found.point[axis];
      state_.value[q] = static_cast<float>(found.value);
      state_.barycentric[0][q] = static_cast<float>(found.u);
      state_.barycentric[1][q] = static_cast<float>(found.v);
      state_.witness[q] = found.witness || state_.witness[q] != 0 ? 1 : 0;
    }
    // The double value stands where float32 rounding would hide it.
    state_.slack[q] = static_cast<float>(limits_.slack64(domain_.largest()[q]) * 1.001);
    state_.lower[q] = std::max(state_.lower[q], rounded_down(found.lower));
    state_.converged[q] = found.closed ? 1 : 0;
  }

  static float rounded_down(double x) {
    const auto nearest = static_cast<float>(x);
    return static_cast<double>(nearest) > x ? std::nextafter(nearest, -std::numeric_limits<float>::infinity())
                                            : nearest;
  }

  const QueryTile& tile_;
  const SolveLimits& limits_;
  TileScratch& scratch_;
  Domain domain_;
  QueryState state_;
  WaveColumns wave_;
  float* kernel_scratch_ = nullptr;
  OpenCell* open_ = nullptr;
  size_t open_count_ = 0;
  size_t child_count_ = 0;
  uint32_t level_ = 0;
  uint32_t* hard_ = nullptr;
  size_t hard_count_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
