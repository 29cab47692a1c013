// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Every function of formulas on every SIMD target against the C++ library in double: values within the units in the
// last place that the table states, gradients against central differences, ranges by sampling.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "columns.h"
#include "program.h"
#include "random.h"
#include "thalweg/op_table.h"
#include "thalweg/shape.h"

namespace thalweg::formulas {
namespace {

using oracle::library_function;
using oracle::Random;

constexpr std::size_t kPoints = 2048;

std::string text_of(const FunctionRow& row) { return std::string(row.name) + (row.operands == 1 ? "(x)" : "(x, y)"); }
double reference(const FunctionRow& row, double a, double b) { return library_function(row.name, a, b); }

Tape tape_of(std::string_view text) {
  auto shape = Shape::formula("expression", 2, text);
  EXPECT_TRUE(shape) << to_string(shape.error());
  return std::move(compile(*shape)).value();
}

/// Numbers where functions are hard: near multiples of pi / 2, near 0 and 1, whole, huge, and tiny.
float hard_number(Random& random) {
  switch (random.index(10)) {
    case 0:
      return static_cast<float>(std::round(random.uniform(-20, 20)));
    case 1:
      return static_cast<float>(std::round(random.uniform(-1e4, 1e4)) * 1.5707963267948966);
    case 2:
      return static_cast<float>(1 + random.uniform(-1e-3, 1e-3));
    case 3:
      return static_cast<float>(random.uniform(-1, 1));
    case 4:
      return static_cast<float>(random.spread(1e-30, 1e30));
    case 5:
      return static_cast<float>(-random.spread(1e-30, 1e30));
    case 6:
      return static_cast<float>(0.5 + std::round(random.uniform(-20, 20)));
    case 7:
      return random.chance(0.5) ? 0.0F : -0.0F;
    case 8:
      return static_cast<float>(random.uniform(-40000, 40000));
    default:
      return static_cast<float>(random.uniform(-10, 10));
  }
}

std::array<Column, 3> hard_points(Random& random) {
  std::array<Column, 3> points;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    points[axis].resize(kPoints);
    for (float& x : points[axis]) x = hard_number(random);
  }
  // Equal operands are hard for comparisons.
  for (std::size_t i = 0; i < kPoints; i += 7) points[1][i] = points[0][i];
  return points;
}

double ulps_between(float found, double exact) {
  const double size = std::max(std::fabs(exact), static_cast<double>(std::numeric_limits<float>::min()));
  const double ulp = std::ldexp(1.0, std::ilogb(size) - 23);
  return std::fabs(static_cast<double>(found) - exact) / ulp;
}

struct OnTarget {
  const FunctionRow* row;
  const Target* target;
};
std::vector<OnTarget> every_function_on_every_target() {
  std::vector<OnTarget> all;
  for (const FunctionRow& row : function_table()) {
    for (const Target& target : targets()) all.push_back({&row, &target});
  }
  return all;
}
std::ostream& operator<<(std::ostream& out, const OnTarget& on) {
  return out << on.row->name << '_' << on.target->name;
}

class Functions : public testing::TestWithParam<OnTarget> {
 protected:
  static std::map<std::string, double>& worst() {
    static std::map<std::string, double> all;
    return all;
  }
  static void TearDownTestSuite() {
    std::printf("%-10s %8s %12s\n", "function", "ulps", "worst");
    for (const FunctionRow& row : function_table()) {
      std::printf("%-10s %8g %12.3f\n", std::string(row.name).c_str(), row.ulps, worst()[std::string(row.name)]);
    }
  }
};

TEST_P(Functions, AreWithinTheirUnitsInTheLastPlace) {
  const FunctionRow& row = *GetParam().row;
  const Tape tape = tape_of(text_of(row));
  for (std::uint64_t seed = 0; seed < amount(8); ++seed) {
    Random random(seed);
    const auto points = hard_points(random);
    const Fields found = fields_at(tape, *GetParam().target, points, kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const auto a = static_cast<double>(points[0][i]), b = static_cast<double>(points[1][i]);
      const double exact = reference(row, a, b);
      const auto say = [&] { return testing::Message() << row.name << '(' << a << ", " << b << ')'; };
      if (std::isnan(exact)) {
        ASSERT_TRUE(std::isnan(found.value[i])) << say();
        continue;
      }
      if (std::fabs(exact) > static_cast<double>(std::numeric_limits<float>::max())) {
        ASSERT_EQ(std::fabs(found.value[i]), std::numeric_limits<float>::infinity()) << say();
        continue;
      }
      const double ulps = ulps_between(found.value[i], exact);
      ASSERT_LE(ulps, row.ulps) << say() << " is " << found.value[i] << ", exactly " << exact;
      worst()[std::string(row.name)] = std::max(worst()[std::string(row.name)], ulps);
    }
  }
}

TEST_P(Functions, HaveGradientsThatCentralDifferencesConfirm) {
  const FunctionRow& row = *GetParam().row;
  const Tape tape = tape_of(text_of(row));
  Random random(1);
  std::array<Column, 3> points;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    points[axis].resize(kPoints);
    for (float& x : points[axis]) x = static_cast<float>(random.uniform(-3, 3));
  }
  const Fields found = fields_at(tape, *GetParam().target, points, kPoints);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto a = static_cast<double>(points[0][i]), b = static_cast<double>(points[1][i]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto slope = [&](double h) {
        const double x = axis == 0 ? h : 0, y = axis == 1 ? h : 0;
        return (reference(row, a + x, b + y) - reference(row, a - x, b - y)) / (2 * h);
      };
      const double near = slope(1e-5), nearer = slope(2e-6);
      // Kinks, steps, poles and the ends of domains.
      if (!(std::fabs(near - nearer) < 1e-4 * (1 + std::fabs(near)))) continue;
      ++compared;
      ASSERT_NEAR(static_cast<double>(found.gradient[axis][i]), nearer, 2e-3 * (1 + std::fabs(nearer)))
          << row.name << '(' << a << ", " << b << "), axis " << axis;
    }
  }
  EXPECT_GT(4 * compared, kPoints);
}

