// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Reading CSV.
#include "csv.h"

#include <optional>

#include <fmt/format.h>

#include "failure.h"
#include "text.h"

namespace thalweg::cli {

namespace {

std::string_view take_field(std::string_view& line) {
  const std::size_t comma = line.find(',');
  const std::string_view field = trimmed(line.substr(0, comma));
  line = comma == std::string_view::npos ? std::string_view() : line.substr(comma + 1);
  return field;
}

std::size_t field_count(std::string_view line) {
  std::size_t count = 1;
  for (const char c : line) count += c == ',' ? 1 : 0;
  return count;
}

// A row of names: as many as there are numbers in a row, and none of them a number.
bool is_header(std::string_view line, const RowShape& row) {
  if (field_count(line) != row.width()) return false;
  for (std::size_t left = field_count(line); left > 0; --left) {
    const std::string_view field = take_field(line);
    if (field.empty() || parse_number(field)) return false;
  }
  return true;
}

void append_row(std::string_view line, std::size_t line_number, const RowShape& row, const std::string& name,
                std::vector<float>& values) {
  const std::size_t count = field_count(line);
  if (count != row.width()) {
    refuse(name, fmt::format("line {}", line_number), fmt::format("{} numbers of {}", row.width(), shape_text(row)),
           fmt::format("{} fields", count));
  }
  const char* const begin = line.data();
  for (std::size_t i = 0; i < count; ++i) {
    const auto column = static_cast<std::size_t>(line.data() - begin) + 1;
    const std::string_view field = take_field(line);
    const std::optional<double> number = parse_number(field);
    if (!number) refuse(name, fmt::format("{}:{}", line_number, column), "a number", in_quotes(field));
    values.push_back(to_float32(*number));
  }
}

}  // namespace

Array parse_csv(std::string_view text, const RowShape& row, const std::string& name) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
  Array array;
  Lines lines(text);
  bool first = true;
  while (const std::optional<std::string_view> line = lines.next()) {
    const std::string_view content = trimmed(*line);
    if (content.empty() || content[0] == '#') continue;
    const bool header = first && is_header(content, row);
    first = false;
    if (!header) append_row(*line, lines.number(), row, name, array.values);
  }
  array.shape = {array.values.size() / row.width()};
  array.shape.insert(array.shape.end(), row.inner.begin(), row.inner.end());
  return array;
}

}  // namespace thalweg::cli
