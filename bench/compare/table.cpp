// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "table.h"

#include <algorithm>
#include <cstdio>

namespace thalweg::bench {
namespace {

constexpr const char* kHeader =
    "| method | misses | false | mean error | p99 error | worst error | evaluations | ns |\n"
    "|---|---:|---:|---:|---:|---:|---:|---:|\n";

/// Parts of the diagonal; what the oracle cannot resolve is 0.
std::string error_text(double error) {
  if (error < 1e-7) return "0";
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", error);
  return text;
}

std::string line(const std::string& name, const Measurement& m) {
  char text[256];
  std::snprintf(text, sizeof text, "| %s | %zu | %zu | %s | %s | %s | %.1f | %.0f |\n", name.c_str(), m.misses,
                m.false_reports, error_text(m.mean_error).c_str(), error_text(m.p99_error).c_str(),
                error_text(m.most_error).c_str(), m.evaluations, m.nanoseconds);
  return text;
}

}  // namespace

std::string scene_table(const CompareCase& work, const std::vector<Contender>& all,
                        const std::vector<Measurement>& measured) {
  std::string text = "### " + std::string(work.scene.title) + "\n\n`bench/scenes/" + std::string(work.scene.file) +
                     ".json`, " + std::to_string(work.hits()) + " of " + std::to_string(work.count()) +
                     " triangles overlap.\n\n" + kHeader;
  for (std::size_t i = 0; i < all.size(); ++i) text += line("`" + all[i].name + "`", measured[i]);
  return text + "\n";
}

void Totals::add(const std::vector<Contender>& all, const std::vector<Measurement>& measured) {
  if (sums_.empty()) {
    contenders_ = all;
    sums_.resize(all.size());
  }
  ++scenes_;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Measurement& sum = sums_[i];
    const Measurement& m = measured[i];
    sum.rows += m.rows;
    sum.hits += m.hits;
    sum.misses += m.misses;
    sum.false_reports += m.false_reports;
    sum.mean_error += m.mean_error;
    sum.p99_error = std::max(sum.p99_error, m.p99_error);
    sum.most_error = std::max(sum.most_error, m.most_error);
    sum.evaluations += m.evaluations;
    sum.nanoseconds += m.nanoseconds;
  }
}

std::string Totals::table() const {
  std::string text = "### All scenes\n\n" + std::to_string(scenes_) + " scenes, " + std::to_string(sums_[0].rows) +
                     " triangles, " + std::to_string(sums_[0].hits) +
                     " of them overlapping. Misses and false reports are sums, p99 and worst error the worst of a "
                     "scene, the others means over the scenes.\n\n" +
                     kHeader;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    Measurement m = sums_[i];
    m.mean_error /= static_cast<double>(scenes_);
    m.evaluations /= static_cast<double>(scenes_);
    m.nanoseconds /= static_cast<double>(scenes_);
    text += line("`" + contenders_[i].name + "`", m);
  }
  return text + "\n";
}

std::string Totals::who_beats_accelerated() const {
  std::size_t misses = 0;
  double evaluations = 0;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (contenders_[i].options.method != Method::accelerated) continue;
    misses = std::max(misses, sums_[i].misses);
    evaluations = std::max(evaluations, sums_[i].evaluations);
  }
  std::string names;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (contenders_[i].is_ours) continue;
    if (sums_[i].misses < misses || sums_[i].evaluations <= evaluations) {
      names.append(names.empty() ? "" : ", ").append(contenders_[i].name);
    }
  }
  return names;
}

}  // namespace thalweg::bench