TEST_P(Functions, HaveRangesThatHoldTheirValues) {
  const FunctionRow& row = *GetParam().row;
  const Tape tape = tape_of(text_of(row));
  constexpr std::size_t kBoxes = 512;
  for (std::uint64_t seed = 0; seed < amount(4); ++seed) {
    Random random(1000 + seed);
    Boxes boxes(kBoxes);
    for (std::size_t i = 0; i < kBoxes; ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        boxes.centre[axis][i] = hard_number(random);
        const auto size = std::fabs(boxes.centre[axis][i]);
        boxes.half[axis][i] =
            random.chance(0.2) ? 0 : static_cast<float>(random.spread(1e-6, 1)) * std::max(size, 1.0F);
      }
    }
    boxes.bound(tape, *GetParam().target);
    for (std::size_t i = 0; i < kBoxes; ++i) {
      ASSERT_LE(boxes.lower[i], boxes.upper[i]);
      for (int k = 0; k < 40; ++k) {
        double at[2];
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const double by = k < 4 ? (k >> axis & 1) * 2 - 1 : random.uniform(-1, 1);
          at[axis] = static_cast<double>(boxes.centre[axis][i]) + by * static_cast<double>(boxes.half[axis][i]);
        }
        const double exact = reference(row, at[0], at[1]);
        const auto say = [&] {
          return testing::Message() << row.name << '(' << at[0] << ", " << at[1] << ") = " << exact << ", range "
                                    << boxes.lower[i] << " to " << boxes.upper[i];
        };
        if (std::isnan(exact)) {
          ASSERT_TRUE(std::isinf(boxes.lower[i]) && std::isinf(boxes.upper[i])) << say();
        } else {
          ASSERT_GE(exact, static_cast<double>(boxes.lower[i])) << say();
          ASSERT_LE(exact, static_cast<double>(boxes.upper[i])) << say();
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ops, Functions, testing::ValuesIn(every_function_on_every_target()), [](const auto& on) {
  return std::string(on.param.row->name) + "_" + std::string(on.param.target->name);
});

TEST(FunctionTable, NamesEveryFunctionOfTheLanguage) {
  std::string names;
  for (const FunctionRow& row : function_table()) names += std::string(row.name) + " ";
  for (const char* name : {"min", "max", "abs", "sqrt", "square", "sin", "cos", "tan", "asin", "acos", "atan", "atan2",
                           "exp", "log", "floor", "ceil", "mod", "pow", "compare"}) {
    EXPECT_NE((" " + names).find(" " + std::string(name) + " "), std::string::npos) << name;
  }
}

TEST(Functions, HaveTheSameBitsOnEveryTargetThatFuses) {
  for (const FunctionRow& row : function_table()) {
    const Tape tape = tape_of(text_of(row));
    Random random(7);
    const auto points = hard_points(random);
    const Column* first = nullptr;
    std::vector<Fields> all;
    for (const Target& target : targets()) {
      if (target.fused_multiply_add) all.push_back(fields_at(tape, target, points, kPoints));
    }
    for (const Fields& fields : all) {
      if (first == nullptr) first = &fields.value;
      for (std::size_t i = 0; i < kPoints; ++i) {
        const bool both_nan = std::isnan((*first)[i]) && std::isnan(fields.value[i]);
        ASSERT_TRUE(both_nan ||
                    std::bit_cast<std::uint32_t>((*first)[i]) == std::bit_cast<std::uint32_t>(fields.value[i]))
            << row.name << " of " << points[0][i] << ", " << points[1][i];
      }
    }
  }
}

}  // namespace
}  // namespace thalweg::formulas
