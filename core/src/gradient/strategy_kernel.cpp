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
  const Machine<T> m = machine_for<kValueWidth>(tape, scratch, 1);
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

template <int D>
void closest_columns(const Tape& tape, const GradientColumns& columns, float* scratch) {
  using T = Pack<kGradientWidth>;
  const Machine<T> m = machine_for<kGradientWidth>(tape, scratch, 1 + D);
  HWY_ALIGN float evaluations[kMostChunkLanes];
  for (size_t i = 0; i < columns.count; i += lanes_of<T>()) {
    const Closest<T, D> found = closest(tape, m, load_columns<T, D>(columns.points, i));
    store_columns(found.gradient, columns.gradient, i);
    if (columns.value != nullptr) store(found.value, columns.value + i);
    if (columns.witness != nullptr) store_columns(found.witness, columns.witness, i);
    if (columns.evaluations == nullptr) continue;
    store(found.evaluations, evaluations);
    for (size_t lane = 0; lane < lanes_of<T>() && i + lane < columns.count; ++lane) {
      columns.evaluations[i + lane] += static_cast<uint32_t>(evaluations[lane]);
    }
  }
}

void strategy_kernel(const Tape& tape, const GradientRule& rule, const GradientColumns& columns, float* scratch) {
  const bool flat = tape.dimension == 2;
  if (rule.strategy == Gradient::closest_point) {
    flat ? closest_columns<2>(tape, columns, scratch) : closest_columns<3>(tape, columns, scratch);
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
