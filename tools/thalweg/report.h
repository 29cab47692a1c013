// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What commands tell about a run: one JSON object for programs (--json), or lines for people.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "command.h"

namespace thalweg::cli {

using Json = nlohmann::ordered_json;  // non-finite numbers are written as null

/// Lines of a label and what it stands for, aligned.
class Sheet {
 public:
  void add(std::string_view label, const std::string& text);
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::pair<std::string, std::string>> rows_;
};

/// A table with a header; columns are as wide as their widest cell, numbers to the right.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : rows_{std::move(header)} {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// Prints the JSON object when it was asked for, else the text unless --quiet; on stderr when the result itself went
/// to stdout.
void print_report(const Globals& globals, bool result_on_stdout, const Json& json, const std::string& text);

/// 1234567 as `1 234 567`.
[[nodiscard]] std::string grouped(std::uint64_t number);
/// A rate or a number with an SI suffix: `12.3 M`.
[[nodiscard]] std::string with_suffix(double number);
/// The number of threads that --threads stands for.
[[nodiscard]] int thread_count(const Globals& globals);

/// Wall time since it was made, in seconds.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// How many rows have each status.
[[nodiscard]] Json statuses_json(const Summary& summary);
void add_statuses(Sheet& sheet, const Summary& summary);

/// What any batch has in common: rows, seconds, rate, threads, target.
void add_run(Json& json, const Globals& globals, std::size_t rows, double seconds);
[[nodiscard]] std::string run_text(const Globals& globals, std::size_t rows, double seconds, std::string_view noun);

}  // namespace thalweg::cli
