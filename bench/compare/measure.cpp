// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "measure.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "thalweg/batch.h"

namespace thalweg::bench {
namespace {

struct Answers {
  std::vector<std::uint8_t> status, claimed;
  std::vector<float> value;
  std::vector<std::uint32_t> evaluations;

  explicit Answers(std::size_t count) : status(count), claimed(count), value(count), evaluations(count) {}
};

void run(const CompareCase& work, const Contender& contender, Answers& answers) {
  CollideColumns columns;
  columns.status = answers.status.data();
  columns.claimed = answers.claimed.data();
  columns.value = answers.value.data();
  columns.evaluations = answers.evaluations.data();
  const Execution execution{.threads = 1};
  const auto summary =
      collide_triangles(work.tape, {work.rows.data(), work.count()}, contender.options, columns, execution);
  if (!summary) throw std::runtime_error(contender.name + ": " + to_string(summary.error()));
}

Measurement judge(const CompareCase& work, const Contender& contender, const Answers& answers) {
  Measurement m;
  m.rows = work.count();
  m.hits = work.hits();
  const bool proves = method_row(contender.options.method).proves;
  std::vector<double> errors;
  std::uint64_t evaluations = 0;
  for (std::size_t i = 0; i < work.count(); ++i) {
    const bool reported = proves ? answers.status[i] == 1 : answers.claimed[i] == 1;
    m.misses += work.verdicts[i] == oracle::Verdict::overlapping && !reported ? 1U : 0U;
    m.false_reports += work.verdicts[i] == oracle::Verdict::separated && reported ? 1U : 0U;
    m.undecided += proves && answers.status[i] == 3 ? 1U : 0U;
    errors.push_back(std::max(0.0, static_cast<double>(answers.value[i]) - work.truth[i].upper) / work.diagonal);
    evaluations += answers.evaluations[i];
  }
  std::sort(errors.begin(), errors.end());
  for (const double error : errors) m.mean_error += error / static_cast<double>(errors.size());
  m.p99_error = errors[errors.size() * 99 / 100];
  m.most_error = errors.back();
  m.evaluations = static_cast<double>(evaluations) / static_cast<double>(work.count());
  return m;
}

Contender contender_of(const MethodRow& row, Goal goal, const CompareCase& work) {
  Contender made{.name = std::string(row.name), .options = {}};
  made.options.method = row.method;
  made.options.goal = goal;
  const bool flat = work.tape.dimension == 2;
  if (!flat && row.gradient == Gradient::dichotomy_verbatim) {
    made.options.gradient = Gradient::autodiff;
    made.options.gradient_given = true;
  }
  // The published constants are pixels of a picture whose shape has this diagonal.
  constexpr double kPublishedDiagonal = 960;
  const double scale = work.scene.file == "small" ? 1 : work.diagonal / kPublishedDiagonal;
  if (row.floor > 0) made.options.floor = row.floor * scale;
  if (row.method == Method::thesis_fixed) made.options.step = row.step * scale;
  return made;
}

}  // namespace

std::vector<Contender> contenders(const CompareCase& work) {
  std::vector<Contender> all;
  for (const MethodRow& row : method_table()) {
    if (!row.triangles) continue;
    const bool ours = row.method == Method::certified || row.method == Method::accelerated;
    all.push_back(contender_of(row, Goal::verdict, work));
    if (!ours) continue;
    all.back().name += ", verdict";
    all.back().is_ours = true;
    all.push_back(contender_of(row, Goal::deepest, work));
    all.back().name += ", deepest";
    all.back().is_ours = true;
  }
  return all;
}

std::vector<Measurement> measure(const CompareCase& work, const std::vector<Contender>& all, std::size_t rounds) {
  std::vector<Measurement> measured;
  std::vector<std::vector<double>> times(all.size());
  Answers answers(work.count());
  for (const Contender& contender : all) {
    run(work, contender, answers);
    measured.push_back(judge(work, contender, answers));
  }
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto start = std::chrono::steady_clock::now();
      run(work, all[i], answers);
      const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
      times[i].push_back(spent.count() / static_cast<double>(work.count()));
    }
  }
  for (std::size_t i = 0; i < all.size() && rounds > 0; ++i) {
    std::sort(times[i].begin(), times[i].end());
    measured[i].nanoseconds = times[i][rounds / 2];
  }
  return measured;
}

}  // namespace thalweg::bench
