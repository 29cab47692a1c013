// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What batches of pairs have in common, whatever is asked of them: workers' memory, columns that the summary needs and
// the caller does not, which rows are answered together, and the summary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "solve/pairs/pair_tile.h"
#include "thalweg/batch.h"

namespace thalweg {

/// A batch, and how some rows of it are answered.
class PairBatch {
 public:
  PairTile all;          ///< every row
  std::size_t tile = 1;  ///< rows answered together, where no order says otherwise
  /// It looks for the shapes' nearest points, as far from one another as they may be; otherwise for common points.
  bool measures = false;
  const std::uint8_t* status = nullptr;  ///< what was written, for the summary
  const std::uint32_t* evaluations = nullptr;

  virtual ~PairBatch() = default;
  virtual void answer(const PairTile& rows, PairScratch& scratch) const = 0;
};

/// What a batch leaves for the next one.
struct PairMemory {
  std::vector<std::unique_ptr<PairScratch>> workers;
  // Columns that the caller does not ask for.
  std::vector<std::uint8_t> status;
  std::vector<std::uint32_t> evaluations;
  std::vector<float> point, contact_point;
  std::vector<std::uint32_t> by_shapes;  ///< rows of the same two shapes one after the other
  std::vector<std::uint32_t> unordered;  ///< those that are not near a long tape
  // Of rows in spatial order.
  std::vector<std::vector<std::uint32_t>> parts;  ///< per worker
  std::vector<float> corners, middles, values;

  /// A worker's scratch.
  [[nodiscard]] PairScratch& worker(std::size_t index) {
    if (workers[index] == nullptr) workers[index] = std::make_unique<PairScratch>();
    return *workers[index];
  }
};

/// Answers all rows.
[[nodiscard]] Summary run_pairs(const PairBatch& batch, PairMemory& memory, const Execution& execution);

}  // namespace thalweg
