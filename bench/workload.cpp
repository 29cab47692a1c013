// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "workload.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "thalweg/ops.h"

namespace thalweg::bench {
namespace {

bool small_batches = false;
bool refused = false;

/// SplitMix64: the same queries with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  float uniform(double least, double most) {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return static_cast<float>(least + (most - least) * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53);
  }

 private:
  std::uint64_t state_;
};

}  // namespace

std::optional<LoadedScene> load_scene(std::string_view name, std::string& error) {
  const std::string path = std::string(THALWEG_SCENES_DIR "/") + std::string(name) + ".json";
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto scene = parse_scene(text, path);
  if (!scene) {
    error = to_string(scene.error());
    return std::nullopt;
  }
  auto tape = compile(scene->shape);
  if (!tape) {
    error = to_string(tape.error());
    return std::nullopt;
  }
  return LoadedScene{scene->shape, std::move(tape).value()};
}

Shape scattered_scene(std::size_t count) {
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  std::vector<Shape> all;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t column = i % side, row = i / side;
    const std::uint64_t turn = (i + 1) * 0x9e3779b97f4a7c15U;
    const double jitter_x = static_cast<double>(turn >> 40 & 0xff) / 8;
    const double jitter_y = static_cast<double>(turn >> 48 & 0xff) / 8;
    const Vec2 at{100 * static_cast<double>(column) + jitter_x, 100 * static_cast<double>(row) + jitter_y};
    const Shape one = i % 3 == 0 ? circle(25) : i % 3 == 1 ? box(Vec2{20, 30}).rotate(0.4) : star(35, 5, 3);
    all.push_back(one.translate(at));
  }
  return union_(std::move(all));
}

std::vector<float> picture_points(std::size_t count) {
  Random random(1);
  std::vector<float> rows;
  rows.reserve(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    rows.push_back(random.uniform(0, 1920));
    rows.push_back(random.uniform(0, 1080));
  }
  return rows;
}

std::vector<float> picture_triangles(std::size_t count) {
  Random random(2);
  std::vector<float> rows;
  rows.reserve(6 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = random.uniform(0, 1920), y = random.uniform(0, 1080);
    for (int corner = 0; corner < 3; ++corner) {
      rows.push_back(x + random.uniform(-60, 60));
      rows.push_back(y + random.uniform(-60, 60));
    }
  }
  return rows;
}

void refuse(benchmark::State& state, const std::string& why) {
  refused = true;
  state.SkipWithError(why.c_str());
}
bool any_refused() { return refused; }

void use_small_batches() { small_batches = true; }
bool smoke() { return small_batches; }
std::size_t batch(std::size_t full_size) {
  return small_batches ? std::max<std::size_t>(full_size / 100, 64) : full_size;
}

}  // namespace thalweg::bench
