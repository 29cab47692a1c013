// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Triangle meshes as triangle rows: OBJ, PLY and STL. Polygons are cut into fans from their first corner. In a scene
// of the plane every z must be 0: a mesh is never flattened in silence.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "array.h"

namespace thalweg::cli {

/// Where in a file something stands; spelled out only for an error.
struct Place {
  std::string_view noun;  ///< `line`, `vertex`, `triangle`
  std::size_t number = 0;

  [[nodiscard]] std::string text() const;
};

/// Vertices, and polygons cut into triangles, gathered while a file is read.
class MeshBuilder {
 public:
  MeshBuilder(const RowShape& row, std::string name) : row_(row), name_(std::move(name)) {}

  void add_vertex(const std::array<double, 3>& position, Place place);
  /// Corners as positions in the list of vertices; refuses one that is not there, and fewer than three.
  void add_face(const std::vector<std::int64_t>& corners, Place place);

  [[nodiscard]] std::size_t vertex_count() const { return vertices_.size() / dimension(); }
  [[nodiscard]] Array take();

 private:
  [[nodiscard]] std::size_t dimension() const { return row_.inner.back(); }

  const RowShape& row_;
  std::string name_;
  std::vector<float> vertices_;
  std::vector<float> values_;
};

[[nodiscard]] Array parse_obj(std::string_view text, const RowShape& row, const std::string& name);
[[nodiscard]] Array parse_ply(std::string_view bytes, const RowShape& row, const std::string& name);
[[nodiscard]] Array parse_stl(std::string_view bytes, const RowShape& row, const std::string& name);

}  // namespace thalweg::cli
