// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// thalweg_bench [--smoke] [Google Benchmark's own options]
//
// Every case checks its answers before it is timed: a wrong result is an error, not a number. `--smoke` runs all of
// them in seconds on small batches; its ratios mean nothing.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "baselines/native.h"
#include "thalweg/simd.h"
#include "workload.h"

int main(int count, char** arguments) {
  std::vector<char*> kept(arguments, arguments + count);
  std::string short_time = "--benchmark_min_time=0.01";
  const auto smoke =
      std::find_if(kept.begin(), kept.end(), [](const char* text) { return std::string_view(text) == "--smoke"; });
  if (smoke != kept.end()) {
    *smoke = short_time.data();
    thalweg::bench::use_small_batches();
  }
  int kept_count = static_cast<int>(kept.size());
  benchmark::Initialize(&kept_count, kept.data());
  if (benchmark::ReportUnrecognizedArguments(kept_count, kept.data())) return 1;
  benchmark::AddCustomContext("thalweg_target", std::string(thalweg::default_target().name));
  benchmark::AddCustomContext("native_lanes", std::to_string(thalweg::bench::native_lanes()));
  thalweg::bench::register_evaluate_cases();
  thalweg::bench::register_triangle_cases();
  thalweg::bench::register_growth_cases();
  thalweg::bench::register_pair_growth_cases();
  thalweg::bench::register_startup_cases();
  thalweg::bench::register_vm_cases();
  thalweg::bench::register_pair_cases();
  thalweg::bench::register_sweep_cases();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return thalweg::bench::any_refused() ? 1 : 0;
}
