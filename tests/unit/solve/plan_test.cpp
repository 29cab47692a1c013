// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "thalweg/batch.h"
#include "thalweg/method_table.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

Tape tape_of(const Shape& shape) { return std::move(compile(shape)).value(); }
const Tape& flat() {
  static const Tape tape = tape_of(circle(3));
  return tape;
}
const Tape& solid() {
  static const Tape tape = tape_of(sphere(3));
  return tape;
}

TEST(Plan, FillsInWhatEachMethodTakes) {
  const auto plan_of = [](Method method, QueryKind kind) {
    CollideOptions options;
    options.method = method;
    return *plan(flat(), kind, options);
  };
  const SolveLimits certified = plan_of(Method::certified, QueryKind::triangles);
  EXPECT_EQ(certified.gradient.strategy, Gradient::autodiff);
  EXPECT_EQ(certified.budget, 4096U);
  const SolveLimits thesis = plan_of(Method::thesis, QueryKind::triangles);
  EXPECT_EQ(thesis.gradient.strategy, Gradient::dichotomy_verbatim);
  EXPECT_EQ(thesis.iterations, 64U);
  EXPECT_EQ(thesis.starts, 1U);
  EXPECT_EQ(thesis.step, 0.1);
  EXPECT_EQ(thesis.floor, 100);
  EXPECT_EQ(thesis.stop, 0);
  const SolveLimits projected = plan_of(Method::projected, QueryKind::triangles);
  EXPECT_EQ(projected.iterations, 16U);
  EXPECT_EQ(projected.gradient.strategy, Gradient::autodiff);
  EXPECT_EQ(projected.start, Start::best_of_4);
  EXPECT_EQ(projected.stop, 1e-3);
  EXPECT_EQ(plan_of(Method::golden_section, QueryKind::triangles).starts, 3U);
}

TEST(Plan, KeepsWhatTheCallerSays) {
  CollideOptions options;
  options.method = Method::projected;
  options.gradient = Gradient::simplex, options.gradient_given = true;
  options.starts = 5, options.iterations = 9, options.budget = 77, options.tolerance = 0.25;
  options.floor = 0, options.stop = 0.5, options.step = 2, options.stop_at_witness = true;
  const SolveLimits limits = *plan(solid(), QueryKind::triangles, options);
  EXPECT_EQ(limits.gradient.strategy, Gradient::simplex);
  EXPECT_EQ(limits.starts, 5U);
  EXPECT_EQ(limits.iterations, 9U);
  EXPECT_EQ(limits.budget, 77U);
  EXPECT_EQ(limits.tolerance, 0.25);
  EXPECT_EQ(limits.start, Start::sequence);
  EXPECT_EQ(limits.floor, 0);
  EXPECT_EQ(limits.stop, 0.5);
  EXPECT_EQ(limits.step, 2);
  EXPECT_TRUE(limits.stop_at_witness);
}

