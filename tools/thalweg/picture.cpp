// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Colouring the field. Each pixel is sampled at four points; their mean colour is its ground, and their differences
// give the slope of f per pixel, so that lines of equal f have an even width without looking at neighbours.
//
// Blue is inside and orange outside: the pair that all common kinds of colour blindness keep apart, and the lightness
// differs as well.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "legend.h"
#include "measures.h"
#include "picture.h"
#include "progress.h"

namespace thalweg::cli {

namespace {

constexpr std::size_t kSamples = 4;  // per pixel: two by two
constexpr std::size_t kStripPixels = std::size_t{1} << 16;
constexpr std::size_t kStripRows = 64;  // or more, where they are short

struct Samples {
  std::vector<float> points, value, gradient;
  std::vector<float> row_major;  // values as a grid has them
  std::vector<float> measure;    // what `error` and `steps` show, as a share of their scale
};

// One pixel's four samples, in the order top left, top right, bottom left, bottom right.
struct Pixel {
  std::span<const float> value;
  std::span<const float> gradient;  // kSamples times the dimension; empty unless asked for
  std::span<const float> measure;   // empty unless asked for
  std::size_t dimension = 2;

  [[nodiscard]] float mean() const { return (value[0] + value[1] + value[2] + value[3]) / 4; }
  /// |change of f| per pixel
  [[nodiscard]] float slope() const {
    const float dx = value[1] - value[0] + value[3] - value[2];
    const float dy = value[2] - value[0] + value[3] - value[1];
    return std::max(std::hypot(dx, dy), 1e-30F);
  }
};

// The largest of 1, 2, 5 times a power of ten that is at most x.
float round_step(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  const double lead = x / power;
  return static_cast<float>(power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1));
}

// How much of a pixel a line of this width covers whose middle is `distance` pixels away.
float stroke(float distance, float width) { return std::clamp(width / 2 + 0.5F - std::fabs(distance), 0.0F, 1.0F); }

class Painter {
 public:
  Painter(const View& view, PictureStyle style)
      : style_(style),
        reach_(static_cast<float>(0.3 * std::hypot(view.x1 - view.x0, view.y1 - view.y0))),
        step_(round_step((view.x1 - view.x0) / 24)) {}

  [[nodiscard]] Colour operator()(const Pixel& pixel) const {
    const float mean = pixel.mean();
    if (!std::isfinite(mean)) return unknown_;
    Colour colour = ground(pixel);
    const float slope = pixel.slope();
    if (style_.mode == PictureMode::distance) colour = mix(colour, ink_, isolines(mean, slope));
    colour = mix(colour, paper_, style_.wash);
    return mix(colour, ink_, 0.9F * stroke(mean / slope, 2));
  }

 private:
  [[nodiscard]] Colour ground(const Pixel& pixel) const {
    Colour sum;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const float f = pixel.value[i];
      Colour colour;
      if (style_.mode == PictureMode::inside) {
        colour = f < 0 ? inside_(0.45F) : outside_(0.05F);
      } else if (style_.mode == PictureMode::distance) {
        colour = distance_colour(f);
      } else if (!pixel.measure.empty()) {
        colour = std::isnan(pixel.measure[i]) ? unknown_ : measure_(pixel.measure[i]);
      } else {
        colour = gradient_colour(pixel.gradient.subspan(i * pixel.dimension, pixel.dimension), f < 0);
      }
      sum = sum + colour;
    }
    return sum * (1.0F / kSamples);
  }

  // Half steady, half in steps: the bands read as contour lines on a map do.
  [[nodiscard]] Colour distance_colour(float f) const {
    const float depth = std::fabs(f);
    const float banded = (std::floor(depth / step_) + 0.5F) * step_;
    const float share = 1 - std::exp(-std::lerp(depth, banded, 0.6F) / reach_);
    return f < 0 ? inside_(0.15F + 0.85F * std::min(1.6F * share, 1.0F)) : outside_(share);
  }

  // Direction as hue at one lightness; what of the gradient leaves the plane fades to grey, and so does a gradient
  // that vanishes.
  [[nodiscard]] static Colour gradient_colour(std::span<const float> g, bool inside) {
    const float in_plane = std::hypot(g[0], g[1]);
    const float length = g.size() == 3 ? std::hypot(in_plane, g[2]) : in_plane;
    const float share = length > 0 && std::isfinite(length) ? in_plane / length : 0.0F;
    const float hue = share > 0 ? std::atan2(g[1], g[0]) : 0.0F;
    return from_oklch(inside ? 0.58F : 0.76F, 0.12F * share, hue);
  }

  // Thin lines at every step, stronger at every fifth; left out where they would run together.
  [[nodiscard]] float isolines(float f, float slope) const {
    const float spacing = step_ / slope;
    const float index = std::round(f / step_);
    if (index == 0) return 0;  // the surface has a line of its own
    const float distance = (f - index * step_) / slope;
    const bool strong = std::fmod(std::fabs(index), 5.0F) < 0.5F;
    const float visible = std::clamp((spacing - 3) / 6, 0.0F, 1.0F);
    return visible * (strong ? 0.45F : 0.2F) * stroke(distance, 1);
  }

  PictureStyle style_;
  float reach_, step_;
  Colour ink_ = ink();
  Colour paper_ = paper();
  Colour unknown_ = from_hex(0x9a9a9a);
  Ramp measure_ = measure_ramp();
  Ramp inside_{{0.90F, 0.04F, 4.35F}, {0.36F, 0.12F, 4.55F}};
  Ramp outside_{{0.975F, 0.015F, 1.35F}, {0.66F, 0.16F, 0.95F}};
};

