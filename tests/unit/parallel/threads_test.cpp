// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What a batch takes of the machine: the caller's arena and no more, one pool for any number of callers, and no pool
// at all for one thread. Threads are counted where the kernel lists them.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "schedule.h"
#include "thalweg/ops.h"

namespace thalweg {
namespace {

std::size_t threads_of_process() {
  const std::filesystem::directory_iterator listing("/proc/self/task");
  return static_cast<std::size_t>(std::distance(begin(listing), end(listing)));
}

std::size_t cores() { return static_cast<std::size_t>(tbb::info::default_concurrency()); }

/// Tiles long enough for every thread that wants one to come; notes who ran them and how many at once.
class Watch final : public TileTask {
 public:
  void run(std::size_t, std::size_t, std::size_t worker) override {
    const std::size_t running = ++running_;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    const std::scoped_lock lock(mutex_);
    most_running_ = std::max(most_running_, running);
    most_threads_ = std::max(most_threads_, threads_of_process());
    highest_worker_ = std::max(highest_worker_, worker);
    ran_.insert(std::this_thread::get_id());
    --running_;
  }
  [[nodiscard]] std::size_t most_running() const { return most_running_; }
  [[nodiscard]] std::size_t most_threads() const { return most_threads_; }
  [[nodiscard]] std::size_t highest_worker() const { return highest_worker_; }
  [[nodiscard]] const std::set<std::thread::id>& ran() const { return ran_; }

 private:
  std::atomic<std::size_t> running_{0};
  std::mutex mutex_;
  std::size_t most_running_ = 0, most_threads_ = 0, highest_worker_ = 0;
  std::set<std::thread::id> ran_;
};

/// Every batch query, then the process ends with its number of threads as exit code.
void query_and_exit(int threads) {
  const Tape tape = std::move(compile(star(3, 5, 3))).value();
  const Execution execution{.threads = threads, .tile = 16};
  const std::vector<float> rows(6 * 4096, 0.5F);
  std::vector<float> value(4096);
  bool complete = !collide_triangles(tape, {rows.data(), 4096}, {}, {}, execution)->cancelled;
  complete &= !collide_circles(tape, {rows.data(), 4096}, {}, {}, execution)->cancelled;
  complete &= evaluate(tape, rows.data(), 4096, value.data(), nullptr, execution) == 0;
  Watch slow;
  complete &= schedule(slow, 1000, 10, execution);
  std::exit(complete ? static_cast<int>(threads_of_process()) : 0);
}

// In a process of its own: another test may have started the pool of this one.
TEST(OneThreadDeathTest, StartsNoPool) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(query_and_exit(1), testing::ExitedWithCode(1), "");
  if (cores() == 1) GTEST_SKIP() << "one core has no pool";
  const auto with_a_pool = [](int status) { return WIFEXITED(status) && WEXITSTATUS(status) > 1; };
  EXPECT_EXIT(query_and_exit(2), with_a_pool, "") << "the count does not see a pool";
}

TEST(ManyCallers, ShareOnePool) {
  constexpr std::size_t kCallers = 8;
  Watch task;
  std::vector<std::thread> callers;
  callers.reserve(kCallers);
  const std::size_t before = threads_of_process();
  for (std::size_t caller = 0; caller < kCallers; ++caller) {
    callers.emplace_back([&task, caller] {
      for (std::size_t turn = 0; turn < 6; ++turn) {
        const int threads = std::array{0, 2, 5}[(caller + turn) % 3];
        EXPECT_TRUE(schedule(task, 160, 10, {.threads = threads}));
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_LE(task.most_threads(), before + kCallers + cores() - 1);
  EXPECT_LE(task.most_running(), kCallers + cores() - 1);
}

/// Notes who enters an arena.
class Visitors final : public tbb::task_scheduler_observer {
 public:
  explicit Visitors(tbb::task_arena& arena) : tbb::task_scheduler_observer(arena) { observe(true); }
  ~Visitors() override { observe(false); }
  void on_scheduler_entry(bool) override {
    const std::scoped_lock lock(mutex_);
    entered_.insert(std::this_thread::get_id());
  }
  [[nodiscard]] bool include(const std::set<std::thread::id>& threads) {
    const std::scoped_lock lock(mutex_);
    return std::includes(entered_.begin(), entered_.end(), threads.begin(), threads.end());
  }

 private:
  std::mutex mutex_;
  std::set<std::thread::id> entered_;
};

TEST(ArenaOfTheCaller, IsWhereTilesRun) {
  for (const int size : {1, 2}) {
    tbb::task_arena arena(std::min(size, tbb::info::default_concurrency()));
    arena.initialize();
    Visitors visitors(arena);
    Watch task;
    arena.execute([&task] {
      EXPECT_LE(worker_count({}), static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
      EXPECT_TRUE(schedule(task, 400, 10, {}));
    });
    EXPECT_TRUE(visitors.include(task.ran())) << size;
    EXPECT_LE(task.most_running(), static_cast<std::size_t>(size));
    EXPECT_LT(task.highest_worker(), static_cast<std::size_t>(size));
  }
}

TEST(ArenaOfTheCaller, OfOneThreadKeepsTheBatchOnThatThread) {
  tbb::task_arena arena(1);
  Watch task;
  std::thread::id caller;
  arena.execute([&] {
    caller = std::this_thread::get_id();
    EXPECT_TRUE(schedule(task, 400, 10, {}));
  });
  EXPECT_EQ(task.ran(), std::set{caller});
}

TEST(GlobalLimitOfTheCaller, IsHonouredWhateverABatchAsksFor) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  for (const int threads : {0, 2, 5}) {
    Watch task;
    EXPECT_TRUE(schedule(task, 400, 10, {.threads = threads}));
    EXPECT_EQ(task.ran(), std::set{std::this_thread::get_id()}) << threads;
  }
}

}  // namespace
}  // namespace thalweg
