// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One hash per query kind, whatever the number of threads, the tile size and the SIMD target with fused multiply-add.
#include "golden.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <ostream>
#include <string>

#include "thalweg/simd.h"
#include "workload.h"

namespace thalweg::determinism {

std::ostream& operator<<(std::ostream& out, const Golden& golden) { return out << golden.workload; }

namespace {

std::string hex(std::uint64_t hash) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(hash));
  return text;
}

class GoldenHash : public testing::TestWithParam<Golden> {};

TEST_P(GoldenHash, IsTheSameOnEveryTargetWithFusedMultiplyAddAndOnEveryOther) {
  const Workload workload(GetParam().workload);
  // What golden.h would have to say: the best target of each sort.
  std::string row[2] = {hex(GetParam().fused), hex(GetParam().unfused)};
  bool seen[2] = {};
  for (const Target& target : targets()) {
    const int sort = target.fused_multiply_add ? 0 : 1;
    const std::string found = hex(workload.run({.threads = 1, .target = &target}));
    EXPECT_EQ(found, hex(sort == 0 ? GetParam().fused : GetParam().unfused)) << target.name;
    if (!seen[sort]) row[sort] = found;
    seen[sort] = true;
  }
  if (!HasFailure()) return;
  std::printf("golden.h, with a line in CHANGELOG.md:\n    {\"%s\", %s, %s},\n",
              std::string(GetParam().workload).c_str(), row[0].c_str(), row[1].c_str());
}

TEST_P(GoldenHash, IsTheSameForEveryNumberOfThreadsAndTileSize) {
  const Workload workload(GetParam().workload);
  const Target& best = targets().front();
  const std::string expected = hex(workload.run({.threads = 1, .target = &best}));
  for (const int threads : {1, 2, 5, 0}) {
    for (const std::size_t tile : {1U, 7U, 64U, 1000U, 0U}) {
      const Execution execution{.threads = threads, .tile = tile, .target = &best};
      EXPECT_EQ(hex(workload.run(execution)), expected) << threads << " threads, tiles of " << tile;
    }
  }
  for (const Target& target : targets()) {
    const std::string own = hex(workload.run({.threads = 1, .target = &target}));
    EXPECT_EQ(hex(workload.run({.threads = 5, .tile = 7, .target = &target})), own) << target.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Workloads, GoldenHash, testing::ValuesIn(kGolden),
                         [](const auto& golden) { return std::string(golden.param.workload); });

TEST(FusedAndUnfusedTargets, DifferSoThatTheirHashesSaySomething) {
  for (const Golden& golden : kGolden) EXPECT_NE(golden.fused, golden.unfused) << golden.workload;
}

TEST(Hash, IsFnv1a) {
  Hash hash;
  EXPECT_EQ(hex(hash.value()), "0xcbf29ce484222325");
  hash.add("foobar", 6);
  EXPECT_EQ(hex(hash.value()), "0x85944171f73967e8");
}

}  // namespace
}  // namespace thalweg::determinism
