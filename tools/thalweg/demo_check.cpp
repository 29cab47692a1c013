// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The demo's oracle and baseline.
#include "demo_check.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "oracle.h"
#include "report.h"
#include "thalweg/query.h"
#include "thesis.h"

namespace thalweg::cli {

namespace {

constexpr double kMagnitude = 4096;  // no coordinate of the workload is larger

std::array<oracle::Vec, 3> corners_of(std::span<const float> triangles, std::size_t row) {
  std::array<oracle::Vec, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = {static_cast<double>(triangles[6 * row + 2 * i]), static_cast<double>(triangles[6 * row + 2 * i + 1]),
                  0};
  }
  return corners;
}

// Whether a status contradicts what the oracle has proven.
bool contradicts(Status status, oracle::Verdict verdict, const oracle::Bracket& bracket, double tolerance) {
  switch (status) {
    case Status::separated:
      return verdict == oracle::Verdict::overlapping;
    case Status::overlapping:
      return verdict == oracle::Verdict::separated;
    case Status::touching:
      return bracket.lower > tolerance || bracket.upper < -tolerance;
    case Status::undecided:
      return false;
    case Status::bad_row:
      break;
  }
  return true;  // every row of the workload is a good one
}

constexpr std::size_t kBaselineRowsPerThread = 8192;
constexpr std::size_t kChunk = 256;

struct Tally {
  std::atomic<std::size_t> next = 0;
  std::atomic<std::uint64_t> evaluations = 0;
  std::atomic<std::size_t> hits = 0;
};

void descend_rows(const bench::Sdf& scene, std::span<const float> triangles, std::size_t count, Tally& tally) {
  std::uint64_t evaluations = 0;
  std::size_t hits = 0;
  for (std::size_t first = tally.next.fetch_add(kChunk); first < count; first = tally.next.fetch_add(kChunk)) {
    for (std::size_t row = first; row < std::min(first + kChunk, count); ++row) {
      const float* const c = triangles.data() + 6 * row;
      const bench::Vec2 corners[3] = {{c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}};
      const bench::ThesisAnswer answer = bench::descend(scene, corners);
      evaluations += answer.evaluations;
      hits += answer.overlaps ? 1 : 0;
    }
  }
  tally.evaluations += evaluations;
  tally.hits += hits;  // the answers are used, so that none can be left out
}

}  // namespace

OracleCheck check_with_oracle(const Shape& shape, const DemoRows& rows, std::size_t sample) {
  const oracle::Field field(shape);
  const std::size_t count = rows.status.size();
  OracleCheck check;
  check.checked = std::min(sample, count);
  for (std::size_t i = 0; i < check.checked; ++i) {
    const std::size_t row = i * count / check.checked;
    const auto status = static_cast<Status>(rows.status[row]);
    oracle::Limits limits;
    limits.verdict_only = true;
    limits.width = rows.tolerance;
    const oracle::Bracket bracket = oracle::minimum_over_triangle(field, corners_of(rows.triangles, row), limits);
    const oracle::Verdict verdict = oracle::verdict(field, bracket, kMagnitude);
    check.oracle_undecided += verdict == oracle::Verdict::cannot_tell ? 1 : 0;
    if (!contradicts(status, verdict, bracket, rows.tolerance)) continue;
    if (check.wrong++ > 0) continue;
    check.first_wrong_row = row;
    check.first_expected = oracle::name(verdict);
    check.first_found = name(status);
  }
  return check;
}

ThesisTiming time_thesis(std::span<const float> triangles, int threads) {
  const auto scene = bench::thesis_scene();
  const auto workers = static_cast<std::size_t>(threads);
  ThesisTiming timing;
  timing.triangles = std::min(triangles.size() / 6, workers * kBaselineRowsPerThread);
  Tally warm_up;
  descend_rows(*scene, triangles, std::min(timing.triangles, kChunk), warm_up);
  Tally tally;
  const Stopwatch watch;
  std::vector<std::thread> pool;
  for (std::size_t i = 1; i < workers; ++i) {
    pool.emplace_back([&] { descend_rows(*scene, triangles, timing.triangles, tally); });
  }
  descend_rows(*scene, triangles, timing.triangles, tally);
  for (std::thread& thread : pool) thread.join();
  timing.seconds = watch.seconds();
  if (timing.triangles > 0) {
    timing.evaluations_per_triangle =
        static_cast<double>(tally.evaluations.load()) / static_cast<double>(timing.triangles);
  }
  return timing;
}

}  // namespace thalweg::cli