// The samples of some rows of pixels: two by two each, y downwards.
Grid sample_grid(const View& view, std::size_t first_row, std::size_t rows) {
  const double dx = (view.x1 - view.x0) / static_cast<double>(view.width);
  const double dy = (view.y1 - view.y0) / static_cast<double>(view.height);
  Grid grid;
  grid.origin[0] = view.x0 + 0.25 * dx;
  grid.origin[1] = view.y1 - (static_cast<double>(first_row) + 0.25) * dy;
  grid.origin[2] = view.slice;
  grid.step[0][0] = 0.5 * dx;
  grid.step[1][1] = -0.5 * dy;
  grid.size[0] = 2 * view.width;
  grid.size[1] = 2 * rows;
  return grid;
}

// Pixel by pixel from row by row.
std::size_t sample_column(std::size_t sample) { return sample / kSamples * 2 + sample % 2; }

void place_samples(const Grid& grid, std::size_t dimension, Samples& samples) {
  samples.points.resize(grid.count() * dimension);
  float* to = samples.points.data();
  for (std::size_t j = 0; j < grid.size[1]; j += 2) {
    for (std::size_t i = 0; i < 2 * grid.size[0]; ++i, to += dimension) {
      grid.point(sample_column(i), j + i / 2 % 2, 0, static_cast<int>(dimension), to);
    }
  }
}

void evaluate_samples(const Tape& tape, const PictureStyle& style, const Execution& execution, Samples& samples) {
  const auto dimension = static_cast<std::size_t>(tape.dimension);
  const std::size_t count = samples.points.size() / dimension;
  samples.value.resize(count);
  samples.gradient.resize(count * dimension);
  const PointColumns columns{.value = samples.value.data(), .gradient = samples.gradient.data()};
  static_cast<void>(unwrap(evaluate(tape, Points{samples.points.data(), count}, style.gradient, columns, execution),
                           kCommandLine, "--gradient"));
  if (style.mode == PictureMode::error) samples.measure = error_shares(tape, samples.points, samples.gradient);
}

// How far from the surface the picture of the inside depends on more than the sign: its line is 2 pixels wide, and
// the samples of a pixel that it touches lie within 3 L pixels of 0.
float band_of(const Tape& tape, const View& view) {
  const double pixel = std::max((view.x1 - view.x0) / static_cast<double>(view.width),
                                (view.y1 - view.y0) / static_cast<double>(view.height));
  return static_cast<float>(4 * tape.facts.lipschitz * pixel);
}

// Where only the value is shown.
void evaluate_values(const Tape& tape, const Grid& grid, float band, const Execution& execution, Samples& samples) {
  samples.row_major.resize(grid.count());
  samples.value.resize(grid.count());
  static_cast<void>(evaluate_grid(tape, grid, {.value = samples.row_major.data(), .band = band}, execution));
  float* to = samples.value.data();
  for (std::size_t j = 0; j < grid.size[1]; j += 2) {
    for (std::size_t i = 0; i < 2 * grid.size[0]; ++i) {
      *to++ = samples.row_major[(j + i / 2 % 2) * grid.size[0] + sample_column(i)];
    }
  }
}

void sample(const Tape& tape, const View& view, const Grid& grid, const PictureStyle& style, const Execution& execution,
            Samples& samples) {
  if (style.mode == PictureMode::inside || style.mode == PictureMode::distance) {
    const bool signs = style.mode == PictureMode::inside;
    const float band = signs ? band_of(tape, view) : std::numeric_limits<float>::infinity();
    evaluate_values(tape, grid, band, execution, samples);
    return;
  }
  place_samples(grid, static_cast<std::size_t>(tape.dimension), samples);
  if (style.mode == PictureMode::steps) {
    evaluate_values(tape, grid, std::numeric_limits<float>::infinity(), execution, samples);
    samples.measure = step_shares(tape, samples.points, style.gradient, execution);
  } else {
    evaluate_samples(tape, style, execution, samples);
  }
}

}  // namespace

Result<PictureMode> parse_picture_mode(std::string_view text) {
  if (text == "inside") return PictureMode::inside;
  if (text == "distance") return PictureMode::distance;
  if (text == "gradient") return PictureMode::gradient;
  if (text == "error") return PictureMode::error;
  if (text == "steps") return PictureMode::steps;
  return Error{"", "", "inside, distance, gradient, error or steps", fmt::format("'{}'", text)};
}

Canvas draw_field(const Tape& tape, const View& view, PictureStyle style, const Globals& globals) {
  Canvas canvas(view.width, view.height);
  const Painter painter(view, style);
  const auto dimension = static_cast<std::size_t>(tape.dimension);
  const std::size_t strip_rows = std::max(kStripPixels / view.width, kStripRows);
  Progress progress("render", view.width * view.height * kSamples, globals.quiet);
  Execution execution = globals.execution();
  execution.done = progress.done();
  Samples samples;
  for (std::size_t first = 0; first < view.height; first += strip_rows) {
    const std::size_t rows = std::min(strip_rows, view.height - first);
    sample(tape, view, sample_grid(view, first, rows), style, execution, samples);
    for (std::size_t i = 0; i < rows * view.width; ++i) {
      const auto part = [&](const std::vector<float>& numbers, std::size_t width) {
        const std::span<const float> all = numbers;
        return all.empty() ? all : all.subspan(i * kSamples * width, kSamples * width);
      };
      const Pixel pixel{part(samples.value, 1), part(samples.gradient, dimension), part(samples.measure, 1), dimension};
      canvas.at(i % view.width, first + i / view.width) = painter(pixel);
    }
  }
  if (style.mode == PictureMode::error) draw_legend(canvas, error_legend());
  if (style.mode == PictureMode::steps) draw_legend(canvas, steps_legend());
  return canvas;
}

}  // namespace thalweg::cli
