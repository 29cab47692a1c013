// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the scene parser refuses, and how it says so: the JSON pointer of what is wrong (line:column where the text is
// no JSON at all), what was expected there and what was found.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <set>
#include <string>

#include "thalweg/scene.h"

namespace thalweg {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Malformed {
  const char* name;
  std::string text;
  const char* place;
  const char* expected;  ///< part of the error's text
  const char* found;
};
std::ostream& operator<<(std::ostream& out, const Malformed& malformed) { return out << malformed.name; }

std::string scene(int dimension, const std::string& shape, const std::string& rest = "") {
  return R"({"thalweg": 1, "dimension": )" + std::to_string(dimension) + R"(, "shape": )" + shape + rest + "}";
}
std::string in2(const std::string& shape) { return scene(2, shape); }
std::string in3(const std::string& shape) { return scene(3, shape); }
std::string defining(const std::string& shape, const std::string& define) {
  return scene(2, shape, R"(, "define": )" + define);
}
std::string repeated(const std::string& part, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += part;
  return all;
}
/// One radius of a circle, as it stands in the text.
std::string radius(const std::string& text) { return in2(R"({"op": "circle", "radius": )" + text + "}"); }

// --- no JSON: line:column
// -----------------------------------------------------------------------------------------------

const Malformed kSyntax[] = {
    {"empty_text", "", "1:1", "JSON", ""},
    {"missing_value", "{\"thalweg\": 1,\n \"dimension\": 2,\n \"shape\": }", "3:11", "JSON", "}"},
    {"text_after_the_end", in2(R"({"op": "circle", "radius": 1})") + "\nx", "2:1", "JSON", "invalid"},
    {"trailing_comma", "{\"thalweg\": 1,}", "1:15", "JSON", "}"},
    {"single_quotes", "{'thalweg': 1}", "1:2", "JSON", "invalid"},
    {"comment", "{\n// note\n\"thalweg\": 1}", "2:1", "JSON", "invalid"},
    {"nan", radius("NaN"), "1:68", "JSON", "invalid"},
    {"infinity", radius("Infinity"), "1:68", "JSON", "invalid"},
    {"negative_infinity", radius("-Infinity"), "1:69", "JSON", "invalid"},
    {"leading_zero", radius("01"), "1:69", "JSON", "number"},
    {"plus_sign", radius("+1"), "1:68", "JSON", "invalid"},
    {"no_digit_before_the_point", radius(".5"), "1:68", "JSON", "invalid"},
    {"no_digit_after_the_point", radius("1."), "1:70", "JSON", "invalid"},
    {"hexadecimal", radius("0x10"), "1:69", "JSON", "invalid"},
    {"overflowing_number", radius("1e999"), "1:72", "a number that a double can hold", "1e999"},
    {"overflowing_negative_number", radius("-1e999"), "1:73", "a number that a double can hold", "-1e999"},
    {"unterminated_string", "{\"thalweg", "1:10", "JSON", "closing quote"},
    {"bad_escape", "{\"a\\x\": 1}", "1:5", "JSON", "backslash"},
    {"invalid_utf8", "{\"\xff\": 1}", "1:3", "JSON", ""},
    {"control_character", "{\"a\tb\": 1}", "1:4", "JSON", ""},
};

// --- JSON that is no scene
// ----------------------------------------------------------------------------------------------

const Malformed kDocument[] = {
    {"array", "[]", "", "an object", "an array of 0"},
    {"number", "3", "", "an object", "3"},
    {"null", "null", "", "an object", "null"},
    {"empty_object", "{}", "", "\"thalweg\"", "none"},
    {"no_dimension", R"({"thalweg": 1, "shape": {}})", "", "\"dimension\"", "none"},
    {"no_shape", R"({"thalweg": 1, "dimension": 2})", "", "\"shape\"", "none"},
    {"later_version", R"({"thalweg": 2, "dimension": 2, "shape": {}})", "/thalweg", "1", "2"},
    {"version_as_text", R"({"thalweg": "1", "dimension": 2, "shape": {}})", "/thalweg", "1", "\"1\""},
    {"version_as_boolean", R"({"thalweg": true, "dimension": 2, "shape": {}})", "/thalweg", "1", "true"},
    {"dimension_4", scene(4, "{}"), "/dimension", "2 or 3", "4"},
    {"dimension_as_text", R"({"thalweg": 1, "dimension": "2", "shape": {}})", "/dimension", "2 or 3", "\"2\""},
    {"dimension_2_and_a_half", R"({"thalweg": 1, "dimension": 2.5, "shape": {}})", "/dimension", "2 or 3", "2.5"},
    {"unknown_key", scene(2, "{}", R"(, "shapes": 1)"), "/shapes", "one of thalweg, dimension, shape, define",
     "shapes"},
    {"unknown_key_with_slash_and_tilde", scene(2, "{}", R"(, "a/b~c": 1)"), "/a~1b~0c", "one of", "a/b~c"},
    {"unknown_key_with_a_line_break", scene(2, "{}", R"(, "a\nb": 1)"), "/a?b", "one of", "a"},
    {"duplicate_key_with_a_line_break", R"({"a\nb": 1, "a\nb": 1})", "/a?b", "each key once", "again"},
    {"duplicate_key", R"({"thalweg": 1, "thalweg": 1})", "/thalweg", "each key once", "\"thalweg\" again"},
    {"duplicate_parameter", radius(R"(1, "radius": 1)"), "/shape/radius", "each key once", "\"radius\" again"},
    {"duplicate_key_in_an_operand",
     in2(R"({"op": "union", "of": [{"op": "cool_s"}, {"op": "circle", "radius": 1, "op": "box"}]})"), "/shape/of/1/op",
     "each key once", "\"op\" again"},
    {"duplicate_definition", defining("{}", R"({"a": {}, "a": {}})"), "/define/a", "each key once", "\"a\" again"},
    {"nesting_of_arrays_deeper_than_1000", repeated("[", 1001) + repeated("]", 1001), nullptr, "at most 1000",
     "deeper"},
};

// --- nodes
// --------------------------------------------------------------------------------------------------------------

const Malformed kNode[] = {
    {"node_is_an_array", in2("[]"), "/shape", "a node (an object)", "an array of 0"},
    {"node_is_null", in2("null"), "/shape", "a node (an object)", "null"},
    {"no_op", in2("{}"), "/shape", "\"op\"", "none"},
    {"op_is_a_number", in2(R"({"op": 7})"), "/shape/op", "the name of an op", "7"},
    {"unknown_op", in2(R"({"op": "blob"})"), "/shape/op", "an op of dimension 2", "\"blob\""},
    {"op_of_three_dimensions", in2(R"({"op": "sphere", "radius": 1})"), "/shape/op", "dimension 2", "\"sphere\""},
    {"op_of_two_dimensions", in3(R"({"op": "circle", "radius": 1})"), "/shape/op", "dimension 3", "\"circle\""},
    {"op_in_capitals", in2(R"({"op": "Circle", "radius": 1})"), "/shape/op", "an op", "\"Circle\""},
    {"unknown_parameter", in2(R"({"op": "circle", "radius": 1, "raduis": 2})"), "/shape/raduis", "one of op, radius",
     "\"raduis\""},
    {"operands_of_a_primitive", in2(R"({"op": "circle", "radius": 1, "of": []})"), "/shape/of", "one of op, radius",
     "\"of\""},
    {"no_operands", in2(R"({"op": "union"})"), "/shape", "\"of\"", "none"},
    {"operands_as_number", in2(R"({"op": "union", "of": 3})"), "/shape/of", "an array of nodes", "3"},
    {"empty_operands", in2(R"({"op": "union", "of": []})"), "/shape/of", "an array of nodes", "an array of 0"},
    {"two_operands_for_one", in2(R"({"op": "round", "radius": 1, "of": [{"op": "cool_s"}, {"op": "cool_s"}]})"),
     "/shape/of", "one node", "an array of 2"},
    {"operand_is_null", in2(R"({"op": "union", "of": [{"op": "cool_s"}, null]})"), "/shape/of/1", "a node", "null"},
    {"fault_in_an_operand", in2(R"({"op": "union", "of": [{"op": "cool_s"}, {"op": "circle", "radius": -1}]})"),
     "/shape/of/1/radius", "a length in [1e-15, 1e+15]", "-1"},
    {"fault_deep_down", in2(R"({"op": "round", "radius": 0, "of": {"op": "union", "of": [{"op": "circle"}]}})"),
     "/shape/of/of/0", "\"radius\"", "none"},
    {"parameter_with_a_line_break", in2(R"({"op": "cool_s", "a\nb": 2})"), "/shape/a?b", "one of op", "a"},
    {"op_with_a_line_break", in2(R"({"op": "cool\ns"})"), "/shape/op", "an op", "cool"},
    {"implicit_parameter", in2(R"({"op": "cool_s", "unit": 2})"), "/shape/unit", "one of op", "\"unit\""},
};

// --- parameters
// -----------------------------------------------------------------------------------------------------------

const Malformed kNumber[] = {
    {"missing", in2(R"({"op": "circle"})"), "/shape", "\"radius\"", "none"},
    {"text", radius("\"1\""), "/shape/radius", "a length", "\"1\""},
    {"text_nan", radius("\"nan\""), "/shape/radius", "a length", "\"nan\""},
    {"null", radius("null"), "/shape/radius", "a length", "null"},
    {"boolean", radius("true"), "/shape/radius", "a length", "true"},
    {"array", radius("[1]"), "/shape/radius", "a length", "an array of 1"},
    {"object", radius("{}"), "/shape/radius", "a length", "an object"},
    {"zero_size", radius("0"), "/shape/radius", "[1e-15, 1e+15]", "0"},
    {"negative_size", radius("-2.5"), "/shape/radius", "[1e-15, 1e+15]", "-2.5"},
    {"too_large", radius("1e16"), "/shape/radius", "[1e-15, 1e+15]", "1e+16"},
    {"too_small", radius("1e-16"), "/shape/radius", "[1e-15, 1e+15]", "1e-16"},
    {"barely_above_zero_where_zero_is_allowed", in2(R"({"op": "round", "radius": 1e-300, "of": {"op": "cool_s"}})"),
     "/shape/radius", "a length", "1e-300"},
    {"points_not_whole", in2(R"({"op": "star", "radius": 1, "points": 5.5, "sharpness": 2})"), "/shape/points",
     "a whole number", "5.5"},
    {"too_few_points", in2(R"({"op": "star", "radius": 1, "points": 2, "sharpness": 2})"), "/shape/points",
     "a whole number in [3", "2"},
    {"sharpness_below_2", in2(R"({"op": "star", "radius": 1, "points": 5, "sharpness": 1.9})"), "/shape/sharpness",
     "a number in [2", "1.9"},
    {"sharpness_above_points", in2(R"({"op": "star", "radius": 1, "points": 5, "sharpness": 6})"), "/shape/sharpness",
     "[2, points]", "6"},
    {"angle_zero", in2(R"({"op": "pie", "aperture": 0, "radius": 1})"), "/shape/aperture", "an angle", "0"},
    {"angle_above_pi", in2(R"({"op": "pie", "aperture": 3.2, "radius": 1})"), "/shape/aperture", "radians", "3.2"},
    {"scale_zero", in2(R"({"op": "scale", "factor": 0, "of": {"op": "cool_s"}})"), "/shape/factor", "a number in", "0"},
    {"scale_per_axis", in2(R"({"op": "scale", "factor": [1, 2], "of": {"op": "cool_s"}})"), "/shape/factor", "a number",
     "an array of 2"},
    {"negative_k", in2(R"({"op": "smooth_union", "k": -1, "of": {"op": "cool_s"}})"), "/shape/k", "a length", "-1"},
    {"unknown_kind", in2(R"({"op": "smooth_union", "k": 1, "kind": "septic", "of": {"op": "cool_s"}})"), "/shape/kind",
     "one of quadratic", "\"septic\""},
    {"kind_as_number", in2(R"({"op": "smooth_union", "k": 1, "kind": 0, "of": {"op": "cool_s"}})"), "/shape/kind",
     "one of quadratic", "0"},
    {"third_axis_in_2d", in2(R"({"op": "mirror", "axis": "z", "of": {"op": "cool_s"}})"), "/shape/axis", "one of x|y",
     "\"z\""},
    {"ring_wider_than_its_radius", in2(R"({"op": "ring", "aperture": 1, "radius": 1, "thickness": 2.5})"),
     "/shape/thickness", "twice the radius", "2.5"},
    {"moon_eaten_up", in2(R"({"op": "moon", "offset": 1, "ra": 1, "rb": 2})"), "/shape/rb", "below ra + offset", "2"},
    {"corner_wider_than_its_box", in2(R"({"op": "rounded_box", "half_size": [1, 2], "radii": [0, 1.5, 0, 0]})"),
     "/shape/radii", "the smaller half_size", "[0, 1.5, 0, 0]"},
    {"corners_on_a_line", in2(R"({"op": "triangle", "a": [0, 0], "b": [1, 1], "c": [3, 3]})"), "/shape/c",
     "do not lie on one line", "[3, 3]"},
    {"edges_that_cross", in2(R"({"op": "polygon", "points": [[0, 0], [1, 1], [1, 0], [0, 1]]})"), "/shape/points",
     "do not cross", "4 points"},
};

const Malformed kVector[] = {
    {"three_numbers_in_2d", in2(R"({"op": "box", "half_size": [1, 2, 3]})"), "/shape/half_size",
     "an array of 2 numbers", "an array of 3"},
    {"two_numbers_in_3d", in3(R"({"op": "box", "half_size": [1, 2]})"), "/shape/half_size", "an array of 3 numbers",
     "an array of 2"},
    {"one_number", in2(R"({"op": "box", "half_size": 1})"), "/shape/half_size", "an array of 2 numbers", "1"},
    {"text_inside", in2(R"({"op": "box", "half_size": [1, "2"]})"), "/shape/half_size/1", "a length", "\"2\""},
    {"zero_inside", in2(R"({"op": "box", "half_size": [1, 0]})"), "/shape/half_size/1", "a length in", "0"},
    {"one_radius_of_four", in2(R"({"op": "rounded_box", "half_size": [1, 2], "radii": [1, 1, 0, -1]})"),
     "/shape/radii/3", "a length in [0", "-1"},
    {"radii_larger_than_the_box", in2(R"({"op": "rounded_box", "half_size": [1, 2], "radii": [1.5, 0, 0, 0]})"),
     "/shape/radii", "at most the smaller half_size", ""},
    {"zero_normal", in2(R"({"op": "half_plane", "normal": [0, 0], "offset": 1})"), "/shape/normal", "non-zero length",
     "zero"},
    {"zero_normal_in_3d", in3(R"({"op": "plane", "normal": [0, 0, -0.0], "offset": 1})"), "/shape/normal",
     "non-zero length", "zero"},
    {"zero_rotation_axis",
     in3(R"({"op": "rotate", "axis": [0, 0, 0], "angle": 1, "of": {"op": "sphere", "radius": 1}})"), "/shape/axis",
     "non-zero length", "zero"},
    {"zero_quaternion", in3(R"({"op": "rotate", "quaternion": [0, 0, 0, 0], "of": {"op": "sphere", "radius": 1}})"),
     "/shape/quaternion", "non-zero length", "zero"},
    {"axis_and_quaternion",
     in3(R"({"op": "rotate", "axis": [1, 0, 0], "angle": 1, "quaternion": [1, 0, 0, 0], "of": {}})"),
     "/shape/quaternion", "one of op, axis, angle, of", "\"quaternion\""},
    {"triangle_on_one_line", in2(R"({"op": "triangle", "a": [0, 0], "b": [1, 1], "c": [2, 2]})"), "/shape/c",
     "not lie on one line", ""},
    {"polygon_of_two", in2(R"({"op": "polygon", "points": [[0, 0], [1, 0]]})"), "/shape/points", "at least 3 points",
     ""},
    {"polygon_that_crosses_itself", in2(R"({"op": "polygon", "points": [[0, 0], [1, 1], [1, 0], [0, 1]]})"),
     "/shape/points", "do not cross", ""},
    {"polygon_as_number", in2(R"({"op": "polygon", "points": 5})"), "/shape/points", "an array of points", "5"},
    {"polygon_with_a_3d_corner", in2(R"({"op": "polygon", "points": [[0, 0], [1, 0, 0], [0, 1]]})"), "/shape/points/1",
     "an array of 2 numbers", "an array of 3"},
    {"polygon_with_text", in2(R"({"op": "polygon", "points": [[0, 0], [1, 0], [0, "1"]]})"), "/shape/points/2/1",
     "a coordinate", "\"1\""},
    {"polygon_with_a_corner_too_far", in2(R"({"op": "polygon", "points": [[0, 0], [1, 0], [0, 1e16]]})"),
     "/shape/points/2/1", "a coordinate in", "1e+16"},
    {"translation_by_three_in_2d", in2(R"({"op": "translate", "by": [1, 2, 3], "of": {"op": "cool_s"}})"), "/shape/by",
     "an array of 2 numbers", "an array of 3"},
    {"rotation_by_an_axis_in_2d", in2(R"({"op": "rotate", "axis": [0, 0, 1], "angle": 1, "of": {"op": "cool_s"}})"),
     "/shape/axis", "one of op, angle, of", "\"axis\""},
};

// --- definitions
// ----------------------------------------------------------------------------------------------------------

const char* const kCool = R"({"op": "cool_s"})";

const Malformed kDefine[] = {
    {"not_an_object", defining(kCool, "[]"), "/define", "an object", "an array of 0"},
    {"reference_to_nothing", in2(R"({"op": "ref", "name": "wheel"})"), "/shape/name", "\"define\"", "\"wheel\""},
    {"reference_to_another_name",
     defining(R"({"op": "union", "of": [{"op": "ref", "name": "w"}]})", R"({"v": )" + std::string(kCool) + "}"),
     "/shape/of/0/name", "a name of \"define\"", "\"w\""},
    {"reference_without_a_name", defining(R"({"op": "ref"})", "{}"), "/shape", "\"name\"", "none"},
    {"reference_by_number", defining(R"({"op": "ref", "name": 1})", "{}"), "/shape/name", "a string", "1"},
    {"reference_with_more", defining(R"({"op": "ref", "name": "a", "by": [1, 2]})", "{}"), "/shape/by",
     "one of op, name", "\"by\""},
    {"fault_in_an_unused_definition", defining(kCool, R"({"wheel": {"op": "circle", "radius": 0}})"),
     "/define/wheel/radius", "a length", "0"},
    {"name_with_a_slash", defining(kCool, R"({"a/b": {"op": "circle"}})"), "/define/a~1b", "\"radius\"", "none"},
    {"definition_of_another_dimension", defining(kCool, R"({"ball": {"op": "sphere", "radius": 1}})"),
     "/define/ball/op", "an op of dimension 2", "\"sphere\""},
    {"reference_with_a_line_break", in2(R"({"op": "ref", "name": "a\nb"})"), "/shape/name", "a name", "a"},
    {"itself", defining(kCool, R"({"a": {"op": "ref", "name": "a"}})"), "/define/a/name", "without a cycle", "\"a\""},
    {"cycle_of_three",
     defining(kCool, R"({"a": {"op": "ref", "name": "b"}, "b": {"op": "union", "of": [{"op": "ref", "name": "c"}]},
                         "c": {"op": "round", "radius": 1, "of": {"op": "ref", "name": "a"}}})"),
     "/define/c/of/name", "without a cycle", "\"a\""},
};

