// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg render`: a picture of the field, of a slice z = Z for a scene in space, with results drawn over it.
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "command.h"
#include "input.h"
#include "options.h"
#include "output.h"
#include "overlay.h"
#include "picture.h"
#include "queries.h"
#include "report.h"

namespace thalweg::cli {

namespace {

constexpr double kMostPixels = 67108864;  // a picture of 800 MB in memory
constexpr float kOverlayWash = 0.2F;

struct RenderOptions {
  std::string scene, output, overlay, triangles, circles;
  PictureMode mode = PictureMode::distance;
  GradientOptions gradient;
  std::vector<double> bounds, size, slice;

  [[nodiscard]] double z() const { return slice.empty() ? 0 : slice[0]; }
};

std::array<std::size_t, 2> picture_size(const std::vector<double>& size) {
  for (const double side : size) {
    if (side != std::floor(side) || side < 1 || side > 65535) {
      refuse(kCommandLine, "--size", "two whole numbers from 1 to 65535", fmt::format("{}", side));
    }
  }
  if (size[0] * size[1] > kMostPixels) {
    refuse(kCommandLine, "--size", fmt::format("at most {} pixels", kMostPixels), fmt::format("{}", size[0] * size[1]));
  }
  return {static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[1])};
}

ViewRequest view_request(const RenderOptions& options) {
  ViewRequest request;
  if (!options.bounds.empty()) {
    request.bounds = {options.bounds[0], options.bounds[1], options.bounds[2], options.bounds[3]};
  }
  if (!options.size.empty()) request.size = picture_size(options.size);
  request.slice = options.z();
  return request;
}

void check(const RenderOptions& options) {
  if (!has_extension(options.output, ".png") && !is_stream(options.output)) {
    refuse(kCommandLine, "--output", "a name that ends in .png, or -", options.output);
  }
  if (options.overlay.empty() && !(options.triangles.empty() && options.circles.empty())) {
    refuse(kCommandLine, "--overlay", "the result that belongs to the queries", "none");
  }
}

Overlay read_result(const RenderOptions& options, int dimension) {
  Overlay overlay = read_overlay(options.overlay, dimension);
  const auto rows_of = [&](const std::string& path, Array (*read)(const std::string&, int)) {
    Array array = read(path, dimension);
    if (array.shape[0] != overlay.status.size()) {
      refuse(input_name(path), "shape", fmt::format("{} rows, as in {}", overlay.status.size(), options.overlay),
             fmt::format("{} rows", array.shape[0]));
    }
    return std::move(array.values);
  };
  if (!options.triangles.empty()) overlay.triangles = rows_of(options.triangles, read_triangles);
  if (!options.circles.empty()) overlay.circles = rows_of(options.circles, read_circles);
  return overlay;
}

ExitCode run_render(const RenderOptions& options, const Globals& globals) {
  check(options);
  const Stopwatch watch;
  const ViewRequest request = view_request(options);
  const Scene scene = read_scene(options.scene);
  const Tape tape = unwrap(compile(scene.shape), input_name(options.scene), "/shape");
  if (scene.dimension == 2 && !options.slice.empty()) {
    refuse(kCommandLine, "--slice", "a scene of dimension 3", "a scene of dimension 2");
  }
  const View view = choose_view(request, tape.facts);
  const Overlay overlay = options.overlay.empty() ? Overlay() : read_result(options, scene.dimension);
  Output output(options.output);
  Canvas canvas =
      draw_field(tape, view, {options.mode, options.overlay.empty() ? 0 : kOverlayWash, options.gradient}, globals);
  draw_overlay(canvas, view, overlay);
  output.write(canvas.png());
  output.commit();

  const double seconds = watch.seconds();
  Json json = {{"command", "render"},
               {"scene", options.scene},
               {"bounds", {view.x0, view.y0, view.x1, view.y1}},
               {"size", {view.width, view.height}},
               {"elapsed_seconds", seconds},
               {"output", options.output}};
  Sheet sheet;
  sheet.add("picture", fmt::format("{} x {} pixels", view.width, view.height));
  sheet.add("bounds", fmt::format("[{:.6g}, {:.6g}] x [{:.6g}, {:.6g}]", view.x0, view.x1, view.y0, view.y1));
  sheet.add("elapsed", fmt::format("{:.3g} s", seconds));
  print_report(globals, output.is_stdout(), json, sheet.text());
  return ExitCode::done;
}

}  // namespace

Command add_render(CLI::App& app, const Globals& globals) {
  CLI::App* const command = app.add_subcommand("render", "A picture of the field");
  const auto options = std::make_shared<RenderOptions>();
  command->add_option("SCENE", options->scene, "Scene file, or - for stdin")->required();
  add_output(*command, options->output, ".png, or - for stdout");
  add_word(*command, {"--mode", "inside, distance (default), gradient, error or steps"}, options->mode,
           &parse_picture_mode)
      ->type_name("MODE");
  add_word(*command, {"--gradient", "Strategy of the modes gradient, error and steps; default autodiff"},
           options->gradient.strategy, &parse_gradient)
      ->type_name("STRATEGY");
  add_gradient_offset(*command, options->gradient.offset);
  add_numbers(*command,
              {"--bounds", "x0 y0 x1 y1; default: those of the shape and 10 % more, -1 -1 1 1 for one without"},
              options->bounds, 4);
  add_numbers(*command, {"--size", "Width and height in pixels; default: 1280 along the longer side"}, options->size,
              2);
  add_numbers(*command, {"--slice", "z of the plane that is shown of a scene in space; default 0"}, options->slice, 1);
  command->add_option("--overlay", options->overlay, "A result of collide: contact points and normals are drawn");
  command->add_option("--triangles", options->triangles, "The triangles of that result, drawn by status");
  command->add_option("--circles", options->circles, "The circles or spheres of that result, drawn by status");
  return {command, [options, &globals] { return run_render(*options, globals); }};
}

}  // namespace thalweg::cli
