// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Reports as text and JSON.
#include "report.h"

#include <algorithm>
#include <array>
#include <thread>

#include <fmt/format.h>

#include "output.h"

namespace thalweg::cli {

namespace {

bool is_number(const std::string& cell) { return !cell.empty() && (cell[0] >= '0' && cell[0] <= '9'); }

}  // namespace

void Sheet::add(std::string_view label, const std::string& text) { rows_.emplace_back(label, text); }

std::string Sheet::text() const {
  std::size_t width = 0;
  for (const auto& [label, unused] : rows_) width = std::max(width, label.size());
  std::string lines;
  for (const auto& [label, content] : rows_) lines += fmt::format("{:<{}}  {}\n", label, width, content);
  return lines;
}

std::string Table::text() const {
  std::vector<std::size_t> widths(rows_.front().size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string lines;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line +=
          is_number(row[i]) ? fmt::format("{:>{}}  ", row[i], widths[i]) : fmt::format("{:<{}}  ", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    lines += line + '\n';
  }
  return lines;
}

void print_report(const Globals& globals, bool result_on_stdout, const Json& json, const std::string& text) {
  if (globals.quiet && !globals.json) return;
  // Names of files may hold bytes that are not UTF-8; they are replaced rather than refused after the work is done.
  const std::string report = globals.json ? json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n' : text;
  if (result_on_stdout) {
    write_stderr(report);
  } else {
    write_stdout(report);
  }
}

std::string grouped(std::uint64_t number) {
  std::string text = fmt::format("{}", number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ' ');
  return text;
}

std::string with_suffix(double number) {
  constexpr std::array<std::string_view, 4> kSuffixes = {"", " k", " M", " G"};
  std::size_t index = 0;
  for (; number >= 1000 && index + 1 < kSuffixes.size(); ++index) number /= 1000;
  return fmt::format("{:.3g}{}", number, kSuffixes[index]);
}

int thread_count(const Globals& globals) {
  if (globals.threads > 0) return globals.threads;
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

Json statuses_json(const Summary& summary) {
  const auto& by = summary.by_status;
  return {{"separated", by[0]}, {"overlapping", by[1]}, {"touching", by[2]}, {"undecided", by[3]}, {"bad_row", by[4]}};
}

void add_statuses(Sheet& sheet, const Summary& summary) {
  constexpr std::array<std::string_view, 5> kLabels = {"separated", "overlapping", "touching", "undecided", "bad rows"};
  for (std::size_t i = 0; i < kLabels.size(); ++i) {
    sheet.add(fmt::format("  {}", kLabels[i]), fmt::format("{:>12}", grouped(summary.by_status[i])));
  }
}

void add_run(Json& json, const Globals& globals, std::size_t rows, double seconds) {
  json["elapsed_seconds"] = seconds;
  json["rows_per_second"] = seconds > 0 ? static_cast<double>(rows) / seconds : 0;
  json["threads"] = thread_count(globals);
  json["simd"] = globals.active_target().name;
}

std::string run_text(const Globals& globals, std::size_t rows, double seconds, std::string_view noun) {
  const double rate = seconds > 0 ? static_cast<double>(rows) / seconds : 0;
  const int threads = thread_count(globals);
  return fmt::format("{:.4g} s, {} {}/s, {} thread{}, {}", seconds, with_suffix(rate), noun, threads,
                     threads == 1 ? "" : "s", globals.active_target().name);
}

}  // namespace thalweg::cli
