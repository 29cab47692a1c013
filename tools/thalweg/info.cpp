// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg info`: the SIMD targets of this machine and, for a scene, what the compiler proves of it.
#include <cmath>
#include <memory>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.h"
#include "input.h"
#include "options.h"
#include "report.h"
#include "thalweg/tape.h"

namespace thalweg::cli {

namespace {

struct InfoOptions {
  std::string scene;
  bool tape = false;
};

// The distinct nodes of a DAG, operands before the nodes that use them.
class NodeList {
 public:
  explicit NodeList(const Shape& root) { add(root); }

  [[nodiscard]] const std::vector<Shape>& nodes() const { return nodes_; }
  [[nodiscard]] std::size_t index(const Shape& shape) const { return indices_.at(shape.identity()); }

  [[nodiscard]] std::vector<std::size_t> operands(const Shape& shape) const {
    std::vector<std::size_t> indices;
    for (const Shape& operand : shape.operands()) indices.push_back(index(operand));
    return indices;
  }

 private:
  void add(const Shape& shape) {
    if (indices_.count(shape.identity()) != 0) return;
    for (const Shape& operand : shape.operands()) add(operand);
    indices_.emplace(shape.identity(), nodes_.size());
    nodes_.push_back(shape);
  }

  std::vector<Shape> nodes_;
  std::unordered_map<const void*, std::size_t> indices_;
};

Json simd_json(const Globals& globals) {
  Json available = Json::array();
  for (const Target& target : targets()) {
    available.push_back({{"name", target.name}, {"fused_multiply_add", target.fused_multiply_add}});
  }
  return {{"active", globals.active_target().name}, {"available", std::move(available)}};
}

Json bounds_json(const Bounds& bounds, int dimension) {
  const auto count = static_cast<std::size_t>(dimension);
  return {{"lo", std::vector<double>(bounds.lo, bounds.lo + count)},
          {"hi", std::vector<double>(bounds.hi, bounds.hi + count)},
          {"empty", bounds.empty(dimension)}};
}

Json facts_json(const Facts& facts) {
  return {{"exactness", {{"outside", name(facts.outside)}, {"inside", name(facts.inside)}}},
          {"lipschitz", facts.lipschitz},
          {"convex", facts.convex},
          {"unsigned", facts.is_unsigned},
          {"bounds", bounds_json(facts.bounds, facts.dimension)}};
}

Json shapes_json(const NodeList& list) {
  Json shapes = Json::array();
  for (const Shape& shape : list.nodes()) {
    shapes.push_back({{"op", shape.op()},
                      {"dimension", shape.dimension()},
                      {"of", list.operands(shape)},
                      {"facts", facts_json(shape.facts())}});
  }
  return shapes;
}

Json scene_json(const InfoOptions& options, const Shape& shape, const Tape& tape) {
  Json json;
  json["scene"] = options.scene;
  json["dimension"] = shape.dimension();
  json["nodes"] = node_count(shape);
  json["facts"] = facts_json(shape.facts());
  json["tape"] = {{"instructions", tape.instructions.size()},
                  {"registers", tape.register_count},
                  {"positions", tape.position_count},
                  {"constants", tape.constants.size()}};
  json["slack"] = {{"a", tape.slack.a}, {"b", tape.slack.b}};
  if (options.tape) json["disassembly"] = tape.disassembly();
  json["shapes"] = shapes_json(NodeList(shape));
  return json;
}

std::string bounds_text(const Bounds& bounds, int dimension) {
  if (bounds.empty(dimension)) return "empty";
  std::string sides;
  for (int axis = 0; axis < dimension; ++axis) {
    sides += fmt::format("{}[{:.6g}, {:.6g}]", axis == 0 ? "" : " x ", bounds.lo[axis], bounds.hi[axis]);
  }
  return sides;
}

std::string yes_no(bool value) { return value ? "yes" : "no"; }

std::string simd_text(const Globals& globals) {
  std::string names;
  for (const Target& target : targets()) {
    const bool active = target.name == globals.active_target().name;
    names += fmt::format("{}{}{}", names.empty() ? "" : ", ", target.name, active ? " (active)" : "");
  }
  return names;
}

std::string shapes_text(const NodeList& list) {
  constexpr std::size_t kMostLines = 60;
  Table table({"node", "op", "of", "outside", "inside", "L", "convex", "bounds"});
  const std::size_t shown = std::min(list.nodes().size(), kMostLines);
  for (std::size_t i = 0; i < shown; ++i) {
    const Shape& shape = list.nodes()[i];
    const Facts& facts = shape.facts();
    const std::string operands = fmt::format("{}", fmt::join(list.operands(shape), " "));
    table.add({fmt::format("{}", i), std::string(shape.op()), operands.empty() ? "-" : operands,
               std::string(name(facts.outside)), std::string(name(facts.inside)),
               fmt::format("{:.6g}", facts.lipschitz), yes_no(facts.convex),
               bounds_text(facts.bounds, facts.dimension)});
  }
  const std::size_t left = list.nodes().size() - shown;
  return table.text() + (left == 0 ? "" : fmt::format("and {} more; --json lists all\n", left));
}

std::string scene_text(const InfoOptions& options, const Shape& shape, const Tape& tape) {
  const Facts& facts = shape.facts();
  Sheet sheet;
  sheet.add("scene", input_name(options.scene));
  sheet.add("dimension", fmt::format("{}", shape.dimension()));
  sheet.add("nodes", fmt::format("{}", node_count(shape)));
  sheet.add("exactness", fmt::format("outside {}, inside {}", name(facts.outside), name(facts.inside)));
  sheet.add("Lipschitz", fmt::format("{:.9g}", facts.lipschitz));
  sheet.add("convex", yes_no(facts.convex));
  sheet.add("unsigned", yes_no(facts.is_unsigned));
  sheet.add("bounds", bounds_text(facts.bounds, facts.dimension));
  sheet.add("tape", fmt::format("{} instructions, {} registers, {} positions, {} constants", tape.instructions.size(),
                                tape.register_count, tape.position_count, tape.constants.size()));
  sheet.add("slack", tape.has_formulas ? "of each value, by intervals"
                                       : fmt::format("{:.3g} + {:.3g} m, m the largest coordinate of a query",
                                                     tape.slack.a, tape.slack.b));
  std::string text = sheet.text() + '\n' + shapes_text(NodeList(shape));
  if (options.tape) text += '\n' + tape.disassembly() + '\n';
  return text;
}

ExitCode run_info(const InfoOptions& options, const Globals& globals) {
  Json json;
  json["thalweg"] = THALWEG_VERSION;
  json["simd"] = simd_json(globals);
  std::string text = fmt::format("thalweg    " THALWEG_VERSION "\nSIMD       {}\n", simd_text(globals));
  if (options.scene.empty() && options.tape) refuse(kCommandLine, "--tape", "a scene to compile", "none");
  if (!options.scene.empty()) {
    const Scene scene = read_scene(options.scene);
    const Tape tape = unwrap(compile(scene.shape), input_name(options.scene), "/shape");
    json.update(scene_json(options, scene.shape, tape));
    text += scene_text(options, scene.shape, tape);
  }
  print_report(globals, false, json, text);
  return ExitCode::done;
}

}  // namespace

Command add_info(CLI::App& app, const Globals& globals) {
  CLI::App* const command = app.add_subcommand("info", "SIMD targets; a scene's facts, tape and nodes");
  const auto options = std::make_shared<InfoOptions>();
  command->add_option("SCENE", options->scene, "Scene file, or - for stdin");
  add_flag(*command, {"--tape", "Print the compiled program"}, options->tape);
  return {command, [options, &globals] { return run_info(*options, globals); }};
}

}  // namespace thalweg::cli
