// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Checked options.
#include "options.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "text.h"

namespace thalweg::cli {

namespace {

double finite_number(const std::string& word, const std::string& place) {
  const std::optional<double> number = parse_number(word);
  if (!number || !std::isfinite(*number)) refuse(kCommandLine, place, "a finite number", in_quotes(word));
  return *number;
}

std::uint64_t integer(const std::string& word, const std::string& place, IntegerRange range) {
  std::uint64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || error != std::errc() || value < range.least || value > range.most) {
    refuse(kCommandLine, place, fmt::format("a whole number from {} to {}", range.least, range.most), in_quotes(word));
  }
  return value;
}

}  // namespace

std::string OptionText::place() const {
  const std::size_t comma = name.rfind(',');
  return comma == std::string::npos ? name : name.substr(comma + 1);
}

CLI::Option* add_flag(CLI::App& app, const OptionText& text, bool& target) {
  return app.add_flag(text.name, target, text.meaning)->disable_flag_override();
}

CLI::Option* add_integer(CLI::App& app, const OptionText& text, std::uint64_t& target, IntegerRange range) {
  const auto read = [&target, range, place = text.place()](const std::string& word) {
    target = integer(word, place, range);
  };
  return app.add_option_function<std::string>(text.name, read, text.meaning)->type_name("N");
}

CLI::Option* add_positive(CLI::App& app, const OptionText& text, double& target) {
  const auto read = [&target, place = text.place()](const std::string& word) {
    target = finite_number(word, place);
    if (!(target > 0)) refuse(kCommandLine, place, "a number above 0", in_quotes(word));
  };
  return app.add_option_function<std::string>(text.name, read, text.meaning)->type_name("X");
}

CLI::Option* add_not_negative(CLI::App& app, const OptionText& text, double& target) {
  const auto read = [&target, place = text.place()](const std::string& word) {
    target = finite_number(word, place);
    if (!(target >= 0)) refuse(kCommandLine, place, "a number of at least 0", in_quotes(word));
  };
  return app.add_option_function<std::string>(text.name, read, text.meaning)->type_name("X");
}

CLI::Option* add_numbers(CLI::App& app, const OptionText& text, std::vector<double>& target, int count) {
  const auto read = [&target, place = text.place()](const std::vector<std::string>& words) {
    target.clear();
    for (const std::string& word : words) target.push_back(finite_number(word, place));
  };
  return app.add_option_function<std::vector<std::string>>(text.name, read, text.meaning)
      ->expected(count)
      ->type_name("X");
}

CLI::Option* add_output(CLI::App& app, std::string& target, const std::string& meaning) {
  return app.add_option("-o,--output", target, meaning)->required()->type_name("OUT");
}

CLI::Option* add_gradient_offset(CLI::App& app, ProbeOffset& target) {
  return add_word(
             app,
             {"--gradient-offset",
              "How far differences probe: X, f:X (times |f|), scene:X (times the scene's diagonal), or the greatest "
              "of several: 0.005,f:0.00025 (default)"},
             target, &parse_probe_offset)
      ->type_name("O");
}

void add_unsupported(CLI::App& app, const OptionText& text) {
  const auto stop = [place = text.place()](const std::string& word) {
    refuse(kCommandLine, place, "an option of this version", in_quotes(word) + ", which is not supported yet");
  };
  app.add_option_function<std::string>(text.name, stop, text.meaning)->group("");
}

}  // namespace thalweg::cli
