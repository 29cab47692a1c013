// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The main job: one million random triangles against the scene of Luneau's thesis.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace thalweg::cli {

/// The scene as a scene file's text.
extern const std::string_view kDemoScene;

/// The window of the thesis' program, in pixels: where the centres lie.
inline constexpr double kDemoWidth = 1920;
inline constexpr double kDemoHeight = 1080;

/// (N,3,2): centres uniform in the window, each vertex off its centre by a vector uniform in [-60,60]^2. The same
/// numbers on every platform.
[[nodiscard]] std::vector<float> demo_triangles(std::size_t count, std::uint64_t seed);

}  // namespace thalweg::cli
