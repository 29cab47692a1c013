// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the op table says in other forms: the JSON schema and the builder header.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "ops/registry.h"
#include "thalweg/op_table.h"
#include "thalweg/scene.h"

namespace thalweg {
namespace {

using nlohmann::json;

json schema() { return json::parse(scene_schema()); }

/// The schema of an op's node in `anyOf`, by name and parameters.
const json* node_schema(const json& all, const OpRow& row) {
  for (const json& node : all["$defs"]["node"]["anyOf"]) {
    if (node["properties"]["op"]["const"] != std::string(row.name)) continue;
    bool fits = true;
    for (const OpParameter& p : row.parameters) {
      const std::string key(p.name);
      fits = fits && (p.implicit || node["properties"].contains(key));
      if (!fits || p.implicit || p.arity < 2) continue;
      fits = node["properties"][key]["minItems"] == p.arity && node["properties"][key]["maxItems"] == p.arity;
    }
    if (fits) return &node;
  }
  return nullptr;
}

TEST(SceneSchema, IsJsonOfTheDraftThatItNames) {
  const json all = schema();
  EXPECT_EQ(all["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(all["required"], (json{"thalweg", "dimension", "shape"}));
  EXPECT_EQ(all["additionalProperties"], false);
  EXPECT_EQ(all["properties"]["dimension"]["enum"], (json{2, 3}));
}

TEST(SceneSchema, HasEveryOpWithItsParametersAndRanges) {
  const json all = schema();
  for (const OpRow& row : op_table()) {
    const json* node = node_schema(all, row);
    ASSERT_NE(node, nullptr) << row.name;
    EXPECT_EQ((*node)["additionalProperties"], false) << row.name;
    const std::set<std::string> required((*node)["required"].begin(), (*node)["required"].end());
    const bool is_leaf = row.kind == OpKind::primitive || row.kind == OpKind::formula;
    EXPECT_EQ(required.count("of"), is_leaf ? 0U : 1U) << row.name;
    for (const OpParameter& p : row.parameters) {
      if (p.implicit) continue;
      EXPECT_EQ(required.count(std::string(p.name)), p.optional ? 0U : 1U) << row.name << ' ' << p.name;
      const json& parameter = (*node)["properties"][std::string(p.name)];
      EXPECT_FALSE(parameter["description"].get<std::string>().empty()) << row.name << ' ' << p.name;
      if (p.quantity == Quantity::text) {
        EXPECT_EQ(parameter["type"], "string") << row.name << ' ' << p.name;
      }
      if (p.arity != 1 || p.quantity == Quantity::choice || p.quantity == Quantity::text) continue;
      EXPECT_EQ(parameter["minimum"], p.least) << row.name << ' ' << p.name;
      EXPECT_EQ(parameter["maximum"], p.most) << row.name << ' ' << p.name;
    }
  }
}

TEST(SceneSchema, HasReferences) {
  bool found = false;
  const json all = schema();
  for (const json& node : all["$defs"]["node"]["anyOf"]) {
    found = found || node["properties"]["op"]["const"] == "ref";
  }
  EXPECT_TRUE(found);
}

TEST(BuilderHeader, IsTheCommittedOne) {
  std::ifstream file(THALWEG_TESTS_DIR "/../core/include/thalweg/ops.h", std::ios::binary);
  ASSERT_TRUE(file);
  const std::string committed{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(committed, ops_header()) << "write core/include/thalweg/ops.h with `thalweg ops --header`";
}

TEST(BuilderHeader, HasAFunctionForEveryName) {
  const std::string header = ops_header();
  for (const OpRow& row : op_table()) {
    const std::string function = "Shape " + std::string(row.name) + (row.name == "union" ? "_(" : "(");
    EXPECT_NE(header.find(function), std::string::npos) << row.name;
  }
}

}  // namespace
}  // namespace thalweg
