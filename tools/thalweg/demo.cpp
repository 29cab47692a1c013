// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg demo`: the main job from nothing. One million triangles against the thesis scene with proven verdicts,
// timed; a sample of the answers checked by an independent oracle; the thesis' published method timed beside it; a
// result file and a picture.
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <memory>

#include <fmt/format.h>

#include "collide_result.h"
#include "command.h"
#include "demo_check.h"
#include "demo_workload.h"
#include "input.h"
#include "npz.h"
#include "options.h"
#include "output.h"
#include "overlay.h"
#include "picture.h"
#include "progress.h"
#include "report.h"
#include "thalweg/scene.h"

namespace thalweg::cli {

namespace {

constexpr std::size_t kRepeats = 5;
constexpr std::size_t kCheckedRows = 20'000;
constexpr std::size_t kDrawnTriangles = 400;
constexpr std::size_t kPictureWidth = 1600;
constexpr std::uint64_t kMostTriangles = 100'000'000;

struct DemoOptions {
  std::string folder = ".";
  std::uint64_t count = 1'000'000;

  [[nodiscard]] std::string path(const char* file) const { return folder + "/" + file; }
};

struct Certified {
  Summary summary;
  std::vector<double> seconds;  // sorted
  [[nodiscard]] double median() const { return seconds[seconds.size() / 2]; }
};

struct Demo {
  Certified certified;
  OracleCheck check;
  ThesisTiming thesis;
  double tolerance = 0;

