// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg distance SCENE --with SCENE2 --poses Q`: how far a second scene at many poses is from the scene.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "command.h"
#include "npz.h"
#include "options.h"
#include "output.h"
#include "pair_input.h"
#include "progress.h"
#include "report.h"

namespace thalweg::cli {

namespace {

struct Request {
  std::string scene, with, poses, output;
  DistanceOptions options;
  std::uint64_t budget = DistanceOptions().budget;
};

/// The result columns: owned here, lent to the batch, listed for the file.
struct Measured {
  std::size_t count, d;
  std::vector<std::uint8_t> status, converged;
  std::vector<float> distance, lower, point_a, point_b, normal;
  std::vector<std::uint32_t> evaluations;

  Measured(std::size_t rows, std::size_t dimension) : count(rows), d(dimension) {
    for (auto* bytes : {&status, &converged}) bytes->resize(count);
    for (auto* numbers : {&distance, &lower}) numbers->resize(count);
    for (auto* vectors : {&point_a, &point_b, &normal}) vectors->resize(count * d);
    evaluations.resize(count);
  }
  DistanceColumns columns() {
    return {status.data(),  distance.data(), lower.data(),     point_a.data(),
            point_b.data(), normal.data(),   converged.data(), evaluations.data()};
  }
  [[nodiscard]] std::vector<Column> list() const {
    return {{"status", Dtype::uint8, {count}, status.data()},
            {"distance", Dtype::float32, {count}, distance.data()},
            {"lower", Dtype::float32, {count}, lower.data()},
            {"point_a", Dtype::float32, {count, d}, point_a.data()},
            {"point_b", Dtype::float32, {count, d}, point_b.data()},
            {"normal", Dtype::float32, {count, d}, normal.data()},
            {"converged", Dtype::uint8, {count}, converged.data()},
            {"evaluations", Dtype::uint32, {count}, evaluations.data()}};
  }
};

struct Run {
  Summary summary;
  std::size_t converged = 0;
  double seconds = 0;
  double tolerance = 0;  ///< as it stood
};

Json report_json(const Request& request, const Globals& globals, const Run& run) {
  Json json = {{"command", "distance"},
               {"scene", request.scene},
               {"with", request.with},
               {"rows", run.summary.rows},
               {"status", statuses_json(run.summary)},
               {"bad_rows", run.summary.by_status[4]},
               {"converged", run.converged},
               {"evaluations", run.summary.evaluations},
               {"tolerance", run.tolerance},
               {"budget", request.options.budget}};
  add_run(json, globals, run.summary.rows, run.seconds);
  json["output"] = request.output;
  return json;
}

std::string report_text(const Request& request, const Globals& globals, const Run& run) {
  Sheet sheet;
  sheet.add("poses", grouped(run.summary.rows));
  add_statuses(sheet, run.summary);
  sheet.add("converged", grouped(run.converged));
  sheet.add("bracket", fmt::format("tolerance {:.4g}, budget {}", run.tolerance, request.options.budget));
  sheet.add("evaluations", grouped(run.summary.evaluations));
  sheet.add("elapsed", run_text(globals, run.summary.rows, run.seconds, "poses"));
  return sheet.text();
}

Run measure(const Request& request, const PairQueries& queries, Measured& result, const Globals& globals) {
  Progress progress("distance", queries.count, globals.quiet);
  Execution execution = globals.execution();
  execution.done = progress.done();
  const Stopwatch watch;
  Result<Summary> summary = measure_distances(queries, request.options, result.columns(), execution);
  const double seconds = watch.seconds();
  Run run{unwrap(std::move(summary), kCommandLine, "--with"), 0, seconds, 0};
  run.converged = static_cast<std::size_t>(std::ranges::count(result.converged, 1));
  return run;
}

ExitCode run_distance(const Request& request, const Globals& globals) {
  check_result_name(request.output, 2);
  const PairInput input(request.scene, request.with, request.poses);
  Output output(request.output);
  const PairQueries queries = input.queries();
  Measured result(queries.count, static_cast<std::size_t>(input.a.dimension));
  Run run = measure(request, queries, result, globals);
  run.tolerance = request.options.tolerance > 0 ? request.options.tolerance : 1e-2 * pair_size(input.a, input.b);
  write_columns(output, request.output, result.list());
  output.commit();
  print_report(globals, output.is_stdout(), report_json(request, globals, run), report_text(request, globals, run));
  return ExitCode::done;
}

}  // namespace

Command add_distance(CLI::App& app, const Globals& globals) {
  CLI::App* const command = app.add_subcommand("distance", "How far a second scene is from a scene, and where");
  const auto request = std::make_shared<Request>();
  command->add_option("SCENE", request->scene, "Scene file, or - for stdin")->required();
  command->add_option("--with", request->with, "A second scene, placed by --poses")->required();
  command
      ->add_option("--poses", request->poses,
                   "Poses of the second scene: (N,3) x y angle, (N,7) x y z qw qx qy qz, .npy")
      ->required();
  add_output(*command, request->output, ".npz, or - for stdout");
  add_positive(*command, {"--tolerance", "Scene units; default 1e-2 of the diagonal of the smaller bounds"},
               request->options.tolerance);
  add_integer(*command, {"--budget", "Evaluations per pose, default 4096"}, request->budget, {1, UINT32_MAX});
  return {command, [request, &globals] {
            request->options.budget = static_cast<std::uint32_t>(request->budget);
            return run_distance(*request, globals);
          }};
}

}  // namespace thalweg::cli
