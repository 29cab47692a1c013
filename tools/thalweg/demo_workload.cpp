// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The demo's scene and triangles.
#include "demo_workload.h"

#include "uniform.h"

namespace thalweg::cli {

namespace {

constexpr double kReach = 60;

}  // namespace

const std::string_view kDemoScene = R"({
  "thalweg": 1,
  "dimension": 2,
  "shape": {"op": "smooth_union", "k": 1.0, "of": [
    {"op": "translate", "by": [1000, 550], "of": {"op": "star", "radius": 300, "points": 12, "sharpness": 4.0}},
    {"op": "translate", "by": [750, 400],  "of": {"op": "circle", "radius": 200}}
  ]}
})";

std::vector<float> demo_triangles(std::size_t count, std::uint64_t seed) {
  std::vector<float> rows(count * 6);
  Uniform uniform(seed);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = kDemoWidth * uniform();
    const double y = kDemoHeight * uniform();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const double dx = kReach * (2 * uniform() - 1);
      const double dy = kReach * (2 * uniform() - 1);
      rows[6 * i + 2 * corner] = static_cast<float>(x + dx);
      rows[6 * i + 2 * corner + 1] = static_cast<float>(y + dy);
    }
  }
  return rows;
}

}  // namespace thalweg::cli
