// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg sweep`: when moving triangles or circles first meet a scene, or a moving scene them.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "command.h"
#include "input.h"
#include "npz.h"
#include "options.h"
#include "output.h"
#include "progress.h"
#include "queries.h"
#include "report.h"

namespace thalweg::cli {

namespace {

struct Request {
  std::string scene, triangles, ends, circles, motions, output;
  SweepOptions options;
  std::uint64_t budget = SweepOptions().budget;

  [[nodiscard]] bool has_circles() const { return !circles.empty(); }
  [[nodiscard]] std::string noun() const { return has_circles() ? "circles" : "triangles"; }
};

/// The result columns: owned here, lent to the batch, listed for the file.
struct Swept {
  std::size_t count, d;
  std::vector<std::uint8_t> status, converged;
  std::vector<float> toi_lower, toi_upper, value, point, normal, barycentric;
  std::vector<std::uint32_t> evaluations;

  Swept(std::size_t rows, std::size_t dimension, bool has_circles) : count(rows), d(dimension) {
    for (auto* bytes : {&status, &converged}) bytes->resize(count);
    for (auto* numbers : {&toi_lower, &toi_upper, &value}) numbers->resize(count);
    for (auto* vectors : {&point, &normal}) vectors->resize(count * d);
    if (!has_circles) barycentric.resize(count * 3);
    evaluations.resize(count);
  }
  SweepColumns columns() {
    return {.status = status.data(),
            .toi_lower = toi_lower.data(),
            .toi_upper = toi_upper.data(),
            .converged = converged.data(),
            .value = value.data(),
            .point = point.data(),
            .normal = normal.data(),
            .barycentric = barycentric.empty() ? nullptr : barycentric.data(),
            .evaluations = evaluations.data()};
  }
  [[nodiscard]] std::vector<Column> list(bool has_circles) const {
    std::vector<Column> all = {{"status", Dtype::uint8, {count}, status.data()},
                               {"toi_lower", Dtype::float32, {count}, toi_lower.data()},
                               {"toi_upper", Dtype::float32, {count}, toi_upper.data()},
                               {"converged", Dtype::uint8, {count}, converged.data()},
                               {"value", Dtype::float32, {count}, value.data()},
                               {"point", Dtype::float32, {count, d}, point.data()},
                               {"normal", Dtype::float32, {count, d}, normal.data()},
                               {"evaluations", Dtype::uint32, {count}, evaluations.data()}};
    if (!has_circles) all.push_back({"barycentric", Dtype::float32, {count, 3}, barycentric.data()});
    return all;
  }
};

struct Run {
  Summary summary;
  std::size_t converged = 0;
  double seconds = 0;
};

double tolerance_of(const Request& request) {
  return request.options.tolerance > 0 ? request.options.tolerance : kDefaultSweepTolerance;
}

Json report_json(const Request& request, const Globals& globals, const Run& run) {
  Json json = {{"command", "sweep"},
               {"scene", request.scene},
               {"queries", request.noun()},
               {"rows", run.summary.rows},
               {"status", statuses_json(run.summary)},
               {"bad_rows", run.summary.by_status[4]},
               {"converged", run.converged},
               {"evaluations", run.summary.evaluations},
               {"tolerance", tolerance_of(request)},
               {"budget", request.options.budget}};
  add_run(json, globals, run.summary.rows, run.seconds);
  json["output"] = request.output;
  return json;
}

std::string report_text(const Request& request, const Globals& globals, const Run& run) {
  Sheet sheet;
  sheet.add(request.noun(), grouped(run.summary.rows));
  add_statuses(sheet, run.summary);
  sheet.add("converged", grouped(run.converged));
  sheet.add("bracket",
            fmt::format("tolerance {:.4g} of the time, budget {}", tolerance_of(request), request.options.budget));
  sheet.add("evaluations", grouped(run.summary.evaluations));
  sheet.add("elapsed", run_text(globals, run.summary.rows, run.seconds, request.noun()));
  return sheet.text();
}

void check(const Request& request) {
  if (request.triangles.empty() == request.circles.empty()) {
    refuse(kCommandLine, "sweep", "one of --triangles and --circles", request.circles.empty() ? "neither" : "both");
  }
  if (request.ends.empty() == request.motions.empty()) {
    refuse(kCommandLine, "sweep", "one of --motions and --triangles-end", request.ends.empty() ? "neither" : "both");
  }
  if (request.has_circles() && !request.ends.empty()) {
    refuse(kCommandLine, "--triangles-end", "--triangles", "--circles");
  }
  check_result_name(request.output, 2);
}

Run sweep(const Request& request, const Tape& tape, const SweepQueries& queries, Swept& result,
          const Globals& globals) {
  Progress progress("sweep", queries.count, globals.quiet);
  Execution execution = globals.execution();
  execution.done = progress.done();
  const Stopwatch watch;
  Result<Summary> summary = request.has_circles()
                                ? sweep_circles(tape, queries, request.options, result.columns(), execution)
                                : sweep_triangles(tape, queries, request.options, result.columns(), execution);
  const double seconds = watch.seconds();
  Run run{unwrap(std::move(summary), kCommandLine, "SCENE"), 0, seconds};
  run.converged = static_cast<std::size_t>(std::ranges::count(result.converged, 1));
  return run;
}

ExitCode run_sweep(const Request& request, const Globals& globals) {
  check(request);
  const Scene scene = read_scene(request.scene);
  const Tape tape = unwrap(compile(scene.shape), input_name(request.scene), "/shape");
  const Array rows = request.has_circles() ? read_circles(request.circles, scene.dimension)
                                           : read_triangles(request.triangles, scene.dimension);
  const bool ends = !request.ends.empty();
  const std::string& moves_name = ends ? request.ends : request.motions;
  const Array moves = ends ? read_triangles(moves_name, scene.dimension) : read_motions(moves_name, scene.dimension);
  if (moves.shape[0] != rows.shape[0]) {
    refuse(input_name(moves_name), "shape", fmt::format("{} rows, one for each query", rows.shape[0]),
           fmt::format("{}", moves.shape[0]));
  }
  SweepQueries queries{.rows = rows.values.data(), .count = rows.shape[0]};
  (ends ? queries.ends : queries.motions) = moves.values.data();
  Output output(request.output);
  Swept result(queries.count, static_cast<std::size_t>(scene.dimension), request.has_circles());
  const Run run = sweep(request, tape, queries, result, globals);
  write_columns(output, request.output, result.list(request.has_circles()));
  output.commit();
  print_report(globals, output.is_stdout(), report_json(request, globals, run), report_text(request, globals, run));
  return ExitCode::done;
}

}  // namespace

Command add_sweep(CLI::App& app, const Globals& globals) {
  CLI::App* const command = app.add_subcommand("sweep", "When moving triangles or circles first meet a scene");
  const auto request = std::make_shared<Request>();
  command->add_option("SCENE", request->scene, "Scene file, or - for stdin")->required();
  command->add_option("--triangles", request->triangles, "Triangles (N,3,d) at time 0");
  command->add_option("--triangles-end", request->ends, "The same triangles at time 1");
  command->add_option("--circles", request->circles, "Circles (N,3) or spheres (N,4)");
  command->add_option("--motions", request->motions,
                      "How the scene moves until time 1: (N,3) dx dy angle, (N,7) dx dy dz qw qx qy qz, .npy");
  add_unsupported(*command, {"--with", "A second scene (not supported yet)"});
  add_unsupported(*command, {"--poses", "Poses of the second scene (not supported yet)"});
  add_output(*command, request->output, ".npz, or - for stdout");
  add_positive(*command, {"--tolerance", "Part of the time, from 1e-5 to 1; default 1e-3"}, request->options.tolerance);
  add_integer(*command, {"--budget", "Evaluations per query, default 1024"}, request->budget, {6, UINT32_MAX});
  return {command, [request, &globals] {
            request->options.budget = static_cast<std::uint32_t>(request->budget);
            return run_sweep(*request, globals);
          }};
}

}  // namespace thalweg::cli
