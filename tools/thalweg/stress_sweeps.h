// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The sweeps of `thalweg stress`: one quantity varied, the others as the caller set them; and the roofline.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "command.h"
#include "stress_timing.h"
#include "thalweg/shape.h"

namespace thalweg::cli {

struct StressSettings {
  std::size_t count = 0;  ///< triangles of a batch where that is not what varies
  std::size_t rounds = 0;
};

/// Throughput of `certified` verdicts against batch size, tile size, threads, SIMD target and scene size, then that of
/// every method and of every gradient strategy that the scene admits. Scene size is left out for an unbounded shape.
[[nodiscard]] std::vector<StressSweep> run_sweeps(const Shape& shape, const StressSettings& settings,
                                                  const Globals& globals);

/// What one thread reaches in evaluations per second, against the limits of the machine in the same rounds.
struct Roofline {
  bool native = false;    ///< the limit is native code of the same field; else the tape's own value kernel
  double limit = 0;       ///< evaluations per second with nothing but evaluation to do
  double copy_bytes = 0;  ///< bytes per second that copying far more than the caches hold reads and writes
  std::vector<StressPoint> points;
  std::vector<double> bytes_per_query;  ///< of each point: read and written, each once

  [[nodiscard]] double evaluations_per_byte(std::size_t i) const {
    return points[i].evaluations_per_query / bytes_per_query[i];
  }
};
[[nodiscard]] Roofline measure_roofline(const Shape& shape, const StressSettings& settings, const Globals& globals);

}  // namespace thalweg::cli
