// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the polygon op checks of its corners before it claims anything.
#pragma once

#include "ops/declaration.h"

namespace thalweg::ops {

/// True when no two edges of the closed polygon x0, y0, x1, y1, ... cross or touch, apart from neighbours at their
/// common corner, and no edge is shorter than the smallest length.
[[nodiscard]] bool is_simple_polygon(Numbers points);

/// True when a simple polygon turns one way only.
[[nodiscard]] bool is_convex_polygon(Numbers points);

/// Signed area, positive for counter-clockwise corners.
[[nodiscard]] double polygon_area(Numbers points);

}  // namespace thalweg::ops
