// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/simplex.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "random.h"

namespace thalweg {
namespace {

using oracle::Random;

void expect_on_simplex(const Barycentric& p, float tolerance = 1e-6F) {
  EXPECT_GE(p.a, 0);
  EXPECT_GE(p.b, 0);
  EXPECT_GE(p.c, 0);
  EXPECT_NEAR(p.a + p.b + p.c, 1, tolerance);
}

double square(double x, double y, double z) { return x * x + y * y + z * z; }

/// Squared distance from (a, b, c) to the simplex, on a fine grid of it.
double least_on_grid(double a, double b, double c) {
  constexpr int kSteps = 200;
  double least = 1e300;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
      least = std::min(least, square(1 - u - v - a, u - b, v - c));
    }
  }
  return least;
}

TEST(SimplexProjection, IsTheClosestPointOfAGrid) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const auto any = [&] { return static_cast<float>(random.uniform(-1.5, 2)); };
    const float a = any(), b = any(), c = any();
    const Barycentric p = project_on_simplex(a, b, c);
    expect_on_simplex(p);
    const double found = std::sqrt(square(p.a - a, p.b - b, p.c - c));
    // The grid may miss the closest point by a cell, never beat it.
    EXPECT_LE(found, std::sqrt(least_on_grid(a, b, c)) + 1e-5) << a << ' ' << b << ' ' << c;
  }
}

TEST(SimplexProjection, LeavesPointsOfTheSimplexWhereTheyAre) {
  for (const Barycentric& p : {Barycentric{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5F, 0.5F, 0}, {0.25F, 0.25F, 0.5F}}) {
    const Barycentric q = project_on_simplex(p.a, p.b, p.c);
    EXPECT_EQ(distance(p, q), 0) << p.a << ' ' << p.b << ' ' << p.c;
  }
}

TEST(SimplexProjection, SendsFarPointsToACorner) {
  const Barycentric p = project_on_simplex(1e6F, 0, -1e6F);
  EXPECT_EQ(p.a, 1);
  EXPECT_EQ(p.b, 0);
  EXPECT_EQ(p.c, 0);
}

TEST(SimplexProjection, IsTheSameForNumbersInAnyOrder) {
  const float x = 0.7F, y = -0.1F, z = 0.9F;
  const Barycentric p = project_on_simplex(x, y, z);
  const Barycentric q = project_on_simplex(z, x, y);
  EXPECT_EQ(p.a, q.b);
  EXPECT_EQ(p.b, q.c);
  EXPECT_EQ(p.c, q.a);
}

struct Corners {
  float at[9];
  std::size_t dimension;
};

double distance_to(const Corners& t, const Barycentric& w, const float* p) {
  double sum = 0;
  for (std::size_t axis = 0; axis < t.dimension; ++axis) {
    const double x = static_cast<double>(w.a) * t.at[axis] + static_cast<double>(w.b) * t.at[t.dimension + axis] +
                     static_cast<double>(w.c) * t.at[2 * t.dimension + axis] - p[axis];
    sum += x * x;
  }
  return std::sqrt(sum);
}

double least_distance(const Corners& t, const float* p) {
  constexpr int kSteps = 120;
  double least = 1e300;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const float u = static_cast<float>(i) / kSteps, v = static_cast<float>(j) / kSteps;
      least = std::min(least, distance_to(t, {std::max(0.0F, 1 - u - v), u, v}, p));
    }
  }
  return least;
}

/// Ordinary, thin, flat and single-point triangles.
Corners random_corners(Random& random, std::size_t dimension, int kind) {
  Corners t{{}, dimension};
  for (std::size_t i = 0; i < 3 * dimension; ++i) t.at[i] = static_cast<float>(random.uniform(-1, 1));
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const float a = t.at[axis], b = t.at[dimension + axis];
    float& c = t.at[2 * dimension + axis];
    if (kind == 1) c = (a + b) / 2 + static_cast<float>(random.uniform(-1e-4, 1e-4));
    if (kind == 2) c = a + (b - a) * 0.25F;
    if (kind == 3) c = t.at[dimension + axis] = a;
  }
  return t;
}

TEST(ClosestPointOfATriangle, IsThatOfAGridForEverySortOfTriangle) {
  Random random(2);
  for (int i = 0; i < 400; ++i) {
    const Corners t = random_corners(random, i % 2 == 0 ? 2 : 3, i / 2 % 4);
    float p[3];
    for (float& x : p) x = static_cast<float>(random.uniform(-2, 2));
    const Barycentric w = closest_point(t.at, p, t.dimension);
    expect_on_simplex(w);
    EXPECT_LE(distance_to(t, w, p), least_distance(t, p) + 2e-4) << i;
  }
}

TEST(ClosestPointOfATriangle, IsThePointItselfInside) {
  const Corners t{{0, 0, 4, 0, 0, 4}, 2};
  const float p[] = {1, 2};
  const Barycentric w = closest_point(t.at, p, 2);
  EXPECT_FLOAT_EQ(w.a, 0.25F);
  EXPECT_FLOAT_EQ(w.b, 0.25F);
  EXPECT_FLOAT_EQ(w.c, 0.5F);
}

TEST(ClosestPointOfATriangle, OfTripledPointIsOfWeightOne) {
  const Corners t{{3, 4, 5, 3, 4, 5, 3, 4, 5}, 3};
  const float p[] = {0, 0, 0};
  expect_on_simplex(closest_point(t.at, p, 3));
}

}  // namespace
}  // namespace thalweg
