// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg stress`: how throughput depends on what a caller may choose, and how near the machine's limits it is.
#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "command.h"
#include "input.h"
#include "options.h"
#include "plot.h"
#include "report.h"
#include "stress_sweeps.h"
#include "thalweg/scene.h"

namespace thalweg::cli {

namespace {

struct StressOptions {
  std::string scene, plots;
  std::uint64_t count = std::uint64_t{1} << 18;
  std::uint64_t rounds = 7;
};

/// Time per query against x as a power: what growing costs.
std::optional<double> exponent(const StressSweep& sweep) {
  if (sweep.name != "batch" && sweep.name != "scene") return std::nullopt;
  std::vector<double> x, seconds;
  for (const StressPoint& point : sweep.points) {
    x.push_back(point.x);
    const double rows = sweep.name == "batch" ? point.x : 1;
    seconds.push_back(rows / point.queries_per_second);
  }
  return fitted_exponent(x, seconds);
}

std::string_view exponent_text(const StressSweep& sweep) {
  return sweep.name == "batch" ? "time of a batch grows as its size to the power"
                               : "time of a triangle grows as the number of primitives to the power";
}

Json json_of(const StressPoint& point) {
  Json json = {{"label", point.label},
               {"x", point.x},
               {"rows", point.rows},
               {"queries_per_second", point.queries_per_second},
               {"spread", point.spread}};
  if (point.evaluations_per_query > 0) {
    json["evaluations_per_query"] = point.evaluations_per_query;
    json["evaluations_per_second"] = point.evaluations_per_second();
  }
  return json;
}

Json json_of(const StressSweep& sweep) {
  Json points = Json::array();
  for (const StressPoint& point : sweep.points) points.push_back(json_of(point));
  Json json = {{"name", sweep.name}, {"axis", sweep.axis}, {"points", points}};
  if (const auto grows = exponent(sweep)) json["exponent"] = *grows;
  return json;
}

Json json_of(const Roofline& roofline) {
  Json points = Json::array();
  for (std::size_t i = 0; i < roofline.points.size(); ++i) {
    Json json = json_of(roofline.points[i]);
    json["of_limit"] = roofline.points[i].evaluations_per_second() / roofline.limit;
    json["bytes_per_query"] = roofline.bytes_per_query[i];
    json["evaluations_per_byte"] = roofline.evaluations_per_byte(i);
    points.push_back(std::move(json));
  }
  return {{"threads", 1},
          {"limit", roofline.native ? "native" : "kernel"},
          {"limit_evaluations_per_second", roofline.limit},
          {"copy_bytes_per_second", roofline.copy_bytes},
          {"points", points}};
}

std::string table_of(const StressSweep& sweep) {
  Table table({sweep.axis, "queries/s", "spread", "evaluations each", "of the best"});
  double best = 0;
  for (const StressPoint& point : sweep.points) best = std::max(best, point.queries_per_second);
  for (const StressPoint& point : sweep.points) {
    table.add({point.label, with_suffix(point.queries_per_second), fmt::format("{:.1f} %", 100 * point.spread),
               point.evaluations_per_query > 0 ? fmt::format("{:.2f}", point.evaluations_per_query) : "-",
               fmt::format("{:.2f}", point.queries_per_second / best)});
  }
  std::string text = table.text();
  if (const auto grows = exponent(sweep)) text += fmt::format("{} {:.2f}\n", exponent_text(sweep), *grows);
  return text + '\n';
}

std::string table_of(const Roofline& roofline) {
  const std::string_view limit = roofline.native ? "native code of the same field" : "the value kernel alone";
  Table table({"one thread", "evaluations/s", "of the limit", "bytes each", "memory/s"});
  for (std::size_t i = 0; i < roofline.points.size(); ++i) {
    const StressPoint& point = roofline.points[i];
    table.add({point.label, with_suffix(point.evaluations_per_second()),
               fmt::format("{:.3f}", point.evaluations_per_second() / roofline.limit),
               fmt::format("{:.0f}", roofline.bytes_per_query[i]),
               with_suffix(point.queries_per_second * roofline.bytes_per_query[i]) + "B"});
  }
  return table.text() + fmt::format("the limit is {}: {} evaluations/s; a copy moves {}B/s\n", limit,
                                    with_suffix(roofline.limit), with_suffix(roofline.copy_bytes));
}

Plot plot_of(const StressSweep& sweep) {
  Plot plot;
  plot.name = "stress-" + sweep.name;
  plot.title = "Throughput against " + sweep.axis;
  plot.x_label = sweep.axis;
  plot.y_label = sweep.name == "gradient" ? "values with gradient per second" : "triangles per second";
  plot.log_x = sweep.numeric;
  plot.log_y = sweep.numeric || sweep.name == "method";
  PlotSeries series;
  for (const StressPoint& point : sweep.points) {
    if (!sweep.numeric) plot.categories.push_back(point.label);
    series.x.push_back(point.x);
    series.y.push_back(point.queries_per_second);
    series.spread.push_back(point.spread * point.queries_per_second);
  }
  plot.series.push_back(std::move(series));
  return plot;
}

/// Evaluations per second against evaluations per byte moved, under what memory and arithmetic admit (S. Williams, A.
/// Waterman, D. Patterson, "Roofline", 2009).
Plot plot_of(const Roofline& roofline) {
  Plot plot;
  plot.name = "stress-roofline";
  plot.title = "Evaluations of one thread under the limits of the machine";
  plot.x_label = "evaluations per byte of queries and results";
  plot.y_label = "evaluations per second";
  plot.log_x = plot.log_y = true;
  const double ridge = roofline.limit / roofline.copy_bytes;
  double least = ridge / 4, most = ridge * 4;
  for (std::size_t i = 0; i < roofline.points.size(); ++i) {
    least = std::min(least, roofline.evaluations_per_byte(i) / 2);
    most = std::max(most, roofline.evaluations_per_byte(i) * 2);
  }
  plot.series.push_back({roofline.native ? "limit: a copy, then native code" : "limit: a copy, then the kernel alone",
                         {least, ridge, most},
                         {least * roofline.copy_bytes, roofline.limit, roofline.limit},
                         {},
                         true,
                         false});
  for (std::size_t i = 0; i < roofline.points.size(); ++i) {
    const StressPoint& point = roofline.points[i];
    plot.series.push_back(
        {point.label, {roofline.evaluations_per_byte(i)}, {point.evaluations_per_second()}, {}, false, true});
  }
  return plot;
}

ExitCode run_stress(const StressOptions& options, const Globals& globals) {
  const Scene scene = read_scene(options.scene);
  // A missing program or folder is told before any time is spent.
  std::optional<Plotter> plotter;
  if (!options.plots.empty()) plotter.emplace(options.plots);
  const StressSettings settings{options.count, options.rounds};
  const std::vector<StressSweep> sweeps = run_sweeps(scene.shape, settings, globals);
  const Roofline roofline = measure_roofline(scene.shape, settings, globals);

  Json json = {{"command", "stress"},
               {"scene", options.scene},
               {"dimension", scene.dimension},
               {"triangles", options.count},
               {"rounds", options.rounds},
               {"seed", globals.seed},
               {"threads", thread_count(globals)},
               {"simd", globals.active_target().name},
               {"sweeps", Json::array()},
               {"roofline", json_of(roofline)}};
  std::string text;
  for (const StressSweep& sweep : sweeps) {
    json["sweeps"].push_back(json_of(sweep));
    text += table_of(sweep);
  }
  text += table_of(roofline);
  if (plotter) {
    json["plots"] = Json::array();
    const auto draw = [&](const Plot& plot) {
      plotter->draw(plot);
      json["plots"].push_back(plotter->path(plot));
    };
    for (const StressSweep& sweep : sweeps) draw(plot_of(sweep));
    draw(plot_of(roofline));
  }
  print_report(globals, false, json, text);
  return ExitCode::done;
}

}  // namespace

Command add_stress(CLI::App& app, const Globals& globals) {
  CLI::App* const command = app.add_subcommand("stress", "Throughput against everything a caller may choose");
  const auto options = std::make_shared<StressOptions>();
  command->add_option("SCENE", options->scene, "Scene file, or - for stdin")->required();
  add_integer(*command, {"--count", "Triangles of a batch; default 262144"}, options->count, {1, 100'000'000});
  add_integer(*command, {"--rounds", "Rounds that medians are taken of; default 7"}, options->rounds, {1, 1000});
  command->add_option("--plots", options->plots, "Folder for plots, drawn by gnuplot")->type_name("DIR");
  return {command, [options, &globals] { return run_stress(*options, globals); }};
}

}  // namespace thalweg::cli
