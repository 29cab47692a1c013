// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// CSV: rows, headers, and the places of what is refused.
#include "csv.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support.h"

namespace thalweg::cli {
namespace {

const RowShape kPoints{{2}, "points"};
const RowShape kTriangles{{3, 2}, "triangles"};

Error refused_csv(std::string_view text, const RowShape& row = kPoints) {
  return refusal([&] { static_cast<void>(parse_csv(text, row, "a.csv")); });
}

TEST(Csv, ReadsRowsWithAndWithoutAHeader) {
  const std::vector<float> expected = {1, 2, -3.5F, 4e2F};
  EXPECT_EQ(parse_csv("1,2\n-3.5,4e2\n", kPoints, "a").values, expected);
  EXPECT_EQ(parse_csv("x,y\r\n1,2\r\n-3.5,4e2", kPoints, "a").values, expected);
  EXPECT_EQ(parse_csv("\xef\xbb\xbf# a comment\n x , y \n\n 1 , +2 \n-3.5,4e2\n", kPoints, "a").values, expected);
}

TEST(Csv, ShapesRowsOfTriangles) {
  const Array array = parse_csv("0,1,2,3,4,5\n", kTriangles, "a");
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{1, 3, 2}));
}

TEST(Csv, ReadsNoRowsFromAnEmptyFile) {
  EXPECT_EQ(parse_csv("", kTriangles, "a").shape, (std::vector<std::size_t>{0, 3, 2}));
  EXPECT_EQ(parse_csv("x,y\n", kPoints, "a").shape, (std::vector<std::size_t>{0, 2}));
}

TEST(Csv, ReadsNonFiniteNumbersAndOverflowsAsBadRows) {
  const Array array = parse_csv("nan,inf\n1e999,-1e999\n1e-999,1e39\n", kPoints, "a");
  EXPECT_TRUE(std::isnan(array.values[0]));
  EXPECT_TRUE(std::isinf(array.values[1]));
  EXPECT_EQ(array.values[2], HUGE_VALF);
  EXPECT_EQ(array.values[3], -HUGE_VALF);
  EXPECT_EQ(array.values[4], 0.0F);
  EXPECT_EQ(array.values[5], HUGE_VALF);
}

TEST(Csv, RefusesAFieldThatIsNoNumber) {
  const Error error = refused_csv("1,2\n3,four\n");
  EXPECT_EQ(error.place, "2:3");
  EXPECT_EQ(error.found, "'four'");
  EXPECT_EQ(refused_csv("1,0x10\n").found, "'0x10'");
  EXPECT_EQ(refused_csv("1,+-2\n").found, "'+-2'");
  EXPECT_EQ(refused_csv("1,2 3\n").found, "'2 3'");
}

TEST(Csv, RefusesAnEmptyField) { EXPECT_EQ(refused_csv("1,\n").found, "''"); }

TEST(Csv, RefusesARowOfAnotherWidth) {
  const Error error = refused_csv("1,2\n3,4,5\n");
  EXPECT_EQ(error.place, "line 2");
  EXPECT_EQ(error.expected, "2 numbers of (N, 2)");
  EXPECT_EQ(error.found, "3 fields");
  EXPECT_EQ(refused_csv("1;2\n").found, "1 fields");
}

TEST(Csv, RefusesASecondHeader) { EXPECT_EQ(refused_csv("x,y\nx,y\n").place, "2:1"); }

}  // namespace
}  // namespace thalweg::cli