  [[nodiscard]] double rate() const { return static_cast<double>(certified.summary.rows) / certified.median(); }
  [[nodiscard]] double thesis_rate() const { return static_cast<double>(thesis.triangles) / thesis.seconds; }
  [[nodiscard]] double speed_up() const { return rate() / thesis_rate(); }
  [[nodiscard]] double evaluations() const {
    return static_cast<double>(certified.summary.evaluations) / static_cast<double>(certified.summary.rows);
  }
};

Certified time_certified(const Tape& tape, std::span<const float> triangles, CollideResult& result,
                         const Globals& globals) {
  const Queries queries{triangles.data(), triangles.size() / 6};
  Progress progress("demo", (kRepeats + 1) * queries.count, globals.quiet);
  Execution execution = globals.execution();
  execution.done = progress.done();
  Certified certified;
  // The first run starts the threads and touches the memory; it is not counted.
  for (std::size_t i = 0; i <= kRepeats; ++i) {
    const Stopwatch watch;
    certified.summary =
        unwrap(collide_triangles(tape, queries, CollideOptions(), result.columns(), execution), "demo", "collide");
    if (i > 0) certified.seconds.push_back(watch.seconds());
  }
  std::sort(certified.seconds.begin(), certified.seconds.end());
  return certified;
}

// The first few hundred rows, which are as random as all.
void draw(const DemoOptions& options, const Tape& tape, std::span<const float> triangles, const CollideResult& result,
          const Globals& globals) {
  const std::size_t count = std::min(kDrawnTriangles, result.status.size());
  const auto head = [](const auto& numbers, std::size_t n) {
    return std::vector(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(n));
  };
  Overlay overlay;
  overlay.status = head(result.status, count);
  overlay.point = head(result.point, 2 * count);
  overlay.normal = head(result.normal, 2 * count);
  overlay.triangles = head(triangles, 6 * count);
  const auto height = static_cast<std::size_t>(static_cast<double>(kPictureWidth) * kDemoHeight / kDemoWidth);
  const View view{0, 0, kDemoWidth, kDemoHeight, kPictureWidth, height, 0};
  Output output(options.path("demo.png"));
  Canvas canvas = draw_field(tape, view, {PictureMode::distance, 0.2F}, globals);
  draw_overlay(canvas, view, overlay);
  output.write(canvas.png());
  output.commit();
}

void write_result(const DemoOptions& options, const CollideResult& result) {
  Output output(options.path("demo.npz"));
  write_columns(output, options.path("demo.npz"), result.list());
  output.commit();
}

Json report_json(const DemoOptions& options, const Globals& globals, const Demo& demo) {
  const Summary& summary = demo.certified.summary;
  return {{"command", "demo"},
          {"triangles", summary.rows},
          {"seed", globals.seed},
          {"threads", thread_count(globals)},
          {"simd", globals.active_target().name},
          {"repeats", kRepeats},
          {"seconds",
           {{"median", demo.certified.median()},
            {"least", demo.certified.seconds.front()},
            {"most", demo.certified.seconds.back()}}},
          {"triangles_per_second", demo.rate()},
          {"evaluations_per_triangle", demo.evaluations()},
          {"status",
           {{"separated", summary.by_status[0]},
            {"overlapping", summary.by_status[1]},
            {"touching", summary.by_status[2]},
            {"undecided", summary.by_status[3]},
            {"bad_row", summary.by_status[4]}}},
          {"checked_rows", demo.check.checked},
          {"wrong_verdicts", demo.check.wrong},
          {"oracle_undecided", demo.check.oracle_undecided},
          {"thesis",
           {{"triangles", demo.thesis.triangles},
            {"triangles_per_second", demo.thesis_rate()},
            {"evaluations_per_triangle", demo.thesis.evaluations_per_triangle},
            {"threads", thread_count(globals)}}},
          {"speed_up", demo.speed_up()},
          {"output", {options.path("demo.npz"), options.path("demo.png")}}};
}

std::string report_text(const DemoOptions& options, const Globals& globals, const Demo& demo) {
  const Summary& summary = demo.certified.summary;
  const int threads = thread_count(globals);
  Table table({"", "certified (thalweg)", "published (thesis)"});
  const auto number = [](double x) { return fmt::format("{:.2f}", x); };
  table.add({"triangles per second", with_suffix(demo.rate()), with_suffix(demo.thesis_rate())});
  table.add({"evaluations per triangle", number(demo.evaluations()), number(demo.thesis.evaluations_per_triangle)});
  table.add({"triangles timed", grouped(summary.rows), grouped(demo.thesis.triangles)});
  table.add({"threads", fmt::format("{}", threads), fmt::format("{}", threads)});
  table.add({"speed-up", fmt::format("{:.0f} x", demo.speed_up()), "1 x"});
  Sheet sheet;
  sheet.add("verdicts",
            fmt::format("{} separated, {} overlapping, {} touching, {} undecided", grouped(summary.by_status[0]),
                        grouped(summary.by_status[1]), grouped(summary.by_status[2]), grouped(summary.by_status[3])));
  sheet.add("wrong verdicts", fmt::format("{} of {} checked by an independent oracle in double precision",
                                          grouped(demo.check.wrong), grouped(demo.check.checked)));
  sheet.add("time",
            fmt::format("{:.4g} s, median of {} runs ({:.4g} to {:.4g}), {}", demo.certified.median(), kRepeats,
                        demo.certified.seconds.front(), demo.certified.seconds.back(), globals.active_target().name));
  sheet.add("written", options.path("demo.npz") + ", " + options.path("demo.png"));
  return table.text() + '\n' + sheet.text();
}

ExitCode run_demo(const DemoOptions& options, const Globals& globals) {
  if (::mkdir(options.folder.c_str(), 0777) != 0 && errno != EEXIST) {
    fail(options.folder, "folder", "a folder to write to", system_message(errno));
  }
  const Scene scene = unwrap(parse_scene(kDemoScene, "demo scene"), "demo scene", "/");
  const Tape tape = unwrap(compile(scene.shape), "demo scene", "/shape");
  const std::vector<float> triangles = demo_triangles(options.count, globals.seed);
  CollideResult result(QueryKind::triangles, options.count, 2);

  Demo demo;
  demo.tolerance = default_tolerance(tape);
  demo.certified = time_certified(tape, triangles, result, globals);
  demo.thesis = time_thesis(triangles, thread_count(globals));
  demo.check = check_with_oracle(scene.shape, {triangles, result.status, demo.tolerance}, kCheckedRows);
  write_result(options, result);
  draw(options, tape, triangles, result, globals);
  print_report(globals, false, report_json(options, globals, demo), report_text(options, globals, demo));
  if (demo.check.wrong > 0) {
    refuse("demo", fmt::format("row {}", demo.check.first_wrong_row), demo.check.first_expected,
           demo.check.first_found);
  }
  return ExitCode::done;
}

}  // namespace

Command add_demo(CLI::App& app, const Globals& globals) {
  CLI::App* const command = app.add_subcommand("demo", "The main job from nothing: a table and a picture");
  const auto options = std::make_shared<DemoOptions>();
  command->add_option("--out", options->folder, "Folder for demo.npz and demo.png; default: the current one")
      ->type_name("DIR");
  add_integer(*command, {"--count", "How many triangles; default 1000000"}, options->count, {1, kMostTriangles});
  return {command, [options, &globals] { return run_demo(*options, globals); }};
}

}  // namespace thalweg::cli
