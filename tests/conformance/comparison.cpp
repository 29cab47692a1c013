// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "comparison.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace thalweg::conformance {
namespace {

using oracle::Vec;

struct Memory {
  Arena arena;
  float* scratch = nullptr;
  explicit Memory(const Tape& tape) : scratch(arena.take<float>(scratch_floats(tape))) {}
};

struct Pointers {
  const float* axis[3] = {};
  explicit Pointers(const Points& points) {
    for (int i = 0; i < points.dimension; ++i) axis[i] = points.column[i].data();
  }
};

void push_vertex(Cells& cells, std::size_t first, Vec v) {
  const double at[3] = {v.x, v.y, v.z};
  for (int axis = 0; axis < cells.centres.dimension; ++axis) {
    cells.edges[first + static_cast<std::size_t>(axis)].push_back(static_cast<float>(at[axis]));
  }
}

}  // namespace

Columns run_value(const Tape& tape, const Target& target, const Points& points) {
  Memory memory(tape);
  Columns out;
  out.value.resize(padded(points.count));
  target.kernels->value(tape, Pointers(points).axis, points.count, out.value.data(), memory.scratch);
  out.value.resize(points.count);
  return out;
}

Columns run_gradient(const Tape& tape, const Target& target, const Points& points) {
  Memory memory(tape);
  Columns out;
  float* gradient[3] = {};
  for (int axis = 0; axis < tape.dimension; ++axis) {
    out.gradient[axis].resize(padded(points.count));
    gradient[axis] = out.gradient[axis].data();
  }
  out.value.resize(padded(points.count));
  target.kernels->gradient(tape, Pointers(points).axis, points.count, out.value.data(), gradient, memory.scratch);
  out.value.resize(points.count);
  return out;
}

void Cells::add_triangle(const Vec (&corners)[3]) {
  const auto d = static_cast<std::size_t>(centres.dimension);
  centres.add((corners[0] + corners[1] + corners[2]) * (1.0 / 3));
  const Vec centre = centres.at(centres.count - 1);
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    push_vertex(*this, i * d, corners[i] - centre);
    most = std::max(most, distance(corners[i], centre));
  }
  reach.push_back(static_cast<float>(most * (1 + 1e-6)));
}

void Cells::add_box(Vec centre, Vec half) {
  is_box = true;
  centres.add(centre);
  push_vertex(*this, 0, half);
  reach.push_back(static_cast<float>(length(half) * (1 + 1e-6)));
}

void Cells::pad() {
  centres.pad();
  reach.resize(padded(centres.count), 0);
  for (auto& column : edges) column.resize(padded(centres.count), 0);
}

Columns run_enclosure(const Tape& tape, const Target& target, const Cells& cells) {
  Memory memory(tape);
  Columns out;
  out.value.resize(padded(cells.centres.count));
  out.lower.resize(padded(cells.centres.count));
  CellColumns columns;
  columns.reach = cells.reach.data();
  columns.is_box = cells.is_box;
  for (std::size_t i = 0; i < 9; ++i) columns.edges[i] = cells.edges[i].data();
  target.kernels->enclosure(tape, Pointers(cells.centres).axis, columns, cells.centres.count, out.lower.data(),
                            out.value.data(), memory.scratch);
  out.value.resize(cells.centres.count);
  out.lower.resize(cells.centres.count);
  return out;
}

void Comparison::add(double found, double expected, double slack, double margin, Vec at) {
  ++count;
  const double error = std::fabs(found - expected);
  worst = std::max(worst, std::isnan(error) ? INFINITY : std::max(error - margin, 0.0) / slack);
  if (error <= slack + margin || !fault.empty()) return;
  std::ostringstream text;
  text << std::setprecision(17) << "found " << found << ", expected " << expected << ", off by " << error
       << ", allowed " << slack << " at " << at.x << ' ' << at.y << ' ' << at.z;
  fault = text.str();
}

Comparison compare_values(const Tape& tape, const oracle::Field& field, const Points& points,
                          const std::vector<float>& value) {
  Comparison all;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double m = points.magnitude(i);
    all.add(value[i], field(points.at(i)), tape.slack(m), field.margin(m), points.at(i));
  }
  return all;
}

}  // namespace thalweg::conformance
