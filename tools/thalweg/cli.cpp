// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The command line as a whole: global options, the commands, and the turning of every failure into one line.
#include <exception>
#include <new>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.h"
#include "options.h"
#include "output.h"

namespace thalweg::cli {

namespace {

constexpr std::uint64_t kMostThreads = 4096;
constexpr const char* kGlobalsLine =
    "Also of every command: --threads, --isa, --seed, --json, --quiet; see thalweg --help.";

std::string target_names() {
  std::vector<std::string_view> names;
  for (const Target& target : targets()) names.push_back(target.name);
  return fmt::format("one of {}", fmt::join(names, ", "));
}

void add_globals(CLI::App& app, Globals& globals, std::uint64_t& threads) {
  add_integer(app, {"--threads", "How many threads; 0: all cores; 1: no pool"}, threads, {0, kMostThreads});
  const auto choose_target = [&globals](const std::string& word) {
    globals.target = find_target(word);
    if (globals.target == nullptr) refuse(kCommandLine, "--isa", target_names(), fmt::format("'{}'", word));
  };
  app.add_option_function<std::string>("--isa", choose_target, "SIMD target, by a name that info gives")
      ->type_name("NAME");
  add_integer(app, {"--seed", "Seed of everything random"}, globals.seed, {0, UINT64_MAX});
  add_flag(app, {"--json", "One machine-readable report on stdout"}, globals.json);
  add_flag(app, {"--quiet", "No summary and no progress"}, globals.quiet);
  app.set_version_flag("--version", "thalweg " THALWEG_VERSION, "Print the version");
}

// What stands before the first colon of a message of CLI11 is the option's name.
std::pair<std::string, std::string> cut_at_colon(const std::string& message) {
  const std::size_t colon = message.find(": ");
  if (colon == std::string::npos) return {"arguments", message};
  return {message.substr(0, colon), message.substr(colon + 2)};
}

std::string command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return fmt::format("a command: {}", fmt::join(names, ", "));
}

// Says in the project's words what CLI11 refuses.
[[noreturn]] void refuse_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  const std::string message = error.what();
  if (app.get_subcommands().empty() && dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) {
    const std::vector<std::string> words = app.remaining();
    refuse(kCommandLine, "COMMAND", command_names(app), words.empty() ? "nothing" : fmt::format("'{}'", words.front()));
  }
  const std::string place = app.get_subcommands().empty() ? "arguments" : app.get_subcommands().front()->get_name();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::string extras = cut_at_colon(message).second;
    refuse(kCommandLine, place, "its own options and arguments alone", extras);
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    refuse(kCommandLine, message.substr(0, message.find(" is required")), "a value", "nothing");
  }
  const auto [option, detail] = cut_at_colon(message);
  if (detail.find("missing") != std::string::npos) refuse(kCommandLine, option, "a value", "too few values");
  refuse(kCommandLine, place, "a valid command line", message);
}

// Runs CLI11; returns false when it has printed help or the version.
bool parse(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    std::ostringstream text;
    std::ostringstream unused;
    app.exit(request, text, unused);
    write_stdout(text.str());
    return false;
  } catch (const CLI::ParseError& error) {
    refuse_parse_error(app, error);
  }
  return true;
}

ExitCode parse_and_run(int argc, const char* const* argv, std::span<const AddCommand> add_commands) {
  Globals globals;
  std::uint64_t threads = 0;
  CLI::App app("Collision queries against signed distance fields, in large batches.", "thalweg");
  add_globals(app, globals, threads);
  app.require_subcommand(1);
  std::vector<Command> commands;
  for (const AddCommand add : add_commands) {
    commands.push_back(add(app, globals));
    commands.back().app->fallthrough();  // global options may follow the command's name
    CLI::App& command = *commands.back().app;
    command.footer(std::string(kGlobalsLine) + (command.get_footer().empty() ? "" : "\n\n" + command.get_footer()));
  }
  if (!parse(app, argc, argv)) return ExitCode::done;
  globals.threads = static_cast<int>(threads);
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  return ExitCode::done;
}

int report(ExitCode code, std::string_view line) {
  write_stderr(fmt::format("{}\n", line));
  return static_cast<int>(code);
}

}  // namespace

Execution Globals::execution() const {
  Execution execution;
  execution.threads = threads;
  execution.target = target;
  return execution;
}

const Target& Globals::active_target() const { return target != nullptr ? *target : default_target(); }

int run(int argc, const char* const* argv, std::span<const AddCommand> commands) {
  try {
    return static_cast<int>(parse_and_run(argc, argv, commands));
  } catch (const Failure& failure) {
    return report(failure.code(), failure.what());
  } catch (const std::bad_alloc&) {
    return report(ExitCode::machine, "thalweg: memory: allocation: expected enough memory, found too little");
  } catch (const std::length_error&) {
    return report(ExitCode::machine, "thalweg: memory: allocation: expected enough memory, found too little");
  } catch (const std::exception& error) {
    return report(ExitCode::machine, error_line({"thalweg", "run", "to finish", error.what()}));
  }
}

}  // namespace thalweg::cli
