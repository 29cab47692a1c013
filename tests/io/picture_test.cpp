// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Pictures: which part of the plane they show, that y points up, and that lines are drawn where they belong.
#include "picture.h"

#include <gtest/gtest.h>

#include "support.h"
#include "thalweg/scene.h"

namespace thalweg::cli {
namespace {

constexpr std::string_view kScene =
    R"({"thalweg": 1, "dimension": 2, "shape": {"op": "translate", "by": [0, 3], "of": {"op": "circle", "radius": 1}}})";

Facts facts_within(double x0, double y0, double x1, double y1) {
  Facts facts;
  facts.bounds.lo[0] = x0;
  facts.bounds.lo[1] = y0;
  facts.bounds.hi[0] = x1;
  facts.bounds.hi[1] = y1;
  return facts;
}

bool bluish(Colour colour) { return colour.b > colour.r; }

TEST(View, DefaultsToTheBoundsOfTheShapeAndATenth) {
  const View view = choose_view({}, facts_within(-1, 0, 1, 1));
  EXPECT_DOUBLE_EQ(view.x0, -1.2);
  EXPECT_DOUBLE_EQ(view.x1, 1.2);
  EXPECT_NEAR(view.y0, -0.2, 1e-3);
  EXPECT_NEAR(view.y1, 1.2, 1e-3);
  EXPECT_EQ(view.width, 1280U);
  EXPECT_EQ(view.height, 747U);
}

TEST(View, ShowsExactlyTheBoundsThatAreGiven) {
  ViewRequest request;
  request.bounds = {0, 0, 4, 1};
  request.size = {100, 100};
  const View view = choose_view(request, Facts());
  EXPECT_EQ(view.x1, 4);
  EXPECT_EQ(view.y1, 1);
  const PixelPoint top_left = view.pixel(0, 1);
  EXPECT_EQ(top_left.x, 0);
  EXPECT_EQ(top_left.y, 0);
}

TEST(View, WidensTheBoundsOfTheShapeToTheSize) {
  ViewRequest request;
  request.size = {200, 100};
  const View view = choose_view(request, facts_within(-1, -1, 1, 1));
  EXPECT_DOUBLE_EQ(view.x1 - view.x0, 2 * (view.y1 - view.y0));
}

TEST(View, ShowsAnUnboundedShapeAroundTheOrigin) {
  const View view = choose_view({}, Facts());
  EXPECT_EQ(view.x0, -1);
  EXPECT_EQ(view.y0, -1);
  EXPECT_EQ(view.x1, 1);
  EXPECT_EQ(view.y1, 1);
}

TEST(View, RefusesAnEmptyShapeWithoutBounds) {
  EXPECT_EQ(refusal([] { static_cast<void>(choose_view({}, facts_within(1, 1, -1, -1))); }).place, "--bounds");
}

TEST(View, RefusesBoundsThatAreTurnedAround) {
  ViewRequest request;
  request.bounds = {1, 0, 0, 1};
  EXPECT_EQ(refusal([&] { static_cast<void>(choose_view(request, Facts())); }).expected, "x0 < x1 and y0 < y1");
}

TEST(Picture, HasYUpAndBlueInside) {
  const Result<Scene> scene = parse_scene(kScene, "scene");
  ASSERT_TRUE(scene);
  const Result<Tape> tape = compile(scene->shape);
  ASSERT_TRUE(tape);
  const View view{-4, -4, 4, 4, 80, 80, 0};
  for (const PictureMode mode : {PictureMode::inside, PictureMode::distance}) {
    Canvas canvas = draw_field(*tape, view, {mode, 0}, Globals());
    EXPECT_TRUE(bluish(canvas.at(40, 10)));
    EXPECT_FALSE(bluish(canvas.at(40, 70)));
    EXPECT_FALSE(bluish(canvas.at(10, 10)));
  }
}

TEST(Picture, GradientHasAHueForEachDirection) {
  const Result<Scene> scene = parse_scene(kScene, "scene");
  ASSERT_TRUE(scene);
  const Result<Tape> tape = compile(scene->shape);
  ASSERT_TRUE(tape);
  Canvas canvas = draw_field(*tape, {-4, -1, 4, 7, 80, 80, 0}, {PictureMode::gradient, 0}, Globals());
  const Colour right = canvas.at(75, 40);
  const Colour left = canvas.at(5, 40);
  EXPECT_GT(right.r, left.r);
  EXPECT_GT(left.b, right.b);
}

TEST(Canvas, DrawsALineWhereItIs) {
  Canvas canvas(20, 20);
  canvas.line({2, 10.5}, {18, 10.5}, {{1, 1, 1}, 1, 1});
  EXPECT_FLOAT_EQ(canvas.at(10, 10).r, 1);
  EXPECT_FLOAT_EQ(canvas.at(10, 8).r, 0);
  canvas.line({3, 1}, {17, 19}, {{1, 0, 0}, 2, 1});
  EXPECT_GT(canvas.at(9, 9).r, 0.5F);
  canvas.line({-1e30, 0}, {1e30, 1e300}, {{1, 1, 1}, 1, 1});  // leaves the canvas without harm
}

TEST(Canvas, MakesAPngFile) {
  const std::string file = Canvas(3, 2).png();
  EXPECT_EQ(file.substr(1, 3), "PNG");
  EXPECT_EQ(file.substr(16, 8), std::string("\0\0\0\x03\0\0\0\x02", 8));
}

}  // namespace
}  // namespace thalweg::cli
