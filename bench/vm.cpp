// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Scalar tapes, one thread, against native code of the same model.
//   vm/<model>/value   vs_native       rate of the whole tape over that of native code
//   vm/prospero/sign   vs_native       time of native code for 1024 x 1024 values over ours for their signs
//                      tape_vs_native  rate of the whole tape over that of native code
//                      values_vs_native  time of native code over ours for all values
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "baselines/native_vm.h"
#include "rounds.h"
#include "thalweg/batch.h"
#include "workload.h"

namespace thalweg::bench {
namespace {

constexpr Execution kOneThread{.threads = 1};
/// Batches so short are evaluated by the tape as it is.
constexpr std::size_t kUnordered = 128;

std::optional<Tape> load_model(const NativeModel& model, std::string& error) {
  const std::string path(model.path);
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto scene = parse_program(text, path);
  if (!scene) {
    error = to_string(scene.error());
    return std::nullopt;
  }
  auto tape = compile(scene->shape);
  if (!tape) {
    error = to_string(tape.error());
    return std::nullopt;
  }
  return std::move(tape).value();
}

/// Points, which both contenders read row by row, and their answers.
struct Columns {
  std::vector<float> rows, value, native_value;

  Columns(const std::vector<float>& all, std::size_t d)
      : rows(all), value(all.size() / d), native_value(value.size()) {}
  [[nodiscard]] std::size_t count() const { return value.size(); }

  void evaluate_whole_tape(const Tape& tape) {
    const std::size_t d = rows.size() / count(), step = tape.instructions.size() < 80 ? count() : kUnordered;
    for (std::size_t i = 0; i < count(); i += step) {
      evaluate(tape, &rows[i * d], std::min(step, count() - i), &value[i], nullptr, kOneThread);
    }
  }
  void evaluate_native(const NativeModel& model) { model.value(rows.data(), count(), native_value.data()); }
};

std::vector<float> points_in_cube(std::size_t count, std::size_t d) {
  const std::vector<float> picture = picture_points(count * d);
  std::vector<float> rows;
  for (std::size_t i = 0; i < count * d; ++i) rows.push_back(picture[2 * i] / 960 - 1);
  return rows;
}

/// Values may differ by rounding, which formulas may amplify at a few points. Returns what is wrong, or nothing.
std::string disagreement(const Columns& c) {
  std::size_t apart = 0;
  for (std::size_t i = 0; i < c.count(); ++i) {
    const double ours = c.value[i], native = c.native_value[i];
    if (std::isnan(ours) && !std::isfinite(native)) continue;
    if (!(std::abs(ours - native) <= 1e-3 * (1 + std::abs(native)))) ++apart;
  }
  return apart * 1000 > c.count() ? std::to_string(apart) + " values differ from native ones" : "";
}

void value_case(benchmark::State& state, const NativeModel& model) {
  std::string error;
  const auto tape = load_model(model, error);
  if (!tape) return refuse(state, error);
  const auto d = static_cast<std::size_t>(tape->dimension);
  Columns c(points_in_cube(batch(std::size_t{1} << (model.steps > 1000 ? 13 : 16)), d), d);
  c.evaluate_whole_tape(*tape);
  c.evaluate_native(model);
  if (error = disagreement(c); !error.empty()) return refuse(state, error);
  Samples vs_native, native_seconds;
  for (auto _ : state) {
    const auto [ours, theirs] = by_turns(
        vs_native.count(), [&] { c.evaluate_whole_tape(*tape); }, [&] { c.evaluate_native(model); });
    vs_native.add(theirs / ours);
    native_seconds.add(theirs);
    state.SetIterationTime(ours);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(c.count()) * state.iterations());
  state.counters["vs_native"] = vs_native.median();
  state.counters["vs_native_spread"] = vs_native.spread();
  state.counters["native_points_per_second"] = static_cast<double>(c.count()) / native_seconds.median();
}

/// x and y in [-1, 1], row 0 at y = +1.
Grid picture_grid(std::size_t side) {
  const double step = 2 / static_cast<double>(side);
  return {.origin = {-1 + step / 2, 1 - step / 2}, .step = {{step}, {0, -step}}, .size = {side, side, 1}};
}

std::vector<float> rows_of(const Grid& grid) {
  std::vector<float> rows(2 * grid.count());
  for (std::size_t i = 0; i < grid.count(); ++i) grid.point(i % grid.size[0], i / grid.size[0], 0, 2, &rows[2 * i]);
  return rows;
}

/// Signs of values beyond what rounding leaves open.
std::string wrong_sign(const Columns& c, const std::vector<std::uint8_t>& inside) {
  for (std::size_t i = 0; i < c.count(); ++i) {
    if (std::abs(c.native_value[i]) > 1e-4F && (c.native_value[i] < 0) != (inside[i] != 0)) {
      return "pixel " + std::to_string(i) + " has the wrong sign";
    }
  }
  return "";
}

void sign_case(benchmark::State& state, const NativeModel& model) {
  std::string error;
  const auto tape = load_model(model, error);
  if (!tape) return refuse(state, error);
  const Grid grid = picture_grid(smoke() ? 128 : 1024);
  Columns c(rows_of(grid), 2);
  std::vector<std::uint8_t> inside(grid.count());
  const auto signs = [&] { static_cast<void>(evaluate_grid(*tape, grid, {.inside = inside.data()}, kOneThread)); };
  const auto values = [&] { static_cast<void>(evaluate_grid(*tape, grid, {.value = c.value.data()}, kOneThread)); };
  signs();
  values();
  c.evaluate_native(model);
  if (error = wrong_sign(c, inside); error.empty()) error = disagreement(c);
  if (!error.empty()) return refuse(state, error);
  Samples sign_ratio, value_ratio, tape_ratio, native_seconds;
  for (auto _ : state) {
    const auto [ours, native] = by_turns(sign_ratio.count(), signs, [&] { c.evaluate_native(model); });
    sign_ratio.add(native / ours);
    value_ratio.add(native / seconds(values));
    tape_ratio.add(native / seconds([&] { c.evaluate_whole_tape(*tape); }));
    native_seconds.add(native);
    state.SetIterationTime(ours);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(c.count()) * state.iterations());
  state.counters["vs_native"] = sign_ratio.median();
  state.counters["vs_native_spread"] = sign_ratio.spread();
  state.counters["values_vs_native"] = value_ratio.median();
  state.counters["tape_vs_native"] = tape_ratio.median();
  state.counters["native_points_per_second"] = static_cast<double>(c.count()) / native_seconds.median();
}

}  // namespace

void register_vm_cases() {
  bool has_prospero = false;
  for (const NativeModel& model : native_models()) {
    const auto add = [&model](const char* what, auto* run) {
      const std::string name = "vm/" + std::string(model.name) + "/" + what;
      return benchmark::RegisterBenchmark(name.c_str(), [&model, run](benchmark::State& state) { run(state, model); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    };
    add("value", value_case);
    if (model.name != "prospero") continue;
    has_prospero = true;
    add("sign", sign_case)->Iterations(smoke() ? 1 : 9);
  }
  if (!has_prospero) benchmark::AddCustomContext("vm/prospero/sign", "left out: no ../shared/models/prospero.vm");
}

}  // namespace thalweg::bench
