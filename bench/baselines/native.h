// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The limit that evaluation is held against: the benchmark scenes as straight-line code, constants folded, two of the
// host's widest vectors in flight, strict IEEE. Answers agree with core's within rounding.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace thalweg::bench {

struct NativeScene {
  std::string_view name;  ///< its scene file is bench/scenes/<name>.json
  /// f at `count` points, rows (N,2) in C order.
  void (*value)(const float* points, std::size_t count, float* value) = nullptr;
  /// The same with its gradient, rows (N,2).
  void (*gradient)(const float* points, std::size_t count, float* value, float* gradient) = nullptr;
};

[[nodiscard]] std::span<const NativeScene> native_scenes();

/// float32 lanes of one vector of the host, as compiled.
[[nodiscard]] std::size_t native_lanes();

}  // namespace thalweg::bench
