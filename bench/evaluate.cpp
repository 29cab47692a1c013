// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// evaluate/<scene>/value and /gradient on one thread, against native code of the same scene.
//   vs_native  thalweg's rate over the native rate of the same rounds: 1 is the limit of an interpreter
//   vs_value   time of value and gradient over the time of the value alone
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "baselines/native.h"
#include "rounds.h"
#include "thalweg/batch.h"
#include "workload.h"

namespace thalweg::bench {
namespace {

// Rounds shorter than a time slice and columns that stay in the second-level cache: what is compared is the code.
constexpr std::size_t kPoints = std::size_t{1} << 16;
constexpr Execution kOneThread{.threads = 1};

struct Columns {
  std::vector<float> points, value, gradient, native_value, native_gradient;

  explicit Columns(std::size_t count)
      : points(picture_points(count)),
        value(count),
        gradient(2 * count),
        native_value(count),
        native_gradient(2 * count) {}
  [[nodiscard]] std::size_t count() const { return value.size(); }
};

/// Both answers at every point, within what float32 leaves open; where they differ in the gradient, which is
/// discontinuous, the point must be rare. Returns what is wrong, or nothing.
std::string disagreement(const LoadedScene& scene, const NativeScene& native, Columns& c) {
  evaluate(scene.tape, c.points.data(), c.count(), c.value.data(), c.gradient.data(), kOneThread);
  native.gradient(c.points.data(), c.count(), c.native_value.data(), c.native_gradient.data());
  const double tolerance = 2 * scene.tape.slack(2048);
  std::size_t turned = 0;
  for (std::size_t i = 0; i < c.count(); ++i) {
    const double point[2] = {c.points[2 * i], c.points[2 * i + 1]};
    const double exact = evaluate_double(scene.tape, point, nullptr);
    const auto wrong = [&](float value) { return !(std::abs(value - exact) <= tolerance); };
    if (wrong(c.value[i]) || wrong(c.native_value[i])) {
      return "point " + std::to_string(i) + ": thalweg " + std::to_string(c.value[i]) + ", native " +
             std::to_string(c.native_value[i]) + ", in double " + std::to_string(exact);
    }
    const double gap =
        std::hypot(c.gradient[2 * i] - c.native_gradient[2 * i], c.gradient[2 * i + 1] - c.native_gradient[2 * i + 1]);
    if (!(gap < 1e-2)) ++turned;
  }
  return turned * 1000 > c.count() ? std::to_string(turned) + " gradients differ from native ones" : "";
}

void finish(benchmark::State& state, std::size_t count, const Samples& vs_native, const Samples& native_seconds) {
  state.SetItemsProcessed(static_cast<std::int64_t>(count) * state.iterations());
  state.counters["vs_native"] = vs_native.median();
  state.counters["vs_native_spread"] = vs_native.spread();
  state.counters["native_points_per_second"] = static_cast<double>(count) / native_seconds.median();
}

void value_case(benchmark::State& state, const NativeScene& native) {
  std::string error;
  const auto scene = load_scene(native.name, error);
  if (!scene) return refuse(state, error);
  Columns c(batch(kPoints));
  if (error = disagreement(*scene, native, c); !error.empty()) return refuse(state, error);
  Samples vs_native, native_seconds;
  for (auto _ : state) {
    const auto [ours, theirs] = by_turns(
        vs_native.count(),
        [&] { evaluate(scene->tape, c.points.data(), c.count(), c.value.data(), nullptr, kOneThread); },
        [&] { native.value(c.points.data(), c.count(), c.native_value.data()); });
    vs_native.add(theirs / ours);
    native_seconds.add(theirs);
    state.SetIterationTime(ours);
  }
  finish(state, c.count(), vs_native, native_seconds);
}

void gradient_case(benchmark::State& state, const NativeScene& native) {
  std::string error;
  const auto scene = load_scene(native.name, error);
  if (!scene) return refuse(state, error);
  Columns c(batch(kPoints));
  if (error = disagreement(*scene, native, c); !error.empty()) return refuse(state, error);
  const auto both = [&] {
    evaluate(scene->tape, c.points.data(), c.count(), c.value.data(), c.gradient.data(), kOneThread);
  };
  Samples vs_native, vs_value, native_seconds;
  for (auto _ : state) {
    const auto [ours, theirs] = by_turns(vs_native.count(), both, [&] {
      native.gradient(c.points.data(), c.count(), c.native_value.data(), c.native_gradient.data());
    });
    const double value =
        seconds([&] { evaluate(scene->tape, c.points.data(), c.count(), c.value.data(), nullptr, kOneThread); });
    vs_native.add(theirs / ours);
    vs_value.add(ours / value);
    native_seconds.add(theirs);
    state.SetIterationTime(ours);
  }
  finish(state, c.count(), vs_native, native_seconds);
  state.counters["vs_value"] = vs_value.median();
}

}  // namespace

void register_evaluate_cases() {
  for (const NativeScene& native : native_scenes()) {
    const std::string name = "evaluate/" + std::string(native.name);
    const auto add = [&native](const std::string& full_name, auto* run) {
      benchmark::RegisterBenchmark(full_name.c_str(), [&native, run](benchmark::State& state) { run(state, native); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    };
    add(name + "/value", value_case);
    add(name + "/gradient", gradient_case);
  }
}

}  // namespace thalweg::bench
