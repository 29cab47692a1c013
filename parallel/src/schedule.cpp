// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The caller's arena is used as it is; a thread limit makes an arena of its own inside. One thread runs on the caller
// without touching the pool.
#include "schedule.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace thalweg {
namespace {

bool run_tiles(TileTask& task, std::size_t begin, std::size_t end, std::size_t worker, const Execution& execution) {
  if (execution.cancelled != nullptr && execution.cancelled->load(std::memory_order_relaxed)) return false;
  task.run(begin, end, worker);
  if (execution.done != nullptr) execution.done->fetch_add(end - begin, std::memory_order_relaxed);
  return true;
}

struct Batch {
  TileTask& task;
  std::size_t count = 0, tile = 0;
  const Execution& execution;
  /// Tiles that ran. Its order says to the thread sanitizer what oneTBB, not instrumented as distributed, sees to by
  /// itself: the caller's writes come before every tile, one use of a worker's scratch before the next, and every tile
  /// before the return.
  std::atomic<std::size_t> finished{0};
};

void run_range(Batch& batch, std::size_t first, std::size_t last) {
  static_cast<void>(batch.finished.load(std::memory_order_acquire));
  const auto worker = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
  std::size_t ran = 0;
  for (std::size_t i = first; i != last; ++i) {
    const std::size_t begin = i * batch.tile;
    if (run_tiles(batch.task, begin, std::min(begin + batch.tile, batch.count), worker, batch.execution)) ++ran;
  }
  batch.finished.fetch_add(ran, std::memory_order_acq_rel);
}

bool run_in_arena(TileTask& task, std::size_t count, std::size_t tile, const Execution& execution) {
  Batch batch{.task = task, .count = count, .tile = tile, .execution = execution};
  const std::size_t tiles = (count + tile - 1) / tile;
  batch.finished.store(0, std::memory_order_release);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, tiles, 1),
      [&batch](const tbb::blocked_range<std::size_t>& range) { run_range(batch, range.begin(), range.end()); },
      tbb::auto_partitioner());
  return batch.finished.load(std::memory_order_acquire) == tiles;
}

}  // namespace

std::size_t worker_count(const Execution& execution) {
  if (execution.threads == 1) return 1;
  const int most = execution.threads == 0 ? tbb::this_task_arena::max_concurrency() : execution.threads;
  return static_cast<std::size_t>(std::max(most, 1));
}

bool schedule(TileTask& task, std::size_t count, std::size_t tile, const Execution& execution) {
  if (execution.threads == 1 || count <= tile) {
    bool complete = true;
    for (std::size_t begin = 0; begin < count; begin += tile) {
      complete = run_tiles(task, begin, std::min(begin + tile, count), 0, execution) && complete;
    }
    return complete;
  }
  if (execution.threads == 0) return run_in_arena(task, count, tile, execution);
  // More threads than cores would not run, and oneTBB would say so on stderr.
  tbb::task_arena arena(std::min(execution.threads, tbb::info::default_concurrency()));
  return arena.execute([&] { return run_in_arena(task, count, tile, execution); });
}

}  // namespace thalweg
