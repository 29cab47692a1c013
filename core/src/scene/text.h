// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Places in a text, and pieces of it, as errors show them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace thalweg::scene {

/// `line:column` of a byte, both from 1 on.
[[nodiscard]] std::string line_and_column(std::string_view text, std::size_t position);

/// Text of the document in quotes, on one line; what is long is cut.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace thalweg::scene
