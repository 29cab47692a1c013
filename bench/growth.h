// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What growing costs: times at a row of sizes, all of them by turns within each round.
//   ns_at_<x>   time per query at size x, the median of the rounds
//   exponent    b of the fitted time = a x^b
#pragma once

#include <benchmark/benchmark.h>

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
