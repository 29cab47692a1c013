// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "profile_plots.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "plot.h"

namespace thalweg::cli {

namespace {

std::string label(Gradient strategy) { return std::string(name(strategy)); }

Plot sweep_plot(const ProfileReport& report, bool near_kinks) {
  Plot plot;
  plot.name = near_kinks ? "offset_near_kinks" : "offset_away_from_kinks";
  plot.title = near_kinks ? "99 % of the errors near kinks against the offset"
                          : "Median error away from kinks against the offset";
  plot.x_label = "offset o, in diagonals of the scene";
  plot.y_label = "angular error, radians";
  plot.log_x = plot.log_y = true;
  for (const OffsetSweep& sweep : report.sweeps) {
    PlotSeries series;
    series.name = label(sweep.strategy);
    series.x = sweep.offset;
    for (const AngleErrors& errors : near_kinks ? sweep.kinks : sweep.smooth) {
      series.y.push_back(near_kinks ? errors.p99 : errors.median);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot lost_plot(const ProfileReport& report) {
  Plot plot;
  plot.name = "offset_lost";
  plot.title = "Gradients in the wrong half space, or zero, against the offset";
  plot.x_label = "offset o, in diagonals of the scene";
  plot.y_label = "share of the points, %";
  plot.log_x = true;
  for (const OffsetSweep& sweep : report.sweeps) {
    PlotSeries series;
    series.name = label(sweep.strategy);
    series.x = sweep.offset;
    for (std::size_t i = 0; i < sweep.offset.size(); ++i) {
      const AngleErrors& a = sweep.smooth[i];
      const AngleErrors& b = sweep.kinks[i];
      const double lost = (a.wrong_half_space + a.vanished) * static_cast<double>(a.count) +
                          (b.wrong_half_space + b.vanished) * static_cast<double>(b.count);
      series.y.push_back(100 * lost / static_cast<double>(std::max<std::size_t>(1, a.count + b.count)));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot band_plot(const ProfileReport& report) {
  Plot plot;
  plot.name = "distance";
  plot.title = "99 % of the errors by distance from the surface";
  plot.x_label = "|f| in diagonals of the scene";
  plot.y_label = "angular error, radians";
  plot.log_y = true;
  plot.categories.assign(kBandNames.begin(), kBandNames.end());
  for (const StrategyProfile& profile : report.strategies) {
    PlotSeries series;
    series.name = label(profile.strategy);
    for (const AngleErrors& band : profile.bands) series.y.push_back(band.p99);
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot cost_plot(const ProfileReport& report) {
  Plot plot;
  plot.name = "cost";
  plot.title = "Median error away from kinks against the cost of a gradient";
  plot.x_label = "nanoseconds a gradient, one thread";
  plot.y_label = "angular error, radians";
  plot.log_x = plot.log_y = true;
  for (const StrategyProfile& profile : report.strategies) {
    PlotSeries series;
    series.name = label(profile.strategy);
    series.x = {profile.nanoseconds};
    series.y = {profile.smooth.median};
    series.line = false;
    plot.series.push_back(std::move(series));
  }
  return plot;
}

using Measure = std::function<double(const DescentProfile&)>;

/// Methods side by side, a bar for each strategy.
Plot descent_plot(const ProfileReport& report, Plot plot, const Measure& measure) {
  for (const DescentProfile& descent : report.descents) {
    const std::string method(name(descent.method));
    if (plot.categories.empty() || plot.categories.back() != method) plot.categories.push_back(method);
    const std::string strategy = label(descent.strategy);
    auto series = std::find_if(plot.series.begin(), plot.series.end(),
                               [&](const PlotSeries& known) { return known.name == strategy; });
    if (series == plot.series.end()) {
      series = plot.series.insert(series, PlotSeries());
      series->name = strategy;
    }
    series->y.push_back(measure(descent));
  }
  return plot;
}

}  // namespace

std::vector<std::string> draw_profile(const ProfileReport& report, const std::string& folder,
                                      const std::string& scene) {
  Plot misses, errors, costs;
  misses.name = "descent_misses", misses.title = "Overlaps that a descent misses", misses.y_label = "% of the overlaps";
  errors.name = "descent_errors", errors.title = "99 % of a descent's errors of the least value";
  errors.y_label = "diagonals of the scene", errors.log_y = true;
  costs.name = "descent_cost", costs.title = "Cost of a descent", costs.y_label = "nanoseconds a triangle, one thread";
  costs.log_y = true;
  std::vector<Plot> plots = {cost_plot(report), band_plot(report)};
  if (!report.sweeps.empty()) {
    plots.insert(plots.end(), {sweep_plot(report, false), sweep_plot(report, true), lost_plot(report)});
  }
  plots.push_back(descent_plot(report, misses, [](const DescentProfile& d) {
    return 100 * static_cast<double>(d.misses) / static_cast<double>(std::max<std::size_t>(1, d.hits));
  }));
  plots.push_back(descent_plot(report, errors, [](const DescentProfile& d) { return std::max(d.p99_error, 1e-8); }));
  plots.push_back(descent_plot(report, costs, [](const DescentProfile& d) { return d.nanoseconds; }));
  const Plotter plotter(folder);
  std::vector<std::string> paths;
  for (Plot& plot : plots) {
    plot.title += fmt::format(" ({})", scene);
    plotter.draw(plot);
    paths.push_back(plotter.path(plot));
  }
  return paths;
}

}  // namespace thalweg::cli
