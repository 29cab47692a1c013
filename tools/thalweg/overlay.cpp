// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Drawing results.
#include "overlay.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "failure.h"
#include "input.h"
#include "npy.h"
#include "npz.h"
#include "queries.h"
#include "thalweg/query.h"

namespace thalweg::cli {

namespace {

constexpr double kNormalPixels = 14;
constexpr double kDotPixels = 2.6;

// Grey recedes, raspberry and violet stand out against blue and orange alike, and yellow is the lightest.
Pen outline_pen(Status status) {
  switch (status) {
    case Status::overlapping:
      return {from_hex(0xc0105c), 1.4, 0.95};
    case Status::touching:
      return {from_hex(0xf2d600), 1.8, 1.0};
    case Status::undecided:
      return {from_hex(0x6a1bd1), 1.8, 1.0};
    case Status::separated:
    case Status::bad_row:
      break;
  }
  return {from_hex(0x3d4450), 1.0, 0.6};
}

class OverlayPainter {
 public:
  OverlayPainter(Canvas& canvas, const View& view, const Overlay& overlay)
      : canvas_(canvas), view_(view), overlay_(overlay), d_(overlay.dimension) {}

  void outline(std::size_t row) {
    const Pen pen = outline_pen(static_cast<Status>(overlay_.status[row]));
    if (!overlay_.triangles.empty()) {
      const float* const corners = overlay_.triangles.data() + row * 3 * d_;
      if (d_ == 2) {
        for (std::size_t i = 0; i < 3; ++i) canvas_.line(pixel(corners + i * 2), pixel(corners + (i + 1) % 3 * 2), pen);
      } else {
        cut_triangle(corners, pen);
      }
    }
    if (!overlay_.circles.empty()) circle(overlay_.circles.data() + row * (d_ + 1), pen);
  }

  void contact(const float* point, const float* normal) {
    if (d_ == 3 && std::fabs(point[2] - view_.slice) * view_.pixels_per_unit() > 2) return;
    const PixelPoint at = pixel(point);
    const PixelPoint tip{at.x + kNormalPixels * normal[0], at.y - kNormalPixels * normal[1]};
    canvas_.line(at, tip, {paper(), 3.4, 0.9});
    canvas_.dot(at, kDotPixels + 1.2, {paper(), 0, 0.9});
    canvas_.line(at, tip, {ink(), 1.4, 1});
    canvas_.dot(at, kDotPixels, {ink(), 0, 1});
  }

  /// Descent paths, fading from their start to a dot at their end.
  void paths() {
    const std::size_t width = overlay_.path_steps * d_;
    if (width == 0) return;
    for (std::size_t first = 0; first + width <= overlay_.path.size(); first += width) {
      const float* const points = overlay_.path.data() + first;
      std::size_t last = 0;
      while (last + 1 < overlay_.path_steps && std::isfinite(points[(last + 1) * d_])) ++last;
      if (!std::isfinite(points[0])) continue;
      for (std::size_t i = 0; i < last; ++i) {
        const double strength = 0.25 + 0.75 * static_cast<double>(i + 1) / static_cast<double>(last);
        canvas_.line(pixel(points + i * d_), pixel(points + (i + 1) * d_), {from_hex(0x6a1bd1), 1.3, strength});
      }
      canvas_.dot(pixel(points + last * d_), kDotPixels, {from_hex(0x6a1bd1), 0, 1});
    }
  }

 private:
  [[nodiscard]] PixelPoint pixel(const float* point) const {
    return view_.pixel(static_cast<double>(point[0]), static_cast<double>(point[1]));
  }

  void circle(const float* row, const Pen& pen) {
    const double radius = row[d_];
    const double height = d_ == 3 ? view_.slice - static_cast<double>(row[2]) : 0;
    const double squared = radius * radius - height * height;
    if (squared > 0) canvas_.ring(pixel(row), std::sqrt(squared) * view_.pixels_per_unit(), pen);
  }

