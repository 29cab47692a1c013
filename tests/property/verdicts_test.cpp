// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Certified answers for triangles and circles against the oracle's own branch and bound: 5 000 queries a scene, and
// 100 000 in the long run; half of them are of the kinds that break collision code.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <ostream>

#include "random_queries.h"
#include "random_shapes.h"
#include "sampling.h"
#include "thalweg/ops.h"
#include "thalweg/scene.h"
#include "verdict_checks.h"

namespace thalweg::property {
namespace {

using oracle::describe;
using oracle::Random;

Shape scene_file(const std::string& name) {
  std::ifstream file(THALWEG_TESTS_DIR "/../bench/scenes/" + name + ".json", std::ios::binary);
  const auto scene = parse_scene(std::string{std::istreambuf_iterator<char>(file), {}}, name);
  if (!scene) throw std::invalid_argument(to_string(scene.error()));
  return scene->shape;
}

Shape bracket3() {
  const Shape plate = box(Vec3{40, 6, 25});
  const Shape post = capsule({0, 0, 0}, {0, 40, 0}, 9).rotate(Vec3{0, 0, 1}, -0.4);
  const Shape hole = cylinder(20, 7).translate(Vec3{24, 0, 8});
  const Shape ring = torus(18, 5).rotate(Vec3{1, 0.2, 0}, 0.9).translate(Vec3{-16, 20, 0});
  return smooth_union(2, {plate - hole, post, ring}).translate(Vec3{100, 50, -30});
}

/// Faces flush with half spaces, on and off the axes.
Shape wedge() {
  const double slope = 1 / std::numbers::sqrt2;
  return half_plane({0, 1}, 2) & half_plane({slope, slope}, 3) & half_plane({-0.6, -0.8}, 1.5);
}

Shape hollow() { return onion(star(20, 5, 2.6), 0.5) | mirror(circle(4).translate(Vec2{9, -3}), 0); }
Shape quarter_space() { return plane({0.6, 0, 0.8}, 2) & plane({0, 1, 0}, 1); }

struct Scene {
  const char* name;
  Shape (*make)();
  /// Part of the ordinary triangles whose deepest point may stay unproven within the budget: along a valley whose
  /// floor is level (the middle of a ring, a stroke or a wall) every cell of the floor's length stays open.
  double unconverged;
};
std::ostream& operator<<(std::ostream& out, const Scene& scene) { return out << scene.name; }

const Scene kScenes[] = {
    {"thesis", [] { return scene_file("small"); }, 1e-3},
    {"primitives12", [] { return scene_file("primitives12"); }, 0.1},
    {"primitives60", [] { return scene_file("primitives60"); }, 0.05},
    {"cool_s", [] { return cool_s().scale(50).rotate(0.3); }, 0.1},
    {"wedge", wedge, 1e-3},
    {"hollow", hollow, 0.2},
    {"bracket3", bracket3, 0.05},
    {"plane3", quarter_space, 1e-3},
};

class Certified : public testing::TestWithParam<std::tuple<Scene, Form, Goal>> {};

TEST_P(Certified, AnswersAgreeWithTheOracle) {
  const auto& [scene, form, goal] = GetParam();
  const Shape shape = scene.make();
  const auto tape = compile(shape);
  ASSERT_TRUE(tape) << to_string(tape.error());
  const oracle::Field field(shape);
  const auto region = oracle::region_of(shape);
  CollideOptions options;
  options.goal = goal;
  Random random(2026);
  // Discs and deepest points cost the oracle much more than the verdicts of triangles.
  const std::size_t verdicts = form == Form::triangles ? 5000 : 1000;
  const std::size_t count = amount(goal == Goal::verdict ? verdicts : verdicts / 10);
  auto rows = form == Form::triangles ? mixed_triangles(random, field, region, count)
                                      : mixed_circles(random, field, region, count);
  const Answers answers = answer(*tape, form, std::move(rows), options);
  const Findings findings = check_rows(field, *tape, answers);
  EXPECT_EQ(findings.fault, "");
  EXPECT_EQ(findings.over_budget, 0U);
  EXPECT_EQ(answers.summary.rows, count);
  RecordProperty("oracle_cannot_tell", static_cast<int>(findings.unknown));
  RecordProperty("undecided", static_cast<int>(findings.undecided));
  RecordProperty("unconverged", static_cast<int>(findings.unconverged));
}

std::string name_of(const testing::TestParamInfo<Certified::ParamType>& info) {
  const auto& [scene, form, goal] = info.param;
  return std::string(scene.name) + (form == Form::triangles ? "_triangles_" : "_circles_") + std::string(name(goal));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Certified,
                         testing::Combine(testing::ValuesIn(kScenes), testing::Values(Form::triangles, Form::circles),
                                          testing::Values(Goal::verdict, Goal::deepest)),
                         name_of);

class CertifiedPlain : public testing::TestWithParam<Scene> {};

// Adversarial queries may end undecided; ordinary ones must not.
TEST_P(CertifiedPlain, TrianglesAreDecidedAndDeepestConverges) {
  const Shape shape = GetParam().make();
  const auto tape = compile(shape);
  ASSERT_TRUE(tape) << to_string(tape.error());
  const oracle::Field field(shape);
  Random random(7);
  const auto rows = random_triangles(random, field, oracle::region_of(shape), oracle::QueryKind::plain, amount(5000));
  CollideOptions options;
  const Answers verdicts = answer(*tape, Form::triangles, rows, options);
  EXPECT_LE(static_cast<double>(verdicts.summary.by_status[3]), 1e-4 * static_cast<double>(verdicts.count()));
  options.goal = Goal::deepest;
  const Answers deepest = answer(*tape, Form::triangles, rows, options);
  std::size_t unconverged = 0;
  for (const auto converged : deepest.converged) unconverged += converged == 1 ? 0U : 1U;
  EXPECT_LE(static_cast<double>(unconverged), GetParam().unconverged * static_cast<double>(deepest.count()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, CertifiedPlain, testing::ValuesIn(kScenes),
                         [](const auto& scene) { return std::string(scene.param.name); });

TEST(CertifiedRandomShapes, AnswersAgreeWithTheOracle) {
  for (const Drawn& drawn : drawn_trees(31'000, amount(24))) {
    const auto tape = compile(drawn.shape);
    ASSERT_TRUE(tape) << to_string(tape.error()) << "\n" << describe(drawn.shape, drawn.seed);
    const oracle::Field field(drawn.shape);
    const auto region = oracle::region_of(drawn.shape);
    Random random(drawn.seed ^ 0x7a1a);
    for (const Goal goal : {Goal::verdict, Goal::deepest}) {
      CollideOptions options;
      options.goal = goal;
      const std::size_t count = goal == Goal::verdict ? 160 : 40;
      const Answers triangles = answer(*tape, Form::triangles, mixed_triangles(random, field, region, count), options);
      ASSERT_EQ(check_rows(field, *tape, triangles).fault, "") << describe(drawn.shape, drawn.seed);
      const Answers circles = answer(*tape, Form::circles, mixed_circles(random, field, region, count), options);
      ASSERT_EQ(check_rows(field, *tape, circles).fault, "") << describe(drawn.shape, drawn.seed);
    }
  }
}

}  // namespace
}  // namespace thalweg::property
