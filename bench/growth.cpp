// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What growing costs, all sizes by turns within each round: growth/primitives, /queries, /streaming and /threads.
//   ns_at_<x>, exponent   see growth.h; the exponent is of a query for primitives and threads, of a batch otherwise
//   processor_time_added  of growth/threads: what all threads together use beyond one thread's, as a share of it
//   serial_fraction  of growth/threads, after A. Karp and H. Flatt, "Measuring parallel processor performance" (1990)
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "growth.h"
#include "oracle.h"
#include "rounds.h"
#include "thalweg/batch.h"
#include "workload.h"

namespace thalweg::bench {
namespace {

/// Queries for each primitive of growth/primitives, and where they are few.
constexpr std::size_t kDense = 256;
constexpr std::size_t kSparse = 16;

/// Triangles against a tape, with the columns that most callers take.
struct Verdicts {
  const Tape* tape = nullptr;
  const std::vector<float>* rows = nullptr;
  std::vector<std::uint8_t> status;
  std::vector<float> value, point;

  Verdicts(const Tape& of, const std::vector<float>& triangles)
      : tape(&of), rows(&triangles), status(triangles.size() / 6), value(status.size()), point(2 * status.size()) {}

  void run(std::size_t count, int threads) {
    CollideColumns columns;
    columns.status = status.data();
    columns.value = value.data();
    columns.point = point.data();
    benchmark::DoNotOptimize(collide_triangles(*tape, {rows->data(), count}, {}, columns, {.threads = threads})->rows);
  }
};

/// Triangles of the same size everywhere, centres uniform over the scene.
std::vector<float> triangles_over(const Shape& shape, std::size_t count) {
  std::vector<float> rows = picture_triangles(count);
  const Bounds& bounds = shape.facts().bounds;
  const double sx = (bounds.hi[0] - bounds.lo[0]) / 1920, sy = (bounds.hi[1] - bounds.lo[1]) / 1080;
  for (std::size_t i = 0; i < rows.size(); i += 6) {
    const double cx = (rows[i] + rows[i + 2] + rows[i + 4]) / 3.0, cy = (rows[i + 1] + rows[i + 3] + rows[i + 5]) / 3.0;
    for (std::size_t k = 0; k < 6; k += 2) {
      rows[i + k] = static_cast<float>(bounds.lo[0] + sx * cx + (rows[i + k] - cx) / 6);
      rows[i + k + 1] = static_cast<float>(bounds.lo[1] + sy * cy + (rows[i + k + 1] - cy) / 6);
    }
  }
  return rows;
}

/// What the oracle finds wrong with some of the verdicts, or nothing.
std::string wrong_verdict(const Shape& shape, const Verdicts& answers, std::size_t sample) {
  const oracle::Field field(shape);
  const std::size_t stride = std::max<std::size_t>(answers.status.size() / sample, 1);
  for (std::size_t row = 0; row < answers.status.size(); row += stride) {
    const float* t = answers.rows->data() + 6 * row;
    const auto found = oracle::minimum_over_triangle(
        field, {oracle::Vec{t[0], t[1], 0}, oracle::Vec{t[2], t[3], 0}, oracle::Vec{t[4], t[5], 0}},
        {.verdict_only = true});
    const auto verdict = oracle::verdict(field, found, 16384);
    const auto status = static_cast<Status>(answers.status[row]);
    if ((status == Status::separated && verdict == oracle::Verdict::overlapping) ||
        (status == Status::overlapping && verdict == oracle::Verdict::separated)) {
      return "triangle " + std::to_string(row) + ": the verdict is wrong";
    }
  }
  return "";
}

/// A scene with triangles over it.
struct Scattered {
  Tape tape;
  std::vector<float> rows;
  std::unique_ptr<Verdicts> work;

