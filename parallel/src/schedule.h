// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Runs tiles on the worker threads. The one place that knows oneTBB.
#pragma once

#include <cstddef>

#include "thalweg/batch.h"

namespace thalweg {

/// Something that can be done to the rows [begin, end) by one worker at a time; `worker` is below worker_count().
class TileTask {
 public:
  virtual ~TileTask() = default;
  virtual void run(std::size_t begin, std::size_t end, std::size_t worker) = 0;
};

/// How many workers may run at once, for scratch memory.
[[nodiscard]] std::size_t worker_count(const Execution& execution);

/// Cuts `count` rows into tiles and runs them all; returns false if it was cancelled. One virtual call per tile.
bool schedule(TileTask& task, std::size_t count, std::size_t tile, const Execution& execution);

/// Calls body(begin, end, worker) until all rows are done: neither counted nor cut short, for what comes before rows
/// are answered.
template <class Body>
void prepare_rows(std::size_t count, std::size_t tile, const Execution& execution, const Body& body) {
  struct Task final : TileTask {
    explicit Task(const Body& each) : body(each) {}
    void run(std::size_t begin, std::size_t end, std::size_t worker) override { body(begin, end, worker); }
    const Body& body;
  } task(body);
  Execution all = execution;
  all.done = nullptr;
  all.cancelled = nullptr;
  schedule(task, count, tile, all);
}

}  // namespace thalweg
