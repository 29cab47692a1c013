// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg profile`: the gradient strategies against each other, by themselves, against their offset, and under the
// local descents.
#include <memory>

#include <fmt/format.h>

#include "command.h"
#include "input.h"
#include "options.h"
#include "profile_descents.h"
#include "profile_plots.h"
#include "profile_sample.h"
#include "profile_strategies.h"
#include "progress.h"
#include "report.h"

namespace thalweg::cli {

namespace {

constexpr std::uint64_t kMostRows = 10'000'000;

struct ProfileOptions {
  std::string scene, plots;
  std::uint64_t points = 20'000, triangles = 2'000;
  ProbeOffset offset;
};

Json bands_json(const StrategyProfile& profile) {
  Json bands = Json::array();
  for (std::size_t i = 0; i < kBandNames.size(); ++i) {
    Json band = to_json(profile.bands[i]);
    band["distance_in_diagonals"] = kBandNames[i];
    bands.push_back(std::move(band));
  }
  return bands;
}

Json strategies_json(const ProfileReport& report) {
  Json rows = Json::array();
  for (const StrategyProfile& profile : report.strategies) {
    rows.push_back({{"strategy", name(profile.strategy)},
                    {"evaluations", profile.evaluations},
                    {"nanoseconds", profile.nanoseconds},
                    {"all", to_json(profile.all)},
                    {"away_from_kinks", to_json(profile.smooth)},
                    {"near_kinks", to_json(profile.kinks)},
                    {"by_distance", bands_json(profile)}});
  }
  return rows;
}

Json sweeps_json(const ProfileReport& report) {
  Json rows = Json::array();
  for (const OffsetSweep& sweep : report.sweeps) {
    Json points = Json::array();
    for (std::size_t i = 0; i < sweep.offset.size(); ++i) {
      points.push_back({{"offset_in_diagonals", sweep.offset[i]},
                        {"away_from_kinks", to_json(sweep.smooth[i])},
                        {"near_kinks", to_json(sweep.kinks[i])}});
    }
    rows.push_back({{"strategy", name(sweep.strategy)}, {"offsets", std::move(points)}});
  }
  return rows;
}

Json descents_json(const ProfileReport& report) {
  Json rows = Json::array();
  for (const DescentProfile& descent : report.descents) {
    rows.push_back({{"method", name(descent.method)},
                    {"strategy", name(descent.strategy)},
                    {"hits", descent.hits},
                    {"misses", descent.misses},
                    {"iterations", descent.iterations},
                    {"evaluations", descent.evaluations},
                    {"nanoseconds", descent.nanoseconds},
                    {"value_error_in_diagonals",
                     {{"median", descent.median_error}, {"p99", descent.p99_error}, {"max", descent.most_error}}}});
  }
  return rows;
}

std::string number(double x) { return fmt::format("{:.3g}", x); }
std::string percent(double share) { return fmt::format("{:.2f}", 100 * share); }

std::string strategies_text(const ProfileReport& report) {
  Table table({"strategy", "evaluations", "ns", "median", "p99", "max", "kinks median", "kinks p99", "wrong half %",
               "zero %", "NaN"});
  for (const StrategyProfile& p : report.strategies) {
    table.add({std::string(name(p.strategy)), fmt::format("{:.2f}", p.evaluations),
               fmt::format("{:.1f}", p.nanoseconds), number(p.smooth.median), number(p.smooth.p99),
               number(p.smooth.most), number(p.kinks.median), number(p.kinks.p99), percent(p.all.wrong_half_space),
               percent(p.all.vanished), fmt::format("{}", p.all.nan)});
  }
  return table.text();
}

std::string bands_text(const ProfileReport& report) {
  std::vector<std::string> header = {"p99 at |f| of"};
  header.insert(header.end(), kBandNames.begin(), kBandNames.end());
  Table table(header);
  for (const StrategyProfile& profile : report.strategies) {
    std::vector<std::string> row = {std::string(name(profile.strategy))};
    for (const AngleErrors& band : profile.bands) row.push_back(number(band.p99));
    table.add(row);
  }
  return table.text();
}

std::string descents_text(const ProfileReport& report) {
  Table table({"method", "strategy", "misses", "of hits", "iterations", "evaluations", "ns", "error median",
               "error p99", "error max"});
  for (const DescentProfile& d : report.descents) {
    table.add({std::string(name(d.method)), std::string(name(d.strategy)), fmt::format("{}", d.misses),
               fmt::format("{}", d.hits), fmt::format("{:.1f}", d.iterations), fmt::format("{:.1f}", d.evaluations),
               fmt::format("{:.0f}", d.nanoseconds), number(d.median_error), number(d.p99_error),
               number(d.most_error)});
  }
  return table.text();
}

ProfileReport measure(const Tape& tape, const ProfileOptions& options, const Globals& globals) {
  constexpr std::size_t kSweptPoints = 5'000;
  ProfileReport report;
  const ProfileSample sample = make_profile_sample(tape, options.points, globals.seed);
  const ProfileSample swept = sample.head(kSweptPoints);
  for (const Gradient strategy : strategies_of(tape.dimension)) {
    report.strategies.push_back(profile_strategy(tape, sample, {strategy, options.offset}, globals));
    if (strategy == Gradient::autodiff || strategy == Gradient::closest_point) continue;
    report.sweeps.push_back(sweep_offset(tape, swept, strategy, globals));
  }
  report.descents =
      profile_descents(tape, profile_triangles(tape, options.triangles, globals.seed), options.offset, globals);
  return report;
}

ExitCode run_profile(const ProfileOptions& options, const Globals& globals) {
  const Scene scene = read_scene(options.scene);
  const Tape tape = unwrap(compile(scene.shape), input_name(options.scene), "/shape");
  const Bounds& bounds = tape.facts.bounds;
  if (bounds.empty(tape.dimension) || !bounds.finite(tape.dimension) || !(bounds.diagonal(tape.dimension) > 0)) {
    refuse(input_name(options.scene), "/shape", "a shape of finite extent", "an unbounded or empty one");
  }
  const Stopwatch watch;
  const ProfileReport report = measure(tape, options, globals);
  std::vector<std::string> plots;
  if (!options.plots.empty()) plots = draw_profile(report, options.plots, input_name(options.scene));
  const Json json = {{"command", "profile"},
                     {"scene", options.scene},
                     {"dimension", tape.dimension},
                     {"points", options.points},
                     {"triangles", options.triangles},
                     {"seed", globals.seed},
                     {"simd", globals.active_target().name},
                     {"gradient_offset", to_string(options.offset)},
                     {"diagonal", bounds.diagonal(tape.dimension)},
                     {"elapsed_seconds", watch.seconds()},
                     {"strategies", strategies_json(report)},
                     {"sweeps", sweeps_json(report)},
                     {"descents", descents_json(report)},
                     {"plots", plots}};
  std::string text = fmt::format(
      "{} points, offset {}; angles in radians from the gradient in double, away from kinks\n"
      "but for the columns that say otherwise; one thread, {}\n\n",
      grouped(options.points), to_string(options.offset), globals.active_target().name);
  text += strategies_text(report) + '\n' + bands_text(report);
  text += fmt::format("\n{} triangles; errors of the value in diagonals of the scene\n\n", grouped(options.triangles));
  text += descents_text(report);
  for (const std::string& plot : plots) text += plot + '\n';
  print_report(globals, false, json, text);
  return ExitCode::done;
}

}  // namespace

Command add_profile(CLI::App& app, const Globals& globals) {
  CLI::App* const command = app.add_subcommand("profile", "The gradient strategies against each other");
  const auto options = std::make_shared<ProfileOptions>();
  command->add_option("SCENE", options->scene, "Scene file, or - for stdin")->required();
  add_integer(*command, {"--points", "How many points; default 20000"}, options->points, {1, kMostRows});
  add_integer(*command, {"--triangles", "How many triangles; default 2000"}, options->triangles, {1, kMostRows});
  add_gradient_offset(*command, options->offset);
  command->add_option("--plots", options->plots, "Folder for plots, with their numbers")->type_name("DIR");
  return {command, [options, &globals] { return run_profile(*options, globals); }};
}

}  // namespace thalweg::cli
