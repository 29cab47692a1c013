// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What breaks collision code, on every method: kinks, medial axes, coincident surfaces, slivers, triangles without
// area, enormous and tiny coordinates, contact at one point; and random trees of up to 40 nodes. Whatever a method
// finds, what it reports must hold: the oracle checks every row.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <vector>

#include "random_queries.h"
#include "random_shapes.h"
#include "sampling.h"
#include "thalweg/method_table.h"
#include "thalweg/ops.h"
#include "verdict_checks.h"

namespace thalweg::property {
namespace {

struct Hard {
  const char* name;
  Shape shape;
  std::vector<float> rows;
  /// What `certified` must say of each row.
  std::vector<Status> expected;
};
std::ostream& operator<<(std::ostream& out, const Hard& hard) { return out << hard.name; }

constexpr Status kApart = Status::separated, kOver = Status::overlapping, kTouch = Status::touching;

/// Two discs whose fields meet in a ridge (outside) and in a valley (inside).
Shape twins() { return circle(1).translate(Vec2{-1.5, 0}) | circle(1).translate(Vec2{1.5, 0}); }

std::vector<Hard> hard_cases() {
  const auto huge = 1e14F;
  return {
      {"kink_between_two_discs", twins(), {0, -3, 0, 3, 0, 0, -0.4F, -1, 0.4F, -1, 0, 2}, {kApart, kApart}},
      {"ridge_ends_in_a_disc", twins(), {-1, 0, 1, 0, 0, 0.1F, 0, 0, 0.6F, 0, 0, 5}, {kOver, kOver}},
      {"medial_axis_of_a_box", box(Vec2{3, 1}), {-2, 0, 2, 0, 0, 0, -9, 0, 9, 0, 0, 9}, {kOver, kOver}},
      {"centre_of_a_disc", circle(2), {0, 0, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0}, {kOver, kOver}},
      {"centre_of_a_star", star(3, 7, 3), {-1, -1, 1, -1, 0, 2}, {kOver}},
      {"coincident_edge", box(Vec2{2, 1}), {-1, 1, 1, 1, 0, 3, -2, 1, 2, 1, -2, 1}, {kTouch, kTouch}},
      {"coincident_face", box(Vec3{2, 1, 2}), {-1, 1, -1, 1, 1, -1, 0, 1, 1}, {kTouch}},
      {"coincident_operands", box(Vec2{2, 1}) | box(Vec2{2, 1}).translate(Vec2{0, 0}), {5, 0, 6, 0, 5, 1}, {kApart}},
      {"shared_wall",
       box(Vec2{1, 1}).translate(Vec2{-1, 0}) | box(Vec2{1, 1}).translate(Vec2{1, 0}),
       {0, -0.5F, 0, 0.5F, 0, 0, 0, 3, 0, 2, 0, 4},
       {kTouch, kApart}},
      {"sliver_through", circle(1), {-9, 0.5F, 9, 0.5F, 0, 0.50001F}, {kOver}},
      {"sliver_beside", circle(1), {-9, 1.001F, 9, 1.001F, 0, 1.0011F}, {kApart}},
      {"segment", circle(1), {-9, 0.2F, 9, 0.2F, 9, 0.2F, -9, 2, 9, 2, 0, 2}, {kOver, kApart}},
      {"point", circle(1), {0.5F, 0, 0.5F, 0, 0.5F, 0, 7, 0, 7, 0, 7, 0}, {kOver, kApart}},
      {"touching_at_one_point", circle(1), {1, 0, 4, -2, 4, 2, 1, -5, 1, 5, 3, 0}, {kTouch, kTouch}},
      {"touching_corner_to_corner", box(Vec2{1, 1}), {1, 1, 3, 1.5F, 1.5F, 3}, {kTouch}},
      {"enormous_triangle", circle(1), {-huge, -huge, huge, -huge, 0, huge}, {}},
      {"enormous_shape",
       circle(1e9).translate(Vec2{3e9, 0}),
       {1.5e9F, 0, 1.6e9F, 0, 1.5e9F, 1e8F, 3e9F, 0, 3.1e9F, 0, 3e9F, 1e8F},
       {kApart, kOver}},
      {"tiny_shape", circle(1e-9), {2e-9F, 0, 3e-9F, 0, 2e-9F, 1e-9F, 0, 0, 1e-10F, 0, 0, 1e-10F}, {kApart, kOver}},
      {"tiny_triangle",
       circle(1),
       {1.5F, 0, 1.5000001F, 0, 1.5F, 1e-7F, 0.5F, 0, 0.5000001F, 0, 0.5F, 1e-7F},
       {kApart, kOver}},
      {"unsigned_segment",
       segment({0, 0}, {3, 1}),
       {-1, -1, 4, -1, 1, 4, 1, 0, 1, 1, 5, 3, 0, 1, 1, 1, 0, 2},
       {kTouch, kTouch, kApart}},
      {"unsigned_segment_beside_a_disc",
       segment({0, 0}, {3, 1}) | circle(1).translate(Vec2{0, 4}),
       {-1, -1, 4, -1, 1, 2, 0, 0, 1, 0, 0, 3.5F, 5, 0, 6, 0, 5, 1},
       {kTouch, kOver, kApart}},
      {"thin_shell", onion(sphere(2), 1e-3), {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 3, 0, 0, 0, 3, 0}, {kApart, kOver}},
  };
}

std::string fault_on(const Shape& shape, const std::vector<float>& rows, const MethodRow& row, Goal goal,
                     std::vector<std::uint8_t>* status = nullptr) {
  const Tape tape = std::move(compile(shape)).value();
  CollideOptions options;
  options.method = row.method, options.goal = goal;
  if (tape.dimension == 3 && row.gradient == Gradient::dichotomy_verbatim) {
    options.gradient = Gradient::autodiff, options.gradient_given = true;
  }
  const Answers answers = answer(tape, Form::triangles, rows, options);
  if (status != nullptr) *status = answers.status;
  const Findings findings = check_rows(oracle::Field(shape), tape, answers);
  if (findings.over_budget > 0) return "over budget";
  for (std::size_t i = 0; i < answers.count() && !row.proves; ++i) {
    const bool silent = answers.status[i] == 1 || answers.status[i] == 3;
    if (!silent || answers.lower[i] != -std::numeric_limits<float>::infinity()) return "a local method proves more";
  }
  return findings.fault;
}

class AdversarialCase : public testing::TestWithParam<Hard> {};

TEST_P(AdversarialCase, IsAnsweredTruthfullyByEveryMethod) {
  const Hard& hard = GetParam();
  for (const MethodRow& row : method_table()) {
    if (!row.triangles) continue;
    for (const Goal goal : {Goal::verdict, Goal::deepest}) {
      EXPECT_EQ(fault_on(hard.shape, hard.rows, row, goal), "") << row.name << ' ' << name(goal);
    }
  }
}

TEST_P(AdversarialCase, IsDecidedByTheCertifiedMethod) {
  const Hard& hard = GetParam();
  std::vector<std::uint8_t> status;
  ASSERT_EQ(fault_on(hard.shape, hard.rows, method_row(Method::certified), Goal::verdict, &status), "");
  for (std::size_t i = 0; i < hard.expected.size(); ++i) {
    EXPECT_EQ(name(static_cast<Status>(status[i])), name(hard.expected[i])) << "row " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, AdversarialCase, testing::ValuesIn(hard_cases()),
                         [](const auto& hard) { return std::string(hard.param.name); });

TEST(LocalMethods, ReportOnRandomTreesWhatTheOracleConfirms) {
  for (const Drawn& drawn : drawn_trees(81'000, amount(8))) {
    const oracle::Field field(drawn.shape);
    oracle::Random random(drawn.seed);
    const auto rows = mixed_triangles(random, field, oracle::region_of(drawn.shape), 24);
    for (const MethodRow& row : method_table()) {
      if (!row.triangles || row.proves) continue;
      ASSERT_EQ(fault_on(drawn.shape, rows, row, Goal::deepest), "") << row.name << "\n"
                                                                     << oracle::describe(drawn.shape, drawn.seed);
    }
  }
}

TEST(AcceleratedMethod, MissesNoOverlapOfRandomTreesThatPublishedOnesFind) {
  std::size_t ours = 0, theirs = 0;
  for (const Drawn& drawn : drawn_trees(82'000, amount(12))) {
    const Tape tape = std::move(compile(drawn.shape)).value();
    const oracle::Field field(drawn.shape);
    oracle::Random random(drawn.seed);
    const auto rows = random_triangles(random, field, oracle::region_of(drawn.shape), oracle::QueryKind::plain, 200);
    const auto hits = [&](Method method) {
      CollideOptions options;
      options.method = method;
      return answer(tape, Form::triangles, rows, options).summary.by_status[1];
    };
    ours += hits(Method::accelerated);
    theirs += hits(Method::projected);
  }
  EXPECT_GT(theirs, 200U);
  EXPECT_GE(ours, theirs);
}

}  // namespace
}  // namespace thalweg::property
