// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// triangles/thesis_scene/verdict and /deepest, certified, against the thesis' own method on one thread each, and the
// verdicts on two threads against one.
//   vs_thesis      time per triangle of the published method over ours, in the same rounds
//   vs_one_thread  time on one thread over time on two
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "baselines/thesis.h"
#include "oracle.h"
#include "rounds.h"
#include "thalweg/batch.h"
#include "workload.h"

namespace thalweg::bench {
namespace {

constexpr std::size_t kTriangles = std::size_t{1} << 20;
constexpr std::size_t kDeepestTriangles = std::size_t{1} << 15;
constexpr std::size_t kThesisTriangles = 1024;  // a round; more would only make rounds longer
constexpr std::size_t kSample = 5000;           // of the answers that the oracle checks

struct Batch {
  LoadedScene scene;
  std::vector<float> rows;
  std::vector<std::uint8_t> status, converged;
  std::vector<float> value, lower, point;
  CollideOptions options;

  Batch(LoadedScene loaded, std::size_t triangles, Goal goal)
      : scene(std::move(loaded)),
        rows(picture_triangles(triangles)),
        status(triangles),
        converged(triangles),
        value(triangles),
        lower(triangles),
        point(2 * triangles) {
    options.goal = goal;
  }
  [[nodiscard]] std::size_t count() const { return status.size(); }

  Result<Summary> run(int threads) {
    CollideColumns columns;
    columns.status = status.data();
    columns.converged = converged.data();
    columns.value = value.data();
    columns.lower = lower.data();
    columns.point = point.data();
    const Execution execution{.threads = threads};
    return collide_triangles(scene.tape, {rows.data(), count()}, options, columns, execution);
  }
};

std::array<oracle::Vec, 3> triangle_at(const Batch& batch, std::size_t row) {
  const float* t = batch.rows.data() + 6 * row;
  return {oracle::Vec{t[0], t[1], 0}, oracle::Vec{t[2], t[3], 0}, oracle::Vec{t[4], t[5], 0}};
}

std::string wrong_row(const oracle::Field& field, const Batch& batch, std::size_t row) {
  const auto triangle = triangle_at(batch, row);
  const bool deepest = batch.options.goal == Goal::deepest;
  const double tolerance = default_tolerance(batch.scene.tape);
  const double slack = batch.scene.tape.slack(2048);
  const auto found = oracle::minimum_over_triangle(field, triangle,
                                                   {.verdict_only = !deepest, .width = deepest ? tolerance / 4 : 0.0});
  const auto verdict = oracle::verdict(field, found, 2048);
  const auto status = static_cast<Status>(batch.status[row]);
  const std::string at = "triangle " + std::to_string(row) + ": ";
  const bool contradicted = (status == Status::separated && verdict == oracle::Verdict::overlapping) ||
                            (status == Status::overlapping && verdict == oracle::Verdict::separated);
  if (contradicted) return at + "the verdict is wrong";
  if (status == Status::overlapping && !(field({batch.point[2 * row], batch.point[2 * row + 1], 0}) < 0)) {
    return at + "f is not negative at the reported point";
  }
  if (batch.lower[row] > found.upper) return at + "the lower bound is above the minimum";
  if (batch.value[row] < found.lower - slack) return at + "the value is below the minimum";
  if (deepest && batch.converged[row] != 0 && batch.value[row] > found.upper + tolerance + slack) {
    return at + "the point is not the deepest";
  }
  return "";
}

/// Runs once and holds a sample against the oracle; also warms the scratch memory.
std::string wrong_answer(Batch& batch) {
  const auto summary = batch.run(1);
  if (!summary) return to_string(summary.error());
  const std::size_t undecided = summary->by_status[static_cast<std::size_t>(Status::undecided)];
  if (undecided * 10000 > summary->rows) return std::to_string(undecided) + " verdicts are undecided";
  const oracle::Field field(batch.scene.shape);
  const std::size_t stride = std::max<std::size_t>(batch.count() / kSample, 1);
  for (std::size_t row = 0; row < batch.count(); row += stride) {
    if (std::string wrong = wrong_row(field, batch, row); !wrong.empty()) return wrong;
  }
  return "";
}

/// The published method on a slice of the batch that moves on from round to round.
class ThesisRun {
 public:
  ThesisRun(const Batch& batch, std::size_t slice)
      : batch_(batch), slice_(std::min(slice, batch.count())), shape_(thesis_scene()) {}

