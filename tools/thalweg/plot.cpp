// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Numbers and a script for gnuplot, and gnuplot run on them. The colours are those of M. Okabe and K. Ito (2008), which
// people with any of the common colour deficiencies can tell apart.
#include "plot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "failure.h"
#include "input.h"
#include "output.h"

extern char** environ;

namespace thalweg::cli {

namespace {

constexpr std::array<std::string_view, 7> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                      "#E69F00", "#56B4E9", "#000000"};

bool on_path(std::string_view program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string candidate = fmt::format("{}/{}", folder.empty() ? "." : folder, program);
    if (::access(candidate.c_str(), X_OK) == 0) return true;
  }
  return false;
}

// Between single quotes gnuplot takes every character as it is, and two quotes as one.
std::string quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text) result.append(c == '\'' ? 2 : 1, c);
  return result + "'";
}

// One block for each series, as `index` counts them.
std::string numbers_of(const Plot& plot) {
  std::string text;
  for (const PlotSeries& series : plot.series) {
    text += fmt::format("# {}: x y spread\n", series.name);
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      const double spread = series.spread.empty() ? 0 : series.spread[i];
      if (plot.categories.empty()) {
        text += fmt::format("{} {} {}\n", series.x[i], series.y[i], spread);
      } else {
        text += fmt::format("\"{}\" {} {}\n", plot.categories[i], series.y[i], spread);
      }
    }
    text += "\n\n";
  }
  return text;
}

std::string curve(const Plot& plot, std::size_t index) {
  const PlotSeries& series = plot.series[index];
  const std::string_view colour = kColours[index % kColours.size()];
  const std::string title = series.name.empty() ? "notitle" : "title " + quoted(series.name);
  const std::string from = fmt::format("{} index {}", quoted(plot.name + ".dat"), index);
  if (!plot.categories.empty()) {
    return fmt::format("{} using 2:3:xtic(1) {} linecolor rgb '{}'", from, title, colour);
  }
  const std::string_view style = !series.line ? "points" : (series.marks ? "linespoints" : "lines");
  std::string text = fmt::format("{} using 1:2 with {} {} linecolor rgb '{}' linewidth 2 pointtype 7 pointsize 1.2",
                                 from, style, title, colour);
  if (!series.spread.empty()) {
    text += fmt::format(", \\\n  {} using 1:2:3 with yerrorbars notitle linecolor rgb '{}' pointtype 7", from, colour);
  }
  return text;
}

std::string script_of(const Plot& plot) {
  std::string text = fmt::format("# gnuplot {0}.gp draws {0}.png from {0}.dat.\n", plot.name);
  text += fmt::format("if (!exists('picture')) picture = {}\n", quoted(plot.name + ".png"));
  text += "set terminal pngcairo size 1100,700 font 'sans,13' noenhanced\nset output picture\n";
  text += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", quoted(plot.title), quoted(plot.x_label),
                      quoted(plot.y_label));
  text +=
      "set grid back linetype 1 linecolor rgb '#dddddd'\nset border 3\nset tics nomirror\nset key outside bottom "
      "center horizontal maxrows 3 height 1\n";
  text += plot.log_y ? "set format y '%.0s %c'\n" : "set format y '%.1s %c'\n";
  const bool fractions = std::any_of(plot.series.begin(), plot.series.end(), [](const PlotSeries& series) {
    return std::any_of(series.x.begin(), series.x.end(), [](double x) { return x < 1; });
  });
  if (plot.log_x) text += fmt::format("set logscale x\nset format x '{}'\n", fractions ? "%g" : "%.0s %c");
  text += plot.log_y ? "set logscale y\n" : "set yrange [0:*]\n";
  if (!plot.categories.empty()) {
    text += "set style data histograms\nset style histogram errorbars gap 1 linewidth 1\n";
    text += "set style fill solid 0.85 border -1\nset boxwidth 0.9\nset xtics rotate by -25\n";
  }
  text += "plot ";
  for (std::size_t i = 0; i < plot.series.size(); ++i) text += (i == 0 ? "" : ", \\\n  ") + curve(plot, i);
  return text + "\n";
}

void write_file(const std::string& path, std::string_view text) {
  Output output(path);
  output.write(text);
  output.commit();
}

// Runs gnuplot in the folder; returns its exit status. Its words are dropped: the caller reports in one line.
int run_gnuplot(const std::string& folder, const std::string& script, const std::string& picture) {
  const std::string assignment = "picture = " + quoted(picture);
  std::array<std::string, 4> words = {"gnuplot", "-e", assignment, script};
  std::array<char*, 5> arguments = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail(folder + "/" + script, "gnuplot", "a program that starts", system_message(error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

// gnuplot does not notice when its picture does not fit on the disk: a whole one ends with the chunk IEND.
bool is_whole_picture(const std::string& path) {
  constexpr std::string_view kEnd = "IEND\xae\x42\x60\x82";
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::array<char, kEnd.size()> tail = {};
  if (!file || file.tellg() < static_cast<std::streamoff>(tail.size())) return false;
  file.seekg(-static_cast<std::streamoff>(tail.size()), std::ios::end);
  file.read(tail.data(), tail.size());
  return file && std::string_view(tail.data(), tail.size()) == kEnd;
}

}  // namespace

Plotter::Plotter(std::string folder) : folder_(std::move(folder)) {
  if (!on_path("gnuplot")) refuse(kCommandLine, "--plots", "gnuplot on the PATH", "none");
  if (::mkdir(folder_.c_str(), 0777) != 0 && errno != EEXIST) {
    fail(folder_, "folder", "a folder to write to", system_message(errno));
  }
}

void Plotter::draw(const Plot& plot) const {
  write_file(folder_ + "/" + plot.name + ".dat", numbers_of(plot));
  const std::string script = plot.name + ".gp";
  write_file(folder_ + "/" + script, script_of(plot));
  // Beside its target first, so that a failure leaves no half of a picture.
  const std::string unfinished = "." + plot.name + ".png";
  const std::string from = folder_ + "/" + unfinished;
  const int status = run_gnuplot(folder_, script, unfinished);
  const bool whole = status == 0 && is_whole_picture(from);
  if (whole && std::rename(from.c_str(), path(plot).c_str()) == 0) return;
  std::remove(from.c_str());
  fail(folder_ + "/" + script, "gnuplot", "a picture",
       status == 0 ? "a picture that is not whole" : fmt::format("exit status {}", status));
}

}  // namespace thalweg::cli
