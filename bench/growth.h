// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What growing costs: times at a row of sizes, all of them by turns within each round.
//   ns_at_<x>   time per query at size x, the median of the rounds
//   exponent    b of the fitted time = a x^b
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "rounds.h"
#include "workload.h"

namespace thalweg::bench {

/// Times at a row of sizes.
class Growth {
 public:
  explicit Growth(std::vector<std::size_t> sizes) : sizes_(std::move(sizes)), seconds_(sizes_.size()) {}

  [[nodiscard]] const std::vector<std::size_t>& sizes() const { return sizes_; }
  void add(std::size_t i, double seconds) { seconds_[i].add(seconds); }
  [[nodiscard]] double median(std::size_t i) const { return seconds_[i].median(); }

  /// b of the least squares fit of log time = log a + b log size.
  [[nodiscard]] double exponent() const {
    double x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      const double size = std::log(static_cast<double>(sizes_[i])), time = std::log(median(i));
      x += size, y += time, xx += size * size, xy += size * time;
    }
    const auto n = static_cast<double>(sizes_.size());
    const double variance = n * xx - x * x;
    return variance > 0 ? (n * xy - x * y) / variance : 0;
  }

 private:
  std::vector<std::size_t> sizes_;
  std::vector<Samples> seconds_;
};

inline void finish(benchmark::State& state, const Growth& growth, const std::vector<std::size_t>& queries) {
  for (std::size_t i = 0; i < growth.sizes().size(); ++i) {
    state.counters["ns_at_" + std::to_string(growth.sizes()[i])] =
        1e9 * growth.median(i) / static_cast<double>(queries[i]);
  }
  state.counters["exponent"] = growth.exponent();
}

/// Times `run(work, first row, rows)` on scenes of 10 to 10 000 primitives; make(size, error) gives the work on one, or
/// says what is wrong with its answers. Also:
///   cost_of_1000_over_10   time of a row among 1 000 primitives over that of one among 10
///   vs_whole_tape          at 1 000 primitives, time of `few` rows a call, which the whole tape answers, over that of
///                          the batch, which shortened ones do
template <class Make, class Run>
void grow_by_scene(benchmark::State& state, const Make& make, const Run& run, std::size_t few) {
  Growth growth(smoke() ? std::vector<std::size_t>{10, 100, 1000} : std::vector<std::size_t>{10, 100, 1000, 10'000});
  std::string error;
  std::vector<decltype(make(10, error))> works;
  for (const std::size_t size : growth.sizes()) {
    works.push_back(make(size, error));
    if (!error.empty()) return refuse(state, std::to_string(size) + " primitives, " + error);
  }
  Samples cost, gain;
  for (auto _ : state) {
    double sum = 0;
    std::vector<double> each;
    for (std::size_t i = 0; i < works.size(); ++i) {
      auto& work = *works[i];
      const std::size_t repeats = std::max<std::size_t>(batch(1 << 14) / work.count(), 1);
      const double time = seconds([&] {
        for (std::size_t k = 0; k < repeats; ++k) run(work, std::size_t{0}, work.count());
      });
      sum += time;
      each.push_back(time / static_cast<double>(repeats * work.count()));
      growth.add(i, each.back());
    }
    auto& thousand = *works[2];
    const std::size_t some = std::min<std::size_t>(thousand.count() / few, 32) * few;
    const double whole = seconds([&] {
      for (std::size_t row = 0; row < some; row += few) run(thousand, row, few);
    });
    cost.add(each[2] / each[0]);
    gain.add(whole / static_cast<double>(some) / each[2]);
    state.SetIterationTime(sum);
  }
  finish(state, growth, std::vector<std::size_t>(works.size(), 1));
  state.counters["cost_of_1000_over_10"] = cost.median();
  state.counters["cost_of_1000_over_10_spread"] = cost.spread();
  state.counters["vs_whole_tape"] = gain.median();
  state.counters["vs_whole_tape_spread"] = gain.spread();
}

/// A case whose rounds are its iterations.
template <class Run>
void add_growth_case(const char* name, Run run) {
  constexpr int kRounds = 5;
  benchmark::RegisterBenchmark(name, run)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(smoke() ? 1 : kRounds);
}

}  // namespace thalweg::bench
