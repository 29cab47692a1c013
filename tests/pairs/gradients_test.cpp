// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Every gradient strategy in queries of pairs: normals of all methods and steps of the local ones, and what they take.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gradient/strategies.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

/// One pose of two rounded shapes, which overlap about the x axis.
struct Asked {
  static constexpr std::size_t kContacts = 4;

  Asked(int dimension, Method method, Gradient strategy, bool with_points = true)
      : d(static_cast<std::size_t>(dimension)),
        normal(d),
        contact_normal(kContacts * d),
        first(std::move(compile(ball(dimension))).value()),
        second(std::move(compile(ball(dimension))).value()) {
    const std::vector<float> pose =
        d == 2 ? std::vector<float>{1.5F, 0.5F, 2.0F} : std::vector<float>{1.5F, 0.5F, 0.25F, 0.5F, 0.5F, 0.5F, 0.5F};
    const Tape* const shapes[] = {&first, &second};
    PairQueries queries;
    queries.shapes = shapes, queries.shape_count = 2, queries.poses = pose.data(), queries.count = 1;
    PairOptions options;
    options.method = method, options.goal = Goal::deepest;
    options.gradient = strategy, options.gradient_given = true;
    options.gradient_offset = {.absolute = 1e-3, .of_value = 0};
    std::vector<float> point(d), contact_point(kContacts * d);
    CollideColumns columns;
    columns.normal = normal.data(), columns.evaluations = &evaluations;
    PairContacts contacts;
    contacts.capacity = kContacts, contacts.found = &found, contacts.normal = contact_normal.data();
    if (with_points) columns.point = point.data(), contacts.point = contact_point.data();
    const auto summary = collide_pairs(queries, options, columns, contacts);
    if (!summary) error = summary.error();
  }

  static Shape ball(int dimension) { return dimension == 2 ? circle(1) : sphere(1); }

  std::size_t d;
  std::vector<float> normal, contact_normal;
  std::uint32_t evaluations = 0, found = 0;
  Error error;

 private:
  Tape first, second;
};

std::vector<Gradient> strategies_of(int dimension) {
  std::vector<Gradient> all;
  for (const Gradient strategy : {Gradient::autodiff, Gradient::central, Gradient::forward, Gradient::simplex,
                                  Gradient::closest_point, Gradient::dichotomy, Gradient::dichotomy_verbatim}) {
    const bool plane_alone = strategy == Gradient::dichotomy || strategy == Gradient::dichotomy_verbatim;
    if (dimension == 2 || !plane_alone) all.push_back(strategy);
  }
  return all;
}

TEST(GradientOfPairs, GivesNormalsAlongTheLineOfCentres) {
  for (const int dimension : {2, 3}) {
    const double length = std::sqrt(dimension == 2 ? 2.5 : 2.5625);
    for (const Method method : {Method::certified, Method::thesis, Method::midsurface}) {
      for (const Gradient strategy : strategies_of(dimension)) {
        SCOPED_TRACE(std::string(name(method)) + ' ' + std::string(name(strategy)));
        const Asked asked(dimension, method, strategy);
        ASSERT_EQ(asked.error.expected, "");
        ASSERT_GE(asked.found, 1U);
        const double along = static_cast<double>(asked.normal[0]) * 1.5 + static_cast<double>(asked.normal[1]) * 0.5 +
                             (dimension == 3 ? static_cast<double>(asked.normal[2]) * 0.25 : 0);
        EXPECT_GT(along / length, method == Method::certified ? 0.999 : 0.7);
        for (std::size_t axis = 0; axis < asked.d; ++axis) {
          EXPECT_NEAR(asked.normal[axis], asked.contact_normal[axis], 1e-6) << "the deepest contact is the row's";
        }
      }
    }
  }
}

TEST(GradientOfPairs, IsCountedInEvaluationsOfBothFields) {
  for (const int dimension : {2, 3}) {
    const Tape tape = std::move(compile(Asked::ball(dimension))).value();
    const Asked closed(dimension, Method::certified, Gradient::autodiff);
    for (const Gradient strategy : strategies_of(dimension)) {
      if (strategy == Gradient::autodiff || strategy == Gradient::closest_point) continue;
      SCOPED_TRACE(name(strategy));
      const Asked asked(dimension, Method::certified, strategy);
      const GradientRule rule = rule_of(tape, strategy, {.absolute = 1e-3, .of_value = 0});
      EXPECT_EQ(asked.evaluations, closed.evaluations + (1 + asked.found) * evaluations_of(rule, dimension, false));
      EXPECT_GT(Asked(dimension, Method::thesis, strategy).evaluations,
                Asked(dimension, Method::thesis, Gradient::autodiff).evaluations);
    }
  }
}

TEST(GradientOfPairs, NeedsNoColumnOfPoints) {
  const Asked with(2, Method::certified, Gradient::central);
  const Asked without(2, Method::certified, Gradient::central, false);
  EXPECT_EQ(with.normal, without.normal);
  EXPECT_EQ(with.contact_normal, without.contact_normal);
  EXPECT_EQ(with.evaluations, without.evaluations);
}

TEST(GradientOfPairs, IsRefusedInSpaceForDichotomies) {
  const Asked asked(3, Method::certified, Gradient::dichotomy);
  EXPECT_EQ(asked.error.place, "--gradient");
}

}  // namespace
}  // namespace thalweg
