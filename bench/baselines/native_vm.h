// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The limit that scalar tapes are held against: .vm models as straight-line code, written by generate_vm.py when the
// build is configured. Models that are not there have none.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace thalweg::bench {

struct NativeModel {
  std::string_view name;
  std::string_view path;
  int dimension = 2;
  std::size_t steps = 0;  ///< constants and coordinates included
  /// f at `count` points of `dimension` numbers each.
  void (*value)(const float* points, std::size_t count, float* value) = nullptr;
};

[[nodiscard]] std::span<const NativeModel> native_models();

}  // namespace thalweg::bench
