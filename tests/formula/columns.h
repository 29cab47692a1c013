// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Points and cells through the kernels of a target, for tapes with formulas.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "kernels/kernels.h"
#include "thalweg/simd.h"
#include "thalweg/tape.h"

namespace thalweg::formulas {

using Column = std::vector<float>;

/// `quick`, or twenty times that when the environment has THALWEG_FULL=1.
inline std::size_t amount(std::size_t quick) {
  const char* value = std::getenv("THALWEG_FULL");
  const bool full = value != nullptr && *value != '\0' && std::string_view(value) != "0";
  return full ? 20 * quick : quick;
}

struct Fields {
  Column value;
  std::array<Column, 3> gradient;
};

inline Fields fields_at(const Tape& tape, const Target& target, const std::array<Column, 3>& points,
                        std::size_t count) {
  const std::size_t room = padded(count);
  Fields fields{Column(room), {Column(room), Column(room), Column(room)}};
  std::array<Column, 3> columns = points;
  for (Column& column : columns) column.resize(room);
  const float* at[3] = {columns[0].data(), columns[1].data(), columns[2].data()};
  float* gradient[3] = {fields.gradient[0].data(), fields.gradient[1].data(), fields.gradient[2].data()};
  Column scratch(scratch_floats(tape));
  target.kernels->gradient(tape, at, count, nullptr, gradient, scratch.data());
  target.kernels->value(tape, at, count, fields.value.data(), scratch.data());
  return fields;
}

/// Boxes by centre and half extents, with what their ranges are.
struct Boxes {
  explicit Boxes(std::size_t boxes) : count(boxes) {
    for (auto* columns : {&centre, &half}) {
      for (Column& column : *columns) column.resize(padded(count));
    }
    for (Column* column : {&reach, &place, &lower, &value, &upper}) column->resize(padded(count));
  }

  void bound(const Tape& tape, const Target& target) {
    for (std::size_t i = 0; i < count; ++i) {
      float square = 0;
      for (int axis = 0; axis < tape.dimension; ++axis) {
        const float edge = half[static_cast<std::size_t>(axis)][i];
        square += edge * edge;
      }
      reach[i] = std::sqrt(square) * 1.000001F;
    }
    CellColumns cells;
    cells.reach = reach.data();
    cells.is_box = true;
    cells.place = place.data();
    for (std::size_t axis = 0; axis < 3; ++axis) cells.edges[axis] = half[axis].data();
    const float* at[3] = {centre[0].data(), centre[1].data(), centre[2].data()};
    Column scratch(scratch_floats(tape));
    target.kernels->ranges(tape, at, cells, count, {lower.data(), value.data(), upper.data()}, scratch.data());
  }

  std::size_t count;
  std::array<Column, 3> centre, half;
  Column reach, place, lower, value, upper;
};

}  // namespace thalweg::formulas
