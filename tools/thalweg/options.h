// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Options with values that are checked as strictly as the arrays are, with errors of the same form. CLI11 takes every
// value as text; these functions read it.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "failure.h"
#include "thalweg/query.h"
#include "thalweg/result.h"

namespace thalweg::cli {

/// The name of an option as errors spell it, and what `--help` says of it.
struct OptionText {
  std::string name;  ///< as CLI11 takes it: `-o,--output`
  std::string meaning;

  [[nodiscard]] std::string place() const;  ///< the longest of the names
};

struct IntegerRange {
  std::uint64_t least = 0;
  std::uint64_t most = 0;
};

/// On when it is named; takes no value.
CLI::Option* add_flag(CLI::App& app, const OptionText& text, bool& target);
CLI::Option* add_integer(CLI::App& app, const OptionText& text, std::uint64_t& target, IntegerRange range);
CLI::Option* add_positive(CLI::App& app, const OptionText& text, double& target);
CLI::Option* add_not_negative(CLI::App& app, const OptionText& text, double& target);
/// Exactly `count` finite numbers.
CLI::Option* add_numbers(CLI::App& app, const OptionText& text, std::vector<double>& target, int count);
/// A word that the library parses.
template <class T>
CLI::Option* add_word(CLI::App& app, const OptionText& text, T& target, Result<T> (*parse)(std::string_view)) {
  return app.add_option_function<std::string>(
      text.name,
      [&target, parse, place = text.place()](const std::string& word) {
        target = unwrap(parse(word), kCommandLine, place);
      },
      text.meaning);
}
/// `-o,--output`, required.
CLI::Option* add_output(CLI::App& app, std::string& target, const std::string& meaning);

/// `--gradient-offset`: how far the strategies that take differences probe.
CLI::Option* add_gradient_offset(CLI::App& app, ProbeOffset& target);

/// An option of the contract that is refused until it exists.
void add_unsupported(CLI::App& app, const OptionText& text);

}  // namespace thalweg::cli
