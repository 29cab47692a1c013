// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Values and gradients over columns of points, by every strategy but `autodiff`, which is the gradient kernel itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gradient/strategy_kernel.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include <limits>

#include "gradient/closest.inl"
#include "gradient/probes.inl"
#include "gradient/strategies.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// The points of a chunk, from columns.
template <class T, int D>
HWY_INLINE Point<T, D> load_columns(const float* const* columns, size_t at) {
  if constexpr (D == 2) {
    return {Make<T>::load(columns[0] + at), Make<T>::load(columns[1] + at)};
  } else {
    return {Make<T>::load(columns[0] + at), Make<T>::load(columns[1] + at), Make<T>::load(columns[2] + at)};
  }
}
template <class T, int D>
HWY_INLINE void store_columns(Point<T, D> p, float* const* columns, size_t at) {
  store(p.x, columns[0] + at);
  store(p.y, columns[1] + at);
  if constexpr (D == 3) store(p.z, columns[2] + at);
}

template <class T, int D>
HWY_INLINE Point<T, D> by_probes(const GradientRule& rule, const Surroundings<T, D>& f, T here) {
  if (rule.strategy == Gradient::central) return central(f);
  if (rule.strategy == Gradient::forward) return forward(f, here);
  if constexpr (D == 2) {
    if (rule.strategy == Gradient::dichotomy) return dichotomy(f, here, false);
    if (rule.strategy == Gradient::dichotomy_verbatim) return dichotomy(f, here, true);
  }
  return simplex(f);
}

template <int D>
void probe_columns(const Tape& tape, const GradientRule& rule, const GradientColumns& columns, float* scratch) {
  using T = Pack<kValueWidth>;
  const Machine<T> m = machine_for<ValueMode<T, D>>(tape, scratch);
  const T absolute = Make<T>::set(rule.probe.absolute);
  const T of_value = Make<T>::set(rule.probe.of_value);
  const bool symmetric = rule.strategy == Gradient::central || rule.strategy == Gradient::simplex;
  const bool wants_value = columns.value != nullptr || rule.probe.of_value > 0 || !symmetric;
  for (size_t i = 0; i < columns.count; i += lanes_of<T>()) {
    Surroundings<T, D> f(m, load_columns<T, D>(columns.points, i));
    const T here = wants_value ? f.here() : zero<T>();
    f.reach(max(absolute, of_value * abs(here)));
    store_columns(by_probes(rule, f, here), columns.gradient, i);
    if (columns.value != nullptr) store(here, columns.value + i);
  }
}

/// The searches under way, one a lane; a lane whose search has ended takes the next point.
template <int D>
class ClosestLanes {
 public:
  using T = Pack<kGradientWidth>;
  using Search = ClosestSearch<T, D>;

  ClosestLanes(const Tape& tape, const GradientColumns& columns, float* scratch)
      : tape_(tape), columns_(columns), machine_(machine_for<GradientMode<T, D>>(tape, scratch)) {}

  void run() {
    const size_t lanes = lanes_of<T>();
    for (size_t lane = 0; lane < kMostLanes; ++lane) {
      for (float* from : from_) from[lane] = 0;
      begins_[lane] = 0;
    }
    Search search = begin_closest(tape_, load_columns<T, D>(from_table(), 0), Field<T, D>{});
    size_t busy = 0;
    for (size_t lane = 0; lane < lanes; ++lane) busy += take_next(lane) ? 1 : 0;
    while (busy > 0) {
      search = step(search);
      store(search.active, active_);
      publish(search);
      for (size_t lane = 0; lane < lanes; ++lane) {
        if (active_[lane] > 0 || row_[lane] == kNoRow) continue;
        write(lane);
        busy -= take_next(lane) ? 0 : 1;
      }
    }
  }

 private:
  static constexpr size_t kMostLanes = kGradientWidth * 16;
  static constexpr size_t kNoRow = ~size_t{0};

  float* const* from_table() {
    for (int axis = 0; axis < D; ++axis) from_pointers_[axis] = from_[axis];
    return from_pointers_;
  }

  /// Puts the next point into a lane; false when there is none.
  bool take_next(size_t lane) {
    if (next_ == columns_.count) {
      row_[lane] = kNoRow;
      return false;
    }
    row_[lane] = next_;
    for (int axis = 0; axis < D; ++axis) from_[axis][lane] = columns_.points[axis][next_];
    begins_[lane] = 1;
    ++next_;
    return true;
  }

  /// New points are evaluated for the first time, the others at their trials.
  HWY_INLINE Search step(const Search& search) {
    const auto begins = zero<T>() < Make<T>::load(begins_);
    const Point<T, D> from = load_columns<T, D>(from_table(), 0);
    const Field<T, D> f = gradient_at_point(machine_, select(begins, from, search.trial));
    const Search first = begin_closest(tape_, from, f);
    Search later = search;
    advance_closest(later, f);
    store(zero<T>(), begins_);
    return chosen(begins, first, later);
  }

  template <class M>
  static HWY_INLINE Search chosen(M m, const Search& a, const Search& b) {
    return {select(m, a.from, b.from),
            select(m, a.trial, b.trial),
            select(m, a.nearest, b.nearest),
            select(m, a.tangent, b.tangent),
            select(m, a.normal, b.normal),
            select(m, a.least, b.least),
            select(m, a.share, b.share),
            select(m, a.returns, b.returns),
            select(m, a.slack, b.slack),
            select(m, a.active, b.active),
            select(m, a.evaluations, b.evaluations),
            select(m, a.value, b.value)};
  }

  HWY_INLINE void publish(const Search& search) {
    store_point(closest_direction(search), found_);
    store_point(search.nearest, found_ + D * lanes_of<T>());
    store(search.value, found_ + 2 * D * lanes_of<T>());
    store(search.evaluations, found_ + (2 * D + 1) * lanes_of<T>());
  }

  void write(size_t lane) {
    const size_t lanes = lanes_of<T>(), row = row_[lane];
    for (size_t axis = 0; axis < D; ++axis) {
      columns_.gradient[axis][row] = found_[axis * lanes + lane];
      if (columns_.witness != nullptr) columns_.witness[axis][row] = found_[(D + axis) * lanes + lane];
    }
    if (columns_.value != nullptr) columns_.value[row] = found_[2 * D * lanes + lane];
    if (columns_.evaluations != nullptr) {
      columns_.evaluations[row] += static_cast<uint32_t>(found_[(2 * D + 1) * lanes + lane]);
    }
  }

  const Tape& tape_;
  const GradientColumns& columns_;
  const Machine<T> machine_;
  size_t next_ = 0;
  size_t row_[kMostLanes] = {};
  float from_[D][kMostLanes], begins_[kMostLanes], active_[kMostLanes];
  float* from_pointers_[D] = {};
  float found_[(2 * D + 2) * kMostLanes];  ///< direction, witness, value, evaluations
};

void strategy_kernel(const Tape& tape, const GradientRule& rule, const GradientColumns& columns, float* scratch) {
  const bool flat = tape.dimension == 2;
  if (rule.strategy == Gradient::closest_point) {
    flat ? ClosestLanes<2>(tape, columns, scratch).run() : ClosestLanes<3>(tape, columns, scratch).run();
  } else {
    flat ? probe_columns<2>(tape, rule, columns, scratch) : probe_columns<3>(tape, rule, columns, scratch);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(strategy_kernel);
StrategyKernel strategy_entry(std::int64_t target) { return THALWEG_ENTRY_OF(strategy_kernel, target); }
}  // namespace thalweg
#endif
