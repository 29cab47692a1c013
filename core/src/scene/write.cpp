// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the op table says in other forms: scene text of a shape, the JSON schema, the C++ builder header.
#include <nlohmann/json.hpp>

#include "ops/registry.h"
#include "thalweg/scene.h"

namespace thalweg {
namespace {

using Ordered = nlohmann::ordered_json;

std::string_view nth_choice(std::string_view choices, std::size_t n) {
  for (; n > 0; --n) choices.remove_prefix(choices.find('|') + 1);
  return choices.substr(0, choices.find('|'));
}

Ordered parameter_json(const OpParameter& parameter, std::span<const double> numbers) {
  if (parameter.quantity == Quantity::choice) {
    return std::string(nth_choice(parameter.choices, static_cast<std::size_t>(numbers[0])));
  }
  if (parameter.arity == 1) return numbers[0];
  Ordered array = Ordered::array();
  if (parameter.arity == 0) {
    for (std::size_t i = 0; i < numbers.size(); i += 2) array.push_back({numbers[i], numbers[i + 1]});
  } else {
    for (const double number : numbers) array.push_back(number);
  }
  return array;
}

Ordered node_json(const Shape& shape) {
  const OpRow& row = op_table()[static_cast<std::size_t>(shape.op_index())];
  Ordered node;
  node["op"] = std::string(row.name);
  if (row.kind == OpKind::formula) {
    node["text"] = std::string(shape.text());
    return node;
  }
  auto numbers = shape.parameters();
  for (const OpParameter& parameter : row.parameters) {
    const std::size_t count = parameter.arity == 0 ? numbers.size() : static_cast<std::size_t>(parameter.arity);
    if (!parameter.implicit) node[std::string(parameter.name)] = parameter_json(parameter, numbers.first(count));
    numbers = numbers.subspan(count);
  }
  if (row.kind == OpKind::combine) {
    node["of"] = Ordered::array();
    for (const Shape& operand : shape.operands()) node["of"].push_back(node_json(operand));
  } else if (row.kind != OpKind::primitive) {
    node["of"] = node_json(shape.operands()[0]);
  }
  return node;
}

Ordered number_schema(const OpParameter& parameter) {
  Ordered schema;
  schema["type"] = parameter.quantity == Quantity::count ? "integer" : "number";
  schema["minimum"] = parameter.least;
  schema["maximum"] = parameter.most;
  return schema;
}

Ordered parameter_schema(const OpParameter& parameter) {
  Ordered schema;
  if (parameter.quantity == Quantity::text) {
    schema["type"] = "string";
  } else if (parameter.quantity == Quantity::choice) {
    schema["enum"] = Ordered::array();
    std::string_view rest = parameter.choices;
    for (bool more = true; more;) {
      schema["enum"].push_back(std::string(rest.substr(0, rest.find('|'))));
      more = rest.find('|') != std::string_view::npos;
      if (more) rest.remove_prefix(rest.find('|') + 1);
    }
  } else if (parameter.arity == 1) {
    schema = number_schema(parameter);
  } else {
    const int arity = parameter.arity == 0 ? 2 : parameter.arity;
    Ordered point = {{"type", "array"}, {"items", number_schema(parameter)}, {"minItems", arity}, {"maxItems", arity}};
    schema = point;
    if (parameter.arity == 0) schema = {{"type", "array"}, {"items", point}, {"minItems", 3}};
  }
  schema["description"] = std::string(parameter.meaning);
  return schema;
}

Ordered row_schema(const OpRow& row) {
  Ordered properties;
  Ordered required = {"op"};
  properties["op"] = {{"const", std::string(row.name)}};
  for (const OpParameter& parameter : row.parameters) {
    if (parameter.implicit) continue;
    properties[std::string(parameter.name)] = parameter_schema(parameter);
    if (!parameter.optional) required.push_back(std::string(parameter.name));
  }
  if (row.kind == OpKind::formula && row.parameters.size() > 1) {
    Ordered one_of = Ordered::array();
    for (const OpParameter& parameter : row.parameters) {
      one_of.push_back({{"required", {std::string(parameter.name)}}});
    }
    return {{"type", "object"},
            {"properties", properties},
            {"required", required},
            {"oneOf", one_of},
            {"additionalProperties", false}};
  }
  const bool has_operands = row.kind != OpKind::primitive && row.kind != OpKind::formula;
  const Ordered node = {{"$ref", "#/$defs/node"}};
  if (row.kind == OpKind::combine) {
    properties["of"] = {{"anyOf", {node, {{"type", "array"}, {"items", node}, {"minItems", 1}}}}};
  } else if (has_operands) {
    properties["of"] = {{"anyOf", {node, {{"type", "array"}, {"items", node}, {"minItems", 1}, {"maxItems", 1}}}}};
  }
  if (has_operands) required.push_back("of");
  return {{"type", "object"}, {"properties", properties}, {"required", required}, {"additionalProperties", false}};
}

}  // namespace

std::string Shape::to_json() const { return node_json(*this).dump(); }

std::string scene_text(const Shape& shape) {
  const Ordered scene = {{"thalweg", 1}, {"dimension", shape.dimension()}, {"shape", node_json(shape)}};
  return scene.dump(2) + "\n";
}

std::string scene_schema() {
  Ordered nodes = Ordered::array();
  for (const OpRow& row : op_table()) nodes.push_back(row_schema(row));
  nodes.push_back({{"type", "object"},
                   {"properties", {{"op", {{"const", "ref"}}}, {"name", {{"type", "string"}}}}},
                   {"required", {"op", "name"}},
                   {"additionalProperties", false}});
  Ordered schema;
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "thalweg scene";
  schema["type"] = "object";
  schema["properties"] = {{"thalweg", {{"const", 1}}},
                          {"dimension", {{"enum", {2, 3}}}},
                          {"shape", {{"$ref", "#/$defs/node"}}},
                          {"define", {{"type", "object"}, {"additionalProperties", {{"$ref", "#/$defs/node"}}}}}};
  schema["required"] = {"thalweg", "dimension", "shape"};
  schema["additionalProperties"] = false;
  schema["$defs"] = {{"node", {{"anyOf", nodes}}}};
  return schema.dump(2) + "\n";
}

}  // namespace thalweg
