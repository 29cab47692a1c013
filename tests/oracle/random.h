// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Random numbers that are the same with every standard library: SplitMix64 (Steele, Lea and Flood, 2014), and
// uniform doubles from its upper 53 bits.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace thalweg::oracle {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  double uniform(double least, double most) {
    return least + (most - least) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
  /// Uniform in the exponent; both ends positive.
  double spread(double least, double most) { return least * std::exp(uniform(0, std::log(most / least))); }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(bits() % count); }
  bool chance(double probability) { return uniform(0, 1) < probability; }

 private:
  std::uint64_t state_;
};

}  // namespace thalweg::oracle
