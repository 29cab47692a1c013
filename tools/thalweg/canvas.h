// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A picture in memory and what is drawn on it: anti-aliased lines, rings and dots, in pixel coordinates with the
// origin at the top left corner of the top left pixel.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "colour.h"

namespace thalweg::cli {

struct PixelPoint {
  double x = 0, y = 0;
};

struct Pen {
  Colour colour;
  double width = 1;  ///< in pixels
  double opacity = 1;
};

class Canvas {
 public:
  Canvas(std::size_t width, std::size_t height) : width_(width), height_(height), pixels_(width * height) {}

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] Colour& at(std::size_t column, std::size_t row) { return pixels_[row * width_ + column]; }

  void line(PixelPoint a, PixelPoint b, const Pen& pen);
  void ring(PixelPoint centre, double radius, const Pen& pen);
  void dot(PixelPoint centre, double radius, const Pen& pen);

  /// The picture as the bytes of a PNG file.
  [[nodiscard]] std::string png() const;

 private:
  struct Box {
    std::size_t column0 = 0, row0 = 0, column1 = 0, row1 = 0;  ///< half open
  };
  [[nodiscard]] Box clipped(double x0, double y0, double x1, double y1) const;
  /// Blends the pen over each pixel of the box by how far its centre is inside, in pixels: 0.5 outside to 0.5 inside.
  template <class Depth>
  void blend(const Box& box, const Pen& pen, Depth depth);

  std::size_t width_, height_;
  std::vector<Colour> pixels_;
};

}  // namespace thalweg::cli
