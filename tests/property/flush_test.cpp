// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Triangles parallel to a face, where a bound that only knows f(c) - L r needs (edge / tolerance)^2 cells. The
// minimum is the gap, known without any search.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg::property {
namespace {

struct Flush {
  const char* name;
  Shape shape;
  int dimension;
  double height;  ///< of the face: y in 2D and 3D
};

std::vector<Flush> flush_cases() {
  const Shape slab = box(Vec2{8, 1}), block = box(Vec3{8, 1, 8});
  return {
      {"half_plane", half_plane({0, 1}, 1), 2, 1},
      {"plane", plane({0, 1, 0}, 1), 3, 1},
      {"box", slab, 2, 1},
      {"block", block, 3, 1},
      {"cylinder", cylinder(1, 9), 3, 1},
      {"union", slab.translate(Vec2{0, -0.5}) | slab, 2, 1},
      {"rounded", round(block, 0.5), 3, 1.5},
      {"lifted", block.translate(Vec3{0, 3, 0}) | sphere(0.5).translate(Vec3{0, -9, 0}), 3, 4},
  };
}

struct Answer {
  Status status;
  float value, lower;
  bool converged;
  std::uint32_t evaluations;
};

/// 2D: an edge parallel to the face and the third corner above it; 3D: all corners at the gap.
Answer ask(const Flush& flush, double gap, Goal goal) {
  const auto tape = compile(flush.shape);
  EXPECT_TRUE(tape);
  const auto y = static_cast<float>(flush.height + gap);
  const std::vector<float> rows = flush.dimension == 2 ? std::vector<float>{-3, y, 4, y, 1, y + 2}
                                                       : std::vector<float>{-3, y, -2, 4, y, -3, 1, y, 5};
  std::uint8_t status = 77, converged = 77;
  Answer answer{};
  CollideColumns columns;
  columns.status = &status, columns.converged = &converged, columns.value = &answer.value;
  columns.lower = &answer.lower, columns.evaluations = &answer.evaluations;
  CollideOptions options;
  options.goal = goal;
  options.tolerance = 1e-4;
  EXPECT_TRUE(collide_triangles(*tape, {rows.data(), 1}, options, columns));
  answer.status = static_cast<Status>(status);
  answer.converged = converged == 1;
  return answer;
}

TEST(FlushTriangle, IsSeparatedAboveTheFaceAfterAHandfulOfEvaluations) {
  for (const Flush& flush : flush_cases()) {
    for (const double gap : {0.5, 1e-2, 1e-4}) {
      const Answer answer = ask(flush, gap, Goal::verdict);
      EXPECT_EQ(answer.status, Status::separated) << flush.name << " gap " << gap;
      EXPECT_LE(answer.evaluations, 64U) << flush.name << " gap " << gap;
      EXPECT_LE(answer.lower, gap + 1e-6) << flush.name;
    }
  }
}

TEST(FlushTriangle, OverlapsBelowTheFace) {
  for (const Flush& flush : flush_cases()) {
    for (const double gap : {-0.5, -1e-2, -1e-4}) {
      EXPECT_EQ(ask(flush, gap, Goal::verdict).status, Status::overlapping) << flush.name << " gap " << gap;
    }
  }
}

// A sign would be a better answer than touching, so half of the budget may go into looking for one.
TEST(FlushTriangle, TouchesInTheFaceWithinHalfTheBudget) {
  for (const Flush& flush : flush_cases()) {
    const Answer answer = ask(flush, 0, Goal::verdict);
    EXPECT_EQ(answer.status, Status::touching) << flush.name;
    EXPECT_LE(answer.evaluations, CollideOptions().budget / 2) << flush.name;
  }
}

TEST(FlushTriangle, ConvergesToTheGap) {
  for (const Flush& flush : flush_cases()) {
    for (const double gap : {0.5, 1e-2, 0.0, -1e-2}) {
      const Answer answer = ask(flush, gap, Goal::deepest);
      EXPECT_TRUE(answer.converged) << flush.name << " gap " << gap;
      EXPECT_NEAR(answer.value, gap, 1.1e-4) << flush.name;
      EXPECT_LE(answer.lower, gap + 1e-6) << flush.name;
      const std::uint32_t enough = gap == 0 ? CollideOptions().budget / 2 : 256U;
      EXPECT_LE(answer.evaluations, enough) << flush.name << " gap " << gap;
    }
  }
}

}  // namespace
}  // namespace thalweg::property
