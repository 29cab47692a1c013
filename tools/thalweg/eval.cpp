// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg eval`: the field, and on request its gradient, at points.
#include <memory>
#include <optional>

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

struct EvalOptions {
  std::string scene, points, output;
  Gradient strategy = Gradient::autodiff;
  bool with_gradient = false;
};

ExitCode run_eval(const EvalOptions& options, const Globals& globals) {
  check_result_name(options.output, options.with_gradient ? 2 : 1);
  const Scene scene = read_scene(options.scene);
  const Tape tape = unwrap(compile(scene.shape), input_name(options.scene), "/shape");
  const Array points = read_points(options.points, scene.dimension);
  Output output(options.output);

  const std::size_t count = points.shape[0];
  std::vector<float> value(count);
  std::vector<float> gradient(options.with_gradient ? points.values.size() : 0);
  std::vector<Column> columns = {{"value", Dtype::float32, {count}, value.data()}};
  if (options.with_gradient) columns.push_back({"gradient", Dtype::float32, points.shape, gradient.data()});

  const Stopwatch watch;
  std::size_t bad_rows = 0;
  {
    Progress progress("eval", count, globals.quiet);
    Execution execution = globals.execution();
    execution.done = progress.done();
    bad_rows = evaluate(tape, points.values.data(), count, value.data(),
                        options.with_gradient ? gradient.data() : nullptr, options.strategy, execution);
  }
  const double seconds = watch.seconds();
  write_columns(output, options.output, columns);
  output.commit();

  Json json = {{"command", "eval"}, {"scene", options.scene}, {"rows", count}, {"bad_rows", bad_rows}};
  if (options.with_gradient) json["gradient"] = name(options.strategy);
  add_run(json, globals, count, seconds);
  json["output"] = options.output;
  Sheet sheet;
  sheet.add("points", grouped(count));
  sheet.add("bad rows", grouped(bad_rows));
  sheet.add("elapsed", run_text(globals, count, seconds, "points"));
  print_report(globals, output.is_stdout(), json, sheet.text());
  return ExitCode::done;
}

}  // namespace

Command add_eval(CLI::App& app, const Globals& globals) {
  CLI::App* const command = app.add_subcommand("eval", "The field at points, and its gradient");
  const auto options = std::make_shared<EvalOptions>();
  command->add_option("SCENE", options->scene, "Scene file, or - for stdin")->required();
  command->add_option("--points", options->points, "Points (N,d): .npy, .csv, or - for stdin")->required();
  add_output(*command, options->output, ".npz, .npy for `value` alone, or - for stdout");
  CLI::Option* const gradient =
      add_word(*command, {"--gradient", "Also `gradient`, by this strategy"}, options->strategy, &parse_gradient);
  gradient->type_name("STRATEGY");
  return {command, [options, gradient, &globals] {
            options->with_gradient = gradient->count() > 0;
            return run_eval(*options, globals);
          }};
}

}  // namespace thalweg::cli
