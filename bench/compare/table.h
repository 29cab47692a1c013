// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The measurements as Markdown, and the sums over all scenes that decide who beats whom.
#pragma once

#include <string>
#include <vector>

#include "measure.h"

namespace thalweg::bench {

[[nodiscard]] std::string scene_table(const CompareCase& work, const std::vector<Contender>& all,
                                      const std::vector<Measurement>& measured);

/// Sums over scenes, contender by contender; every scene has the same ones in the same order.
class Totals {
 public:
  void add(const std::vector<Contender>& all, const std::vector<Measurement>& measured);
  [[nodiscard]] std::string table() const;
  /// Published methods with fewer misses or no more evaluations than `accelerated` for the same triangles; its worse
  /// goal counts.
  [[nodiscard]] std::string who_beats_accelerated() const;

 private:
  std::vector<Contender> contenders_;
  std::vector<Measurement> sums_;
  std::size_t scenes_ = 0;
};

}  // namespace thalweg::bench
