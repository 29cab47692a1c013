// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The one list of methods, and the words of the other options.
//
// Luneau 2025: "Détections de collisions avec des SDFs", CNAM ENJMIN. Macklin et al. 2020: "Local Optimization for
// Robust Signed Distance Field Collision", PACM CGIT 3(1).
#include <array>

#include "thalweg/method_table.h"

namespace thalweg {
namespace {

constexpr std::string_view kLuneau = "Luneau 2025, section 3.2";
constexpr std::string_view kMacklin = "Macklin et al. 2020";

constexpr std::array kMethods = {
    MethodRow{.method = Method::certified,
              .name = "certified",
              .proves = true,
              .mathematics = "branch and bound in waves on f(c) - L r, enclosures and support functions",
              .source = "core/docs/certificates.md"},
    MethodRow{.method = Method::accelerated,
              .name = "accelerated",
              .iterations = 64,
              .mathematics = "next point: argmin over the triangle of max_i f_i + g_i.(x - x_i), then the place that "
                             "f_i - L |x - x_i| excludes least",
              .source = "core/docs/methods.md; bundles after Kelley 1960, exclusion after Piyavskii 1972"},
    MethodRow{.method = Method::thesis,
              .name = "thesis",
              .gradient = Gradient::dichotomy_verbatim,
              .iterations = 64,
              .step = 0.1,
              .floor = 100,
              .mathematics = "x <- closest point of the triangle to x - alpha max(|f|, mu) grad f",
              .source = kLuneau},
    MethodRow{.method = Method::thesis_fixed,
              .name = "thesis_fixed",
              .gradient = Gradient::dichotomy_verbatim,
              .iterations = 64,
              .step = 10,
              .mathematics = "x <- closest point of the triangle to x - alpha grad f, alpha in scene units",
              .source = kLuneau},
    MethodRow{.method = Method::thesis_scaled,
              .name = "thesis_scaled",
              .gradient = Gradient::dichotomy_verbatim,
              .iterations = 64,
              .step = 0.1,
              .mathematics = "x <- closest point of the triangle to x - alpha |f| grad f: it slows at the surface",
              .source = kLuneau},
    MethodRow{.method = Method::projected,
              .name = "projected",
              .alias = "descent",
              .start = Start::best_of_4,
              .iterations = 16,
              .stop = 1e-3,
              .mathematics = "w <- projection on the simplex of w - t (g.(v_i - x))_i, t from 1/(2 max|v_i - x|), "
                             "x 0.8 each time",
              .source = "Macklin et al. 2020, as in PhysX"},
    MethodRow{.method = Method::frank_wolfe,
              .name = "frank_wolfe",
              .iterations = 10,
              .mathematics = "x <- x + 2/(k + 2) (v - x), v the corner with the least g.v",
              .source = kMacklin},
    MethodRow{.method = Method::frank_wolfe_search,
              .name = "frank_wolfe_search",
              .iterations = 24,
              .stop = 1e-6,
              .mathematics = "x <- the least of f from x to v by 16 steps of golden section, v the corner with the "
                             "least g.v",
              .source = kMacklin},
    MethodRow{.method = Method::golden_section,
              .name = "golden_section",
              .start = Start::mid_edges,
              .iterations = 24,
              .mathematics = "golden section along each edge; the inside of the triangle is not looked at",
              .source = kMacklin},
    MethodRow{.method = Method::distance_step,
              .name = "distance_step",
              .iterations = 32,
              .step = 1,
              .stop = 1e-3,
              .mathematics =
                  "x <- closest point of the triangle to x - alpha max(|f|, mu)/L grad f, alpha = 1, mu = 0: "
                  "it cannot jump over the surface",
              .source = "sphere tracing, Hart 1996"},
    MethodRow{.method = Method::published,
              .name = "published",
              .triangles = false,
              .mathematics = "f(centre) < radius",
              .source = "Luneau 2025, section 3.1"},
    MethodRow{.method = Method::midsurface,
              .name = "midsurface",
              .triangles = false,
              .pairs = true,
              .mathematics = "descends f_a + f_b + |max(f_a, f_b)| from Halton starts with backtracking",
              .source = "MuJoCo; core/docs/pairs.md"},
};

consteval bool in_order() {
  for (std::size_t i = 0; i < kMethods.size(); ++i) {
    if (kMethods[i].method != static_cast<Method>(i)) return false;
  }
  return true;
}
static_assert(in_order());

template <class Enum>
struct Word {
  std::string_view text;
  Enum value;
};
template <class Enum>
Word(const char*, Enum) -> Word<Enum>;

constexpr std::array kStarts = {Word{"own", Start::own},
                                Word{"centroid", Start::centroid},
                                Word{"vertices", Start::vertices},
                                Word{"mid_edges", Start::mid_edges},
                                Word{"best_of_4", Start::best_of_4},
                                Word{"halton", Start::halton},
                                Word{"sequence", Start::sequence}};
constexpr std::array kStops = {Word{"none", Stop::none},
                               Word{"goal", Stop::goal},
                               Word{"budget", Stop::budget},
                               Word{"iterations", Stop::iterations},
                               Word{"small step", Stop::small_step},
                               Word{"stationary", Stop::stationary},
                               Word{"witness", Stop::witness},
                               Word{"excluded", Stop::excluded}};
constexpr std::array kGoals = {Word{"verdict", Goal::verdict}, Word{"deepest", Goal::deepest}};
constexpr std::array kGradients = {Word{"autodiff", Gradient::autodiff},
                                   Word{"central", Gradient::central},
                                   Word{"forward", Gradient::forward},
                                   Word{"simplex", Gradient::simplex},
                                   Word{"dichotomy", Gradient::dichotomy},
                                   Word{"dichotomy:verbatim", Gradient::dichotomy_verbatim},
                                   Word{"closest_point", Gradient::closest_point}};

Error unknown(std::string_view option, std::string_view expected, std::string_view text) {
  std::string found = "\"";
  found.append(text).append("\"");
  return {.file = "", .place = std::string(option), .expected = "one of " + std::string(expected), .found = found};
}

template <class Enum, class Words>
Result<Enum> parse(const Words& words, std::string_view text, std::string_view option) {
  std::string all;
  for (const auto& word : words) {
    if (word.text == text) return word.value;
    all.append(all.empty() ? "" : ", ").append(word.text);
  }
  return unknown(option, all, text);
}

template <class Words, class Enum>
std::string_view name_in(const Words& words, Enum value) {
  for (const auto& word : words) {
    if (word.value == value) return word.text;
  }
  return "";
}

}  // namespace

std::span<const MethodRow> method_table() { return kMethods; }
const MethodRow& method_row(Method method) { return kMethods[static_cast<std::size_t>(method)]; }

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
std::string_view name(Method method) { return method_row(method).name; }
std::string_view name(Start start) { return name_in(kStarts, start); }
std::string_view name(Stop stop) { return name_in(kStops, stop); }
std::string_view name(Goal goal) { return name_in(kGoals, goal); }
std::string_view name(Gradient gradient) { return name_in(kGradients, gradient); }

Result<Method> parse_method(std::string_view text) {
  std::string all;
  for (const MethodRow& row : kMethods) {
    if (row.name == text || (!row.alias.empty() && row.alias == text)) return row.method;
    all.append(all.empty() ? "" : ", ").append(row.name);
    if (!row.alias.empty()) all.append(", ").append(row.alias);
  }
  return unknown("--method", all, text);
}
Result<Start> parse_start(std::string_view text) { return parse<Start>(kStarts, text, "--start"); }
Result<Goal> parse_goal(std::string_view text) { return parse<Goal>(kGoals, text, "--goal"); }
Result<Gradient> parse_gradient(std::string_view text) { return parse<Gradient>(kGradients, text, "--gradient"); }

}  // namespace thalweg
