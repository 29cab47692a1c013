// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// pairs/torus/certified and pairs/torus/midsurface: two equal tori at random poses, on one thread, against the scalar
// double midsurface of baselines/midsurface.h.
//   vs_midsurface  time per pair of the baseline over ours, in the same rounds
// Certified answers are verdict, every overlap region and its deepest point.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "baselines/midsurface.h"
#include "rounds.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"
#include "workload.h"

namespace thalweg::bench {
namespace {

constexpr std::size_t kPairs = 8192;
constexpr std::size_t kBaselinePairs = 256;  // a round
constexpr std::size_t kContacts = 8;
constexpr double kTolerance = 1.5e-4;  // 1e-4 of the torus' box, rounded up

/// Offsets uniform in [-0.5, 0.5]^3, rotations uniform.
std::vector<float> torus_poses(std::size_t count) {
  std::mt19937_64 random(1);
  const auto uniform = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) rows.push_back(static_cast<float>(uniform(-0.5, 0.5)));
    double q[4], square = 0;
    do {
      square = 0;
      for (double& x : q) {
        x = uniform(-1, 1);
        square += x * x;
      }
    } while (square > 1 || square < 1e-4);
    for (const double x : q) rows.push_back(static_cast<float>(x / std::sqrt(square)));
  }
  return rows;
}

struct TorusPairs {
  Tape tape;
  std::vector<float> rows;
  std::vector<std::uint8_t> status, converged;
  std::vector<float> value, lower, point, contact_point, contact_normal, contact_value, contact_lower;
  std::vector<std::uint32_t> found;
  PairOptions options;

  TorusPairs(Tape compiled, std::size_t count, Method method)
      : tape(std::move(compiled)),
        rows(torus_poses(count)),
        status(count),
        converged(count),
        value(count),
        lower(count),
        point(3 * count),
        contact_point(3 * kContacts * count),
        contact_normal(3 * kContacts * count),
        contact_value(kContacts * count),
        contact_lower(kContacts * count),
        found(count) {
    options.goal = Goal::deepest;
    options.method = method;
  }
  [[nodiscard]] std::size_t count() const { return status.size(); }

  Result<Summary> run() {
    const Tape* const shapes[2] = {&tape, &tape};
    PairQueries queries;
    queries.shapes = shapes;
    queries.shape_count = 2;
    queries.poses = rows.data();
    queries.count = count();
    CollideColumns columns;
    columns.status = status.data();
    columns.converged = converged.data();
    columns.value = value.data();
    columns.lower = lower.data();
    columns.point = point.data();
    PairContacts contacts;
    contacts.capacity = kContacts;
    contacts.found = found.data();
    contacts.point = contact_point.data();
    contacts.normal = contact_normal.data();
    contacts.value = contact_value.data();
    contacts.lower = contact_lower.data();
    return collide_pairs(queries, options, columns, contacts, {.threads = 1});
  }
};

/// The least of max(f_a, f_b) on a grid of the first torus' box: no bound of ours may lie above it.
double least_on_grid(const TorusPose& pose) {
  double least = 1;
  for (int x = 0; x <= 40; ++x) {
    for (int y = 0; y <= 12; ++y) {
      for (int z = 0; z <= 40; ++z) {
        const double p[3] = {-0.5 + x / 40.0, -0.15 + 0.3 * y / 12, -0.5 + z / 40.0};
        least = std::min(least, common_value({}, pose, p));
      }
    }
  }
  return least;
}

std::string wrong_pair(const TorusPairs& pairs, std::size_t row, bool certified) {
  const TorusPose pose = torus_pose(pairs.rows.data() + 7 * row);
  const std::string at = "pair " + std::to_string(row) + ": ";
  const auto status = static_cast<Status>(pairs.status[row]);
  const float* p = pairs.point.data() + 3 * row;
  const double point[3] = {p[0], p[1], p[2]};
  if (status == Status::overlapping && !(common_value({}, pose, point) < 0)) return at + "the point is not common";
  if (!certified) return "";
  const double seen = std::min(least_on_grid(pose), midsurface({}, pose).value);
  if (status == Status::separated && seen < 0) return at + "the shapes are not apart";
  if (static_cast<double>(pairs.lower[row]) > seen) return at + "the bound is above a value";
  const bool deepest = status != Status::overlapping || pairs.converged[row] == 0 ||
                       static_cast<double>(pairs.value[row]) <= seen + kTolerance;
  return deepest ? "" : at + "the point is not the deepest";
}

std::string wrong_answer(TorusPairs& pairs, bool certified) {
  const auto summary = pairs.run();
  if (!summary) return to_string(summary.error());
  const std::size_t stride = std::max<std::size_t>(pairs.count() / 500, 1);
  for (std::size_t row = 0; row < pairs.count(); row += stride) {
    if (std::string wrong = wrong_pair(pairs, row, certified); !wrong.empty()) return wrong;
  }
  return "";
}

/// Median of |value - deepest| over overlapping pairs, the deepest as certified.
double median_error(const TorusPairs& pairs, std::size_t count) {
  std::vector<double> errors;
  for (std::size_t row = 0; row < std::min(count, pairs.count()); ++row) {
    if (static_cast<Status>(pairs.status[row]) != Status::overlapping) continue;
    const double found = midsurface({}, torus_pose(pairs.rows.data() + 7 * row)).value;
    errors.push_back(std::fabs(found - static_cast<double>(pairs.value[row])));
  }
  if (errors.empty()) return 0;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return errors[errors.size() / 2];
}

void against_midsurface(benchmark::State& state, Method method) {
  auto tape = compile(torus(0.35, 0.15));
  if (!tape) return refuse(state, to_string(tape.error()));
  TorusPairs pairs(std::move(tape).value(), batch(kPairs), method);
  const bool certified = method == Method::certified;
  if (const std::string error = wrong_answer(pairs, certified); !error.empty()) return refuse(state, error);
  const std::size_t slice = std::min(batch(kBaselinePairs), pairs.count());
  std::size_t next = 0;
  Samples vs_midsurface, baseline_seconds;
  std::uint64_t evaluations = 0;
  for (auto _ : state) {
    const auto [ours, theirs] = by_turns(
        vs_midsurface.count(), [&] { evaluations = pairs.run()->evaluations; },
        [&] {
          for (std::size_t i = 0; i < slice; ++i, ++next) {
            benchmark::DoNotOptimize(midsurface({}, torus_pose(pairs.rows.data() + 7 * (next % pairs.count()))).value);
          }
        });
    const double theirs_each = theirs / static_cast<double>(slice);
    vs_midsurface.add(theirs_each / (ours / static_cast<double>(pairs.count())));
    baseline_seconds.add(theirs_each);
    state.SetIterationTime(ours);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(pairs.count()) * state.iterations());
  state.counters["vs_midsurface"] = vs_midsurface.median();
  state.counters["vs_midsurface_spread"] = vs_midsurface.spread();
  state.counters["evaluations_per_pair"] = static_cast<double>(evaluations) / static_cast<double>(pairs.count());
  state.counters["midsurface_us_per_pair"] = 1e6 * baseline_seconds.median();
  if (certified) state.counters["midsurface_median_error"] = median_error(pairs, batch(kPairs) / 8);
}

}  // namespace

void register_pair_cases() {
  const auto add = [](const char* name, Method method) {
    benchmark::RegisterBenchmark(name, [method](benchmark::State& state) { against_midsurface(state, method); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  add("pairs/torus/certified", Method::certified);
  add("pairs/torus/midsurface", Method::midsurface);
}

}  // namespace thalweg::bench
