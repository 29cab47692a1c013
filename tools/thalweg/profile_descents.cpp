// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "profile_descents.h"

#include <algorithm>
#include <cmath>

#include "collide_result.h"
#include "profile_strategies.h"
#include "thalweg/method_table.h"

namespace thalweg::cli {

namespace {

constexpr int kRuns = 3;
constexpr double kReferenceTolerance = 1e-6;  // in diagonals

/// Local methods over triangles that ask for a gradient: golden section along the edges does not.
bool takes_gradients(const MethodRow& row) {
  return row.triangles && !row.proves && row.method != Method::golden_section;
}

class Contest {
 public:
  Contest(const Tape& tape, const std::vector<float>& triangles, const Globals& globals)
      : tape_(tape),
        diagonal_(tape.facts.bounds.diagonal(tape.dimension)),
        execution_(globals.execution()),
        reference_(QueryKind::triangles, triangles.size() / 3 / static_cast<std::size_t>(tape.dimension),
                   tape.dimension) {
    queries_ = {triangles.data(), reference_.status.size()};
    execution_.threads = 1;
    CollideOptions options;
    options.goal = Goal::deepest;
    options.tolerance = kReferenceTolerance * diagonal_;
    run(options, reference_);
  }

  [[nodiscard]] DescentProfile profile(Method method, Gradient strategy, const ProbeOffset& offset) const {
    CollideOptions options;
    options.method = method;
    options.goal = Goal::deepest;  // or `accelerated` ends at the first negative value
    options.gradient = strategy;
    options.gradient_given = true;
    options.gradient_offset = offset;
    CollideResult result(QueryKind::triangles, queries_.count, tape_.dimension);
    DescentProfile profile;
    profile.method = method;
    profile.strategy = strategy;
    const auto count = static_cast<double>(queries_.count);
    profile.nanoseconds = 1e9 * median_seconds(kRuns, [&] { run(options, result); }) / count;
    for (std::size_t i = 0; i < queries_.count; ++i) {
      profile.iterations += static_cast<double>(result.iterations[i]) / count;
      profile.evaluations += static_cast<double>(result.evaluations[i]) / count;
    }
    compare(result, profile);
    return profile;
  }

 private:
  /// Only what a descent finds is asked for: no normals.
  void run(const CollideOptions& options, CollideResult& result) const {
    CollideColumns columns;
    columns.status = result.status.data();
    columns.value = result.value.data();
    columns.lower = result.lower.data();
    columns.claimed = result.claimed.data();
    columns.iterations = result.iterations.data();
    columns.evaluations = result.evaluations.data();
    static_cast<void>(
        unwrap(collide_triangles(tape_, queries_, options, columns, execution_), kCommandLine, "--method"));
  }

  void compare(const CollideResult& result, DescentProfile& profile) const {
    std::vector<double> errors;
    for (std::size_t i = 0; i < queries_.count; ++i) {
      const bool hit = reference_.status[i] == static_cast<std::uint8_t>(Status::overlapping);
      profile.hits += hit ? 1 : 0;
      profile.misses += hit && result.claimed[i] == 0 ? 1 : 0;
      const double error = static_cast<double>(result.value[i]) - static_cast<double>(reference_.value[i]);
      errors.push_back(std::max(0.0, error) / diagonal_);
    }
    if (errors.empty()) return;
    std::sort(errors.begin(), errors.end());
    profile.median_error = errors[errors.size() / 2];
    profile.p99_error = errors[errors.size() * 99 / 100];
    profile.most_error = errors.back();
  }

  const Tape& tape_;
  double diagonal_;
  Queries queries_;
  Execution execution_;
  CollideResult reference_;
};

}  // namespace

std::vector<DescentProfile> profile_descents(const Tape& tape, const std::vector<float>& triangles,
                                             const ProbeOffset& offset, const Globals& globals) {
  const Contest contest(tape, triangles, globals);
  std::vector<DescentProfile> profiles;
  for (const MethodRow& row : method_table()) {
    if (!takes_gradients(row)) continue;
    for (const Gradient strategy : strategies_of(tape.dimension)) {
      profiles.push_back(contest.profile(row.method, strategy, offset));
    }
  }
  return profiles;
}

}  // namespace thalweg::cli
