// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Triangle meshes: OBJ, PLY and STL give the same triangles, and what is wrong with them is refused with its place.
#include "mesh.h"

#include <gtest/gtest.h>

#include "support.h"

namespace thalweg::cli {
namespace {

const RowShape kFlat{{3, 2}, "triangles"};
const RowShape kSpace{{3, 3}, "triangles"};
const std::vector<float> kCorners = {0, 0, 1, 2, 0, 1, 0, 2, 1};

using Parser = Array (*)(std::string_view, const RowShape&, const std::string&);

Error refused(Parser parser, const std::string& text, const RowShape& row = kSpace) {
  return refusal([&] { static_cast<void>(parser(text, row, "mesh")); });
}

std::string ply(std::string_view format, std::string_view body) {
  return "ply\nformat " + std::string(format) +
         " 1.0\ncomment made by hand\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         std::string(body);
}

std::string stl(std::uint32_t count, std::string_view triangles) {
  return std::string(80, 's') + bytes_of({count}) + std::string(triangles);
}

std::string stl_triangle() {
  return bytes_of({0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 2.F, 0.F, 1.F, 0.F, 2.F, 1.F}) + std::string(2, '\0');
}

std::string swapped(std::string bytes) { return {bytes.rbegin(), bytes.rend()}; }

TEST(Obj, ReadsTrianglesWithTextureAndNormalNumbers) {
  const std::string text = "# c\no name\nv 0 0 1\nv 2 0 1\nv 0 2 1 1.0\nvn 0 0 1\nf 1//1 2/5/1 3\n";
  EXPECT_EQ(parse_obj(text, kSpace, "a").values, kCorners);
}

TEST(Obj, ReadsNegativeNumbersFromTheEnd) {
  EXPECT_EQ(parse_obj("v 0 0 1\nv 2 0 1\nv 0 2 1\nf -3 -2 -1\n", kSpace, "a").values, kCorners);
}

TEST(Obj, CutsPolygonsIntoFans) {
  const Array array = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", kFlat, "a");
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{2, 3, 2}));
  EXPECT_EQ(array.values, (std::vector<float>{0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1}));
}

TEST(Obj, RefusesAVertexThatIsNotThere) {
  EXPECT_EQ(refused(parse_obj, "v 0 0 0\nv 1 0 0\nf 1 2 3\n").place, "line 3");
  EXPECT_EQ(refused(parse_obj, "v 0 0 0\nf 1 1 -2\n").place, "line 2");
  EXPECT_EQ(refused(parse_obj, "v 0 0 0\nf 0 1 1\n").found, "'0'");
}

TEST(Obj, RefusesAFaceOfTwoCorners) {
  EXPECT_EQ(refused(parse_obj, "v 0 0 0\nv 1 0 0\nf 1 2\n").expected, "at least 3 corners");
}

TEST(Obj, RefusesAnUnknownKeyword) { EXPECT_EQ(refused(parse_obj, "hello\n").found, "'hello'"); }

TEST(Obj, RefusesAVertexWithoutNumbers) {
  EXPECT_EQ(refused(parse_obj, "v 0 0\n").found, "the end of the line");
  EXPECT_EQ(refused(parse_obj, "v 0 a 0\n").found, "'a'");
}

TEST(Mesh, IsNotFlattenedInSilence) {
  EXPECT_EQ(refused(parse_obj, "v 0 0 3\n", kFlat).found, "z = 3");
  EXPECT_EQ(refused(parse_stl, stl(1, stl_triangle()), kFlat).expected, "z = 0 in a scene of dimension 2");
}

TEST(Ply, ReadsAscii) {
  EXPECT_EQ(parse_ply(ply("ascii", "0 0 1\n2 0 1\n0 2 1\n3 0 1 2\n"), kSpace, "a").values, kCorners);
}

TEST(Ply, ReadsBinaryOfEitherByteOrder) {
  const std::string little = bytes_of({0.F, 0.F, 1.F, 2.F, 0.F, 1.F, 0.F, 2.F, 1.F}) + '\x03' + bytes_of({0, 1, 2});
  EXPECT_EQ(parse_ply(ply("binary_little_endian", little), kSpace, "a").values, kCorners);
  std::string big;
  for (const float number : kCorners) big += swapped(bytes_of({number}));
  big += '\x03';
  for (const int corner : {0, 1, 2}) big += swapped(bytes_of({corner}));
  EXPECT_EQ(parse_ply(ply("binary_big_endian", big), kSpace, "a").values, kCorners);
}