  void operator()() {
    for (std::size_t i = 0; i < slice_; ++i) {
      const float* t = batch_.rows.data() + 6 * ((next_ + i) % batch_.count());
      const Vec2 triangle[3] = {{t[0], t[1]}, {t[2], t[3]}, {t[4], t[5]}};
      const ThesisAnswer answer = descend(*shape_, triangle);
      evaluations_ += answer.evaluations;
      benchmark::DoNotOptimize(answer.overlaps);
    }
    next_ += slice_;
  }
  [[nodiscard]] std::size_t slice() const { return slice_; }
  [[nodiscard]] std::uint64_t evaluations() const { return evaluations_; }

 private:
  const Batch& batch_;
  std::size_t slice_, next_ = 0;
  std::unique_ptr<Sdf> shape_;
  std::uint64_t evaluations_ = 0;
};

void against_thesis(benchmark::State& state, std::size_t triangles, Goal goal) {
  std::string error;
  auto scene = load_scene("small", error);
  if (!scene) return refuse(state, error);
  Batch work(*std::move(scene), batch(triangles), goal);
  if (error = wrong_answer(work); !error.empty()) return refuse(state, error);
  ThesisRun thesis(work, batch(kThesisTriangles));
  Samples vs_thesis, thesis_seconds;
  std::uint64_t evaluations = 0;
  double thesis_total = 0;
  for (auto _ : state) {
    const auto [ours, theirs] = by_turns(
        vs_thesis.count(), [&] { evaluations = work.run(1)->evaluations; }, [&] { thesis(); });
    const double theirs_each = theirs / static_cast<double>(thesis.slice());
    vs_thesis.add(theirs_each / (ours / static_cast<double>(work.count())));
    thesis_seconds.add(theirs_each);
    thesis_total += theirs;
    state.SetIterationTime(ours);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(work.count()) * state.iterations());
  state.counters["vs_thesis"] = vs_thesis.median();
  state.counters["vs_thesis_spread"] = vs_thesis.spread();
  state.counters["evaluations_per_triangle"] = static_cast<double>(evaluations) / static_cast<double>(work.count());
  state.counters["thesis_triangles_per_second"] = 1 / thesis_seconds.median();
  state.counters["thesis_ns_per_evaluation"] = 1e9 * thesis_total / static_cast<double>(thesis.evaluations());
}

void two_threads(benchmark::State& state) {
  std::string error;
  auto scene = load_scene("small", error);
  if (!scene) return refuse(state, error);
  Batch work(*std::move(scene), batch(4 * kTriangles), Goal::verdict);
  if (error = wrong_answer(work); !error.empty()) return refuse(state, error);
  const auto one_thread = work.status;
  if (const auto summary = work.run(2); !summary || work.status != one_thread) {
    return refuse(state, "two threads do not answer as one does");
  }
  Samples vs_one_thread;
  for (auto _ : state) {
    const auto [two, one] = by_turns(
        vs_one_thread.count(), [&] { benchmark::DoNotOptimize(work.run(2)->rows); },
        [&] { benchmark::DoNotOptimize(work.run(1)->rows); });
    vs_one_thread.add(one / two);
    state.SetIterationTime(two);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(work.count()) * state.iterations());
  state.counters["vs_one_thread"] = vs_one_thread.median();
  state.counters["vs_one_thread_spread"] = vs_one_thread.spread();
}

}  // namespace

void register_triangle_cases() {
  const auto add = [](const char* name, auto run) {
    benchmark::RegisterBenchmark(name, run)->UseManualTime()->Unit(benchmark::kMillisecond);
  };
  add("triangles/thesis_scene/verdict",
      [](benchmark::State& state) { against_thesis(state, kTriangles, Goal::verdict); });
  add("triangles/thesis_scene/deepest",
      [](benchmark::State& state) { against_thesis(state, kDeepestTriangles, Goal::deepest); });
  add("triangles/thesis_scene/verdict/threads:2", two_threads);
}

}  // namespace thalweg::bench
