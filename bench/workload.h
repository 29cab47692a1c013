// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the cases run on: the scenes of bench/scenes/ and seeded queries over the thesis' picture, 1920 by 1080.
#pragma once

#include <benchmark/benchmark.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thalweg/scene.h"
#include "thalweg/tape.h"

namespace thalweg::bench {

struct LoadedScene {
  Shape shape;
  Tape tape;
};
/// Reads and compiles bench/scenes/<name>.json; on failure `error` says why.
[[nodiscard]] std::optional<LoadedScene> load_scene(std::string_view name, std::string& error);

/// `count` small primitives on a jittered grid of cells of 100 by 100 units: the density stays whatever the count.
[[nodiscard]] Shape scattered_scene(std::size_t count);

/// Rows (N,2), uniform over the picture.
[[nodiscard]] std::vector<float> picture_points(std::size_t count);
/// Rows (N,3,2): centres uniform over the picture, each vertex offset uniformly by up to 60 units along each axis.
[[nodiscard]] std::vector<float> picture_triangles(std::size_t count);

/// `--smoke`: batches a hundredth of the size, to see that every case runs and answers right.
void use_small_batches();
[[nodiscard]] std::size_t batch(std::size_t full_size);
[[nodiscard]] bool smoke();

/// Ends a case whose answers are wrong: it gets no number, and the program exits with 1.
void refuse(benchmark::State& state, const std::string& why);
[[nodiscard]] bool any_refused();

void register_evaluate_cases();
void register_triangle_cases();
void register_growth_cases();
void register_pair_growth_cases();
void register_sweep_cases();
void register_startup_cases();
void register_vm_cases();
void register_pair_cases();

}  // namespace thalweg::bench
