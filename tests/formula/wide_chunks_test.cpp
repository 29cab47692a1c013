// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Values of many points go through the wide chunks of kernels/scalars.cpp, those of few through the machine that every
// tape has. Random programs use every op with operands from everywhere.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "columns.h"
#include "oracle/program.h"
#include "oracle/random.h"
#include "thalweg/batch.h"
#include "thalweg/scene.h"

namespace thalweg::formulas {
namespace {

constexpr std::size_t kMany = 200;

bool same_bits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b)); }

TEST(WideChunks, HaveTheBitsOfPointsAlone) {
  for (std::size_t seed = 1; seed <= amount(60); ++seed) {
    oracle::Random random(seed);
    const int dimension = random.chance(0.5) ? 2 : 3;
    const std::string text = oracle::random_program(random, 60, random.chance(0.5), dimension);
    const auto scene = parse_program(text, "random.vm");
    ASSERT_TRUE(scene) << to_string(scene.error());
    const Tape tape = *compile(scene->shape);
    const auto d = static_cast<std::size_t>(tape.dimension);
    Column points(kMany * d), together(kMany), alone(kMany);
    for (float& x : points) {
      static constexpr double kEdges[] = {0, -0.0, 1, -1, 1e-42, -1e-42, 1e14};
      x = static_cast<float>(random.chance(0.3) ? kEdges[random.index(std::size(kEdges))] : random.uniform(-3, 3));
    }
    for (const Target& target : targets()) {
      const Execution execution{.threads = 1, .target = &target};
      evaluate(tape, points.data(), kMany, together.data(), nullptr, execution);
      for (std::size_t i = 0; i < kMany; ++i) evaluate(tape, &points[i * d], 1, &alone[i], nullptr, execution);
      for (std::size_t i = 0; i < kMany; ++i) {
        ASSERT_TRUE(same_bits(together[i], alone[i]))
            << target.name << ", seed " << seed << ", row " << i << ": " << together[i] << " and " << alone[i] << "\n"
            << text;
      }
    }
  }
}

/// Instructions that move points are not scalar: no wide chunk can take them.
TEST(WideChunks, AreNotAskedOfWarpedFormulas) {
  const auto scene = parse_scene(R"({"thalweg": 1, "dimension": 2, "shape": {"op": "mirror", "axis": "x",
                                     "of": {"op": "expression", "text": "x + 2 * y"}}})",
                                 "warped.json");
  ASSERT_TRUE(scene) << to_string(scene.error());
  const Tape tape = *compile(scene->shape);
  EXPECT_FALSE(tape.only_scalars);
  Column points, value(kMany), gradient(2 * kMany);
  for (std::size_t i = 0; i < kMany; ++i) {
    points.insert(points.end(), {static_cast<float>(i) - 99.5F, 0.25F * static_cast<float>(i)});
  }
  for (const Target& target : targets()) {
    const Execution execution{.threads = 1, .target = &target};
    evaluate(tape, points.data(), kMany, value.data(), nullptr, execution);
    for (std::size_t i = 0; i < kMany; ++i) ASSERT_EQ(value[i], std::abs(points[2 * i]) + 2 * points[2 * i + 1]) << i;
    evaluate(tape, points.data(), kMany, value.data(), gradient.data(), execution);
    for (std::size_t i = 0; i < kMany; ++i) {
      ASSERT_EQ(value[i], std::abs(points[2 * i]) + 2 * points[2 * i + 1]) << i;
      ASSERT_EQ(gradient[2 * i], points[2 * i] < 0 ? -1 : 1) << i;
      ASSERT_EQ(gradient[2 * i + 1], 2) << i;
    }
  }
}

/// Columns end in the middle of a wide chunk.
TEST(WideChunks, HaveTheBitsOfPointsInRows) {
  const Tape tape = *compile(parse_program("x var-x\ny var-y\na max x y\nb sqrt y\nc min a b\n", "some.vm")->shape);
  oracle::Random random(7);
  std::array<Column, 3> columns;
  for (Column& column : columns) {
    for (std::size_t i = 0; i < kMany; ++i) column.push_back(static_cast<float>(random.uniform(-3, 3)));
  }
  Column rows, value(kMany);
  for (std::size_t i = 0; i < kMany; ++i) rows.insert(rows.end(), {columns[0][i], columns[1][i]});
  for (const Target& target : targets()) {
    evaluate(tape, rows.data(), kMany, value.data(), nullptr, {.threads = 1, .target = &target});
    const Fields fields = fields_at(tape, target, columns, kMany);
    for (std::size_t i = 0; i < kMany; ++i)
      ASSERT_TRUE(same_bits(fields.value[i], value[i])) << target.name << ' ' << i;
  }
}

}  // namespace
}  // namespace thalweg::formulas
