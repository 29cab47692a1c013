// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batch queries from many threads of the caller at once, on one tape: the same answers as alone.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "golden.h"
#include "workload.h"

namespace thalweg::determinism {
namespace {

TEST(BatchQueries, GiveTheSameAnswersFromManyThreadsAtOnce) {
  static constexpr std::string_view kNames[] = {"triangles2_verdict", "triangles3_projected", "circles2_deepest",
                                                "eval3_autodiff", "grid3_all"};
  std::vector<std::unique_ptr<Workload>> workloads;
  std::vector<std::uint64_t> expected;
  for (const std::string_view name : kNames) {
    workloads.push_back(std::make_unique<Workload>(name));
    expected.push_back(workloads.back()->run({.threads = 1}));
  }
  std::atomic<int> wrong{0};
  std::vector<std::thread> callers;
  callers.reserve(8);
  for (std::size_t caller = 0; caller < 8; ++caller) {
    callers.emplace_back([&, caller] {
      for (std::size_t turn = 0; turn < 6; ++turn) {
        const std::size_t which = (caller + turn) % workloads.size();
        const Execution execution{.threads = static_cast<int>((caller + turn) % 3), .tile = 50 + 97 * turn};
        if (workloads[which]->run(execution) != expected[which]) ++wrong;
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(wrong, 0);
}

TEST(BatchQueries, CompileTheSameTapeFromManyThreadsAtOnce) {
  const Workload first("triangles2_verdict");
  std::atomic<int> wrong{0};
  std::vector<std::thread> callers;
  callers.reserve(8);
  for (int caller = 0; caller < 8; ++caller) {
    callers.emplace_back([&] {
      const Workload own("triangles2_verdict");
      if (own.tape().disassembly() != first.tape().disassembly() || own.tape().constants != first.tape().constants) {
        ++wrong;
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Cancellation, LeavesOutTilesAndSaysSo) {
  const Workload workload("triangles2_verdict");
  const std::vector<float> rows(6 * 100, 1.0F);
  std::vector<std::uint8_t> status(100, 77);
  CollideColumns columns;
  columns.status = status.data();
  const std::atomic<bool> cancelled{true};
  std::atomic<std::size_t> done{0};
  for (const int threads : {1, 2}) {
    const Execution execution{.threads = threads, .tile = 10, .done = &done, .cancelled = &cancelled};
    const auto summary = collide_triangles(workload.tape(), {rows.data(), 100}, {}, columns, execution);
    ASSERT_TRUE(summary);
    EXPECT_TRUE(summary->cancelled);
    EXPECT_EQ(summary->rows, 0U);
    EXPECT_EQ(done, 0U);
    EXPECT_EQ(status, std::vector<std::uint8_t>(100, 77));
  }
}

TEST(Progress, CountsEveryRow) {
  const Workload workload("triangles2_verdict");
  const std::vector<float> rows(6 * 1003, 1.0F);
  for (const int threads : {1, 3}) {
    std::atomic<std::size_t> done{0};
    const Execution execution{.threads = threads, .tile = 100, .done = &done};
    const auto summary = collide_triangles(workload.tape(), {rows.data(), 1003}, {}, {}, execution);
    ASSERT_TRUE(summary);
    EXPECT_FALSE(summary->cancelled);
    EXPECT_EQ(summary->rows, 1003U);
    EXPECT_EQ(done, 1003U);
  }
}

}  // namespace
}  // namespace thalweg::determinism