TEST(Plan, TakesTheToleranceFromFiniteBounds) {
  EXPECT_DOUBLE_EQ(default_tolerance(flat()), 1e-4 * 6 * std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(default_tolerance(tape_of(half_plane({0, 1}, 0))), 1e-4);
  EXPECT_DOUBLE_EQ(default_tolerance(tape_of(circle(1) & circle(1).translate(Vec2{9, 0}))), 1e-4);
  EXPECT_DOUBLE_EQ(plan(flat(), QueryKind::circles, {})->tolerance, default_tolerance(flat()));
}

TEST(Plan, TakesItsSlackFromTheTapeAndTrustsDoubleWithItsShare) {
  const SolveLimits limits = *plan(flat(), QueryKind::triangles, {});
  EXPECT_EQ(limits.slack.a, flat().search_slack.a);
  EXPECT_EQ(limits.slack.b, flat().search_slack.b);
  EXPECT_EQ(limits.slack64.a, flat().search_slack.a * 0x1p-29);
  EXPECT_EQ(limits.slack64.b, flat().search_slack.b * 0x1p-29);
}

/// The option that a refusal names, or nothing.
std::string refused(const Tape& tape, QueryKind kind, const CollideOptions& options) {
  const auto limits = plan(tape, kind, options);
  return limits ? "" : limits.error().place;
}

TEST(Plan, RefusesMethodsThatDoNotFitTheQuery) {
  CollideOptions options;
  options.method = Method::published;
  EXPECT_EQ(refused(flat(), QueryKind::triangles, options), "--method");
  EXPECT_EQ(refused(flat(), QueryKind::circles, options), "");
  for (const MethodRow& row : method_table()) {
    options.method = row.method;
    const bool circles = row.method == Method::certified || row.method == Method::published;
    EXPECT_EQ(refused(flat(), QueryKind::circles, options), circles ? "" : "--method") << row.name;
    EXPECT_EQ(refused(flat(), QueryKind::triangles, options), row.triangles ? "" : "--method") << row.name;
  }
}

TEST(Plan, RefusesStartsAndRulesThatMakeNoSense) {
  CollideOptions options;
  options.method = Method::projected;
  options.start = Start::vertices, options.starts = 4;
  EXPECT_EQ(refused(flat(), QueryKind::triangles, options), "--starts");
  options.start = Start::halton, options.starts = 400;
  EXPECT_EQ(refused(flat(), QueryKind::triangles, options), "");
  options.method = Method::golden_section;
  EXPECT_EQ(refused(flat(), QueryKind::triangles, options), "--start");
  options = {};
  options.method = Method::thesis, options.step = -1;
  EXPECT_EQ(refused(flat(), QueryKind::triangles, options), "--step");
  options = {};
  options.method = Method::thesis, options.budget = 12;
  EXPECT_EQ(refused(flat(), QueryKind::triangles, options), "--budget");
  options = {};
  options.margin = -1;
  EXPECT_EQ(refused(flat(), QueryKind::triangles, options), "--margin");
}

TEST(MethodTable, SaysOfEveryMethodWhatItDoesAndWhereItComesFrom) {
  for (const MethodRow& row : method_table()) {
    EXPECT_FALSE(row.name.empty());
    EXPECT_FALSE(row.mathematics.empty()) << row.name;
    EXPECT_FALSE(row.source.empty()) << row.name;
    EXPECT_EQ(&method_row(row.method), &row);
    EXPECT_EQ(*parse_method(row.name), row.method);
    if (row.alias.empty()) continue;
    EXPECT_EQ(*parse_method(row.alias), row.method);
  }
}

TEST(Plan, RefusesADichotomyInSpace) {
  CollideOptions options;
  options.method = Method::thesis;
  EXPECT_EQ(refused(solid(), QueryKind::triangles, options), "--gradient");
  options.gradient = Gradient::central, options.gradient_given = true;
  EXPECT_EQ(refused(solid(), QueryKind::triangles, options), "");
  options.method = Method::projected, options.gradient = Gradient::dichotomy;
  EXPECT_EQ(refused(solid(), QueryKind::triangles, options), "--gradient");
}

TEST(Plan, RefusesTolerancesAndBudgetsThatMakeNoSense) {
  for (const double tolerance : {-1.0, std::numeric_limits<double>::quiet_NaN(), Bounds::kInfinity}) {
    CollideOptions options;
    options.tolerance = tolerance;
    EXPECT_EQ(refused(flat(), QueryKind::triangles, options), "--tolerance");
  }
  CollideOptions options;
  options.budget = 0;
  EXPECT_EQ(refused(flat(), QueryKind::triangles, options), "--budget");
}

TEST(Words, OfMethodsGoalsAndGradientsReadBack) {
  for (const Start s : {Start::own, Start::centroid, Start::vertices, Start::mid_edges, Start::best_of_4, Start::halton,
                        Start::sequence}) {
    EXPECT_EQ(*parse_start(name(s)), s);
  }
  EXPECT_EQ(*parse_method("descent"), Method::projected);
  for (const Goal goal : {Goal::verdict, Goal::deepest}) EXPECT_EQ(*parse_goal(name(goal)), goal);
  for (const Gradient g : {Gradient::autodiff, Gradient::central, Gradient::forward, Gradient::simplex,
                           Gradient::dichotomy, Gradient::dichotomy_verbatim}) {
    EXPECT_EQ(*parse_gradient(name(g)), g);
  }
  EXPECT_EQ(name(Gradient::dichotomy_verbatim), "dichotomy:verbatim");
  const auto wrong = parse_method("newton");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().place, "--method");
  EXPECT_EQ(wrong.error().found, "\"newton\"");
  EXPECT_NE(wrong.error().expected.find("certified"), std::string::npos);
  EXPECT_FALSE(parse_goal("deep"));
  EXPECT_FALSE(parse_gradient(""));
}

TEST(ColumnsFromARow, MoveEveryColumnByItsOwnWidth) {
  std::uint8_t bytes[40] = {};
  float floats[200] = {};
  std::uint32_t numbers[40] = {};
  CollideColumns columns;
  columns.status = bytes, columns.converged = bytes + 10, columns.claimed = bytes + 20, columns.ambiguous = bytes + 30;
  columns.starts = numbers, columns.iterations = numbers + 10, columns.evaluations = numbers + 20;
  columns.value = floats, columns.lower = floats + 10, columns.point = floats + 20, columns.normal = floats + 60;
  columns.barycentric = floats + 100;
  const CollideColumns moved = columns_from(columns, 4, 3);
  EXPECT_EQ(moved.status, bytes + 4);
  EXPECT_EQ(moved.ambiguous, bytes + 34);
  EXPECT_EQ(moved.evaluations, numbers + 24);
  EXPECT_EQ(moved.lower, floats + 14);
  EXPECT_EQ(moved.point, floats + 20 + 12);
  EXPECT_EQ(moved.normal, floats + 60 + 12);
  EXPECT_EQ(moved.barycentric, floats + 100 + 12);
  EXPECT_EQ(columns_from(columns, 4, 2).point, floats + 20 + 8);
  EXPECT_EQ(columns_from({}, 4, 2).point, nullptr);
}

}  // namespace
}  // namespace thalweg
