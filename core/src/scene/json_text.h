// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// JSON text to a document, stricter than the standard: no duplicate keys, no number that overflows, no nesting deeper
// than kDeepestNesting.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "thalweg/result.h"

namespace thalweg::scene {

inline constexpr std::size_t kDeepestNesting = 1000;

[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, std::string_view file);

/// A key as one step of a JSON pointer, `/` and `~` escaped.
[[nodiscard]] std::string pointer_step(std::string_view key);

}  // namespace thalweg::scene
