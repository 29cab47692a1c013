// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg collide`: triangles, circles or a second scene at many poses against a scene, one row of every result column
// for each.
#include <array>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "collide_pairs.h"
#include "collide_result.h"
#include "command.h"
#include "explain.h"
#include "input.h"
#include "npz.h"
#include "options.h"
#include "output.h"
#include "progress.h"
#include "queries.h"
#include "report.h"
#include "text.h"
#include "thalweg/method_table.h"

namespace thalweg::cli {

namespace {

struct Options {
  std::string scene, circles, triangles, output;
  CollideOptions collide;
  bool one_sided = false;
  std::uint64_t starts = 0, iterations = 0, budget = CollideOptions().budget;
  PairRequest pairs;  ///< what only pairs of shapes take
  std::optional<std::uint64_t> explained_row;

  [[nodiscard]] QueryKind kind() const { return triangles.empty() ? QueryKind::circles : QueryKind::triangles; }
};

// Names of the counts in Summary::by_status, in its order.
constexpr std::array<std::string_view, 5> kStatusNames = {"separated", "overlapping", "touching", "undecided",
                                                          "bad_row"};

struct Run {
  Summary summary;
  double seconds = 0;
};

Run collide(const Tape& tape, const Array& rows, CollideResult& result, const Options& options,
            const Globals& globals) {
  const Queries queries{rows.values.data(), rows.shape[0]};
  Progress progress("collide", queries.count, globals.quiet);
  Execution execution = globals.execution();
  execution.done = progress.done();
  const Stopwatch watch;
  const bool triangles = options.kind() == QueryKind::triangles;
  Result<Summary> summary = triangles ? collide_triangles(tape, queries, options.collide, result.columns(), execution)
                                      : collide_circles(tape, queries, options.collide, result.columns(), execution);
  const double seconds = watch.seconds();
  return {unwrap(std::move(summary), kCommandLine, "--method"), seconds};
}

double evaluations_per_query(const Summary& summary) {
  const std::size_t answered = summary.rows - summary.by_status[4];
  return answered == 0 ? 0 : static_cast<double>(summary.evaluations) / static_cast<double>(answered);
}

std::string_view noun(const Options& options) {
  return options.kind() == QueryKind::triangles ? "triangles" : "circles";
}

Json report_json(const Options& options, const Globals& globals, const Run& run, double tolerance) {
  Json by_status;
  for (std::size_t i = 0; i < kStatusNames.size(); ++i)
    by_status[std::string(kStatusNames[i])] = run.summary.by_status[i];
  Json json = {{"command", "collide"},
               {"scene", options.scene},
               {"queries", noun(options)},
               {"rows", run.summary.rows},
               {"status", std::move(by_status)},
               {"bad_rows", run.summary.by_status[4]},
               {"evaluations", run.summary.evaluations},
               {"evaluations_per_query", evaluations_per_query(run.summary)},
               {"method", name(options.collide.method)},
               {"goal", name(options.collide.goal)},
               {"tolerance", tolerance},
               {"budget", options.collide.budget}};
  add_run(json, globals, run.summary.rows, run.seconds);
  json["output"] = options.output;
  return json;
}

std::string report_text(const Options& options, const Globals& globals, const Run& run, double tolerance) {
  const Summary& summary = run.summary;
  Sheet sheet;
  sheet.add(noun(options), grouped(summary.rows));
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    const double percent =
        summary.rows == 0 ? 0 : 100.0 * static_cast<double>(summary.by_status[i]) / static_cast<double>(summary.rows);
    const std::string label = i == 4 ? "bad rows" : std::string(kStatusNames[i]);
    sheet.add("  " + label, fmt::format("{:>12}  {:6.2f} %", grouped(summary.by_status[i]), percent));
  }
  sheet.add("method", fmt::format("{}, goal {}, tolerance {:.4g}, budget {}", name(options.collide.method),
                                  name(options.collide.goal), tolerance, options.collide.budget));
  sheet.add("evaluations",
            fmt::format("{}, {:.3f} a query", grouped(summary.evaluations), evaluations_per_query(summary)));
  sheet.add("elapsed", run_text(globals, summary.rows, run.seconds, noun(options)));
  return sheet.text();
}

/// Options that not every kind of query takes.
struct OptionFor {
  const char* option;
  bool triangles, circles, pairs;
};
constexpr std::array kOptionsFor = {
    OptionFor{"--start", true, false, false},           OptionFor{"--starts", true, false, true},
    OptionFor{"--iterations", true, false, true},       OptionFor{"--step", true, false, false},
    OptionFor{"--floor", true, false, false},           OptionFor{"--stop", true, false, false},
    OptionFor{"--stop-at-witness", true, false, false}, OptionFor{"--contacts", true, false, true},
    OptionFor{"--margin", true, false, false},          OptionFor{"--feature", true, false, false},
    OptionFor{"--one-sided", true, true, false},        OptionFor{"--explain", true, true, false},
    OptionFor{"--region", false, false, true},          OptionFor{"--paths", false, false, true}};

/// Nothing that was asked for is left out in silence.
void check_options(const CLI::App& command, const Options& options) {
  const bool pairs = !options.pairs.with.empty();
  const bool triangles = !pairs && options.kind() == QueryKind::triangles;
  for (const OptionFor& row : kOptionsFor) {
    if (command.get_option(row.option)->count() == 0) continue;
    if (pairs ? row.pairs : triangles ? row.triangles : row.circles) continue;
    std::string kinds = row.triangles ? "--triangles" : "";
    if (row.circles) kinds += kinds.empty() ? "--circles" : " or --circles";
    if (row.pairs) kinds += kinds.empty() ? "--with and --poses" : " or --with";
    refuse(kCommandLine, row.option, kinds, pairs ? "--with" : triangles ? "--triangles" : "--circles");
  }
}

void check(const Options& options) {
  if (options.circles.empty() && options.triangles.empty()) {
    refuse(kCommandLine, "collide", "--circles, --triangles, or --with and --poses", "none of them");
  }
  if (!options.circles.empty() && !options.triangles.empty()) {
    refuse(kCommandLine, "collide", "one of --circles and --triangles", "both");
  }
  if (!options.explained_row) check_result_name(options.output, 2);
}

/// Writes the proof of one row; the summary is what it proves.
ExitCode explain(const Tape& tape, const Array& rows, const Options& options, const Globals& globals) {
  Output output(options.output);
  const Json proof = explain_row(tape, options.kind(), rows, *options.explained_row, options.collide);
  output.write(proof.dump(1) + '\n');
  output.commit();
  Sheet sheet;
  sheet.add("row", fmt::format("{}", *options.explained_row));
  sheet.add("proven", proof["status"].get<std::string>());
  sheet.add("cells", fmt::format("{}", proof["cells"].size()));
  const Json report = {
      {"command", "collide"},      {"explained_row", *options.explained_row}, {"row_status", proof["row_status"]},
      {"status", proof["status"]}, {"cells", proof["cells"].size()},          {"output", options.output}};
  print_report(globals, output.is_stdout(), report, sheet.text());
  return ExitCode::done;
}

ExitCode run_pairs(const Options& options, const Globals& globals) {
  if (options.pairs.with.empty() || options.pairs.poses.empty()) {
    refuse(kCommandLine, options.pairs.with.empty() ? "--poses" : "--with", "--with and --poses together", "one alone");
  }
  if (!options.circles.empty() || !options.triangles.empty()) {
    refuse(kCommandLine, "collide", "one of --circles, --triangles and --with", "more than one");
  }
  PairRequest request = options.pairs;
  static_cast<CollideOptions&>(request.options) = options.collide;
  request.wants_contacts = request.wants_contacts || options.collide.goal == Goal::deepest;
  if (request.wants_paths && options.collide.method == Method::certified) {
    refuse(kCommandLine, "--paths", "a method that descends: thesis, midsurface", "certified");
  }
  request.scene = options.scene;
  request.output = options.output;
  return run_collide_pairs(request, globals);
}

ExitCode run_collide(Options& options, const Globals& globals) {
  options.collide.starts = static_cast<std::uint32_t>(options.starts);
  options.collide.iterations = static_cast<std::uint32_t>(options.iterations);
  options.collide.budget = static_cast<std::uint32_t>(options.budget);
  if (!options.pairs.with.empty() || !options.pairs.poses.empty()) return run_pairs(options, globals);
  check(options);
  if (options.pairs.wants_contacts) options.collide.contacts = static_cast<std::uint32_t>(options.pairs.contacts);
  const Scene scene = read_scene(options.scene);
  const Tape tape = unwrap(compile(scene.shape), input_name(options.scene), "/shape");
  const Array rows = options.kind() == QueryKind::triangles ? read_triangles(options.triangles, scene.dimension)
                                                            : read_circles(options.circles, scene.dimension);
  if (options.explained_row) return explain(tape, rows, options, globals);
  Output output(options.output);
  CollideResult result(options.kind(), rows.shape[0], scene.dimension, options.collide.contacts);
  if (options.one_sided) result.want_one_sided();
  const Run run = collide(tape, rows, result, options, globals);
  result.flatten_contacts();
  write_columns(output, options.output, result.list());
  output.commit();

  const double tolerance = options.collide.tolerance > 0 ? options.collide.tolerance : default_tolerance(tape);
  print_report(globals, output.is_stdout(), report_json(options, globals, run, tolerance),
               report_text(options, globals, run, tolerance));
  return ExitCode::done;
}

/// Returns the option --contacts.
CLI::Option* add_pair_options(CLI::App& command, PairRequest& pairs) {
  command.add_option("--with", pairs.with,
                     "A second scene, placed by --poses; methods certified, thesis and midsurface");
  command.add_option("--poses", pairs.poses,
                     "Poses of the second scene: (N,3) x y angle, (N,7) x y z qw qx qy qz, .npy");
  add_positive(command,
               {"--region", "Pairs: overlap regions closer than this may be one contact; default 1/32 of the box"},
               pairs.options.region);
  add_flag(command, {"--paths", "Pairs: keep the descent paths of a local method, for render --overlay"},
           pairs.wants_paths);
  return add_integer(command,
                     {"--contacts", "Contacts kept per triangle or pair, deepest first; pairs with goal deepest: 16"},
                     pairs.contacts, {1, 1U << 16U});
}

std::string method_names() {
  std::string names;
  for (const MethodRow& row : method_table()) {
    names.append(names.empty() ? "" : ", ").append(row.name);
    if (!row.alias.empty()) names.append(" or ").append(row.alias);
    if (row.method == Method::certified) names.append(" (default)");
  }
  return names;
}

/// What the methods do, for the end of `collide --help`.
std::string method_lines() {
  std::string lines = "Methods:\n";
  for (const MethodRow& row : method_table()) {
    const std::string_view queries = row.method == Method::certified ? ""
                                     : row.pairs                     ? "pairs; "
                                     : row.triangles                 ? "triangles; "
                                                                     : "circles; ";
    lines += fmt::format("  {:<19} {}{} [{}]\n", row.name, queries, row.mathematics, row.source);
  }
  return lines;
}

void add_contact_options(CLI::App& command, Options& options) {
  add_not_negative(command, {"--margin", "Contacts: local minima of f of at most this, scene units; default 0"},
                   options.collide.margin);
  add_positive(command, {"--feature", "Contacts closer than this are one; default 1/64 of the diagonal of the bounds"},
               options.collide.feature);
}

void add_explain(CLI::App& command, Options& options) {
  command
      .add_option_function<std::string>(
          "--explain",
          [&options](const std::string& word) {
            const std::optional<long long> row = parse_integer(word);
            if (!row || *row < 0) refuse(kCommandLine, "--explain", "a row's number, from 0", in_quotes(word));
            options.explained_row = static_cast<std::uint64_t>(*row);
          },
          "Write the proof of one row's verdict to OUTPUT, as JSON, in place of the columns")
      ->type_name("ROW");
}

void add_local_options(CLI::App& command, Options& options) {
  constexpr std::uint64_t kMost = UINT32_MAX;
  add_word(command,
           {"--start", "Local methods: own (default), centroid, vertices, mid_edges, best_of_4, halton, sequence"},
           options.collide.start, &parse_start);
  add_integer(command, {"--starts", "Local methods: how many starts of the policy"}, options.starts, {0, kMost});
  add_integer(command, {"--iterations", "Local methods: most iterations"}, options.iterations, {0, kMost});
  add_positive(command, {"--step", "alpha of thesis, thesis_fixed, thesis_scaled, distance_step"},
               options.collide.step);
  add_not_negative(command, {"--floor", "mu of thesis, thesis_scaled, distance_step; scene units"},
                   options.collide.floor);
  add_not_negative(command, {"--stop", "Local methods: end when a step moves the barycentric coordinates by less"},
                   options.collide.stop);
  add_flag(command, {"--stop-at-witness", "Local methods: end where f < 0 is proven"}, options.collide.stop_at_witness);
}

}  // namespace