class MalformedScene : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedScene, IsRefusedWithPlaceExpectedAndFound) {
  const auto parsed = parse_scene(GetParam().text, "scene.json");
  ASSERT_FALSE(parsed) << GetParam().text;
  const Error& error = parsed.error();
  EXPECT_EQ(error.file, "scene.json");
  if (GetParam().place != nullptr) {
    EXPECT_EQ(error.place, GetParam().place) << to_string(error);
  }
  EXPECT_THAT(error.expected, HasSubstr(GetParam().expected)) << to_string(error);
  EXPECT_THAT(error.found, HasSubstr(GetParam().found)) << to_string(error);
  EXPECT_THAT(error.found, Not(HasSubstr("json.exception"))) << to_string(error);
  // One line, whatever the text holds.
  EXPECT_EQ(to_string(error).find('\n'), std::string::npos);
}

const auto kNameOf = [](const auto& malformed) { return std::string(malformed.param.name); };
INSTANTIATE_TEST_SUITE_P(Syntax, MalformedScene, testing::ValuesIn(kSyntax), kNameOf);
INSTANTIATE_TEST_SUITE_P(Document, MalformedScene, testing::ValuesIn(kDocument), kNameOf);
INSTANTIATE_TEST_SUITE_P(Node, MalformedScene, testing::ValuesIn(kNode), kNameOf);
INSTANTIATE_TEST_SUITE_P(Number, MalformedScene, testing::ValuesIn(kNumber), kNameOf);
INSTANTIATE_TEST_SUITE_P(Vector, MalformedScene, testing::ValuesIn(kVector), kNameOf);
INSTANTIATE_TEST_SUITE_P(Define, MalformedScene, testing::ValuesIn(kDefine), kNameOf);

