// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A nut on a bolt: narrow gaps all around, the scene that distance fields in collision are shown on. Threads are rings
// here, ridges on the bolt and wider grooves in the nut, so that what is true follows from a few lengths.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "asked_pairs.h"
#include "pair_oracle.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

constexpr double kPitch = 0.2;

Shape hexagonal_prism(double apothem, double half_height) {
  std::vector<Shape> slabs;
  for (int k = 0; k < 3; ++k) {
    slabs.push_back(box({apothem, half_height, 2 * apothem}).rotate(Vec3{0, 1, 0}, k * std::numbers::pi / 3));
  }
  return intersection(slabs);
}

Shape ring_at(double radius, double tube, double y) { return torus(radius, tube).translate(Vec3{0, y, 0}); }

/// A shaft of radius 0.3 with ridges up to 0.34, and a head whose lower face is at y = -0.5.
Shape bolt() {
  std::vector<Shape> parts = {cylinder(0.5, 0.3), hexagonal_prism(0.45, 0.1).translate(Vec3{0, -0.6, 0})};
  for (int k = -2; k <= 2; ++k) parts.push_back(ring_at(0.3, 0.04, k * kPitch));
  return union_(parts);
}

/// A bore of radius 0.32 with two grooves up to 0.38.
Shape nut() {
  return subtraction({hexagonal_prism(0.5, 0.15), cylinder(0.3, 0.32), ring_at(0.32, 0.06, -kPitch / 2),
                      ring_at(0.32, 0.06, kPitch / 2)});
}

struct Fit {
  std::vector<float> poses;
  std::vector<Status> expected;

  void add(double x, double y, double turn, Status status) {
    for (const double number : {x, y, 0.0, std::cos(turn / 2), 0.0, std::sin(turn / 2), 0.0}) {
      poses.push_back(static_cast<float>(number));
    }
    expected.push_back(status);
  }
};

TEST(CertifiedPairs, ANutIsFreeOnABoltWhereTheThreadsMeshAndOnlyThere) {
  Fit fit;
  for (const double y : {-0.1, 0.1, 0.3}) {
    for (const double turn : {0.0, 0.4, 2.0}) fit.add(0, y, turn, Status::separated);
  }
  fit.add(0.01, 0.1, 0, Status::separated);
  fit.add(0, 0, 0, Status::overlapping);       // half a pitch off: the ridge at y = 0 cuts the land between the grooves
  fit.add(0.03, 0.1, 0, Status::overlapping);  // off the axis by more than the gap
  fit.add(0, -0.42, 0.4, Status::overlapping);  // into the head
  const std::size_t count = fit.expected.size();

  const Tape a = std::move(compile(bolt())).value();
  const Tape b = std::move(compile(nut())).value();
  const Tape* const shapes[] = {&a, &b};
  std::vector<std::uint8_t> status(count), converged(count);
  std::vector<float> value(count), lower(count), point(3 * count);
  CollideColumns columns;
  columns.status = status.data(), columns.converged = converged.data();
  columns.value = value.data(), columns.lower = lower.data(), columns.point = point.data();
  PairQueries queries;
  queries.shapes = shapes, queries.shape_count = 2, queries.poses = fit.poses.data(), queries.count = count;
  PairOptions options;
  options.budget = 65536;  // the gap of 0.02 is all around
  ASSERT_TRUE(collide_pairs(queries, options, columns));

  for (std::size_t row = 0; row < count; ++row) {
    SCOPED_TRACE(row);
    const oracle::PairField field(bolt(), nut(), oracle::placement(fit.poses.data() + 7 * row, 3));
    const oracle::PairGrid grid(field, {{-0.6, -0.71, -0.6}, {0.6, 0.51, 0.6}}, 48);
    EXPECT_EQ(name(static_cast<Status>(status[row])), name(fit.expected[row]));
    EXPECT_EQ(converged[row], 1);
    EXPECT_LE(lower[row], grid.least());
    const oracle::Vec at = {point[3 * row], point[3 * row + 1], point[3 * row + 2]};
    EXPECT_NEAR(value[row], field(at), 1e-5);
    EXPECT_EQ(field(at) < 0, fit.expected[row] == Status::overlapping);
  }
}

}  // namespace
}  // namespace thalweg
