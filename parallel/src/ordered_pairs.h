// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Pairs of the same two shapes, one of them with a long tape: rows are taken in the order of where they meet it, and
// answered a few neighbours at a time with a tape shortened for there (ordered_batch.h). A search may leave that place,
// so what it was shortened for goes with the tape (solve/pairs/stand_in.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "ordered_batch.h"
#include "pair_batch.h"
#include "solve/pairs/problem.h"

namespace thalweg {

class OrderedPairs final : public OrderedBatch::Answer {
 public:
  OrderedPairs(const PairBatch& batch, const PairShapes& shapes, std::span<const std::uint32_t> rows,
               PairMemory& memory);

  [[nodiscard]] bool pays() const { return side_.has_value(); }
  /// Where it pays. Returns false if it was cancelled.
  bool run(const Execution& execution);

  void answer(const OrderedBatch::Part& part) override;

 private:
  [[nodiscard]] const Tape& tape() const;
  /// Boxes, in the frame of the long tape's shape, that hold most of what rows evaluate.
  void find_boxes(const Execution& execution);
  void find_boxes(std::size_t begin, std::size_t end);

  const PairBatch& batch_;
  PairShapes shapes_;
  std::span<const std::uint32_t> rows_;
  PairMemory& memory_;
  std::optional<std::size_t> side_;  ///< of the pair, 0 or 1, that has the tape to be shortened
  RowLayout layout_;
};

}  // namespace thalweg
