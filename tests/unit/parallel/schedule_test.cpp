// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "schedule.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace thalweg {
namespace {

/// Notes which rows were run, by which worker, and whether a worker was ever two places at once.
class Recorder final : public TileTask {
 public:
  Recorder(std::size_t rows, std::size_t workers, std::size_t tile)
      : runs_(rows), busy_(workers), tile_(tile), owner_(std::this_thread::get_id()) {}

  void run(std::size_t begin, std::size_t end, std::size_t worker) override {
    if (worker >= busy_.size() || begin >= end || end > runs_.size() || end - begin > tile_) {
      ++faults_;
      return;
    }
    if (busy_[worker].exchange(true)) ++faults_;
    for (std::size_t row = begin; row < end; ++row) ++runs_[row];
    if (std::this_thread::get_id() != owner_) ++elsewhere_;
    busy_[worker] = false;
  }

  [[nodiscard]] bool every_row_once() const {
    for (const auto& runs : runs_) {
      if (runs != 1) return false;
    }
    return true;
  }
  [[nodiscard]] int faults() const { return faults_; }
  [[nodiscard]] int elsewhere() const { return elsewhere_; }

 private:
  std::vector<std::atomic<int>> runs_;
  std::vector<std::atomic<bool>> busy_;
  std::size_t tile_;
  std::thread::id owner_;
  std::atomic<int> faults_{0};
  std::atomic<int> elsewhere_{0};
};

TEST(Schedule, RunsEveryRowOnceForAnyThreadsAndTiles) {
  for (const int threads : {0, 1, 2, 5}) {
    for (const std::size_t rows : {0U, 1U, 63U, 64U, 65U, 1000U}) {
      for (const std::size_t tile : {1U, 7U, 64U, 2000U}) {
        const Execution execution{.threads = threads};
        Recorder task(rows, worker_count(execution), tile);
        EXPECT_TRUE(schedule(task, rows, tile, execution));
        EXPECT_TRUE(task.every_row_once()) << threads << ' ' << rows << ' ' << tile;
        EXPECT_EQ(task.faults(), 0) << threads << ' ' << rows << ' ' << tile;
      }
    }
  }
}

TEST(Schedule, StaysOnTheCallingThreadWhenAskedForOne) {
  Recorder task(1000, 1, 10);
  EXPECT_TRUE(schedule(task, 1000, 10, {.threads = 1}));
  EXPECT_EQ(task.elsewhere(), 0);
}

TEST(WorkerCount, IsOneForOneThreadAndAtLeastOneForAny) {
  EXPECT_EQ(worker_count({.threads = 1}), 1U);
  EXPECT_EQ(worker_count({.threads = 5}), 5U);
  EXPECT_GE(worker_count({.threads = 0}), 1U);
  EXPECT_GE(worker_count({.threads = -3}), 1U);
}

TEST(Schedule, LeavesOutTilesOnceCancelled) {
  class CancelAfterThree final : public TileTask {
   public:
    void run(std::size_t, std::size_t, std::size_t) override {
      if (++tiles == 3) cancelled = true;
    }
    std::atomic<bool> cancelled{false};
    int tiles = 0;
  } task;
  std::atomic<std::size_t> done{0};
  EXPECT_FALSE(schedule(task, 100, 10, {.threads = 1, .done = &done, .cancelled = &task.cancelled}));
  EXPECT_EQ(task.tiles, 3);
  EXPECT_EQ(done, 30U);
}

}  // namespace
}  // namespace thalweg