  // The segment in which the plane z = slice cuts a triangle.
  void cut_triangle(const float* corners, const Pen& pen) {
    std::array<PixelPoint, 3> crossings;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const float* const a = corners + i * 3;
      const float* const b = corners + (i + 1) % 3 * 3;
      const double za = a[2] - view_.slice;
      const double zb = b[2] - view_.slice;
      if ((za < 0) == (zb < 0)) continue;
      const double t = za / (za - zb);
      crossings[count++] =
          view_.pixel(std::lerp(double{a[0]}, double{b[0]}, t), std::lerp(double{a[1]}, double{b[1]}, t));
    }
    if (count == 2) canvas_.line(crossings[0], crossings[1], pen);
  }

  Canvas& canvas_;
  const View& view_;
  const Overlay& overlay_;
  std::size_t d_;
};

std::string required_member(const NpzReader& archive, const std::string& member) {
  std::optional<std::string> bytes = archive.member(member);
  if (!bytes) refuse(archive.member_name(member), "array", "a result of collide with it", "a file without it");
  return *std::move(bytes);
}

}  // namespace

Overlay read_overlay(const std::string& path, int dimension) {
  const std::string bytes = read_input(path);
  const NpzReader archive(bytes, input_name(path));
  Overlay overlay;
  overlay.dimension = static_cast<std::size_t>(dimension);
  overlay.status = parse_npy_uint8(required_member(archive, "status"), archive.member_name("status"));
  const auto vectors = [&](const std::string& member) {
    const RowShape row{{overlay.dimension}, "points"};
    Array array = parse_npy_rows(required_member(archive, member), row, archive.member_name(member));
    if (array.shape[0] != overlay.status.size()) {
      refuse(archive.member_name(member), "shape", fmt::format("{} rows", overlay.status.size()),
             fmt::format("{} rows", array.shape[0]));
    }
    return std::move(array.values);
  };
  overlay.point = vectors("point");
  overlay.normal = vectors("normal");
  const auto of_contacts = [&](const std::string& member) {
    std::optional<std::string> found = archive.member(member);
    if (!found) return std::vector<float>();
    return parse_npy_rows(*found, {{overlay.dimension}, "contacts"}, archive.member_name(member)).values;
  };
  overlay.contact_point = of_contacts("contact_point");
  overlay.contact_normal = of_contacts("contact_normal");
  if (overlay.contact_normal.size() != overlay.contact_point.size()) {
    refuse(archive.member_name("contact_normal"), "shape", "as many rows as contact_point", "another number");
  }
  if (std::optional<std::string> found = archive.member("path")) {
    Array paths = parse_npy(*found, archive.member_name("path"));
    if (paths.shape.size() != 4 || paths.shape[3] != overlay.dimension) {
      refuse(archive.member_name("path"), "shape", fmt::format("(N,S,L,{})", dimension), shape_text(paths.shape));
    }
    overlay.path_steps = paths.shape[2];
    overlay.path = std::move(paths.values);
  }
  return overlay;
}

void draw_overlay(Canvas& canvas, const View& view, const Overlay& overlay) {
  OverlayPainter painter(canvas, view, overlay);
  const auto has = [&](std::size_t row, Status status) {
    return overlay.status[row] == static_cast<std::uint8_t>(status);
  };
  // The many separated ones first, so that they hide nothing.
  for (std::size_t row = 0; row < overlay.status.size(); ++row) {
    if (has(row, Status::separated)) painter.outline(row);
  }
  for (std::size_t row = 0; row < overlay.status.size(); ++row) {
    if (!has(row, Status::separated) && !has(row, Status::bad_row)) painter.outline(row);
  }
  painter.paths();
  const std::size_t d = overlay.dimension;
  for (std::size_t row = 0; row < overlay.status.size(); ++row) {
    if (has(row, Status::overlapping) || has(row, Status::touching)) {
      painter.contact(overlay.point.data() + row * d, overlay.normal.data() + row * d);
    }
  }
  for (std::size_t i = 0; i < overlay.contact_point.size(); i += d) {
    painter.contact(overlay.contact_point.data() + i, overlay.contact_normal.data() + i);
  }
}

}  // namespace thalweg::cli
