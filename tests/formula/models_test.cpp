// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Whole programs: the project's own, and those of ../shared/models where that folder is beside the repository. Values,
// signs and verdicts against a second reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "columns.h"
#include "program.h"
#include "thalweg/batch.h"
#include "thalweg/scene.h"

namespace thalweg::formulas {
namespace {

using oracle::file_text;
using oracle::Program;
using oracle::Random;

const std::string kOwn = THALWEG_TESTS_DIR "/../bench/scenes/";
const std::string kShared = THALWEG_TESTS_DIR "/../../shared/models/";

std::vector<std::string> models() {
  std::vector<std::string> all;
  for (const std::string& folder : {kOwn, kShared}) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".vm") all.push_back(entry.path().string());
    }
  }
  std::ranges::sort(all);
  return all;
}

struct Model {
  explicit Model(const std::string& path)
      : text(file_text(path)), program(text), tape(std::move(compile(parse_program(text, path)->shape)).value()) {}
  std::string text;
  Program program;
  Tape tape;

  [[nodiscard]] double at(const float* p) const {
    return program.evaluate(static_cast<double>(p[0]), static_cast<double>(p[1]),
                            tape.dimension == 3 ? static_cast<double>(p[2]) : 0.0);
  }
  [[nodiscard]] float in_float32(const float* p) const {
    return program.evaluate(p[0], p[1], tape.dimension == 3 ? p[2] : 0.0F);
  }
};

std::vector<float> random_rows(std::size_t numbers, double size, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> rows(numbers);
  for (float& x : rows) x = static_cast<float>(random.uniform(-size, size));
  return rows;
}

class Models : public testing::TestWithParam<std::string> {};

TEST_P(Models, HaveTheValuesOfASecondReader) {
  const Model model(GetParam());
  const auto d = static_cast<std::size_t>(model.tape.dimension);
  constexpr std::size_t kCount = 4000;
  const auto points = random_rows(kCount * d, 1.2, 1);
  std::vector<float> value(kCount), gradient(kCount * d);
  EXPECT_EQ(evaluate(model.tape, points.data(), kCount, value.data(), gradient.data()), 0U);
  for (std::size_t i = 0; i < kCount; ++i) {
    const double exact = model.at(&points[i * d]);
    if (std::isnan(exact)) {
      EXPECT_TRUE(std::isnan(value[i]));
      continue;
    }
    // Some programs lose most of their digits in float32, where the second reader does so too.
    const auto in_float32 = static_cast<double>(model.in_float32(&points[i * d]));
    const double off = std::min(std::fabs(static_cast<double>(value[i]) - exact),
                                std::fabs(static_cast<double>(value[i]) - in_float32));
    ASSERT_LE(off, 2e-3 * (1 + std::fabs(exact))) << "row " << i << ": " << value[i] << ", exactly " << exact;
    for (std::size_t k = 0; k < d; ++k) ASSERT_TRUE(std::isfinite(gradient[i * d + k]));
  }
}

TEST_P(Models, HaveVerdictsThatDenseSamplingCannotRefute) {
  const Model model(GetParam());
  const auto d = static_cast<std::size_t>(model.tape.dimension);
  const std::size_t count = amount(100);
  auto rows = random_rows(count * 3 * d, 1, 2);
  Random random(3);
  for (std::size_t i = 0; i < count; ++i) {
    // Around the first corner, of all sizes.
    const auto size = static_cast<float>(random.spread(1e-4, 1));
    for (std::size_t k = d; k < 3 * d; ++k) rows[3 * d * i + k] = rows[3 * d * i + k % d] + size * rows[3 * d * i + k];
  }
  std::vector<std::uint8_t> status(count), converged(count);
  std::vector<float> value(count), lower(count), point(count * d);
  for (const Goal goal : {Goal::verdict, Goal::deepest}) {
    CollideColumns columns;
    columns.status = status.data();
    columns.converged = converged.data();
    columns.value = value.data();
    columns.lower = lower.data();
    columns.point = point.data();
    CollideOptions options;
    options.goal = goal;
    ASSERT_TRUE(collide_triangles(model.tape, {rows.data(), count}, options, columns));
    std::size_t decided = 0;
    for (std::size_t i = 0; i < count; ++i) {
      decided += status[i] < 2 ? 1 : 0;
      const float* const corner = &rows[3 * d * i];
      double least = INFINITY;
      for (int k = 0; k < 300; ++k) {
        double u = random.uniform(0, 1), v = random.uniform(0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        if (k % 5 == 0) v = 0;
        double at[3] = {};
        for (std::size_t axis = 0; axis < d; ++axis) {
          const auto a = static_cast<double>(corner[axis]);
          at[axis] =
              a + u * (static_cast<double>(corner[d + axis]) - a) + v * (static_cast<double>(corner[2 * d + axis]) - a);
        }
        const double f = model.program.evaluate(at[0], at[1], at[2]);
        if (!std::isnan(f)) least = std::min(least, f);
      }
      if (status[i] == 0) {
        ASSERT_GT(least, 0) << "row " << i;
      }
      if (status[i] == 1) {
        ASSERT_LT(model.at(&point[i * d]), 0) << "row " << i;
      }
      ASSERT_GE(least, static_cast<double>(lower[i])) << "row " << i;
      if (goal == Goal::deepest && converged[i] != 0) {
        ASSERT_LE(static_cast<double>(value[i]) - least, 2e-4) << "row " << i << ", status " << int{status[i]};
      }
    }
    EXPECT_GT(10 * decided, 9 * count);
  }
}

TEST_P(Models, HaveTheSameAnswersInSpatialOrder) {
  const Model model(GetParam());
  const auto d = static_cast<std::size_t>(model.tape.dimension);
  // Above this many rows long tapes are shortened for tiles of neighbours.
  constexpr std::size_t kMany = 4096;
  const auto points = random_rows(kMany * d, 1, 4);
  std::vector<float> all(kMany), alone(kMany);
  evaluate(model.tape, points.data(), kMany, all.data(), nullptr);
  for (std::size_t i = 0; i < kMany; i += 64) evaluate(model.tape, &points[i * d], 64, &alone[i], nullptr);
  for (std::size_t i = 0; i < kMany; ++i) {
    if (!std::isnan(all[i])) {
      ASSERT_EQ(all[i], alone[i]) << "row " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Models, testing::ValuesIn(models()), [](const auto& path) {
  std::string name = std::filesystem::path(path.param).stem().string();
  std::ranges::replace_if(
      name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

TEST(Prospero, HasTheSignsOfAScalarEvaluation) {
  const std::string path = kShared + "prospero.vm";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const Model model(path);
  EXPECT_EQ(model.tape.dimension, 2);
  const std::size_t side = amount(1) == 1 ? 256 : 1024;
  std::vector<float> points, value(side * side);
  for (std::size_t row = 0; row < side; ++row) {
    for (std::size_t column = 0; column < side; ++column) {
      points.push_back(-1 + 2 * (static_cast<float>(column) + 0.5F) / static_cast<float>(side));
      points.push_back(1 - 2 * (static_cast<float>(row) + 0.5F) / static_cast<float>(side));
    }
  }
  evaluate(model.tape, points.data(), side * side, value.data(), nullptr);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < side * side; ++i) {
    const double exact = model.at(&points[2 * i]);
    inside += exact < 0 ? 1 : 0;
    if (std::fabs(exact) > 1e-5) {
      ASSERT_EQ(value[i] < 0, exact < 0) << "pixel " << i << ", " << exact;
    }
  }
  EXPECT_GT(20 * inside, side * side);
}

}  // namespace
}  // namespace thalweg::formulas
