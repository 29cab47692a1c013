// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg ops`: the op table, as a table, as JSON, as the JSON Schema of scenes, or as the C++ header of builders.
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.h"
#include "options.h"
#include "output.h"
#include "report.h"
#include "thalweg/op_table.h"
#include "thalweg/scene.h"

namespace thalweg::cli {

namespace {

struct OpsOptions {
  bool schema = false;
  bool header = false;
};

Json parameter_json(const OpParameter& parameter) {
  Json json = {{"name", parameter.name},        {"quantity", name(parameter.quantity)},
               {"arity", parameter.arity},      {"least", parameter.least},
               {"most", parameter.most},        {"meaning", parameter.meaning},
               {"optional", parameter.optional}};
  if (parameter.optional) json["default"] = parameter.fallback;
  if (parameter.choices.empty()) return json;
  Json choices = Json::array();
  std::string_view rest = parameter.choices;
  while (!rest.empty()) {
    const std::size_t bar = std::min(rest.find('|'), rest.size());
    choices.push_back(rest.substr(0, bar));
    rest.remove_prefix(std::min(bar + 1, rest.size()));
  }
  json["choices"] = std::move(choices);
  return json;
}

Json ops_json() {
  Json ops = Json::array();
  for (const OpRow& row : op_table()) {
    Json parameters = Json::array();
    for (const OpParameter& parameter : row.parameters) {
      if (!parameter.implicit) parameters.push_back(parameter_json(parameter));
    }
    Json dimension = row.dimension == 0 ? Json(nullptr) : Json(row.dimension);
    ops.push_back({{"name", row.name},
                   {"kind", name(row.kind)},
                   {"dimension", std::move(dimension)},
                   {"parameters", std::move(parameters)},
                   {"exactness", row.exactness},
                   {"note", row.note},
                   {"rounding", row.rounding}});
  }
  Json functions = Json::array();
  for (const FunctionRow& row : function_table()) {
    functions.push_back({{"name", row.name},
                         {"opcode", row.opcode.empty() ? Json(nullptr) : Json(row.opcode)},
                         {"operands", row.operands},
                         {"meaning", row.meaning},
                         {"ulps", row.ulps}});
  }
  return {{"ops", std::move(ops)}, {"functions", std::move(functions)}};
}

std::string parameters_text(const OpRow& row) {
  std::vector<std::string> words;
  for (const OpParameter& parameter : row.parameters) {
    if (parameter.implicit) continue;
    std::string word(parameter.name);
    if (parameter.arity == 0) word += "[]";
    if (parameter.arity > 1) word += fmt::format("[{}]", parameter.arity);
    words.push_back(parameter.optional ? fmt::format("({})", word) : word);
  }
  return words.empty() ? "-" : fmt::format("{}", fmt::join(words, ", "));
}

std::string ops_text() {
  Table table({"op", "kind", "dim", "parameters", "exactness", "note"});
  for (const OpRow& row : op_table()) {
    table.add({std::string(row.name), std::string(name(row.kind)),
               row.dimension == 0 ? "any" : fmt::format("{}", row.dimension), parameters_text(row),
               std::string(row.exactness), std::string(row.note)});
  }
  Table functions({"function", "opcode", "operands", "greatest error", "meaning"});
  for (const FunctionRow& row : function_table()) {
    functions.add({std::string(row.name), row.opcode.empty() ? "-" : std::string(row.opcode),
                   fmt::format("{}", row.operands), row.ulps == 0 ? "none" : fmt::format("{} ulps", row.ulps),
                   std::string(row.meaning)});
  }
  return table.text() + "\n" + functions.text();
}

ExitCode run_ops(const OpsOptions& options, const Globals& globals) {
  if (options.schema + options.header + globals.json > 1) {
    refuse(kCommandLine, "ops", "one of --json, --schema and --header", "several");
  }
  if (options.schema) {
    write_stdout(scene_schema() + "\n");
  } else if (options.header) {
    write_stdout(ops_header());
  } else {
    print_report(globals, false, globals.json ? ops_json() : Json(), ops_text());
  }
  return ExitCode::done;
}

}  // namespace

Command add_ops(CLI::App& app, const Globals& globals) {
  CLI::App* const command = app.add_subcommand("ops", "Every op with its parameters, dimension and exactness");
  const auto options = std::make_shared<OpsOptions>();
  add_flag(*command, {"--schema", "The JSON Schema of scene files"}, options->schema);
  add_flag(*command, {"--header", "The C++ header of builder functions"}, options->header);
  return {command, [options, &globals] { return run_ops(*options, globals); }};
}

}  // namespace thalweg::cli
