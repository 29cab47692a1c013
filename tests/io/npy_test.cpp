// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// NPY: what is read, what is refused and with which words, and that what is written is read back.
#include "npy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "queries.h"
#include "support.h"

namespace thalweg::cli {
namespace {

Error refused_npy(const std::string& bytes) {
  return refusal([&] { static_cast<void>(parse_npy(bytes, "a.npy")); });
}

Error refused_header(const std::string& header) { return refused_npy(npy_file(header, std::string(16, '\0'))); }

TEST(Npy, ReadsFloat32InCOrder) {
  const Array array =
      parse_npy(npy_file(npy_dictionary("<f4", "(2, 3)"), bytes_of({1.F, 2.F, 3.F, 4.F, 5.F, 6.F})), "a");
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(array.values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

TEST(Npy, ReadsEveryFormatVersion) {
  for (const int major : {1, 2, 3}) {
    const Array array = parse_npy(npy_file(npy_dictionary("<f4", "(1,)"), bytes_of({7.F}), major), "a");
    EXPECT_EQ(array.values, std::vector<float>{7}) << major;
  }
}

TEST(Npy, ReadsFloat64AsTheNearestFloat32) {
  const Array array = parse_npy(npy_file(npy_dictionary("<f8", "(4,)"), bytes_of({0.1, 1e300, -1e300, 1e-300})), "a");
  EXPECT_EQ(array.values[0], 0.1F);
  EXPECT_EQ(array.values[1], std::numeric_limits<float>::infinity());
  EXPECT_EQ(array.values[2], -std::numeric_limits<float>::infinity());
  EXPECT_EQ(array.values[3], 0.0F);
}

TEST(Npy, KeepsNonFiniteNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Array array = parse_npy(npy_file(npy_dictionary("<f8", "(2,)"), bytes_of({nan, -HUGE_VAL})), "a");
  EXPECT_TRUE(std::isnan(array.values[0]));
  EXPECT_EQ(array.values[1], -std::numeric_limits<float>::infinity());
}

TEST(Npy, ReadsAnArrayWithoutRows) {
  const Array array = parse_npy(npy_file(npy_dictionary("<f4", "(0, 3, 2)"), ""), "a");
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{0, 3, 2}));
  EXPECT_TRUE(array.values.empty());
}

TEST(Npy, ReadsKeysInAnyOrderAndEitherQuote) {
  const std::string header = R"({"shape": (1,), "fortran_order": False, "descr": "<f4"})";
  EXPECT_EQ(parse_npy(npy_file(header, bytes_of({3.F})), "a").values, std::vector<float>{3});
}

TEST(Npy, RefusesAnEmptyFile) { EXPECT_EQ(refused_npy("").found, "an empty file"); }

TEST(Npy, RefusesAnotherMagic) { EXPECT_EQ(refused_npy("\x93NUMPZ\x01").place, "NPY magic"); }

TEST(Npy, RefusesAFileThatEndsInItsVersion) { EXPECT_EQ(refused_npy("\x93NUMPY\x01").place, "NPY version"); }

TEST(Npy, RefusesAnUnknownVersion) {
  EXPECT_EQ(refused_npy(npy_file(npy_dictionary("<f4", "(0,)"), "", 4)).found, "4.0");
  EXPECT_EQ(refused_npy(npy_file(npy_dictionary("<f4", "(0,)"), "", 1, 1)).found, "1.1");
}

TEST(Npy, RefusesAFileThatEndsInItsHeaderLength) {
  EXPECT_EQ(refused_npy(std::string("\x93NUMPY\x01\x00\x10", 9)).place, "NPY header length");
}

TEST(Npy, RefusesAHeaderLongerThanTheFile) {
  const Error error = refused_npy(std::string("\x93NUMPY\x01\x00\xff\xff{", 11));
  EXPECT_EQ(error.place, "NPY header");
  EXPECT_EQ(error.expected, "65535 bytes");
  EXPECT_EQ(error.found, "1 bytes");
}

TEST(Npy, RefusesAFortranOrderArray) {
  const Error error = refused_npy(npy_file(npy_dictionary("<f4", "(2, 2)", "True"), std::string(16, '\0')));
  EXPECT_EQ(error.place, "fortran_order");
  EXPECT_EQ(error.expected, "C order");
}

TEST(Npy, RefusesABigEndianArray) {
  const Error error = refused_header(npy_dictionary(">f4", "(4,)"));
  EXPECT_EQ(error.place, "dtype");
  EXPECT_EQ(error.found, "'>f4'");
}

TEST(Npy, RefusesIntegers) { EXPECT_EQ(refused_header(npy_dictionary("<i4", "(4,)")).place, "dtype"); }

TEST(Npy, RefusesHalfPrecision) { EXPECT_EQ(refused_header(npy_dictionary("<f2", "(8,)")).found, "'<f2'"); }

TEST(Npy, RefusesAStructuredDtype) {
  const Error error = refused_header("{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (4,)}");
  EXPECT_EQ(error.found, "a structured dtype");
}

TEST(Npy, RefusesPickledObjects) { EXPECT_EQ(refused_header(npy_dictionary("|O", "(4,)")).found, "'|O'"); }

TEST(Npy, RefusesTruncatedData) {
  const Error error = refused_npy(npy_file(npy_dictionary("<f4", "(2, 2)"), std::string(15, '\0')));
  EXPECT_EQ(error.place, "data");
  EXPECT_EQ(error.expected, "16 bytes for shape (2, 2)");
  EXPECT_EQ(error.found, "15 bytes");
}

TEST(Npy, RefusesTrailingData) {
  EXPECT_EQ(refused_npy(npy_file(npy_dictionary("<f4", "(2, 2)"), std::string(17, '\0'))).found, "17 bytes");
}

TEST(Npy, RefusesAShapeWhoseSizeOverflows) {
  EXPECT_EQ(refused_header(npy_dictionary("<f8", "(4294967296, 4294967296)")).place, "shape");
  EXPECT_EQ(refused_header(npy_dictionary("<f8", "(4611686018427387904, 2)")).place, "shape");
}

TEST(Npy, RefusesALengthBeyond64Bits) {
  EXPECT_EQ(refused_header(npy_dictionary("<f4", "(99999999999999999999,)")).expected, "a length below 2^64");
}

TEST(Npy, RefusesAHugeShapeBeforeItAllocates) {
  EXPECT_EQ(refused_header(npy_dictionary("<f4", "(1000000000000, 2)")).place, "data");
}

TEST(Npy, RefusesANegativeLength) {
  EXPECT_EQ(refused_header(npy_dictionary("<f4", "(-1, 2)")).expected, "a whole number");
}

TEST(Npy, RefusesAShapeThatIsNoTuple) {
  EXPECT_EQ(refused_header(npy_dictionary("<f4", "4")).expected, "'('");
  EXPECT_EQ(refused_header(npy_dictionary("<f4", "(4)")).expected, "',' after the only length");
  EXPECT_EQ(refused_header(npy_dictionary("<f4", "(2 2)")).expected, "',' after the only length");
}

TEST(Npy, RefusesAMissingKey) {
  EXPECT_EQ(refused_header("{'descr': '<f4', 'fortran_order': False}").expected, "the key 'shape'");
  EXPECT_EQ(refused_header("{'descr': '<f4', 'shape': (4,)}").expected, "the key 'fortran_order'");
  EXPECT_EQ(refused_header("{'fortran_order': False, 'shape': (4,)}").expected, "the key 'descr'");
}

TEST(Npy, RefusesAnUnknownKey) {
  EXPECT_EQ(refused_header("{'descr': '<f4', 'fortran_order': False, 'shape': (4,), 'x': 1}").found, "'x'");
}

TEST(Npy, RefusesAKeyThatStandsTwice) {
  EXPECT_EQ(refused_header("{'descr': '<f4', 'descr': '<f4'}").found, "'descr' twice");
}

TEST(Npy, RefusesAnUnclosedHeader) {
  EXPECT_EQ(refused_header("{'descr': '<f4', 'fortran_order': False, 'shape': (4,)").found, "the end of the header");
  EXPECT_EQ(refused_header("{'descr': '<f4").expected, "a closed string");
  EXPECT_EQ(refused_header("").expected, "'{'");
}

TEST(Npy, RefusesTextAfterTheHeader) {
  const Error error = refused_header(npy_dictionary("<f4", "(4,)") + "x");
  EXPECT_EQ(error.expected, "the end of the header");
}

TEST(Npy, RefusesATruthValueThatIsNone) {
  EXPECT_EQ(refused_header(npy_dictionary("<f4", "(4,)", "0")).expected, "True or False");
}

TEST(Npy, RefusesRowsOfAnotherShape) {
  const RowShape triangles{{3, 2}, "triangles"};
  const auto refused_shape = [&](std::string_view shape, std::size_t numbers) {
    const std::string file = npy_file(npy_dictionary("<f4", shape), std::string(4 * numbers, '\0'));
    return refusal([&] { static_cast<void>(parse_npy_rows(file, triangles, "t.npy")); });
  };
  EXPECT_EQ(refused_shape("(5, 3, 3)", 45).found, "(5, 3, 3)");
  EXPECT_EQ(refused_shape("(5, 3, 3)", 45).expected, "(N, 3, 2) for triangles");
  EXPECT_EQ(refused_shape("(6,)", 6).found, "(6,)");
  EXPECT_EQ(refused_shape("()", 1).found, "()");
  EXPECT_EQ(refused_shape("(0,)", 0).place, "shape");
}

TEST(Npy, EveryTruncationOfAFileIsRefused) {
  const std::string whole = npy_file(npy_dictionary("<f4", "(1, 2)"), bytes_of({1.F, 2.F}));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_THROW(static_cast<void>(parse_npy(whole.substr(0, length), "a")), Failure) << length;
  }
}

TEST(Npy, HeaderIsAlignedAndReadBack) {
  const std::vector<float> numbers = {1, 2, 3, 4, 5, 6};
  const Column column{"x", Dtype::float32, {3, 2}, numbers.data()};
  const std::string header = npy_header_bytes(column);
  EXPECT_EQ(header.size() % 64, 0U);
  const Array array = parse_npy(header + std::string(reinterpret_cast<const char*>(numbers.data()), 24), "a");
  EXPECT_EQ(array.shape, column.shape);
  EXPECT_EQ(array.values, numbers);
}

}  // namespace
}  // namespace thalweg::cli
