// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Rows of numbers as CSV: one row a line, fields separated by commas; empty lines and lines that begin with # are
// left out, and a first line without any number is a header.
#pragma once

#include <string>
#include <string_view>

#include "array.h"

namespace thalweg::cli {

[[nodiscard]] Array parse_csv(std::string_view text, const RowShape& row, const std::string& name);

}  // namespace thalweg::cli
