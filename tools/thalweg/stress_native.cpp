// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Native code is known by what it answers: whichever scene file was read, only the field counts.
#include "stress_native.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "thalweg/batch.h"
#ifdef THALWEG_HAS_DEMO
#include "native.h"
#endif

namespace thalweg::cli {

#ifdef THALWEG_HAS_DEMO

NativeValue native_code_of(const Tape& tape, std::span<const float> points) {
  if (tape.dimension != 2) return nullptr;
  const std::size_t count = std::min<std::size_t>(points.size() / 2, 4096);
  std::vector<float> expected(count), found(count);
  evaluate(tape, points.data(), count, expected.data(), nullptr, {.threads = 1});
  double magnitude = 0;
  for (const float x : points) magnitude = std::max(magnitude, std::fabs(static_cast<double>(x)));
  const double tolerance = 2 * tape.slack(magnitude);
  for (const bench::NativeScene& scene : bench::native_scenes()) {
    scene.value(points.data(), count, found.data());
    const bool same = std::equal(expected.begin(), expected.end(), found.begin(),
                                 [&](double a, double b) { return std::fabs(a - b) <= tolerance; });
    if (same) return scene.value;
  }
  return nullptr;
}

#else

NativeValue native_code_of(const Tape&, std::span<const float>) { return nullptr; }

#endif

}  // namespace thalweg::cli