// --- limits of nesting
// ------------------------------------------------------------------------------------------------------

std::string nested(int depth) {
  return in2(repeated(R"({"op": "round", "radius": 0, "of": )", depth) + kCool + repeated("}", depth));
}

TEST(NestedScene, IsReadDownToAThousandLevels) {
  // The scene object and the innermost node count as well.
  EXPECT_TRUE(parse_scene(nested(998), "s"));
  const auto parsed = parse_scene(nested(999), "s");
  ASSERT_FALSE(parsed);
  EXPECT_THAT(parsed.error().place, HasSubstr("/shape/of/of/of"));
  EXPECT_THAT(parsed.error().expected, HasSubstr("1000"));
}

TEST(NestedScene, CountsNodesThroughReferences) {
  const auto chain = [](int nodes) {
    std::string define = R"({"n0": {"op": "cool_s"})";
    for (int i = 1; i < nodes; ++i) {
      define += ", \"n" + std::to_string(i) + R"(": {"op": "round", "radius": 0, "of": {"op": "ref", "name": "n)" +
                std::to_string(i - 1) + "\"}}";
    }
    const std::string last = R"({"op": "ref", "name": "n)" + std::to_string(nodes - 1) + "\"}";
    return parse_scene(defining(last, define + "}"), "s");
  };
  EXPECT_TRUE(chain(400));
  // Ten thousand would be deeper than any stack should be asked for.
  const auto parsed = chain(10'000);
  ASSERT_FALSE(parsed);
  EXPECT_THAT(parsed.error().expected, HasSubstr("deep"));
}

TEST(MalformedText, NeverCrashesTheParserWhereverItIsCut) {
  const std::string whole = defining(R"({"op": "smooth_union", "k": 1e0, "kind": "quadratic", "of": [
      {"op": "ref", "name": "w"}, {"op": "polygon", "points": [[0, 0], [1, 0], [0.5, -1.25e1]]}]})",
                                     R"({"w": {"op": "circle", "radius": 3}})");
  ASSERT_TRUE(parse_scene(whole, "s")) << to_string(parse_scene(whole, "s").error());
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    const auto parsed = parse_scene(std::string_view(whole).substr(0, cut), "s");
    ASSERT_FALSE(parsed) << cut;
    EXPECT_FALSE(parsed.error().place.empty()) << cut;
  }
}

}  // namespace
}  // namespace thalweg
