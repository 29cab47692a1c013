// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The field of a scene as a picture: which rectangle of the plane, on how many pixels, in which mode.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "canvas.h"
#include "command.h"
#include "thalweg/query.h"
#include "thalweg/result.h"
#include "thalweg/tape.h"

namespace thalweg::cli {

/// A rectangle of the plane z = slice on a grid of pixels, y upwards.
struct View {
  double x0 = 0, y0 = 0, x1 = 1, y1 = 1;
  std::size_t width = 1, height = 1;
  double slice = 0;  ///< z of the plane, in 3D

  [[nodiscard]] PixelPoint pixel(double x, double y) const;
  [[nodiscard]] double pixels_per_unit() const;  ///< along x
};

/// What the command line may leave open.
struct ViewRequest {
  std::optional<std::array<double, 4>> bounds;     ///< x0 y0 x1 y1
  std::optional<std::array<std::size_t, 2>> size;  ///< width, height
  double slice = 0;
};

/// Bounds and size as given; missing bounds are those of the shape and a tenth more, missing sizes follow the bounds,
/// and bounds that were not given are widened to the shape of the picture. Refuses an unbounded shape without bounds.
[[nodiscard]] View choose_view(const ViewRequest& request, const Facts& facts);

enum class PictureMode : std::uint8_t {
  inside,
  distance,
  gradient,  ///< direction as hue
  error,     ///< angle from the gradient in double precision, on a logarithmic scale with a legend
  steps,     ///< how many steps of |f| along the gradient lead to the surface
};
[[nodiscard]] Result<PictureMode> parse_picture_mode(std::string_view text);

struct PictureStyle {
  PictureMode mode = PictureMode::distance;
  float wash = 0;                 ///< 0 to 1: lightens the picture so that an overlay stands out
  GradientOptions gradient = {};  ///< of `gradient`, `error` and `steps`
};

/// The field over the view.
[[nodiscard]] Canvas draw_field(const Tape& tape, const View& view, PictureStyle style, const Globals& globals);

}  // namespace thalweg::cli
