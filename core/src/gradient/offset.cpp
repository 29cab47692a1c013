// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Probe offsets as text, read and written.
#include <charconv>
#include <cmath>
#include <string>

#include "thalweg/query.h"

namespace thalweg {
namespace {

struct Part {
  std::string_view prefix;
  double ProbeOffset::*number;
};
// The one without a prefix is the last resort.
constexpr Part kParts[] = {
    {"f:", &ProbeOffset::of_value}, {"scene:", &ProbeOffset::of_scene}, {"", &ProbeOffset::absolute}};

bool read_part(std::string_view word, ProbeOffset& offset) {
  for (const Part& part : kParts) {
    if (!word.starts_with(part.prefix)) continue;
    word.remove_prefix(part.prefix.size());
    double number = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    const bool whole = error == std::errc() && stop == word.data() + word.size();
    if (!whole || !std::isfinite(number) || !(number > 0)) return false;
    offset.*part.number = number;
    return true;
  }
  return false;
}

std::string shortest(double number) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, number).ptr;
  return {text, end};
}

}  // namespace

Result<ProbeOffset> parse_probe_offset(std::string_view text) {
  ProbeOffset offset{.absolute = 0, .of_value = 0, .of_scene = 0};
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    if (!read_part(rest.substr(0, comma), offset)) {
      std::string found = "\"";
      found.append(text).append("\"");
      return Error{.file = "",
                   .place = "--gradient-offset",
                   .expected = "a length, f:X or scene:X, each above 0, or several with commas between",
                   .found = std::move(found)};
    }
    if (comma == std::string_view::npos) return offset;
    rest.remove_prefix(comma + 1);
  }
}

std::string to_string(const ProbeOffset& offset) {
  std::string text;
  for (const Part& part : {kParts[2], kParts[0], kParts[1]}) {
    if (!(offset.*part.number > 0)) continue;
    if (!text.empty()) text += ',';
    text.append(part.prefix).append(shortest(offset.*part.number));
  }
  return text;
}

}  // namespace thalweg
