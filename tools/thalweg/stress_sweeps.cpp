// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "stress_sweeps.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "report.h"
#include "stress_native.h"
#include "stress_workload.h"

namespace thalweg::cli {

namespace {

/// What all sweeps share.
struct Bench {
  const Shape& shape;
  StressSettings settings;
  const Globals& globals;
  StressWorkload work;

  Bench(const Shape& of, const StressSettings& with, const Globals& all)
      : shape(of), settings(with), globals(all), work(of, with.count, stress_reach(of), all.seed) {}

  [[nodiscard]] StressSweep timed(const char* name, const char* axis, bool numeric,
                                  const std::vector<StressCase>& cases) const {
    return {name, axis, numeric, time_by_turns(cases, settings.rounds)};
  }
};

StressCase verdicts(StressWorkload& work, std::size_t rows, const Execution& execution) {
  StressCase one;
  one.rows = rows;
  one.run = [&work, execution](std::size_t n) { return work.collide(n, CollideOptions(), execution); };
  return one;
}

StressCase named(StressCase one, std::string label, double x) {
  one.label = std::move(label);
  one.x = x;
  return one;
}

StressSweep batch_sweep(Bench& bench) {
  std::vector<StressCase> cases;
  for (std::size_t rows = 1; rows < bench.settings.count; rows *= 8) {
    cases.push_back(
        named(verdicts(bench.work, rows, bench.globals.execution()), grouped(rows), static_cast<double>(rows)));
  }
  const std::size_t all = bench.settings.count;
  cases.push_back(named(verdicts(bench.work, all, bench.globals.execution()), grouped(all), static_cast<double>(all)));
  return bench.timed("batch", "triangles in a batch", true, cases);
}

StressSweep tile_sweep(Bench& bench) {
  std::vector<StressCase> cases;
  for (std::size_t tile = 64; tile <= 65'536; tile *= 4) {
    Execution execution = bench.globals.execution();
    execution.tile = tile;
    cases.push_back(
        named(verdicts(bench.work, bench.settings.count, execution), grouped(tile), static_cast<double>(tile)));
  }
  return bench.timed("tile", "triangles in a tile", true, cases);
}

StressSweep thread_sweep(Bench& bench) {
  const int most = thread_count(bench.globals);
  std::vector<int> counts;
  for (int threads = 1; threads < most; threads *= 2) counts.push_back(threads);
  counts.push_back(most);
  std::vector<StressCase> cases;
  for (const int threads : counts) {
    Execution execution = bench.globals.execution();
    execution.threads = threads;
    cases.push_back(named(verdicts(bench.work, bench.settings.count, execution), fmt::format("{}", threads), threads));
  }
  return bench.timed("threads", "threads", true, cases);
}

StressSweep target_sweep(Bench& bench) {
  std::vector<StressCase> cases;
  for (const Target& target : targets()) {
    Execution execution = bench.globals.execution();
    execution.target = &target;
    StressCase one = verdicts(bench.work, bench.settings.count, execution);
    one.may_shrink = true;
    cases.push_back(named(std::move(one), std::string(target.name), static_cast<double>(cases.size())));
  }
  return bench.timed("simd", "SIMD target", false, cases);
}

StressSweep scene_sweep(Bench& bench) {
  const double reach = stress_reach(bench.shape);
  const std::size_t primitives = primitive_count(bench.shape);
  std::vector<std::unique_ptr<StressWorkload>> scenes;
  std::vector<StressCase> cases;
  for (const std::size_t copies : {1, 4, 16, 64, 256}) {
    if (copies > 1 && copies * primitives > 10'000) break;
    scenes.push_back(std::make_unique<StressWorkload>(repeated(bench.shape, copies), bench.settings.count, reach,
                                                      bench.globals.seed));
    StressCase one = verdicts(*scenes.back(), bench.settings.count, bench.globals.execution());
    one.may_shrink = true;
    const std::size_t all = copies * primitives;
    cases.push_back(named(std::move(one), grouped(all), static_cast<double>(all)));
  }
  return bench.timed("scene", "primitives in the scene", true, cases);
}

/// Every method with its goals, as far as the scene admits it.
std::vector<StressCase> method_cases(Bench& bench, const Execution& execution) {
  std::vector<StressCase> cases;
  const auto add = [&](Method method, Goal goal, std::string label) {
    CollideOptions options;
    options.method = method;
    options.goal = goal;
    StressCase one;
    one.rows = bench.settings.count;
    one.may_shrink = true;
    one.run = [&work = bench.work, options, execution](std::size_t n) { return work.collide(n, options, execution); };
    cases.push_back(named(std::move(one), std::move(label), static_cast<double>(cases.size())));
  };
  add(Method::certified, Goal::verdict, "certified, verdict");
  add(Method::certified, Goal::deepest, "certified, deepest");
  add(Method::projected, Goal::verdict, std::string(name(Method::projected)));
  // Its gradient, by dichotomy over angles, is one of the plane.
  if (bench.shape.dimension() == 2) add(Method::thesis, Goal::verdict, std::string(name(Method::thesis)));
  return cases;
}

StressSweep gradient_sweep(Bench& bench) {
  constexpr std::array kStrategies = {Gradient::autodiff,     Gradient::central,   Gradient::forward,
                                      Gradient::simplex,      Gradient::dichotomy, Gradient::dichotomy_verbatim,
                                      Gradient::closest_point};
  std::vector<StressCase> cases;
  for (const Gradient strategy : kStrategies) {
    if (!bench.work.admits(strategy)) continue;
    StressCase one;
    one.rows = bench.settings.count;
    one.may_shrink = true;
    one.run = [&bench, strategy](std::size_t n) {
      return bench.work.evaluate_gradients(n, strategy, bench.globals.execution());
    };
    cases.push_back(named(std::move(one), std::string(name(strategy)), static_cast<double>(cases.size())));
  }
  return bench.timed("gradient", "gradient strategy, at points", false, cases);
}

StressCase copying(std::vector<char>& from, std::vector<char>& to) {
  StressCase one;
  one.label = "copy";
  one.rows = from.size();
  one.run = [&from, &to](std::size_t bytes) {
    std::memcpy(to.data(), from.data(), bytes);
    return static_cast<std::uint64_t>(to[bytes / 2] == 0 ? 1 : 0);
  };
  return one;
}

}  // namespace

std::vector<StressSweep> run_sweeps(const Shape& shape, const StressSettings& settings, const Globals& globals) {
  Bench bench(shape, settings, globals);
  std::vector<StressSweep> sweeps = {batch_sweep(bench), tile_sweep(bench), thread_sweep(bench), target_sweep(bench)};
  if (shape.facts().bounds.finite(shape.dimension())) sweeps.push_back(scene_sweep(bench));
  sweeps.push_back(bench.timed("method", "method", false, method_cases(bench, globals.execution())));
  sweeps.push_back(gradient_sweep(bench));
  return sweeps;
}

Roofline measure_roofline(const Shape& shape, const StressSettings& settings, const Globals& globals) {
  // Far more than the last cache of any machine at hand, as reading and writing count.
  constexpr std::size_t kCopied = std::size_t{1} << 27;
  Bench bench(shape, settings, globals);
  Execution one_thread = globals.execution();
  one_thread.threads = 1;
  std::vector<char> from(kCopied, 1), to(kCopied, 2);
  StressCase values;
  values.label = "value at points";
  values.rows = settings.count;
  values.run = [&](std::size_t n) { return bench.work.evaluate_values(n, one_thread); };
  std::vector<StressCase> cases = {values};
  for (StressCase& one : method_cases(bench, one_thread)) cases.push_back(std::move(one));
  cases.push_back(copying(from, to));
  const NativeValue native = native_code_of(bench.work.tape(), bench.work.points());
  if (native != nullptr) {
    values.run = [&](std::size_t n) {
      native(bench.work.points().data(), n, bench.work.values());
      return n;
    };
    cases.push_back(values);
  }

  Roofline roofline;
  roofline.points = time_by_turns(cases, settings.rounds);
  roofline.native = native != nullptr;
  roofline.limit = (native != nullptr ? roofline.points.back() : roofline.points.front()).evaluations_per_second();
  if (native != nullptr) roofline.points.pop_back();
  roofline.copy_bytes = 2 * roofline.points.back().queries_per_second;
  roofline.points.pop_back();
  roofline.bytes_per_query.assign(roofline.points.size(), static_cast<double>(bench.work.bytes_per_triangle()));
  roofline.bytes_per_query.front() = static_cast<double>(bench.work.bytes_per_value());
  return roofline;
}

}  // namespace thalweg::cli
