// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "scene/text.h"

#include <algorithm>

namespace thalweg::scene {

std::string line_and_column(std::string_view text, std::size_t position) {
  const std::string_view before = text.substr(0, std::min(position, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return std::to_string(line) + ":" + std::to_string(before.size() - start + 1);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMost = 200;
  std::string line = "\"";
  for (const char c : text.substr(0, kMost)) line += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  return line + (text.size() > kMost ? "...\"" : "\"");
}

}  // namespace thalweg::scene
