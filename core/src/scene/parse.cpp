// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A scene document to a Shape. What a node may hold is read from the op table; nothing here knows an op by name but
// `ref`, which is not an op: it stands for a node of `define`.
#include <algorithm>
#include <map>
#include <set>

#include "ops/registry.h"
#include "scene/json_text.h"
#include "scene/text.h"
#include "shape/validate.h"
#include "thalweg/scene.h"

namespace thalweg {
namespace {

using nlohmann::json;
using ops::Entry;

std::string type_and_value(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "an array of " + std::to_string(value.size());
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

class SceneParser {
 public:
  SceneParser(const json& document, std::string_view file, const ReadText& read_text)
      : document_(document), file_(file), read_text_(read_text) {}

  Result<Scene> parse() {
    if (!document_.is_object()) return fault("", "an object", type_and_value(document_));
    static constexpr std::string_view kKeys[] = {"thalweg", "dimension", "shape", "define"};
    for (const auto& [key, value] : document_.items()) {
      if (std::ranges::find(kKeys, key) == std::end(kKeys)) {
        return fault("/" + scene::pointer_step(key), "one of thalweg, dimension, shape, define", scene::in_quotes(key));
      }
    }
    if (auto error = header()) return *error;
    if (auto error = definitions()) return *error;
    auto shape = node(document_["shape"], "/shape");
    if (!shape) return shape.error();
    return Scene{*std::move(shape), dimension_};
  }

 private:
  Error fault(std::string place, std::string expected, std::string found) const {
    return {std::string(file_), std::move(place), std::move(expected), std::move(found)};
  }

  std::optional<Error> header() {
    for (const char* key : {"thalweg", "dimension", "shape"}) {
      if (!document_.contains(key)) return fault("", std::string("the key \"") + key + "\"", "none");
    }
    const json& version = document_["thalweg"];
    if (!version.is_number() || version != 1) return fault("/thalweg", "1", type_and_value(version));
    const json& dimension = document_["dimension"];
    if (!dimension.is_number() || (dimension != 2 && dimension != 3)) {
      return fault("/dimension", "2 or 3", type_and_value(dimension));
    }
    dimension_ = dimension == 2 ? 2 : 3;
    return std::nullopt;
  }

  /// Every definition is read, used or not, so that a fault in one never goes unseen.
  std::optional<Error> definitions() {
    if (!document_.contains("define")) return std::nullopt;
    const json& define = document_["define"];
    if (!define.is_object()) return fault("/define", "an object", type_and_value(define));
    for (const auto& [key, value] : define.items()) {
      if (auto shape = definition(key, ""); !shape) return shape.error();
    }
    return std::nullopt;
  }

  Result<Shape> definition(const std::string& key, const std::string& place) {
    if (const auto found = defined_.find(key); found != defined_.end()) return found->second;
    if (!document_.contains("define") || !document_["define"].contains(key)) {
      return fault(place, "a name of \"define\"", scene::in_quotes(key));
    }
    if (!open_.insert(key).second)
      return fault(place, "definitions without a cycle", scene::in_quotes(key) + " in itself");
    auto shape = node(document_["define"][key], "/define/" + scene::pointer_step(key));
    open_.erase(key);
    if (shape) defined_.emplace(key, *shape);
    return shape;
  }

  Result<Shape> node(const json& value, const std::string& place) {
    if (++depth_ > scene::kDeepestNesting) {
      return fault(place, "nodes nested at most " + std::to_string(scene::kDeepestNesting) + " deep", "deeper ones");
    }
    auto shape = node_of_any_depth(value, place);
    --depth_;
    return shape;
  }

  Result<Shape> node_of_any_depth(const json& value, const std::string& place) {
    if (!value.is_object()) return fault(place, "a node (an object)", type_and_value(value));
    if (!value.contains("op")) return fault(place, "the key \"op\"", "none");
    if (!value["op"].is_string()) return fault(place + "/op", "the name of an op", type_and_value(value["op"]));
    const auto op = value["op"].get<std::string>();
    if (op == "ref") return reference(value, place);
    const auto rows = ops::find_ops(op, dimension_);
    if (rows.empty()) {
      return fault(place + "/op", "an op of dimension " + std::to_string(dimension_), type_and_value(value["op"]));
    }
    const int row = best_row(rows, value);
    const Entry& entry = ops::registry()[static_cast<std::size_t>(row)];
    if (auto error = unknown_key(entry, value, place)) return *error;
    if (entry.row.kind == OpKind::formula) return formula(entry, value, place);
    std::vector<double> numbers;
    for (const OpParameter& parameter : entry.row.parameters) {
      if (auto error = read(parameter, value, place, numbers)) return *error;
    }
    std::vector<Shape> of;
    if (has_operands(entry)) {
      if (auto error = operands(entry, value, place, of)) return *error;
    }
    auto shape = Shape::make(row, numbers, std::move(of));
    if (shape) return shape;
    Error error = shape.error();
    error.file = file_;
    error.place = place + "/" + error.place;
    return error;
  }

  Result<Shape> reference(const json& value, const std::string& place) {
    for (const auto& [key, unused] : value.items()) {
      if (key != "op" && key != "name") {
        return fault(place + "/" + scene::pointer_step(key), "one of op, name", scene::in_quotes(key));
      }
    }
    if (!value.contains("name")) return fault(place, "the key \"name\"", "none");
    if (!value["name"].is_string()) return fault(place + "/name", "a string", type_and_value(value["name"]));
    return definition(value["name"].get<std::string>(), place + "/name");
  }

  static bool has_operands(const Entry& entry) {
    return entry.row.kind != OpKind::primitive && entry.row.kind != OpKind::formula;
  }

  /// A leaf with a text, in the scene or in a file that it names.
  Result<Shape> formula(const Entry& entry, const json& value, const std::string& place) const {
    std::string names, given;
    for (const OpParameter& parameter : entry.row.parameters) {
      const std::string key(parameter.name);
      names += (names.empty() ? "" : " or ") + scene::in_quotes(key);
      if (!value.contains(key)) continue;
      if (!given.empty()) return fault(place + "/" + key, "only one of " + names, "both");
      given = key;
    }
    if (given.empty()) return fault(place, "the key " + names, "none");
    const std::string here = place + "/" + given;
    const json& found = value[given];
    if (!found.is_string()) return fault(here, "a string", type_and_value(found));
    auto text = found.get<std::string>();
    if (given == "file") {
      if (read_text_ == nullptr) return fault(here, "the program itself, as \"text\"", "a file");
      auto read = read_text_(text);
      if (!read) return fault(here, read.error().expected, read.error().found);
      text = *std::move(read);
    }
    auto shape = Shape::formula(entry.row.name, dimension_, text);
    if (shape) return shape;
    const Error& error = shape.error();
    return fault(error.place.empty() ? here : here + ":" + error.place, error.expected, error.found);
  }

  /// Of rows with one name, the first whose required parameters are all there; else the first.
  static int best_row(const std::vector<int>& rows, const json& value) {
    for (const int row : rows) {
      const auto& parameters = ops::registry()[static_cast<std::size_t>(row)].row.parameters;
      const bool complete = std::ranges::all_of(
          parameters, [&](const OpParameter& p) { return p.optional || value.contains(std::string(p.name)); });
      if (complete) return row;
    }
    return rows.front();
  }

  std::optional<Error> unknown_key(const Entry& entry, const json& value, const std::string& place) const {
    std::string known = "op";
    for (const OpParameter& parameter : entry.row.parameters) {
      if (!parameter.implicit) known += ", " + std::string(parameter.name);
    }
    if (has_operands(entry)) known += ", of";
    for (const auto& item : value.items()) {
      const std::string& key = item.key();
      const bool is_parameter =
          std::ranges::any_of(entry.row.parameters, [&](const OpParameter& p) { return !p.implicit && p.name == key; });
      if (key == "op" || is_parameter || (key == "of" && has_operands(entry))) continue;
      return fault(place + "/" + scene::pointer_step(key), "one of " + known, scene::in_quotes(key));
    }
    return std::nullopt;
  }

  std::optional<Error> read(const OpParameter& parameter, const json& value, const std::string& place,
                            std::vector<double>& numbers) const {
    const std::string key(parameter.name);
    if (parameter.implicit || (parameter.optional && !value.contains(key))) {
      numbers.insert(numbers.end(), static_cast<std::size_t>(parameter.arity), parameter.fallback);
      return std::nullopt;
    }
    if (!value.contains(key)) return fault(place, "the key \"" + key + "\"", "none");
    const json& found = value[key];
    const std::string here = place + "/" + key;
    if (parameter.quantity == Quantity::choice) return read_choice(parameter, found, here, numbers);
    if (parameter.arity == 0) return read_points(parameter, found, here, numbers);
    if (parameter.arity == 1) return read_number(parameter, found, here, numbers);
    return read_numbers(parameter, found, here, numbers);
  }

  std::optional<Error> read_choice(const OpParameter& parameter, const json& found, const std::string& place,
                                   std::vector<double>& numbers) const {
    std::string_view rest = parameter.choices;
    for (double index = 0; found.is_string(); ++index) {
      const auto bar = rest.find('|');
      if (found.get_ref<const std::string&>() == rest.substr(0, bar)) {
        numbers.push_back(index);
        return std::nullopt;
      }
      if (bar == std::string_view::npos) break;
      rest.remove_prefix(bar + 1);
    }
    return fault(place, shape::describe(parameter), type_and_value(found));
  }

  std::optional<Error> read_number(const OpParameter& parameter, const json& found, const std::string& place,
                                   std::vector<double>& numbers) const {
    if (!found.is_number()) return fault(place, shape::describe(parameter), type_and_value(found));
    numbers.push_back(found.get<double>());
    return std::nullopt;
  }

  std::optional<Error> read_numbers(const OpParameter& parameter, const json& found, const std::string& place,
                                    std::vector<double>& numbers) const {
    const auto wanted = static_cast<std::size_t>(parameter.arity == 0 ? 2 : parameter.arity);
    if (!found.is_array() || found.size() != wanted) {
      return fault(place, "an array of " + std::to_string(wanted) + " numbers", type_and_value(found));
    }
    for (std::size_t i = 0; i < wanted; ++i) {
      if (auto error = read_number(parameter, found[i], place + "/" + std::to_string(i), numbers)) return error;
    }
    return std::nullopt;
  }

  std::optional<Error> read_points(const OpParameter& parameter, const json& found, const std::string& place,
                                   std::vector<double>& numbers) const {
    if (!found.is_array()) return fault(place, "an array of points", type_and_value(found));
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (auto error = read_numbers(parameter, found[i], place + "/" + std::to_string(i), numbers)) return error;
    }
    return std::nullopt;
  }

  std::optional<Error> operands(const Entry& entry, const json& value, const std::string& place,
                                std::vector<Shape>& of) {
    if (!value.contains("of")) return fault(place, "the key \"of\"", "none");
    const json& found = value["of"];
    const bool many = entry.row.kind == OpKind::combine;
    if (found.is_object()) {
      auto operand = node(found, place + "/of");
      if (!operand) return operand.error();
      of.push_back(*std::move(operand));
      return std::nullopt;
    }
    if (!found.is_array() || (many ? found.empty() : found.size() != 1)) {
      return fault(place + "/of", many ? "an array of nodes" : "one node", type_and_value(found));
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      auto operand = node(found[i], place + "/of/" + std::to_string(i));
      if (!operand) return operand.error();
      of.push_back(*std::move(operand));
    }
    return std::nullopt;
  }

  const json& document_;
  std::string_view file_;
  const ReadText& read_text_;
  int dimension_ = 2;
  std::size_t depth_ = 0;
  std::map<std::string, Shape> defined_;
  std::set<std::string> open_;
};

}  // namespace

Result<Scene> parse_scene(std::string_view text, std::string_view file, const ReadText& read_text) {
  auto document = scene::parse_json(text, file);
  if (!document) return document.error();
  return SceneParser(*document, file, read_text).parse();
}

Result<Scene> parse_program(std::string_view text, std::string_view file) {
  auto shape = Shape::formula("vm", 0, text);
  if (shape) return Scene{*shape, shape->dimension()};
  Error error = shape.error();
  error.file = file;
  return error;
}

}  // namespace thalweg
