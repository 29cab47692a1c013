// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What `collide` answered, drawn over the field: the queries as outlines in the colour of their status, contact
// points as dots with short normals. In 3D a triangle or sphere is drawn where the slice cuts it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "array.h"
#include "canvas.h"
#include "picture.h"

namespace thalweg::cli {

struct Overlay {
  std::size_t dimension = 2;
  std::vector<std::uint8_t> status;                  ///< (N)
  std::vector<float> point, normal;                  ///< (N, d)
  std::vector<float> triangles;                      ///< (N, 3, d), or empty
  std::vector<float> circles;                        ///< (N, d + 1), or empty
  std::vector<float> contact_point, contact_normal;  ///< (M, d) of all rows, or empty
  std::vector<float> path;                           ///< (N, starts, steps, d), NaN beyond a path's end, or empty
  std::size_t path_steps = 0;
};

/// status, point and normal of a result file.
[[nodiscard]] Overlay read_overlay(const std::string& path, int dimension);

void draw_overlay(Canvas& canvas, const View& view, const Overlay& overlay);

}  // namespace thalweg::cli
