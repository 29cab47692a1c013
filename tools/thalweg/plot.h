// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Plots for reports, drawn by gnuplot. Beside each picture stay its numbers and the script, so that anybody can draw it
// again: NAME.png, NAME.dat, NAME.gp.
#pragma once

#include <string>
#include <vector>

namespace thalweg::cli {

struct PlotSeries {
  std::string name;            ///< in the legend; empty: not there
  std::vector<double> x, y;    ///< of one length
  std::vector<double> spread;  ///< half the length of the error bar at each y; empty: none
  bool line = true;            ///< points joined by lines; a series of a roof is a line alone, see `marks`
  bool marks = true;
};

struct Plot {
  std::string name;  ///< of the files
  std::string title, x_label, y_label;
  bool log_x = false;
  bool log_y = false;
  /// With names the series are bars, one group for each name, and x is not used.
  std::vector<std::string> categories;
  std::vector<PlotSeries> series;
};

class Plotter {
 public:
  /// Makes the folder where it is missing; refuses when gnuplot is not on the PATH.
  explicit Plotter(std::string folder);

  void draw(const Plot& plot) const;
  [[nodiscard]] std::string path(const Plot& plot) const { return folder_ + "/" + plot.name + ".png"; }

 private:
  std::string folder_;
};

}  // namespace thalweg::cli
