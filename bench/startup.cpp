// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// startup/1000_nodes: from scene text to tape, sizes by turns within each round.
//   ms_at_<n>  wall time for a scene of n nodes
//   exponent   b of the fitted time = a x^b
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "rounds.h"
#include "thalweg/ops.h"
#include "thalweg/scene.h"
#include "thalweg/tape.h"
#include "workload.h"

namespace thalweg::bench {
namespace {

/// Unions of eight primitives each, every primitive in a place of its own.
std::string text_of(std::size_t nodes) {
  std::vector<Shape> groups, parts;
  for (std::size_t i = 0; 2 * i < nodes; ++i) {
    const double x = static_cast<double>(i % 97) * 7.3, y = static_cast<double>(i / 97) * 9.1;
    const Shape one = i % 3 == 0 ? circle(2) : i % 3 == 1 ? box(Vec2{1, 2}) : star(3, 5, 3);
    parts.push_back(one.translate(Vec2{x, y}));
    if (parts.size() == 8) groups.push_back(i % 2 == 0 ? union_(parts) : smooth_union(0.5, parts)), parts.clear();
  }
  groups.insert(groups.end(), parts.begin(), parts.end());
  return scene_text(union_(groups));
}

void startup(benchmark::State& state) {
  const std::vector<std::size_t> sizes = {100, 1000, 10'000};
  std::vector<std::string> texts;
  std::vector<Samples> times(sizes.size());
  for (const std::size_t size : sizes) texts.push_back(text_of(size));
  for (auto _ : state) {
    double sum = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      bool good = true;
      const double time = seconds([&] {
        const auto scene = parse_scene(texts[i], "scene");
        good = scene && compile(scene->shape);
      });
      if (!good) return refuse(state, "the scene does not compile");
      times[i].add(time);
      sum += time;
    }
    state.SetIterationTime(sum);
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    state.counters["ms_at_" + std::to_string(sizes[i])] = 1e3 * times[i].median();
  }
  state.counters["exponent"] = std::log(times[2].median() / times[0].median()) / std::log(100.0);
}

}  // namespace

void register_startup_cases() {
  benchmark::RegisterBenchmark("startup/1000_nodes", startup)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(smoke() ? 1 : 9);
}

}  // namespace thalweg::bench
