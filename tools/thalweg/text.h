// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Text cut into lines and words, and words read as numbers: what the CSV, OBJ, PLY and STL readers share.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace thalweg::cli {

/// Walks over lines; a line ends in \n, \r\n or the end of the text.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  /// The next line without its end, or nothing after the last.
  [[nodiscard]] std::optional<std::string_view> next();
  [[nodiscard]] std::size_t number() const { return number_; }  ///< of the line just returned, from 1
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Without blanks at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Takes the next word off the front of `text`; empty at its end.
[[nodiscard]] std::string_view take_word(std::string_view& text);

/// The whole of `text` as a number (decimal, nan or inf, optionally signed); an overflow gives an infinity.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// The whole of `text` as an integer.
[[nodiscard]] std::optional<long long> parse_integer(std::string_view text);

/// `text` in quotes, shortened, for an error's `found`.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace thalweg::cli
