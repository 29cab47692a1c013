// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What a command is to the program: an entry of the command line and what runs when it was named.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "failure.h"
#include "thalweg/batch.h"
#include "thalweg/simd.h"

namespace thalweg::cli {

/// Options that every command takes, before or after its name.
struct Globals {
  int threads = 0;                 ///< 0: all cores
  const Target* target = nullptr;  ///< null: default_target()
  std::uint64_t seed = 1;
  bool json = false;
  bool quiet = false;

  [[nodiscard]] Execution execution() const;
  [[nodiscard]] const Target& active_target() const;
};

struct Command {
  CLI::App* app = nullptr;  ///< parsed() when the command was named
  std::function<ExitCode()> run;
};

/// Adds a command's options below `app`; `globals` outlives the command.
using AddCommand = Command (*)(CLI::App& app, const Globals& globals);

Command add_info(CLI::App& app, const Globals& globals);
Command add_ops(CLI::App& app, const Globals& globals);
Command add_eval(CLI::App& app, const Globals& globals);
Command add_collide(CLI::App& app, const Globals& globals);
Command add_distance(CLI::App& app, const Globals& globals);
Command add_sweep(CLI::App& app, const Globals& globals);
Command add_render(CLI::App& app, const Globals& globals);
Command add_profile(CLI::App& app, const Globals& globals);
Command add_stress(CLI::App& app, const Globals& globals);
Command add_demo(CLI::App& app, const Globals& globals);  ///< in a library of its own, see demo.cpp

/// Parses the command line and runs the command that it names; every failure becomes its line and its exit code.
[[nodiscard]] int run(int argc, const char* const* argv, std::span<const AddCommand> commands);

}  // namespace thalweg::cli