TEST(Ply, StepsOverOtherElementsAndProperties) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement note 1\nproperty list uchar float things\nelement vertex 3\nproperty double z\n"
      "property uchar red\nproperty float x\nproperty float y\nelement face 1\nproperty uchar flag\n"
      "property list uchar uint vertex_index\nend_header\n2 9 9\n1 255 0 0\n1 255 2 0\n1 255 0 2\n7 3 0 1 2\n";
  EXPECT_EQ(parse_ply(text, kSpace, "a").values, kCorners);
}

TEST(Ply, RefusesTruncatedBodies) {
  EXPECT_EQ(refused(parse_ply, ply("ascii", "0 0 1\n2 0 1\n0 2 1\n3 0 1\n")).found, "the end of the file");
  const Error error = refused(parse_ply, ply("binary_little_endian", bytes_of({0.F, 0.F, 1.F, 2.F})));
  EXPECT_EQ(error.place, "vertex 1");
}

TEST(Ply, RefusesTrailingData) {
  EXPECT_EQ(refused(parse_ply, ply("ascii", "0 0 1\n2 0 1\n0 2 1\n3 0 1 2\n9\n")).expected, "the end of the file");
}

TEST(Ply, RefusesAHugeCountBeforeItAllocates) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 9000000000000000000\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  EXPECT_EQ(refused(parse_ply, header).place, "vertex 0");
}

TEST(Ply, RefusesBrokenHeaders) {
  EXPECT_EQ(refused(parse_ply, "plyx\n").expected, "ply");
  EXPECT_EQ(refused(parse_ply, "ply\nformat ascii 2.0\n").expected, "version 1.0");
  EXPECT_EQ(refused(parse_ply, "ply\nformat text 1.0\n").found, "'text'");
  EXPECT_EQ(refused(parse_ply, "ply\nformat ascii 1.0\n").expected, "end_header");
  EXPECT_EQ(refused(parse_ply, "ply\nend_header\n").expected, "a format line");
  EXPECT_EQ(refused(parse_ply, "ply\nelement vertex -1\n").found, "'-1'");
  EXPECT_EQ(refused(parse_ply, "ply\nproperty float x\n").place, "line 2");
  EXPECT_EQ(refused(parse_ply, "ply\nelement vertex 1\nproperty real x\n").found, "'real'");
  EXPECT_EQ(refused(parse_ply, "ply\nelement face 1\nproperty list float int a\n").expected, "a whole number type");
  EXPECT_EQ(refused(parse_ply, "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n").place,
            "element vertex");
}

TEST(Ply, RefusesCornersThatAreNoVertices) {
  EXPECT_EQ(refused(parse_ply, ply("ascii", "0 0 1\n2 0 1\n0 2 1\n3 0 1 3\n")).found, "position 3");
  EXPECT_EQ(refused(parse_ply, ply("ascii", "0 0 1\n2 0 1\n0 2 1\n3 0 1 1.5\n")).found, "1.5");
  EXPECT_EQ(refused(parse_ply, ply("ascii", "0 0 1\n2 0 1\n0 2 1\n-3 0 1 1\n")).expected, "the length of a list");
}

TEST(Stl, ReadsBinary) { EXPECT_EQ(parse_stl(stl(1, stl_triangle()), kSpace, "a").values, kCorners); }

TEST(Stl, ReadsAscii) {
  const std::string text =
      "solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 1\n   vertex 2 0 1\n"
      "   vertex 0 2 1\n  endloop\n endfacet\nendsolid a\n";
  EXPECT_EQ(parse_stl(text, kSpace, "a").values, kCorners);
  EXPECT_EQ(refused(parse_stl, text.substr(0, text.size() - 11)).expected, "endsolid");
}

TEST(Stl, RefusesADifferentLengthThanPromised) {
  EXPECT_EQ(refused(parse_stl, stl(2, stl_triangle())).place, "data");
  EXPECT_EQ(refused(parse_stl, stl(0xffffffffU, "")).place, "data");
  EXPECT_EQ(refused(parse_stl, "short").place, "STL header");
}

TEST(Stl, RefusesALoopOfTwoVertices) {
  EXPECT_EQ(refused(parse_stl, "solid\nvertex 0 0 1\nvertex 1 0 1\nendloop\nendsolid\n").found, "2");
  EXPECT_EQ(refused(parse_stl, "solid\nvertex 0 0\n").found, "the end of the line");
  EXPECT_EQ(refused(parse_stl, "solid\nnonsense\n").found, "'nonsense'");
}

}  // namespace
}  // namespace thalweg::cli
