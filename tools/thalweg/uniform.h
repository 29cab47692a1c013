// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Random numbers that are the same on every platform.
#pragma once

#include <cstdint>

namespace thalweg::cli {

/// SplitMix64 (Steele, Lea, Flood 2014) as a function of a counter: row i is the same however many rows there are, and
/// no standard distribution, whose algorithm each library chooses, is involved.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : state_(scramble(seed)) {}

  /// In [0, 1), with 53 random bits.
  double operator()() {
    state_ += 0x9e3779b97f4a7c15;
    return static_cast<double>(scramble(state_) >> 11) * 0x1p-53;
  }

 private:
  static std::uint64_t scramble(std::uint64_t z) {
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
  }

  std::uint64_t state_;
};

}  // namespace thalweg::cli
