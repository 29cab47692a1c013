// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// NPY, NumPy's array format, versions 1.0 to 3.0. The header is parsed strictly and nothing is allocated before the
// shape agrees with the bytes that are there.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "array.h"

namespace thalweg::cli {

/// The header of an NPY file and where its numbers begin.
struct NpyHeader {
  std::string descr;  ///< as spelled: `<f4`
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t data_offset = 0;
};

[[nodiscard]] bool looks_like_npy(std::string_view bytes);

/// Reads the header alone. `name` stands for the file in refusals, here and below.
[[nodiscard]] NpyHeader parse_npy_header(std::string_view bytes, const std::string& name);

/// A whole file: float32 or float64, little-endian, C order, as float32.
[[nodiscard]] Array parse_npy(std::string_view bytes, const std::string& name);

/// A whole file of uint8.
[[nodiscard]] std::vector<std::uint8_t> parse_npy_uint8(std::string_view bytes, const std::string& name);

/// The bytes before the numbers, padded so that the numbers are aligned to 64 bytes.
[[nodiscard]] std::string npy_header_bytes(const Column& column);

}  // namespace thalweg::cli
