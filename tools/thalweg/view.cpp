// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Which part of the plane a picture shows.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "failure.h"
#include "picture.h"

namespace thalweg::cli {

namespace {

constexpr std::size_t kDefaultWidth = 1280;
constexpr double kMargin = 0.1;

std::array<double, 4> shape_bounds(const Facts& facts) {
  const Bounds& bounds = facts.bounds;
  // What has no bounds, as a formula, is shown around the origin.
  if (!bounds.empty(facts.dimension) && !bounds.finite(2)) return {-1, -1, 1, 1};
  const bool known = !bounds.empty(2) && bounds.finite(2);
  const double width = bounds.hi[0] - bounds.lo[0];
  const double height = bounds.hi[1] - bounds.lo[1];
  if (!known || !(std::max(width, height) > 0)) {
    refuse(kCommandLine, "--bounds", "x0 y0 x1 y1 for this scene", known ? "a shape without extent" : "an empty shape");
  }
  const double margin = kMargin * std::max(width, height);
  return {bounds.lo[0] - margin, bounds.lo[1] - margin, bounds.hi[0] + margin, bounds.hi[1] + margin};
}

// Keeps the middle and makes the rectangle as wide and high as square pixels need.
std::array<double, 4> widened(std::array<double, 4> bounds, double aspect) {
  const double width = bounds[2] - bounds[0];
  const double height = bounds[3] - bounds[1];
  const double extra_x = std::max(0.0, height * aspect - width) / 2;
  const double extra_y = std::max(0.0, width / aspect - height) / 2;
  return {bounds[0] - extra_x, bounds[1] - extra_y, bounds[2] + extra_x, bounds[3] + extra_y};
}

std::array<std::size_t, 2> size_for(const std::array<double, 4>& bounds) {
  const double aspect = (bounds[2] - bounds[0]) / (bounds[3] - bounds[1]);
  const auto width = static_cast<double>(kDefaultWidth);
  const auto side = [](double length) {
    return static_cast<std::size_t>(std::clamp(std::round(length), 16.0, 4096.0));
  };
  return aspect >= 1 ? std::array{kDefaultWidth, side(width / aspect)}
                     : std::array{side(width * aspect), kDefaultWidth};
}

}  // namespace

PixelPoint View::pixel(double x, double y) const {
  return {(x - x0) / (x1 - x0) * static_cast<double>(width), (y1 - y) / (y1 - y0) * static_cast<double>(height)};
}

double View::pixels_per_unit() const { return static_cast<double>(width) / (x1 - x0); }

View choose_view(const ViewRequest& request, const Facts& facts) {
  std::array<double, 4> bounds = request.bounds ? *request.bounds : shape_bounds(facts);
  if (!(bounds[0] < bounds[2] && bounds[1] < bounds[3])) {
    refuse(kCommandLine, "--bounds", "x0 < x1 and y0 < y1",
           fmt::format("{} {} {} {}", bounds[0], bounds[1], bounds[2], bounds[3]));
  }
  const std::array<std::size_t, 2> size = request.size ? *request.size : size_for(bounds);
  if (!request.bounds) bounds = widened(bounds, static_cast<double>(size[0]) / static_cast<double>(size[1]));
  return {bounds[0], bounds[1], bounds[2], bounds[3], size[0], size[1], request.slice};
}

}  // namespace thalweg::cli