  /// Returns what is wrong, or nothing.
  std::string make(std::size_t size, std::size_t triangles) {
    const Shape scene = scattered_scene(size);
    auto compiled = compile(scene);
    if (!compiled) return to_string(compiled.error());
    tape = std::move(compiled).value();
    rows = triangles_over(scene, triangles);
    work = std::make_unique<Verdicts>(tape, rows);
    work->run(triangles, 1);
    const std::string error = wrong_verdict(scene, *work, std::clamp<std::size_t>(100'000 / size, 10, 1000));
    return error.empty() ? "" : std::to_string(size) + " primitives, " + error;
  }
  /// Of one query; small batches are repeated.
  [[nodiscard]] double time() const {
    const std::size_t count = work->status.size(), repeats = std::max<std::size_t>(batch(1 << 18) / count, 1);
    const double all = seconds([&] {
      for (std::size_t i = 0; i < repeats; ++i) work->run(count, 1);
    });
    return all / static_cast<double>(repeats * count);
  }
};

void primitives(benchmark::State& state) {
  Growth growth(smoke() ? std::vector<std::size_t>{10, 100, 1000} : std::vector<std::size_t>{10, 100, 1000, 10'000});
  std::vector<Scattered> dense(growth.sizes().size());
  Scattered sparse;
  for (std::size_t i = 0; i < dense.size(); ++i) {
    if (const std::string error = dense[i].make(growth.sizes()[i], batch(kDense * growth.sizes()[i])); !error.empty()) {
      return refuse(state, error);
    }
  }
  if (const std::string error = sparse.make(1000, batch(kSparse * 1000)); !error.empty()) return refuse(state, error);
  Samples ratio, sparse_seconds;
  for (auto _ : state) {
    double sum = 0;
    std::vector<double> each;
    for (std::size_t i = 0; i < dense.size(); ++i) {
      each.push_back(dense[i].time());
      growth.add(i, each.back());
      sum += each.back();
    }
    ratio.add(each[2] / each[0]);
    sparse_seconds.add(sparse.time());
    state.SetIterationTime(sum);
  }
  finish(state, growth, std::vector<std::size_t>(dense.size(), 1));
  state.counters["cost_of_1000_over_10"] = ratio.median();
  state.counters["cost_of_1000_over_10_spread"] = ratio.spread();
  state.counters["ns_at_1000_sparse"] = 1e9 * sparse_seconds.median();
}

void queries(benchmark::State& state) {
  std::string error;
  const auto scene = load_scene("small", error);
  if (!scene) return refuse(state, error);
  std::vector<std::size_t> sizes;
  for (std::size_t size = 1000; size <= batch(10'000'000); size *= 10) sizes.push_back(size);
  Growth growth(sizes);
  const std::vector<float> rows = picture_triangles(sizes.back());
  Verdicts work(scene->tape, rows);
  work.run(sizes.back(), 0);
  if (error = wrong_verdict(scene->shape, work, 1000); !error.empty()) return refuse(state, error);
  for (auto _ : state) {
    double sum = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const double time = seconds([&] { work.run(sizes[i], 0); });
      growth.add(i, time);
      sum += time;
    }
    state.SetIterationTime(sum);
  }
  finish(state, growth, sizes);
}

/// Memory of this process that is in use, in bytes.
double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return resident * 4096;
}

/// A file of this process that is gone when the object is.
class Scratch {
 public:
  Scratch() : file_(std::tmpfile()) {}
  ~Scratch() {
    if (file_ != nullptr) std::fclose(file_);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] std::FILE* file() const { return file_; }

 private:
  std::FILE* file_;
};

constexpr std::size_t kStreamed = std::size_t{1} << 16;

/// Reads triangles, answers them, writes statuses and values, a chunk at a time; returns the most memory in use, or 0
/// when a file failed.
double stream(const Tape& tape, std::FILE* from, std::FILE* to, std::size_t count) {
  std::vector<float> rows(6 * kStreamed);
  Verdicts work(tape, rows);
  double most = 0;
  std::rewind(from);
  std::rewind(to);
  for (std::size_t done = 0; done < count;) {
    const std::size_t chunk = std::min(kStreamed, count - done);
    if (std::fread(rows.data(), 24, chunk, from) != chunk) return 0;
    work.run(chunk, 0);
    if (std::fwrite(work.status.data(), 1, chunk, to) != chunk) return 0;
    if (std::fwrite(work.value.data(), 4, chunk, to) != chunk) return 0;
    most = std::max(most, resident_bytes());
    done += chunk;
  }
  return std::fflush(to) == 0 ? most : 0;
}

/// `count` triangles into a file, a chunk at a time.
bool write_triangles(std::FILE* file, std::size_t count) {
  const std::vector<float> rows = picture_triangles(kStreamed);
  for (std::size_t done = 0; done < count; done += kStreamed) {
    const std::size_t chunk = std::min(kStreamed, count - done);
    if (std::fwrite(rows.data(), 24, chunk, file) != chunk) return false;
  }
  return std::fflush(file) == 0;
}

void streaming(benchmark::State& state) {
  std::string error;
  const auto scene = load_scene("small", error);
  if (!scene) return refuse(state, error);
  std::vector<std::size_t> sizes;
  for (std::size_t size = 10'000; size <= batch(10'000'000); size *= 10) sizes.push_back(size);
  Growth growth(sizes);
  const Scratch from, to;
  if (from.file() == nullptr || to.file() == nullptr || !write_triangles(from.file(), sizes.back())) {
    return refuse(state, "no room for a scratch file");
  }
  std::vector<double> memory(sizes.size());
  for (auto _ : state) {
    double sum = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const double time = seconds([&] { memory[i] = stream(scene->tape, from.file(), to.file(), sizes[i]); });
      if (memory[i] == 0) return refuse(state, "a scratch file failed");
      growth.add(i, time);
      sum += time;
    }
    state.SetIterationTime(sum);
  }
  const double grown = memory.back() - memory.front();
  if (grown > 16e6) return refuse(state, "memory grows with the number of queries");
  finish(state, growth, sizes);
  state.counters["memory_bytes"] = memory.back();
  state.counters["memory_growth_bytes"] = grown;
}

void threads(benchmark::State& state) {
  std::string error;
  const auto scene = load_scene("small", error);
  if (!scene) return refuse(state, error);
  const std::size_t cores = std::max(2U, std::thread::hardware_concurrency());
  std::vector<std::size_t> sizes;
  for (std::size_t size = 1; size < cores; size *= 2) sizes.push_back(size);
  sizes.push_back(cores);
  Growth growth(sizes);
  const std::vector<float> rows = picture_triangles(batch(std::size_t{1} << 20));
  Verdicts work(scene->tape, rows);
  work.run(work.status.size(), 1);
  const auto one_thread = work.status;
  Samples added;
  for (auto _ : state) {
    double sum = 0;
    std::vector<double> processor;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const std::clock_t before = std::clock();
      const double time = seconds([&] { work.run(work.status.size(), static_cast<int>(sizes[i])); });
      processor.push_back(static_cast<double>(std::clock() - before));
      if (work.status != one_thread) return refuse(state, "other threads, other answers");
      growth.add(i, time);
      sum += time;
    }
    added.add(processor.back() / processor.front() - 1);
    state.SetIterationTime(sum);
  }
  finish(state, growth, std::vector<std::size_t>(sizes.size(), work.status.size()));
  state.counters["processor_time_added"] = added.median();
  const double speed_up = growth.median(0) / growth.median(sizes.size() - 1);
  const double inverse = 1 / static_cast<double>(cores);
  state.counters["vs_one_thread"] = speed_up;
  state.counters["serial_fraction"] = (1 / speed_up - inverse) / (1 - inverse);
}

}  // namespace

void register_growth_cases() {
  add_growth_case("growth/primitives", primitives);
  add_growth_case("growth/queries", queries);
  add_growth_case("growth/streaming", streaming);
  add_growth_case("growth/threads", threads);
}

}  // namespace thalweg::bench
