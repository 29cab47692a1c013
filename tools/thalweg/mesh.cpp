// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Gathering a mesh into triangle rows.
#include "mesh.h"

#include <fmt/format.h>

#include "failure.h"

namespace thalweg::cli {

std::string Place::text() const { return fmt::format("{} {}", noun, number); }

void MeshBuilder::add_vertex(const std::array<double, 3>& position, Place place) {
  if (dimension() == 2 && position[2] != 0) {
    refuse(name_, place.text(), "z = 0 in a scene of dimension 2", fmt::format("z = {}", position[2]));
  }
  for (std::size_t axis = 0; axis < dimension(); ++axis) vertices_.push_back(to_float32(position[axis]));
}

void MeshBuilder::add_face(const std::vector<std::int64_t>& corners, Place place) {
  if (corners.size() < 3) refuse(name_, place.text(), "at least 3 corners", fmt::format("{}", corners.size()));
  const auto count = static_cast<std::int64_t>(vertex_count());
  for (const std::int64_t corner : corners) {
    if (corner < 0 || corner >= count) {
      refuse(name_, place.text(), fmt::format("a vertex among the {} read so far", count),
             fmt::format("position {}", corner));
    }
  }
  const auto append = [this](std::int64_t corner) {
    const std::size_t begin = static_cast<std::size_t>(corner) * dimension();
    for (std::size_t axis = 0; axis < dimension(); ++axis) values_.push_back(vertices_[begin + axis]);
  };
  for (std::size_t i = 2; i < corners.size(); ++i) {
    append(corners[0]);
    append(corners[i - 1]);
    append(corners[i]);
  }
}

Array MeshBuilder::take() {
  Array array;
  array.shape = {values_.size() / row_.width()};
  array.shape.insert(array.shape.end(), row_.inner.begin(), row_.inner.end());
  array.values = std::move(values_);
  return array;
}

}  // namespace thalweg::cli
