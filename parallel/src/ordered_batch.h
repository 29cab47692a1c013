// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Long tapes: rows are taken in spatial order and answered a few neighbours at a time, by a tape shortened for where
// they lie.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "compile/shorten.h"
#include "gradient/strategies.h"
#include "order.h"
#include "reuse.h"

namespace thalweg {

/// Where a batch evaluates besides the rows themselves.
struct Surroundings {
  bool bounds = false;  ///< it asks bounds over cells as large as the rows
  float sizes = 0;      ///< it goes so many times a row's own size away from it
  ProbeRule probe;      ///< it probes so far around them
};

/// Rows of a part: no more than `most`, unless they share a cell, and where its tape is still long no more than `few`.
/// The sizes are those of queries (measured, growth/primitives).
struct PartSizes {
  std::size_t most = 512;
  std::size_t few = 64;
  bool in_pieces = true;  ///< where its rows lie is looked at piece by piece, by an analysis for each part
};

class OrderedBatch {
 public:
  /// Rows that lie close together, all answered by one worker.
  struct Part {
    const Tape& tape;                      ///< shortened for them
    const float* rows;                     ///< one after the other
    std::span<const std::uint32_t> order;  ///< which of the caller's each of them is
    std::size_t worker;
  };
  class Answer {
   public:
    virtual ~Answer() = default;
    virtual void answer(const Part& part) = 0;
  };

  /// Whether it pays, for queries that ask a tape so often that its length says it, and for single values or gradients.
  [[nodiscard]] static bool suits_queries(const Tape& tape, std::size_t count, std::size_t least_count);
  [[nodiscard]] static bool suits_points(const Tape& tape, std::size_t count, bool with_gradient);

  OrderedBatch(const Tape& tape, const RowLayout& layout, const float* rows, std::size_t count,
               const Surroundings& surroundings, const Execution& execution, PartSizes sizes = {});
  ~OrderedBatch();
  OrderedBatch(const OrderedBatch&) = delete;
  OrderedBatch& operator=(const OrderedBatch&) = delete;
  /// Returns false if it was cancelled.
  bool run(Answer& answer);

 private:
  /// 2^level cells along the curve and their rows.
  struct Run {
    std::size_t first_cell = 0;
    int level = 0;
    std::uint32_t begin = 0, end = 0;
    [[nodiscard]] std::size_t count() const { return end - begin; }
  };
  struct Worker;
  struct Memory;
  struct Shorten;
  struct Solve;

  [[nodiscard]] Run run_of(std::size_t first_cell, int level) const;
  /// Leaves a run with the first part of its rows and adds one with the others; a single cell stays as it is.
  void halve(Run& run, std::vector<Run>& into) const;
  void cut_into_tasks();
  void shorten(std::size_t begin, std::size_t end, std::size_t worker);
  void solve(std::size_t task, std::size_t worker, Answer& answer);
  void gather(const Run& run, Worker& worker) const;
  void solve_run(const Run& run, const Run& task, const Tape& tape, std::size_t depth, std::size_t worker,
                 Answer& answer);
  void answer_run(const Run& run, const Run& task, const Tape& tape, std::size_t worker, Answer& answer);
  const Tape& shortened_by_pieces(const Run& run, const Run& task, const Tape& tape, Worker& worker) const;
  [[nodiscard]] Region region_of(const Extent& extent) const;
  [[nodiscard]] Region region_of(const Run& run, const Run& task, const Worker& worker) const;
  void widen_by_probes(const Tape& tape, std::vector<Region>& regions, Arena& arena) const;
  Worker& worker(std::size_t index);

  const Tape& tape_;
  RowLayout layout_;
  const float* rows_;
  Surroundings surroundings_;
  const Execution& execution_;
  const Kernels& kernels_;
  PartSizes sizes_;
  std::size_t first_ = 0;  ///< of the tasks whose tapes are held
  Reused<Memory> memory_;
};

}  // namespace thalweg
