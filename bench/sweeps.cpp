// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// sweeps/thesis_scene/...: times of impact of triangles over the thesis' picture, one thread, to a thousandth of the
// time. Each vertex goes up to 200 units along each axis (`ends`), or the scene does, and turns by up to 0.3 radians
// (`motions`).
//   ns_per_triangle          median of the rounds; the goal is 500
//   evaluations_per_triangle, contacts, converged   shares of all rows, the latter two
// growth/sweeps: small triangles that move by up to 100 units in scenes of 10 to 10 000 primitives (growth.h), to a
// hundredth of the time: the coordinates of the largest leave float32 no more.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "growth.h"
#include "oracle.h"
#include "random.h"
#include "rounds.h"
#include "thalweg/batch.h"
#include "workload.h"

namespace thalweg::bench {
namespace {

using oracle::Vec;

constexpr std::size_t kTriangles = std::size_t{1} << 17;
constexpr std::size_t kPerPrimitive = 16;
constexpr std::size_t kFewRows = 128;

/// Moving triangles against a scene, and their answers.
struct Sweeps {
  Shape scene;
  Tape tape;
  std::vector<float> rows, ends, motions;
  std::vector<std::uint8_t> status, converged;
  std::vector<float> lower, upper, point;
  SweepOptions options;
  std::uint64_t evaluations = 0;

  Sweeps(Shape of, std::vector<float> triangles)
      : scene(std::move(of)),
        tape(std::move(compile(scene)).value()),
        rows(std::move(triangles)),
        status(rows.size() / 6),
        converged(status.size()),
        lower(status.size()),
        upper(status.size()),
        point(2 * status.size()) {}
  [[nodiscard]] std::size_t count() const { return status.size(); }

  void move_vertices(double most) {
    oracle::Random random(11);
    for (std::size_t i = 0; i < count(); ++i) {
      const double x = random.uniform(-most, most), y = random.uniform(-most, most);
      for (std::size_t k = 0; k < 6; ++k) {
        const double own = random.uniform(-most, most) / 8;
        ends.push_back(static_cast<float>(static_cast<double>(rows[6 * i + k]) + (k % 2 == 0 ? x : y) + own));
      }
    }
  }
  void move_scene(double most, double angle) {
    oracle::Random random(11);
    for (std::size_t i = 0; i < 3 * count(); ++i) {
      motions.push_back(static_cast<float>(random.uniform(-1, 1) * (i % 3 == 2 ? angle : most)));
    }
  }

  void run(std::size_t row, std::size_t some) {
    SweepQueries queries{.rows = &rows[6 * row], .count = some};
    if (!ends.empty()) queries.ends = &ends[6 * row];
    if (!motions.empty()) queries.motions = &motions[3 * row];
    SweepColumns columns;
    columns.status = &status[row], columns.converged = &converged[row];
    columns.toi_lower = &lower[row], columns.toi_upper = &upper[row];
    columns.point = &point[2 * row];
    evaluations = sweep_triangles(tape, queries, options, columns, {.threads = 1})->evaluations;
  }

