// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Result columns of pairs are those of circles; contacts follow as flat columns, those of row i in
// [contact_offset[i], contact_offset[i + 1]).
#include "collide_pairs.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "collide_result.h"
#include "npz.h"
#include "output.h"
#include "pair_input.h"
#include "progress.h"
#include "report.h"

namespace thalweg::cli {

namespace {

/// Slots in memory, flat columns in the file.
class ContactResult {
 public:
  ContactResult(std::size_t rows, std::size_t capacity, std::size_t dimension)
      : rows_(rows), capacity_(capacity), d_(dimension), found_(rows) {
    const std::size_t slots = rows * capacity;
    for (auto* vectors : {&point_, &normal_}) vectors->resize(slots * d_);
    for (auto* numbers : {&value_, &lower_}) numbers->resize(slots);
    for (auto* flags : {&converged_, &ambiguous_}) flags->resize(slots);
  }

  PairContacts slots() {
    return {capacity_,     found_.data(), point_.data(),     normal_.data(),
            value_.data(), lower_.data(), converged_.data(), ambiguous_.data()};
  }

  /// Packs what was found; the slots are used up.
  void pack() {
    offset_.assign(1, 0);
    std::size_t to = 0;
    for (std::size_t row = 0; row < rows_; ++row) {
      const std::size_t kept = std::min<std::size_t>(found_[row], capacity_);
      for (std::size_t slot = 0; slot < kept; ++slot) move_slot(row * capacity_ + slot, to++);
      offset_.push_back(static_cast<std::uint32_t>(to));
    }
    depth_.resize(to);
    for (std::size_t i = 0; i < to; ++i) depth_[i] = -value_[i];
  }

  void add_to(std::vector<Column>& columns) const {
    const std::size_t count = depth_.size();
    columns.push_back({"contact_offset", Dtype::uint32, {rows_ + 1}, offset_.data()});
    columns.push_back({"contact_found", Dtype::uint32, {rows_}, found_.data()});
    columns.push_back({"contact_point", Dtype::float32, {count, d_}, point_.data()});
    columns.push_back({"contact_normal", Dtype::float32, {count, d_}, normal_.data()});
    columns.push_back({"contact_depth", Dtype::float32, {count}, depth_.data()});
    columns.push_back({"contact_value", Dtype::float32, {count}, value_.data()});
    columns.push_back({"contact_lower", Dtype::float32, {count}, lower_.data()});
    columns.push_back({"contact_converged", Dtype::uint8, {count}, converged_.data()});
    columns.push_back({"contact_ambiguous", Dtype::uint8, {count}, ambiguous_.data()});
  }
  [[nodiscard]] std::size_t count() const { return depth_.size(); }

 private:
  void move_slot(std::size_t from, std::size_t to) {
    std::copy_n(point_.begin() + static_cast<std::ptrdiff_t>(from * d_), d_,
                point_.begin() + static_cast<std::ptrdiff_t>(to * d_));
    std::copy_n(normal_.begin() + static_cast<std::ptrdiff_t>(from * d_), d_,
                normal_.begin() + static_cast<std::ptrdiff_t>(to * d_));
    value_[to] = value_[from];
    lower_[to] = lower_[from];
    converged_[to] = converged_[from];
    ambiguous_[to] = ambiguous_[from];
  }

  std::size_t rows_, capacity_, d_;
  std::vector<std::uint32_t> found_, offset_;
  std::vector<float> point_, normal_, value_, lower_, depth_;
  std::vector<std::uint8_t> converged_, ambiguous_;
};

/// Descent paths (N, starts, steps, d); what lies beyond a path's end is NaN.
struct PathResult {
  std::size_t starts = 0, steps = 0;
  std::vector<float> points;
  std::vector<std::uint32_t> length;

