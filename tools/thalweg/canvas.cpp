// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Drawing by distance: the coverage of a pixel is how deep its centre lies in the stroke, cut to one pixel.
#include "canvas.h"

#include <png.h>

#include <algorithm>
#include <cmath>

#include "failure.h"

namespace thalweg::cli {

Canvas::Box Canvas::clipped(double x0, double y0, double x1, double y1) const {
  // Comparisons that a NaN fails give an empty box.
  const auto cut = [](double x, std::size_t most) {
    if (!(x > 0)) return std::size_t{0};
    return x >= static_cast<double>(most) ? most : static_cast<std::size_t>(x);
  };
  return {cut(std::floor(x0), width_), cut(std::floor(y0), height_), cut(std::ceil(x1), width_),
          cut(std::ceil(y1), height_)};
}

template <class Depth>
void Canvas::blend(const Box& box, const Pen& pen, Depth depth) {
  for (std::size_t row = box.row0; row < box.row1; ++row) {
    for (std::size_t column = box.column0; column < box.column1; ++column) {
      const double inside = depth(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
      if (!(inside > -0.5)) continue;
      const double coverage = std::min(inside + 0.5, 1.0) * pen.opacity;
      Colour& pixel = at(column, row);
      pixel = mix(pixel, pen.colour, static_cast<float>(coverage));
    }
  }
}

void Canvas::line(PixelPoint a, PixelPoint b, const Pen& pen) {
  const double half = pen.width / 2;
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  if (!std::isfinite(squared)) return;
  const double reach = half + 1;
  const double top = std::min(a.y, b.y) - reach;
  const Box box = clipped(std::min(a.x, b.x) - reach, top, std::max(a.x, b.x) + reach, std::max(a.y, b.y) + reach);
  const auto depth = [&](double x, double y) {
    const double t = squared > 0 ? std::clamp(((x - a.x) * dx + (y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
    return half - std::hypot(x - a.x - t * dx, y - a.y - t * dy);
  };
  if (std::fabs(dy) < 1e-9) return blend(box, pen, depth);
  // A steep or slanted line fills little of its box: row by row, only the columns near it.
  const double slant = reach * std::sqrt(squared) / std::fabs(dy);
  for (std::size_t row = box.row0; row < box.row1; ++row) {
    const double t = (static_cast<double>(row) + 0.5 - a.y) / dy;
    const double x = a.x + t * dx;
    const auto y = static_cast<double>(row);
    const Box near = clipped(std::max(x - slant, static_cast<double>(box.column0)), y,
                             std::min(x + slant, static_cast<double>(box.column1)), y + 1);
    blend(near, pen, depth);
  }
}

void Canvas::ring(PixelPoint centre, double radius, const Pen& pen) {
  const double reach = radius + pen.width / 2 + 1;
  blend(clipped(centre.x - reach, centre.y - reach, centre.x + reach, centre.y + reach), pen,
        [&](double x, double y) { return pen.width / 2 - std::fabs(std::hypot(x - centre.x, y - centre.y) - radius); });
}

void Canvas::dot(PixelPoint centre, double radius, const Pen& pen) {
  const double reach = radius + 1;
  blend(clipped(centre.x - reach, centre.y - reach, centre.x + reach, centre.y + reach), pen,
        [&](double x, double y) { return radius - std::hypot(x - centre.x, y - centre.y); });
}

std::string Canvas::png() const {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * pixels_.size());
  for (const Colour& pixel : pixels_) {
    for (const std::uint8_t byte : to_srgb8(pixel)) bytes.push_back(byte);
  }
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(size, '\0');
  if (png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, nullptr) == 0) {
    fail("picture", "PNG", "to be encoded in memory", image.message);
  }
  file.resize(size);
  return file;
}

}  // namespace thalweg::cli
