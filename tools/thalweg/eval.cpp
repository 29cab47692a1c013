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
  GradientOptions gradient;
  bool with_gradient = false, one_sided = false;

  [[nodiscard]] bool with_witness() const { return with_gradient && gradient.strategy == Gradient::closest_point; }
};

/// What is written, and the columns of it.
struct EvalResult {
  std::vector<float> value, gradient, witness, one_sided;
  std::vector<std::uint32_t> evaluations;
  std::vector<std::uint8_t> ambiguous;

  EvalResult(const EvalOptions& options, const Array& points) : value(points.shape[0]) {
    if (!options.with_gradient) return;
    gradient.resize(points.values.size());
    evaluations.resize(value.size());
    ambiguous.resize(value.size());
    if (options.one_sided) one_sided.resize(2 * points.values.size());
    if (options.with_witness()) witness.resize(points.values.size());
  }

  [[nodiscard]] PointColumns columns() {
    const auto or_null = [](auto& numbers) { return numbers.empty() ? nullptr : numbers.data(); };
    return {.value = value.data(),
            .gradient = or_null(gradient),
            .witness = or_null(witness),
            .evaluations = or_null(evaluations),
            .ambiguous = or_null(ambiguous),
            .one_sided = or_null(one_sided)};
  }

  [[nodiscard]] std::vector<Column> list(const EvalOptions& options, const Array& points) const {
    const std::size_t count = value.size();
    std::vector<Column> list = {{"value", Dtype::float32, {count}, value.data()}};
    if (options.with_gradient) {
      list.push_back({"gradient", Dtype::float32, points.shape, gradient.data()});
      if (options.with_witness()) list.push_back({"witness", Dtype::float32, points.shape, witness.data()});
      list.push_back({"evaluations", Dtype::uint32, {count}, evaluations.data()});
      list.push_back({"ambiguous", Dtype::uint8, {count}, ambiguous.data()});
      if (options.one_sided) {
        list.push_back({"one_sided", Dtype::float32, {count, 2, points.shape[1]}, one_sided.data()});
      }
    }
    return list;
  }
};

ExitCode run_eval(const EvalOptions& options, const Globals& globals) {
  check_result_name(options.output, options.with_gradient ? 2 : 1);
  const Scene scene = read_scene(options.scene);
  const Tape tape = unwrap(compile(scene.shape), input_name(options.scene), "/shape");
  const Array points = read_points(options.points, scene.dimension);
  Output output(options.output);

  const std::size_t count = points.shape[0];
  EvalResult result(options, points);
  const Stopwatch watch;
  EvaluateSummary summary;
  {
    Progress progress("eval", count, globals.quiet);
    Execution execution = globals.execution();
    execution.done = progress.done();
    const GradientOptions gradient = options.with_gradient ? options.gradient : GradientOptions();
    summary = unwrap(evaluate(tape, Points{points.values.data(), count}, gradient, result.columns(), execution),
                     kCommandLine, "--gradient");
  }
  const double seconds = watch.seconds();
  write_columns(output, options.output, result.list(options, points));
  output.commit();

  Json json = {{"command", "eval"},
               {"scene", options.scene},
               {"rows", count},
               {"bad_rows", summary.bad_rows},
               {"undefined_rows", summary.undefined_rows}};
  if (options.with_gradient) {
    json["gradient"] = name(options.gradient.strategy);
    json["gradient_offset"] = to_string(options.gradient.offset);
  }
  json["evaluations"] = summary.evaluations;
  add_run(json, globals, count, seconds);
  json["output"] = options.output;
  Sheet sheet;
  sheet.add("points", grouped(count));
  sheet.add("bad rows", grouped(summary.bad_rows));
  if (summary.undefined_rows > 0) sheet.add("undefined rows", grouped(summary.undefined_rows));
  sheet.add("evaluations", grouped(summary.evaluations));
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
  CLI::Option* const gradient = add_word(*command, {"--gradient", "Also `gradient`, by this strategy"},
                                         options->gradient.strategy, &parse_gradient);
  gradient->type_name("STRATEGY");
  add_gradient_offset(*command, options->gradient.offset)->needs(gradient);
  add_flag(*command, {"--one-sided", "Also `one_sided`: the gradients on two sides of a kink"}, options->one_sided)
      ->needs(gradient);
  return {command, [options, gradient, &globals] {
            options->with_gradient = gradient->count() > 0;
            return run_eval(*options, globals);
          }};
}

}  // namespace thalweg::cli
