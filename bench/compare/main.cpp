// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// thalweg_compare [--short | --rows N] [--into PAGE]
//
// Every method for triangles on every scene, against the independent oracle: misses, false reports, error of the value,
// evaluations, nanoseconds. Fails when `certified` is wrong once, or when a published method has fewer misses or no
// more evaluations than `accelerated`. `--into` replaces the tables of a page between its two marks.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "measure.h"
#include "table.h"
#include "thalweg/simd.h"

namespace thalweg::bench {
namespace {

constexpr std::size_t kRows = 4000;
constexpr std::size_t kShortRows = 300;
constexpr std::size_t kRounds = 5;

struct Request {
  std::size_t rows = kRows;
  std::size_t rounds = kRounds;
  std::string page;
};

bool replace_between_marks(const std::string& page, const std::string& tables) {
  const std::string begin = "<!-- thalweg_compare: begin -->\n", end = "<!-- thalweg_compare: end -->";
  std::ifstream in(page, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::size_t from = text.find(begin), to = text.find(end);
  if (from == std::string::npos || to == std::string::npos) return false;
  text.replace(from + begin.size(), to - from - begin.size(), tables);
  std::ofstream out(page, std::ios::binary);
  out << text;
  return static_cast<bool>(out.flush());
}

int compare(const Request& request) {
  Totals totals;
  std::string tables;
  bool certified_is_right = true;
  for (const CompareScene& scene : compare_scenes()) {
    const CompareCase work = make_case(scene, request.rows);
    const auto all = contenders(work);
    const auto measured = measure(work, all, request.rounds);
    const std::string table = scene_table(work, all, measured);
    std::fputs(table.c_str(), stdout);
    std::fflush(stdout);
    tables += table;
    totals.add(all, measured);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Measurement& m = measured[i];
      if (all[i].options.method != Method::certified || m.misses + m.false_reports + m.undecided == 0) continue;
      std::fprintf(stderr, "thalweg_compare: %s: %s is wrong or undecided\n", std::string(scene.file).c_str(),
                   all[i].name.c_str());
      certified_is_right = false;
    }
  }
  const std::string sums = totals.table();
  std::fputs(sums.c_str(), stdout);
  const std::string beaten = totals.who_beats_accelerated();
  if (!beaten.empty()) std::fprintf(stderr, "thalweg_compare: accelerated is beaten by %s\n", beaten.c_str());
  if (!certified_is_right || !beaten.empty()) return 1;
  const std::string target = "Target " + std::string(default_target().name) + ", one thread, " +
                             std::to_string(request.rows) + " triangles a scene.\n\n";
  if (request.page.empty() || replace_between_marks(request.page, "\n" + target + sums + "\n" + tables)) return 0;
  std::fprintf(stderr, "thalweg_compare: %s: marks: expected the two marks, found others\n", request.page.c_str());
  return 1;
}

/// False when an argument is not understood.
bool read(int count, char** arguments, Request& request) {
  for (int i = 1; i < count; ++i) {
    const std::string_view word = arguments[i];
    if (word == "--short") {
      request.rows = kShortRows;
      request.rounds = 1;
    } else if (word == "--rows" && i + 1 < count) {
      request.rows = std::strtoul(arguments[++i], nullptr, 10);
      if (request.rows == 0) return false;
    } else if (word == "--into" && i + 1 < count) {
      request.page = arguments[++i];
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace
}  // namespace thalweg::bench

int main(int count, char** arguments) {
  thalweg::bench::Request request;
  if (!thalweg::bench::read(count, arguments, request)) {
    std::fprintf(stderr, "thalweg_compare: arguments: expected --short, --rows N, --into PAGE, found another\n");
    return 1;
  }
  try {
    return thalweg::bench::compare(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "thalweg_compare: %s\n", error.what());
    return 1;
  }
}
