// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Ratios that survive a busy machine: the contenders run by turns within each round, and only times of one round are
// compared. The median over rounds is what is reported.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

namespace thalweg::bench {

/// Wall time of one call, in seconds.
template <class Call>
double seconds(Call&& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Times two calls, the second one first in every other round, so that neither always finds the warmer caches.
template <class First, class Second>
std::pair<double, double> by_turns(std::size_t round, First&& first, Second&& second) {
  if (round % 2 == 0) {
    const double a = seconds(first);
    return {a, seconds(second)};
  }
  const double b = seconds(second);
  return {seconds(first), b};
}

class Samples {
 public:
  void add(double value) { values_.push_back(value); }
  [[nodiscard]] std::size_t count() const { return values_.size(); }
  [[nodiscard]] double median() const { return quantile(0.5); }
  /// Half the distance between the quartiles, relative to the median.
  [[nodiscard]] double spread() const { return median() == 0 ? 0 : (quantile(0.75) - quantile(0.25)) / (2 * median()); }

 private:
  [[nodiscard]] double quantile(double q) const {
    if (values_.empty()) return 0;
    std::vector<double> sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  }

  std::vector<double> values_;
};

}  // namespace thalweg::bench
