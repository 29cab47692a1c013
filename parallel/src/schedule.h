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

}  // namespace thalweg
