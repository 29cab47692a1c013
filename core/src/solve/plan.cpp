// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/plan.h"

#include <array>
#include <cmath>

#include "solve/descend.h"

namespace thalweg {
namespace {

template <class Enum>
struct Word {
  std::string_view text;
  Enum value;
};
template <class Enum>
Word(const char*, Enum) -> Word<Enum>;

constexpr std::array kMethods = {Word{"certified", Method::certified}, Word{"thesis", Method::thesis},
                                 Word{"projected", Method::projected}, Word{"descent", Method::projected},
                                 Word{"published", Method::published}, Word{"midsurface", Method::midsurface}};
constexpr std::array kGoals = {Word{"verdict", Goal::verdict}, Word{"deepest", Goal::deepest}};
constexpr std::array kGradients = {Word{"autodiff", Gradient::autodiff},
                                   Word{"central", Gradient::central},
                                   Word{"forward", Gradient::forward},
                                   Word{"simplex", Gradient::simplex},
                                   Word{"dichotomy", Gradient::dichotomy},
                                   Word{"dichotomy:verbatim", Gradient::dichotomy_verbatim},
                                   Word{"closest_point", Gradient::closest_point}};

template <class Words>
std::string list(const Words& words) {
  std::string all;
  for (const auto& word : words) all.append(all.empty() ? "" : ", ").append(word.text);
  return all;
}

template <class Enum, class Words>
Result<Enum> parse(const Words& words, std::string_view text, std::string_view option) {
  for (const auto& word : words) {
    if (word.text == text) return word.value;
  }
  std::string found = "\"";
  found.append(text).append("\"");
  return Error{.file = "", .place = std::string(option), .expected = "one of " + list(words), .found = found};
}

template <class Words, class Enum>
std::string_view name_in(const Words& words, Enum value) {
  for (const auto& word : words) {
    if (word.value == value) return word.text;
  }
  return "";
}

Error refused(std::string_view option, std::string_view expected, std::string_view found) {
  return {.file = "", .place = std::string(option), .expected = std::string(expected), .found = std::string(found)};
}

/// What each local method takes when the caller does not say.
struct MethodDefaults {
  Gradient gradient;
  std::uint32_t starts, iterations;
};
MethodDefaults defaults_of(Method method) {
  switch (method) {
    case Method::thesis:
      return {Gradient::dichotomy_verbatim, 1, 64};
    case Method::projected:
      return {Gradient::autodiff, 1, 16};
    default:
      return {Gradient::autodiff, 1, 1};
  }
}

}  // namespace

std::string_view name(Status status) {
  switch (status) {
    case Status::separated:
      return "separated";
    case Status::overlapping:
      return "overlapping";
    case Status::touching:
      return "touching";
    case Status::undecided:
      return "undecided";
    case Status::bad_row:
      return "bad row";
  }
  return "";
}
std::string_view name(Method method) { return name_in(kMethods, method); }
std::string_view name(Goal goal) { return name_in(kGoals, goal); }
std::string_view name(Gradient gradient) { return name_in(kGradients, gradient); }
Result<Method> parse_method(std::string_view text) { return parse<Method>(kMethods, text, "--method"); }
Result<Goal> parse_goal(std::string_view text) { return parse<Goal>(kGoals, text, "--goal"); }
Result<Gradient> parse_gradient(std::string_view text) { return parse<Gradient>(kGradients, text, "--gradient"); }

double default_tolerance(const Tape& tape) {
  const Bounds& bounds = tape.facts.bounds;
  const bool usable = bounds.finite(tape.dimension) && bounds.diagonal(tape.dimension) > 0;
  return usable ? 1e-4 * bounds.diagonal(tape.dimension) : 1e-4;
}

Result<SolveLimits> plan(const Tape& tape, QueryKind kind, const CollideOptions& options) {
  const bool triangles = kind == QueryKind::triangles;
  const bool of_pairs = options.method == Method::midsurface;
  if (triangles && (options.method == Method::published || of_pairs)) {
    return refused("--method", "a method for triangles: certified, thesis, projected", name(options.method));
  }
  if (!triangles && (options.method == Method::thesis || options.method == Method::projected || of_pairs)) {
    return refused("--method", "a method for circles: certified, published", name(options.method));
  }
  if (!std::isfinite(options.tolerance) || options.tolerance < 0) {
    return refused("--tolerance", "a length of at least 0 (0: the default)", "another number");
  }
  if (options.budget == 0) return refused("--budget", "at least 1 evaluation", "0");
  const MethodDefaults defaults = defaults_of(options.method);
  SolveLimits limits;
  limits.goal = options.goal;
  limits.method = options.method;
  const Gradient strategy = options.gradient_given ? options.gradient : defaults.gradient;
  if (auto error = refusal(tape, strategy, options.gradient_offset)) return *std::move(error);
  limits.gradient = rule_of(tape, strategy, options.gradient_offset);
  if (options.gradient_given) limits.normals = limits.gradient;
  limits.starts = options.starts == 0 ? defaults.starts : options.starts;
  limits.iterations = options.iterations == 0 ? defaults.iterations : options.iterations;
  limits.budget = options.budget;
  limits.tolerance = options.tolerance > 0 ? options.tolerance : default_tolerance(tape);
  limits.slack = tape.search_slack;
  limits.slack64 = {.a = limits.slack.a * Twin::kSlackRatio, .b = limits.slack.b * Twin::kSlackRatio};
  return limits;
}

void solve(const TriangleTile& tile, TileScratch& scratch) {
  tile.limits->method == Method::certified ? tile.kernels->certify_triangles(tile, scratch)
                                           : descend_triangles(tile, scratch);
}

void solve(const CircleTile& tile, TileScratch& scratch) {
  tile.limits->method == Method::certified ? tile.kernels->certify_circles(tile, scratch)
                                           : publish_circles(tile, scratch);
}

CollideColumns columns_from(const CollideColumns& columns, std::size_t row, int dimension) {
  CollideColumns moved = columns;
  for_each_column(
      dimension,
      [row](std::size_t width, auto*& column) {
        if (column != nullptr) column += row * width;
      },
      moved);
  return moved;
}

}  // namespace thalweg