  PathResult(const PairOptions& options, std::size_t rows, std::size_t dimension) {
    const bool midsurface = options.method == Method::midsurface;
    starts = options.starts != 0 ? options.starts : midsurface ? 40 : 8;
    steps = (options.iterations != 0 ? options.iterations : midsurface ? 10U : 64U) + 2;
    points.assign(rows * starts * steps * dimension, std::numeric_limits<float>::quiet_NaN());
    length.resize(rows * starts);
  }
  PairPaths slots() { return {steps, points.data(), length.data()}; }
};

struct Run {
  Summary summary;
  double seconds = 0;
  double tolerance = 0, region = 0;  ///< as they stood
};

Json report_json(const PairRequest& request, const Globals& globals, const Run& run, std::size_t contacts) {
  Json json = {{"command", "collide"},
               {"scene", request.scene},
               {"with", request.with},
               {"queries", "poses"},
               {"rows", run.summary.rows},
               {"status", statuses_json(run.summary)},
               {"bad_rows", run.summary.by_status[4]},
               {"evaluations", run.summary.evaluations},
               {"method", name(request.options.method)},
               {"goal", name(request.options.goal)},
               {"tolerance", run.tolerance},
               {"region", run.region},
               {"budget", request.options.budget}};
  if (request.wants_contacts) json["contacts"] = contacts;
  add_run(json, globals, run.summary.rows, run.seconds);
  json["output"] = request.output;
  return json;
}

std::string report_text(const PairRequest& request, const Globals& globals, const Run& run, std::size_t contacts) {
  Sheet sheet;
  sheet.add("poses", grouped(run.summary.rows));
  add_statuses(sheet, run.summary);
  if (request.wants_contacts) sheet.add("contacts", grouped(contacts));
  sheet.add("method",
            fmt::format("{}, goal {}, tolerance {:.4g}, region {:.4g}, budget {}", name(request.options.method),
                        name(request.options.goal), run.tolerance, run.region, request.options.budget));
  sheet.add("evaluations", grouped(run.summary.evaluations));
  sheet.add("elapsed", run_text(globals, run.summary.rows, run.seconds, "poses"));
  return sheet.text();
}

Run run_batch(const PairRequest& request, const PairQueries& queries, const CollideColumns& columns,
              const PairContacts& contacts, const Globals& globals, const PairPaths& paths) {
  Progress progress("collide", queries.count, globals.quiet);
  Execution execution = globals.execution();
  execution.done = progress.done();
  const Stopwatch watch;
  Result<Summary> summary = collide_pairs(queries, request.options, columns, contacts, execution, paths);
  const double seconds = watch.seconds();
  return {unwrap(std::move(summary), kCommandLine, "--with"), seconds, 0, 0};
}

}  // namespace

ExitCode run_collide_pairs(const PairRequest& request, const Globals& globals) {
  check_result_name(request.output, 2);
  const PairInput input(request.scene, request.with, request.poses);
  Output output(request.output);
  const PairQueries queries = input.queries();
  CollideResult result(QueryKind::circles, queries.count, input.a.dimension);
  const auto d = static_cast<std::size_t>(input.a.dimension);
  ContactResult contacts(queries.count, request.wants_contacts ? request.contacts : 0, d);
  PathResult paths(request.options, request.wants_paths ? queries.count : 0, d);
  Run run = run_batch(request, queries, result.columns(), request.wants_contacts ? contacts.slots() : PairContacts{},
                      globals, request.wants_paths ? paths.slots() : PairPaths{});
  const double size = pair_size(input.a, input.b);
  run.tolerance = request.options.tolerance > 0 ? request.options.tolerance : 1e-4 * size;
  run.region = request.options.region > 0 ? request.options.region : size / 32;
  std::vector<Column> columns = result.list();
  if (request.wants_contacts) {
    contacts.pack();
    contacts.add_to(columns);
  }
  if (request.wants_paths) {
    columns.push_back({"path", Dtype::float32, {queries.count, paths.starts, paths.steps, d}, paths.points.data()});
  }
  write_columns(output, request.output, columns);
  output.commit();
  print_report(globals, output.is_stdout(), report_json(request, globals, run, contacts.count()),
               report_text(request, globals, run, contacts.count()));
  return ExitCode::done;
}

}  // namespace thalweg::cli
