// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Reading arrays of queries in any accepted format.
#include "queries.h"

#include <algorithm>

#include "csv.h"
#include "failure.h"
#include "input.h"
#include "mesh.h"
#include "npy.h"

namespace thalweg::cli {

namespace {

using MeshParser = Array (*)(std::string_view bytes, const RowShape& row, const std::string& name);

// The reader of a mesh format by the file's name, or null.
MeshParser mesh_parser(const std::string& path) {
  if (has_extension(path, ".obj")) return parse_obj;
  if (has_extension(path, ".ply")) return parse_ply;
  if (has_extension(path, ".stl")) return parse_stl;
  return nullptr;
}

Array read_rows(const std::string& path, const RowShape& row) {
  const std::string name = input_name(path);
  const MeshParser mesh = mesh_parser(path);
  const bool meshes = row.noun == "triangles";
  if (has_extension(path, ".npy")) return parse_npy_rows(read_input(path), row, name);
  if (has_extension(path, ".csv")) return parse_csv(read_input(path), row, name);
  if (mesh != nullptr && meshes) return mesh(read_input(path), row, name);
  const std::string bytes = read_input(path);
  if (looks_like_npy(bytes)) return parse_npy_rows(bytes, row, name);
  if (path == "-") return parse_csv(bytes, row, name);
  refuse(name, "format", meshes ? "NPY, CSV, OBJ, PLY or STL by the file's ending" : "NPY or CSV by the file's ending",
         mesh != nullptr ? "a mesh, which holds triangles only" : "another ending");
}

}  // namespace

Array parse_npy_rows(std::string_view bytes, const RowShape& row, const std::string& name) {
  Array array = parse_npy(bytes, name);
  const bool matches = array.shape.size() == row.inner.size() + 1 &&
                       std::equal(row.inner.begin(), row.inner.end(), array.shape.begin() + 1);
  if (!matches) {
    refuse(name, "shape", shape_text(row) + " for " + std::string(row.noun), shape_text(array.shape));
  }
  return array;
}

Array read_points(const std::string& path, int dimension) {
  return read_rows(path, {{static_cast<std::size_t>(dimension)}, "points"});
}

Array read_circles(const std::string& path, int dimension) {
  return read_rows(path, {{static_cast<std::size_t>(dimension) + 1}, dimension == 2 ? "circles" : "spheres"});
}

Array read_triangles(const std::string& path, int dimension) {
  return read_rows(path, {{3, static_cast<std::size_t>(dimension)}, "triangles"});
}

namespace {

/// Rows of a translation and a turn.
Array read_placements(const std::string& path, int dimension, std::string_view noun) {
  const RowShape row{{dimension == 2 ? std::size_t{3} : std::size_t{7}}, noun};
  const std::string name = input_name(path);
  const std::string bytes = read_input(path);
  if (!looks_like_npy(bytes)) refuse(name, "format", "NPY", "another format");
  return parse_npy_rows(bytes, row, name);
}

}  // namespace

Array read_poses(const std::string& path, int dimension) { return read_placements(path, dimension, "poses"); }

Array read_motions(const std::string& path, int dimension) { return read_placements(path, dimension, "motions"); }

}  // namespace thalweg::cli
