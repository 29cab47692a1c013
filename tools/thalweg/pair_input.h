// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the commands about two scenes read: both of them, compiled, and the poses of the second.
#pragma once

#include <array>
#include <string>

#include "array.h"
#include "thalweg/pairs.h"

namespace thalweg::cli {

struct PairInput {
  PairInput(const std::string& scene, const std::string& with, const std::string& poses_path);
  PairInput(const PairInput&) = delete;
  PairInput& operator=(const PairInput&) = delete;

  /// They point into this.
  [[nodiscard]] PairQueries queries() const;

  Tape a, b;
  Array poses;

 private:
  std::array<const Tape*, 2> shapes_ = {&a, &b};
};

}  // namespace thalweg::cli
