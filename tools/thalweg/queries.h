// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The arrays that commands take: points, circles and triangles of a scene's dimension, in any accepted format. The
// format follows from the name's ending; stdin is NPY when it begins as NPY does, else CSV.
#pragma once

#include <string>

#include "array.h"

namespace thalweg::cli {

[[nodiscard]] Array read_points(const std::string& path, int dimension);     ///< (N, d)
[[nodiscard]] Array read_circles(const std::string& path, int dimension);    ///< (N, d + 1): centre, radius
[[nodiscard]] Array read_triangles(const std::string& path, int dimension);  ///< (N, 3, d)
[[nodiscard]] Array read_poses(const std::string& path, int dimension);      ///< (N, 3), or (N, 7) in 3D
[[nodiscard]] Array read_motions(const std::string& path, int dimension);    ///< the same

/// An NPY array of rows of this shape, held in memory.
[[nodiscard]] Array parse_npy_rows(std::string_view bytes, const RowShape& row, const std::string& name);

}  // namespace thalweg::cli
