// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// growth/pairs and growth/distances: a small body at random poses all over scenes of 10 to 10 000 primitives
// (growth.h).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "growth.h"
#include "oracle.h"
#include "random.h"
#include "thalweg/batch.h"
#include "thalweg/ops.h"
#include "workload.h"

namespace thalweg::bench {
namespace {

using oracle::Vec;

constexpr std::size_t kPairsPerPrimitive = 16;
constexpr std::size_t kFewRows = 16;
/// Units; the body is 68 long, coordinates reach 10 000.
constexpr double kTolerance = 0.1;

Shape body() { return union_({box(Vec2{25, 6}), circle(9).translate(Vec2{25, 0}), circle(9).translate(Vec2{-25, 0})}); }

/// A batch of poses of the body over a scene, and its answers.
struct Meeting {
  static constexpr std::size_t kContacts = 4;
  Shape scene, part = body();
  Tape tapes[2];
  const Tape* shapes[2] = {&tapes[0], &tapes[1]};
  std::vector<float> poses;
  std::vector<std::uint8_t> status;
  std::vector<std::uint32_t> found;
  std::vector<float> lower, point, other_point, contact_point, contact_normal, contact_value;

  Meeting(std::size_t primitives, std::size_t count)
      : scene(scattered_scene(primitives)),
        tapes{compile(scene).value(), compile(part).value()},
        status(count),
        found(count),
        lower(count),
        point(2 * count),
        other_point(2 * count),
        contact_point(2 * kContacts * count),
        contact_normal(2 * kContacts * count),
        contact_value(kContacts * count) {
    oracle::Random random(7);
    const Bounds& box = scene.facts().bounds;
    const auto uniform = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
    for (std::size_t i = 0; i < count; ++i) {
      poses.insert(poses.end(), {uniform(box.lo[0], box.hi[0]), uniform(box.lo[1], box.hi[1]), uniform(-3.1, 3.1)});
    }
  }
  [[nodiscard]] std::size_t count() const { return status.size(); }
  [[nodiscard]] PairQueries queries(std::size_t row, std::size_t rows) const {
    return {.shapes = shapes, .shape_count = 2, .poses = &poses[3 * row], .count = rows};
  }

  /// Deepest points and contacts.
  void collide(std::size_t row, std::size_t rows) {
    PairOptions options;
    options.goal = Goal::deepest;
    options.tolerance = kTolerance;
    CollideColumns columns;
    columns.status = &status[row], columns.lower = &lower[row], columns.point = &point[2 * row];
    PairContacts contacts;
    contacts.capacity = kContacts;
    contacts.found = &found[row];
    contacts.point = &contact_point[2 * kContacts * row], contacts.normal = &contact_normal[2 * kContacts * row];
    contacts.value = &contact_value[kContacts * row];
    benchmark::DoNotOptimize(collide_pairs(queries(row, rows), options, columns, contacts, {.threads = 1})->rows);
  }
  void measure(std::size_t row, std::size_t rows) {
    DistanceColumns columns;
    columns.status = &status[row], columns.lower = &lower[row];
    columns.point_a = &point[2 * row], columns.point_b = &other_point[2 * row];
    benchmark::DoNotOptimize(measure_distances(queries(row, rows), {}, columns, {.threads = 1})->rows);
  }
};

/// The oracle's fields of a pose.
class Placed {
 public:
  Placed(const Meeting& meeting) : a_(meeting.scene), b_(meeting.part) {}
  void at(const float* pose) { pose_ = pose; }

  [[nodiscard]] double a(Vec p) const { return a_(p); }
  [[nodiscard]] double b(Vec p) const {
    const double x = p.x - pose_[0], y = p.y - pose_[1], cosine = std::cos(pose_[2]), sine = std::sin(pose_[2]);
    return b_({cosine * x + sine * y, cosine * y - sine * x, 0});
  }
  /// The least value of a seen at points of the body.
  [[nodiscard]] double least_inside() const {
    double least = 1e9;
    for (int i = -40; i <= 40; ++i) {
      for (int k = -40; k <= 40; ++k) {
        const Vec p{static_cast<double>(pose_[0]) + i, static_cast<double>(pose_[1]) + k, 0};
        if (b(p) < 0) least = std::min(least, a(p));
      }
    }
    return least;
  }

 private:
  oracle::Field a_, b_;
  const float* pose_ = nullptr;
};

/// What is wrong with a row, or nothing.
std::string wrong_pair(const Meeting& meeting, const Placed& placed, std::size_t row, bool measured) {
  const auto status = static_cast<Status>(meeting.status[row]);
  const Vec p{meeting.point[2 * row], meeting.point[2 * row + 1], 0};
  const double rounding = 4e-3;
  if (status == Status::overlapping && !(std::max(placed.a(p), placed.b(p)) < rounding)) {
    return "the point is not common";
  }
  if (status == Status::separated && placed.least_inside() < 0) return "the shapes are not apart";
  if (!measured || status != Status::separated) return "";
  const Vec q{meeting.other_point[2 * row], meeting.other_point[2 * row + 1], 0};
  if (placed.a(p) > rounding || placed.b(q) > rounding) return "a witness is not of its shape";
  return meeting.lower[row] > distance(p, q) + rounding ? "the bound is above a distance" : "";
}

/// Runs a batch whose work is of `kind` (`collide` or `measure`) and checks some of its answers.
std::string wrong_answer(Meeting& meeting, void (Meeting::*work)(std::size_t, std::size_t)) {
  (meeting.*work)(0, meeting.count());
  Placed placed(meeting);
  const std::size_t stride = std::max<std::size_t>(meeting.count() / 20, 1);
  for (std::size_t row = 0; row < meeting.count(); row += stride) {
    placed.at(&meeting.poses[3 * row]);
    const std::string wrong = wrong_pair(meeting, placed, row, work == &Meeting::measure);
    if (!wrong.empty()) return "pair " + std::to_string(row) + ": " + wrong;
  }
  return "";
}

void pairs(benchmark::State& state, void (Meeting::*work)(std::size_t, std::size_t)) {
  const auto make = [work](std::size_t size, std::string& error) {
    auto meeting = std::make_unique<Meeting>(size, std::max(batch(kPairsPerPrimitive * size), 4 * kFewRows));
    error = wrong_answer(*meeting, work);
    return meeting;
  };
  const auto run = [work](Meeting& meeting, std::size_t row, std::size_t rows) { (meeting.*work)(row, rows); };
  grow_by_scene(state, make, run, kFewRows);
}

}  // namespace

void register_pair_growth_cases() {
  add_growth_case("growth/pairs", [](benchmark::State& state) { pairs(state, &Meeting::collide); });
  add_growth_case("growth/distances", [](benchmark::State& state) { pairs(state, &Meeting::measure); });
}

}  // namespace thalweg::bench
