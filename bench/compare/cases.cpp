// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "cases.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "random.h"
#include "thalweg/batch.h"
#include "thalweg/scene.h"

namespace thalweg::bench {
namespace {

Shape read_shape(std::string_view name) {
  const std::string path = std::string(THALWEG_SCENES_DIR "/") + std::string(name) + ".json";
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto scene = parse_scene(text, path);
  if (!scene) throw std::runtime_error(to_string(scene.error()));
  return scene->shape;
}

std::vector<float> triangles(const Shape& shape, double size, std::size_t count) {
  oracle::Random random(2026);
  const Bounds& bounds = shape.facts().bounds;
  const int d = shape.dimension();
  std::vector<float> rows;
  rows.reserve(count * 3 * static_cast<std::size_t>(d));
  for (std::size_t i = 0; i < count; ++i) {
    double centre[3] = {};
    for (int axis = 0; axis < d; ++axis) {
      const double more = 0.1 * (bounds.hi[axis] - bounds.lo[axis]);
      centre[axis] = random.uniform(bounds.lo[axis] - more, bounds.hi[axis] + more);
    }
    for (int k = 0; k < 3 * d; ++k) rows.push_back(static_cast<float>(centre[k % d] + random.uniform(-size, size)));
  }
  return rows;
}

std::array<oracle::Vec, 3> corners(const std::vector<float>& rows, std::size_t row, int d) {
  std::array<oracle::Vec, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* p = rows.data() + (3 * row + k) * static_cast<std::size_t>(d);
    result[k] = {static_cast<double>(p[0]), static_cast<double>(p[1]), d == 3 ? static_cast<double>(p[2]) : 0.0};
  }
  return result;
}

}  // namespace

const std::vector<CompareScene>& compare_scenes() {
  static const std::vector<CompareScene> scenes = {
      {"small", "thesis (2D)", 60},       {"primitives12", "12 primitives (2D)", 60},
      {"shells", "thin shells (2D)", 6},  {"slots", "deep subtractions (2D)", 6},
      {"bracket3", "bracket (3D)", 8},    {"bowl3", "spheres in a bowl (3D)", 6},
      {"lattice3", "box lattice (3D)", 6}};
  return scenes;
}

std::size_t CompareCase::hits() const {
  return static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), oracle::Verdict::overlapping));
}

CompareCase make_case(const CompareScene& scene, std::size_t count) {
  const Shape shape = read_shape(scene.file);
  auto tape = compile(shape);
  if (!tape) throw std::runtime_error(to_string(tape.error()));
  CompareCase made;
  made.scene = scene;
  made.tape = std::move(tape).value();
  made.rows = triangles(shape, scene.size, count);
  made.diagonal = made.tape.facts.bounds.diagonal(made.tape.dimension);
  made.tolerance = default_tolerance(made.tape);
  const oracle::Field field(shape);
  oracle::Limits limits;
  limits.width = made.tolerance / 4;
  limits.cap = 20000;
  oracle::Limits sign = limits;
  sign.verdict_only = true;
  for (std::size_t row = 0; row < count; ++row) {
    const auto triangle = corners(made.rows, row, made.tape.dimension);
    double magnitude = 0;
    for (const oracle::Vec v : triangle) {
      magnitude = std::max({magnitude, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    }
    oracle::Bracket bracket = minimum_over_triangle(field, triangle, limits);
    oracle::Verdict verdict = oracle::verdict(field, bracket, magnitude);
    if (verdict == oracle::Verdict::cannot_tell) {
      verdict = oracle::verdict(field, minimum_over_triangle(field, triangle, sign), magnitude);
    }
    made.truth.push_back(bracket);
    made.verdicts.push_back(verdict);
  }
  return made;
}

}  // namespace thalweg::bench