Command add_collide(CLI::App& app, const Globals& globals) {
  constexpr std::uint64_t kMost = UINT32_MAX;
  CLI::App* const command = app.add_subcommand("collide", "Triangles, circles or a second scene against a scene");
  const auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "Scene file, or - for stdin")->required();
  command->add_option("--circles", options->circles, "Circles (N,3) or spheres (N,4): .npy, .csv, -");
  command->add_option("--triangles", options->triangles, "Triangles (N,3,d): .npy, .csv, .obj, .ply, .stl, -");
  add_output(*command, options->output, ".npz, or - for stdout");
  add_word(*command, {"--method", method_names()}, options->collide.method, &parse_method);
  add_word(*command, {"--goal", "verdict (default) or deepest"}, options->collide.goal, &parse_goal);
  CLI::Option* const gradient =
      add_word(*command, {"--gradient", "Strategy of a local method's steps, and of the normals"},
               options->collide.gradient, &parse_gradient);
  add_gradient_offset(*command, options->collide.gradient_offset);
  add_flag(*command, {"--one-sided", "Also `one_sided`: the gradients on two sides of a kink"}, options->one_sided);
  add_local_options(*command, *options);
  add_positive(*command, {"--tolerance", "Scene units; default 1e-4 of the diagonal of the bounds"},
               options->collide.tolerance);
  add_integer(*command, {"--budget", "Evaluations per query, default 4096"}, options->budget, {1, kMost});
  CLI::Option* const contacts = add_pair_options(*command, options->pairs);
  add_contact_options(*command, *options);
  add_explain(*command, *options);
  command->footer(method_lines());
  return {command, [command, options, gradient, contacts, &globals] {
            check_options(*command, *options);
            options->collide.gradient_given = gradient->count() > 0;
            options->pairs.wants_contacts = contacts->count() > 0;
            return run_collide(*options, globals);
          }};
}

}  // namespace thalweg::cli
