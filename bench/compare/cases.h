// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the methods are compared on: scenes with seeded triangles, and the minimum of f over each triangle as the
// independent oracle brackets it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "oracle.h"
#include "thalweg/tape.h"

namespace thalweg::bench {

/// A scene of bench/scenes and the size of its triangles.
struct CompareScene {
  std::string_view file;   ///< without its ending
  std::string_view title;  ///< as the table names it
  double size;             ///< corners lie within this of the triangle's centre along each axis, scene units
};
[[nodiscard]] const std::vector<CompareScene>& compare_scenes();

/// One scene with its triangles and the truth about them.
struct CompareCase {
  CompareScene scene;
  Tape tape;
  std::vector<float> rows;  ///< (N,3,d): centres uniform over the bounds grown by a fifth
  std::vector<oracle::Bracket> truth;
  std::vector<oracle::Verdict> verdicts;
  double diagonal = 0;   ///< of the scene's bounds
  double tolerance = 0;  ///< default_tolerance

  [[nodiscard]] std::size_t count() const { return truth.size(); }
  [[nodiscard]] std::size_t hits() const;
};

/// Throws std::runtime_error when the scene cannot be read.
[[nodiscard]] CompareCase make_case(const CompareScene& scene, std::size_t count);

}  // namespace thalweg::bench
