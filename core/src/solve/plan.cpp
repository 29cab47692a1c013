// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/plan.h"

#include <cmath>

#include "compile/shorten.h"
#include "gradient/strategies.h"
#include "solve/contacts.h"
#include "solve/descend.h"
#include "solve/starts.h"
#include "thalweg/method_table.h"

namespace thalweg {
namespace {

Error refused(std::string_view option, std::string_view expected, std::string_view found) {
  return {.file = "", .place = std::string(option), .expected = std::string(expected), .found = std::string(found)};
}

/// The names of the methods that answer a kind of query.
std::string methods_for(bool triangles) {
  std::string all;
  for (const MethodRow& row : method_table()) {
    const bool fits = row.method == Method::certified || (!row.pairs && row.triangles == triangles);
    if (fits) all.append(all.empty() ? "" : ", ").append(row.name);
  }
  return all;
}

/// Fills in where a local method starts, or says what is wrong with the wish.
Result<SolveLimits> with_starts(SolveLimits limits, const CollideOptions& options, const MethodRow& row) {
  limits.start = options.start == Start::own ? row.start : options.start;
  if (options.start == Start::own && options.starts > usual_starts(row.start)) limits.start = Start::sequence;
  if (row.method == Method::golden_section && limits.start != Start::mid_edges) {
    return refused("--start", "mid_edges, at most 3 starts, for golden_section", name(limits.start));
  }
  limits.starts = options.starts == 0 ? usual_starts(limits.start) : options.starts;
  if (limits.starts > most_starts(limits.start)) {
    const std::string most = "at most " + std::to_string(most_starts(limits.start)) + " for --start ";
    return refused("--starts", most + std::string(name(limits.start)), std::to_string(options.starts));
  }
  return limits;
}

/// Further out a far point closes hardly more cells (measured: 16 reaches leave 2 % more evaluations than 64), and all
/// that lies on the way must be in the region of a shortened tape. Verdicts gain less from them than short tapes do.
constexpr float kFarReaches = 16;
constexpr float kFarReachesOfLongTapes = 4;

double default_feature(const Tape& tape) {
  const Bounds& bounds = tape.facts.bounds;
  const bool usable = bounds.finite(tape.dimension) && bounds.diagonal(tape.dimension) > 0;
  return usable ? bounds.diagonal(tape.dimension) / 64 : 1.0 / 64;
}

/// Refuses numbers that make no sense.
Result<SolveLimits> with_rules(SolveLimits limits, const CollideOptions& options, const MethodRow& row) {
  const auto is_length = [](double x) { return std::isfinite(x) && x >= 0; };
  if (!is_length(options.step)) return refused("--step", "a number of at least 0 (0: the method's own)", "another");
  if (!is_length(options.margin)) return refused("--margin", "a length of at least 0", "another number");
  if (!is_length(options.feature)) return refused("--feature", "a length of at least 0 (0: the default)", "another");
  if (!std::isfinite(options.floor)) return refused("--floor", "a length", "another number");
  if (!std::isfinite(options.stop)) return refused("--stop", "a number", "another");
  limits.step = options.step > 0 ? options.step : row.step;
  limits.floor = options.floor >= 0 ? options.floor : row.floor;
  limits.stop = options.stop >= 0 ? options.stop : row.stop;
  limits.stop_at_witness = options.stop_at_witness;
  limits.contacts = options.contacts;
  limits.margin = options.margin;
  return limits;
}

}  // namespace

double default_tolerance(const Tape& tape) {
  const Bounds& bounds = tape.facts.bounds;
  const bool usable = bounds.finite(tape.dimension) && bounds.diagonal(tape.dimension) > 0;
  return usable ? 1e-4 * bounds.diagonal(tape.dimension) : 1e-4;
}

Result<SolveLimits> plan(const Tape& tape, QueryKind kind, const CollideOptions& options) {
  const bool triangles = kind == QueryKind::triangles;
  const MethodRow& row = method_row(options.method);
  if (options.method != Method::certified && (row.pairs || row.triangles != triangles)) {
    const std::string kinds = triangles ? "triangles: " : "circles: ";
    return refused("--method", "a method for " + kinds + methods_for(triangles), row.name);
  }
  if (!std::isfinite(options.tolerance) || options.tolerance < 0) {
    return refused("--tolerance", "a length of at least 0 (0: the default)", "another number");
  }
  if (!triangles && options.contacts > 0) {
    return refused("--contacts", "triangles, which may have several contacts", "circles");
  }
  if (options.contacts > kMostContacts) {
    return refused("--contacts", "at most " + std::to_string(kMostContacts), std::to_string(options.contacts));
  }
  if (options.budget == 0) return refused("--budget", "at least 1 evaluation", "0");
  SolveLimits limits;
  limits.goal = options.goal;
  limits.method = options.method;
  const Gradient strategy = options.gradient_given ? options.gradient : row.gradient;
  if (auto error = refusal(tape, strategy, options.gradient_offset)) return *std::move(error);
  limits.gradient = rule_of(tape, strategy, options.gradient_offset);
  if (options.gradient_given) limits.normals = limits.gradient;
  limits.iterations = options.iterations == 0 ? row.iterations : options.iterations;
  limits.budget = options.budget;
  limits.tolerance = options.tolerance > 0 ? options.tolerance : default_tolerance(tape);
  limits.slack = tape.search_slack;
  const bool is_long = tape.instructions.size() >= kLongTape;
  limits.far_reaches = !is_long ? kFarReaches : options.goal == Goal::deepest ? kFarReachesOfLongTapes : 0;
  limits.slack64 = {.a = tape.enclosure_slack.a * Twin::kSlackRatio, .b = tape.enclosure_slack.b * Twin::kSlackRatio};
  limits.feature = options.feature > 0 ? options.feature : default_feature(tape);
  auto ruled = with_rules(limits, options, row);
  if (!ruled || options.method == Method::certified || !triangles) return ruled;
  // What a lane takes before it can be asked whether it has enough.
  const std::uint32_t least = evaluations_of(limits.gradient, tape.dimension, true) + 6;
  if (options.budget < least) {
    return refused("--budget", "at least " + std::to_string(least) + " evaluations for " + std::string(row.name),
                   std::to_string(options.budget));
  }
  return with_starts(*ruled, options, row);
}

namespace {

void minimise(const TriangleTile& tile, TileScratch& scratch) {
  switch (tile.limits->method) {
    case Method::certified:
    case Method::published:
    case Method::midsurface:
      return tile.kernels->certify_triangles(tile, scratch);
    case Method::accelerated:
      return descend_accelerated(tile, scratch);
    case Method::thesis:
    case Method::thesis_fixed:
    case Method::thesis_scaled:
    case Method::distance_step:
      return descend_in_space(tile, scratch);
    case Method::projected:
      return descend_projected(tile, scratch);
    case Method::frank_wolfe:
      return descend_frank_wolfe(tile, scratch);
    case Method::frank_wolfe_search:
      return descend_frank_wolfe_search(tile, scratch);
    case Method::golden_section:
      return descend_golden_section(tile, scratch);
  }
}

}  // namespace

void solve(const TriangleTile& tile, TileScratch& scratch) {
  minimise(tile, scratch);
  if (tile.limits->contacts > 0) find_contacts(tile, scratch);
}

void solve(const CircleTile& tile, TileScratch& scratch) {
  tile.limits->method == Method::certified ? tile.kernels->certify_circles(tile, scratch)
                                           : publish_circles(tile, scratch);
}

CollideColumns columns_from(const CollideColumns& columns, std::size_t row, int dimension, std::uint32_t contacts) {
  CollideColumns moved = columns;
  const auto move = [row](std::size_t width, auto*& column) {
    if (column != nullptr) column += row * width;
  };
  for_each_column(dimension, move, moved);
  const auto d = static_cast<std::size_t>(dimension);
  for (auto** column : {&moved.contacts.found, &moved.contacts.kept}) move(1, *column);
  move(contacts, moved.contacts.value);
  move(contacts * d, moved.contacts.point);
  move(contacts * d, moved.contacts.normal);
  move(contacts * std::size_t{3}, moved.contacts.barycentric);
  return moved;
}

}  // namespace thalweg
