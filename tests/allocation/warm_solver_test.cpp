// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A solver that has seen a tile of its size before allocates nothing. The program's operator new counts, which is why
// this is a program of its own.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <ostream>
#include <string>
#include <vector>

#include "random.h"
#include "solve/pairs/local.h"
#include "solve/plan.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"
#include "thalweg/simd.h"

namespace {

std::atomic<bool> counting{false};
std::atomic<std::size_t> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  if (counting) ++allocations;
  void* memory = nullptr;
  if (posix_memalign(&memory, alignment < sizeof(void*) ? sizeof(void*) : alignment, size) != 0) throw std::bad_alloc();
  return memory;
}

}  // namespace

// The other forms of the standard end in these.
void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace thalweg {
namespace {

/// How many allocations `work` makes.
template <class Work>
std::size_t allocations_of(Work work) {
  allocations = 0;
  counting = true;
  work();
  counting = false;
  return allocations;
}

constexpr std::size_t kRows = 512;

/// A tile with all columns, at places where float32, double and the whole budget come into play.
struct Bench {
  Tape tape;
  SolveLimits limits;
  std::vector<float> rows;
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(5 * kRows);
  std::vector<std::uint32_t> numbers = std::vector<std::uint32_t>(3 * kRows);
  std::vector<float> floats = std::vector<float>(11 * kRows);

  Bench(const Shape& shape, QueryKind kind, const CollideOptions& options) {
    tape = std::move(compile(shape)).value();
    limits = *plan(tape, kind, options);
    oracle::Random random(5);
    const int d = tape.dimension;
    for (std::size_t i = 0; i < kRows; ++i) {
      const double centre[3] = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
      const int corners = kind == QueryKind::triangles ? 3 : 1;
      const double size = i % 5 == 0 ? 1e-6 : 0.7;
      for (int corner = 0; corner < corners; ++corner) {
        for (int axis = 0; axis < d; ++axis) {
          rows.push_back(static_cast<float>(centre[axis] + random.uniform(-size, size)));
        }
      }
      if (corners == 1) rows.push_back(static_cast<float>(random.uniform(0, 1)));
    }
    // Flush with the surface y = 1, or nearly: these end in double.
    for (std::size_t i = 0; i < 40; ++i) {
      const auto width = static_cast<std::size_t>(kind == QueryKind::triangles ? 3 * d : d + 1);
      float* row = rows.data() + i * width;
      if (kind == QueryKind::triangles) {
        for (int corner = 0; corner < 3; ++corner) row[corner * d + 1] = 1 + static_cast<float>(i) * 1e-8F;
      } else {
        row[d] = 0.5F;
        row[1] = 1.5F + static_cast<float>(i) * 1e-8F;
      }
    }
  }

  template <class Tile>
  Tile tile(const Target& target) {
    Tile made;
    made.tape = &tape;
    made.kernels = target.kernels;
    made.limits = &limits;
    made.rows = rows.data();
    made.count = kRows;
    const auto byte = [&](std::size_t i) { return bytes.data() + i * kRows; };
    const auto number = [&](std::size_t i) { return numbers.data() + i * kRows; };
    made.columns.status = byte(0), made.columns.converged = byte(1);
    made.columns.claimed = byte(2), made.columns.ambiguous = byte(3), made.columns.stop = byte(4);
    made.columns.starts = number(0), made.columns.iterations = number(1), made.columns.evaluations = number(2);
    made.columns.value = floats.data(), made.columns.lower = floats.data() + kRows;
    made.columns.point = floats.data() + 2 * kRows, made.columns.normal = floats.data() + 5 * kRows;
    made.columns.barycentric = floats.data() + 8 * kRows;
    return made;
  }
};

Shape flat_and_round() {
  return smooth_union(0.1, {box(Vec2{2, 1}), onion(circle(1), 0.1).translate(Vec2{2, 1}), star(2, 7, 3).rotate(0.3)});
}
Shape solid() { return (box(Vec3{2, 1, 2}) - sphere(0.8)) | torus(2, 0.3).rotate(Vec3{1, 0, 0}, 0.4); }

struct Request {
  const char* name;
  Method method;
  Goal goal;
};
std::ostream& operator<<(std::ostream& out, const Request& request) { return out << request.name; }

class WarmSolver : public testing::TestWithParam<Request> {
 protected:
  template <class Tile>
  static void check(const Shape& shape, QueryKind kind) {
    CollideOptions options;
    options.method = GetParam().method, options.goal = GetParam().goal;
    options.budget = 1024;
    if (kind == QueryKind::triangles) options.contacts = 4, options.margin = 0.1;
    Bench bench(shape, kind, options);
    for (const Target& target : targets()) {
      const Tile tile = bench.tile<Tile>(target);
      TileScratch scratch(bench.tape);
      EXPECT_GT(allocations_of([&] { solve(tile, scratch); }), 0U) << "the counter does not count";
      // The second call joins what the first one took in pieces.
      solve(tile, scratch);
      EXPECT_EQ(allocations_of([&] { solve(tile, scratch); }), 0U) << target.name;
    }
  }
};

using WarmTriangleSolver = WarmSolver;
TEST_P(WarmTriangleSolver, AllocatesNothingForTriangles) {
  check<TriangleTile>(flat_and_round(), QueryKind::triangles);
  if (GetParam().method != Method::thesis) check<TriangleTile>(solid(), QueryKind::triangles);
}
INSTANTIATE_TEST_SUITE_P(Triangles, WarmTriangleSolver,
                         testing::Values(Request{"verdict", Method::certified, Goal::verdict},
                                         Request{"deepest", Method::certified, Goal::deepest},
                                         Request{"thesis", Method::thesis, Goal::verdict},
                                         Request{"accelerated", Method::accelerated, Goal::deepest},
                                         Request{"frank_wolfe_search", Method::frank_wolfe_search, Goal::verdict},
                                         Request{"golden_section", Method::golden_section, Goal::verdict},
                                         Request{"projected", Method::projected, Goal::verdict}),
                         [](const auto& request) { return std::string(request.param.name); });

class WarmCircleSolver : public WarmSolver {};
TEST_P(WarmCircleSolver, AllocatesNothingForCircles) {
  check<CircleTile>(flat_and_round(), QueryKind::circles);
  check<CircleTile>(solid(), QueryKind::circles);
}
INSTANTIATE_TEST_SUITE_P(Circles, WarmCircleSolver,
                         testing::Values(Request{"verdict", Method::certified, Goal::verdict},
                                         Request{"deepest", Method::certified, Goal::deepest},
                                         Request{"published", Method::published, Goal::verdict}),
                         [](const auto& request) { return std::string(request.param.name); });

TEST(WarmPairSolver, AllocatesNothing) {
  const Tape tape = std::move(compile(torus(0.35, 0.15))).value();
  const Tape* const shapes[2] = {&tape, &tape};
  oracle::Random random(9);
  std::vector<float> poses;
  for (std::size_t i = 0; i < 7 * kRows; ++i) poses.push_back(static_cast<float>(random.uniform(-0.5, 0.5)));
  // Coincident surfaces spend the budget and go on in double.
  for (std::size_t i = 0; i < 7; ++i) poses[i] = i == 3 ? 1 : 0;
  const PairQueries queries{shapes, 2, poses.data(), nullptr, kRows};
  std::vector<std::uint8_t> status(kRows);
  std::vector<std::uint32_t> found(kRows);
  for (const Method method : {Method::certified, Method::thesis, Method::midsurface}) {
    for (const Goal goal : {Goal::verdict, Goal::deepest}) {
      PairOptions options;
      options.method = method;
      options.goal = goal;
      PairTile tile;
      tile.queries = &queries;
      tile.options = &options;
      tile.kernels = default_target().kernels;
      tile.count = kRows;
      tile.columns.status = status.data();
      if (goal == Goal::deepest) tile.contacts.found = found.data();
      PairScratch scratch;
      for (int round = 0; round < 3; ++round) solve(tile, scratch);
      EXPECT_EQ(allocations_of([&] { solve(tile, scratch); }), 0U) << name(method) << ' ' << name(goal);
    }
  }
}

Shape many_discs() {
  std::vector<Shape> all;
  for (int i = 0; i < 300; ++i) all.push_back(circle(0.1).translate(Vec2{i % 20 * 0.4 - 4, i / 20 * 0.4 - 3}));
  return union_(all);
}

TEST(WarmBatch, AllocatesNothing) {
  constexpr std::size_t kCount = 3000;
  oracle::Random random(3);
  std::vector<float> rows(6 * kCount);
  for (float& x : rows) x = static_cast<float>(random.uniform(-4, 4));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = rows[i / 6 * 6 + i % 2] + 0.05F * rows[i];
  std::vector<std::uint8_t> status(kCount);
  std::vector<float> value(kCount), gradient(2 * kCount);
  // Short and long: in the caller's order, and in spatial order by shortened tapes.
  for (const Shape& shape : {flat_and_round(), many_discs()}) {
    const Tape tape = std::move(compile(shape)).value();
    CollideColumns columns;
    columns.status = status.data(), columns.value = value.data();
    const auto run = [&] {
      static_cast<void>(collide_triangles(tape, {rows.data(), kCount}, {}, columns, {.threads = 1}));
      static_cast<void>(collide_circles(tape, {rows.data(), kCount}, {}, columns, {.threads = 1}));
      evaluate(tape, rows.data(), kCount, value.data(), gradient.data(), {.threads = 1});
    };
    for (int round = 0; round < 3; ++round) run();
    EXPECT_EQ(allocations_of(run), 0U) << tape.instructions.size();
  }
}

TEST(WarmBatchOfPairsNearALongTape, AllocatesNothing) {
  constexpr std::size_t kCount = 200;
  const Tape many = std::move(compile(many_discs())).value(), body = std::move(compile(flat_and_round())).value();
  const Tape* const shapes[2] = {&many, &body};
  oracle::Random random(9);
  std::vector<float> poses(3 * kCount), point(2 * kCount);
  for (float& x : poses) x = static_cast<float>(random.uniform(-4, 4));
  CollideColumns columns;
  columns.point = point.data();
  DistanceColumns distances;
  distances.point_a = point.data();
  const PairQueries queries{shapes, 2, poses.data(), nullptr, kCount};
  const auto run = [&] {
    static_cast<void>(collide_pairs(queries, {}, columns, {}, {.threads = 1}));
    static_cast<void>(measure_distances(queries, {}, distances, {.threads = 1}));
  };
  for (int round = 0; round < 3; ++round) run();
  EXPECT_EQ(allocations_of(run), 0U);
}

TEST(WarmBatchOfSweeps, AllocatesNothing) {
  constexpr std::size_t kCount = 600;
  oracle::Random random(9);
  std::vector<float> rows(6 * kCount), ends(6 * kCount), motions(3 * kCount), point(2 * kCount);
  for (auto* numbers : {&rows, &ends, &motions}) {
    for (float& x : *numbers) x = static_cast<float>(random.uniform(-4, 4));
  }
  for (std::size_t i = 0; i < kCount; ++i) rows[3 * i + 2] = std::abs(rows[3 * i + 2]) / 8;
  SweepColumns columns;
  columns.point = point.data();
  for (const Shape& shape : {flat_and_round(), many_discs()}) {
    const Tape tape = std::move(compile(shape)).value();
    const auto run = [&] {
      const SweepQueries triangles{.rows = rows.data(), .ends = ends.data(), .count = kCount};
      const SweepQueries circles{.rows = rows.data(), .motions = motions.data(), .count = kCount};
      static_cast<void>(sweep_triangles(tape, triangles, {}, columns, {.threads = 1}));
      static_cast<void>(sweep_circles(tape, circles, {}, columns, {.threads = 1}));
    };
    for (int round = 0; round < 3; ++round) run();
    EXPECT_EQ(allocations_of(run), 0U) << tape.instructions.size();
  }
}

TEST(WarmBatchOfPairs, AllocatesNothing) {
  constexpr std::size_t kCount = 200;
  const Tape tape = std::move(compile(torus(0.35, 0.15))).value();
  const Tape* const shapes[2] = {&tape, &tape};
  oracle::Random random(9);
  std::vector<float> poses(7 * kCount), point(3 * kCount);
  for (float& x : poses) x = static_cast<float>(random.uniform(-0.5, 0.5));
  CollideColumns columns;
  columns.point = point.data();
  const auto run = [&] {
    static_cast<void>(collide_pairs({shapes, 2, poses.data(), nullptr, kCount}, {}, columns, {}, {.threads = 1}));
  };
  for (int round = 0; round < 3; ++round) run();
  EXPECT_EQ(allocations_of(run), 0U);
}

TEST(WarmGrid, AllocatesNothing) {
  const Tape tape = std::move(compile(flat_and_round())).value();
  const Grid grid{.origin = {-4, -4}, .step = {{0.02}, {0, 0.02}}, .size = {400, 400, 1}};
  std::vector<float> value(grid.count());
  std::vector<std::uint8_t> inside(grid.count());
  for (const GridColumns& columns : {GridColumns{.value = value.data()}, GridColumns{.inside = inside.data()}}) {
    const auto run = [&] { static_cast<void>(evaluate_grid(tape, grid, columns, {.threads = 1})); };
    for (int round = 0; round < 3; ++round) run();
    EXPECT_EQ(allocations_of(run), 0U);
  }
}

}  // namespace
}  // namespace thalweg
