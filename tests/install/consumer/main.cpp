// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The main job through public headers alone: build a scene, compile it, collide triangles; exits 0 when both verdicts
// are right.
#include <array>
#include <cstdint>
#include <cstdio>

#include "thalweg/batch.h"
#include "thalweg/ops.h"

int main() {
  using namespace thalweg;
  const Shape scene = smooth_union(1.0, {star(300, 12, 4).translate({1000, 550}), circle(200).translate({750, 400})});
  const Result<Tape> tape = compile(scene);
  if (!tape) {
    std::fprintf(stderr, "%s\n", to_string(tape.error()).c_str());
    return 1;
  }

  const std::array<float, 12> corners = {740, 390, 760, 390, 750, 410,   // inside the circle
                                         100, 100, 150, 100, 120, 140};  // far from everything
  std::array<std::uint8_t, 2> status{};
  CollideColumns columns;
  columns.status = status.data();
  const Result<Summary> summary = collide_triangles(*tape, {.rows = corners.data(), .count = 2}, {}, columns);
  if (!summary) {
    std::fprintf(stderr, "%s\n", to_string(summary.error()).c_str());
    return 1;
  }
  const bool right = status[0] == static_cast<std::uint8_t>(Status::overlapping) &&
                     status[1] == static_cast<std::uint8_t>(Status::separated);
  std::printf("%s, %s\n", name(Status{status[0]}).data(), name(Status{status[1]}).data());
  return right ? 0 : 1;
}