  /// A point of the plane at a time, in the scene's frame.
  [[nodiscard]] Vec in_scene(std::size_t row, Vec p, double t) const {
    if (motions.empty()) return p;
    const float* const m = &motions[3 * row];
    const double x = p.x - t * static_cast<double>(m[0]), y = p.y - t * static_cast<double>(m[1]);
    const double cosine = std::cos(t * static_cast<double>(m[2])), sine = std::sin(t * static_cast<double>(m[2]));
    return {cosine * x + sine * y, cosine * y - sine * x, 0};
  }
  [[nodiscard]] Vec vertex(std::size_t row, std::size_t k, double t) const {
    const std::size_t at = 6 * row + 2 * k;
    const Vec from{rows[at], rows[at + 1], 0};
    return ends.empty() ? from : from * (1 - t) + Vec{ends[at], ends[at + 1], 0} * t;
  }
};

/// What is wrong with a row, or nothing: points of the triangle at many times, and the contact.
std::string wrong_row(const Sweeps& sweeps, const oracle::Field& field, std::size_t row) {
  constexpr int kTimes = 100, kSide = 8;
  const auto status = static_cast<Status>(sweeps.status[row]);
  for (int i = 0; i <= kTimes; ++i) {
    const double t = static_cast<double>(i) / kTimes;
    if (t >= static_cast<double>(sweeps.lower[row]) && status != Status::separated) break;
    const Vec corners[] = {sweeps.vertex(row, 0, t), sweeps.vertex(row, 1, t), sweeps.vertex(row, 2, t)};
    for (int u = 0; u <= kSide; ++u) {
      for (int v = 0; u + v <= kSide; ++v) {
        const Vec p = corners[0] * ((kSide - u - v) / static_cast<double>(kSide)) +
                      corners[1] * (u / static_cast<double>(kSide)) + corners[2] * (v / static_cast<double>(kSide));
        if (field(sweeps.in_scene(row, p, t)) < 0) return "met at time " + std::to_string(t);
      }
    }
  }
  if (status != Status::overlapping) return "";
  const Vec p{sweeps.point[2 * row], sweeps.point[2 * row + 1], 0};
  return field(sweeps.in_scene(row, p, sweeps.upper[row])) < 4e-3 ? "" : "the contact is not in the scene";
}

std::string wrong_answer(Sweeps& sweeps, std::size_t sample) {
  sweeps.run(0, sweeps.count());
  const oracle::Field field(sweeps.scene);
  const std::size_t stride = std::max<std::size_t>(sweeps.count() / sample, 1);
  for (std::size_t row = 0; row < sweeps.count(); row += stride) {
    const std::string wrong = wrong_row(sweeps, field, row);
    if (!wrong.empty()) return "triangle " + std::to_string(row) + ": " + wrong;
  }
  return "";
}

void thesis_scene(benchmark::State& state, bool scene_moves) {
  std::string error;
  const auto scene = load_scene("small", error);
  if (!scene) return refuse(state, error);
  Sweeps sweeps(scene->shape, picture_triangles(batch(kTriangles)));
  scene_moves ? sweeps.move_scene(200, 0.3) : sweeps.move_vertices(200);
  if (error = wrong_answer(sweeps, 500); !error.empty()) return refuse(state, error);
  Samples each;
  for (auto _ : state) {
    const double time = seconds([&] { sweeps.run(0, sweeps.count()); });
    each.add(time / static_cast<double>(sweeps.count()));
    state.SetIterationTime(time);
  }
  const auto share = [&](const std::vector<std::uint8_t>& of) {
    return static_cast<double>(std::ranges::count(of, 1)) / static_cast<double>(of.size());
  };
  state.SetItemsProcessed(static_cast<std::int64_t>(sweeps.count()) * state.iterations());
  state.counters["ns_per_triangle"] = 1e9 * each.median();
  state.counters["evaluations_per_triangle"] =
      static_cast<double>(sweeps.evaluations) / static_cast<double>(sweeps.count());
  state.counters["contacts"] = share(sweeps.status);
  state.counters["converged"] = share(sweeps.converged);
}

/// Triangles of some 20 units anywhere over a scene.
std::vector<float> triangles_over(const Shape& scene, std::size_t count) {
  oracle::Random random(5);
  const Bounds& box = scene.facts().bounds;
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(box.lo[0], box.hi[0]), y = random.uniform(box.lo[1], box.hi[1]);
    for (std::size_t k = 0; k < 6; ++k) {
      rows.push_back(static_cast<float>((k % 2 == 0 ? x : y) + random.uniform(-10, 10)));
    }
  }
  return rows;
}

void growing_scene(benchmark::State& state) {
  const auto make = [](std::size_t size, std::string& error) {
    const Shape scene = scattered_scene(size);
    const std::size_t count = std::max(batch(kPerPrimitive * size), 2 * kFewRows);
    auto sweeps = std::make_unique<Sweeps>(scene, triangles_over(scene, count));
    sweeps->move_vertices(100);
    sweeps->options.tolerance = 1e-2;
    error = wrong_answer(*sweeps, std::clamp<std::size_t>(100'000 / size, 10, 200));
    return sweeps;
  };
  const auto run = [](Sweeps& sweeps, std::size_t row, std::size_t rows) { sweeps.run(row, rows); };
  grow_by_scene(state, make, run, kFewRows);
}

}  // namespace

void register_sweep_cases() {
  const auto add = [](const char* name, bool scene_moves) {
    benchmark::RegisterBenchmark(name, thesis_scene, scene_moves)->UseManualTime()->Unit(benchmark::kMillisecond);
  };
  add("sweeps/thesis_scene/ends", false);
  add("sweeps/thesis_scene/motions", true);
  add_growth_case("growth/sweeps", growing_scene);
}

}  // namespace thalweg::bench
