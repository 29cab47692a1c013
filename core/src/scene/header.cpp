// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The builder header thalweg/ops.h, written from the op table. A test holds the committed header against this.
#include <map>
#include <set>

#include "ops/registry.h"

namespace thalweg {
namespace {

std::string argument_type(const OpParameter& parameter) {
  switch (parameter.arity) {
    case 0:
      return "std::span<const Vec2>";
    case 1:
      return parameter.quantity == Quantity::choice ? "int" : "double";
    case 2:
      return "Vec2";
    case 3:
      return "Vec3";
    default:
      return "std::array<double, " + std::to_string(parameter.arity) + ">";
  }
}

/// `union` is a keyword of C++; names that are keywords get an underscore.
std::string function_name(std::string_view op) { return op == "union" ? "union_" : std::string(op); }

struct Written {
  std::string arguments;  ///< declarations
  std::string numbers;    ///< code that flattens them
  std::string doc;
};

void write_parameter(const OpParameter& parameter, Written& out) {
  const std::string name(parameter.name);
  if (parameter.implicit || parameter.optional) {
    out.numbers += "  numbers.push_back(" + std::to_string(static_cast<int>(parameter.fallback)) + ");\n";
    return;
  }
  if (!out.arguments.empty()) out.arguments += ", ";
  out.arguments += argument_type(parameter) + " " + name;
  out.doc += "///   " + name + ": " + std::string(parameter.meaning) + "\n";
  if (parameter.arity == 0) {
    out.numbers += "  for (const Vec2& p : " + name + ") numbers.insert(numbers.end(), {p.x, p.y});\n";
  } else if (parameter.arity == 1) {
    out.numbers += "  numbers.push_back(" + name + ");\n";
  } else if (parameter.arity < 4) {
    out.numbers += "  numbers.insert(numbers.end(), {" + name + ".x, " + name + ".y" +
                   (parameter.arity == 3 ? ", " + name + ".z" : "") + "});\n";
  } else {
    out.numbers += "  numbers.insert(numbers.end(), " + name + ".begin(), " + name + ".end());\n";
  }
}

std::string formula_function(const OpRow& row) {
  const std::string name(row.name);
  return "/// " + name + ": " + std::string(row.exactness) + "; " + std::string(row.note) +
         ".\n///   dimension: 2, 3, or 0: 3 if the formula depends on z, else 2\n[[nodiscard]] inline Shape " + name +
         "(std::string_view text, int dimension = 0) {\n  return builder::made_formula(\"" + name +
         "\", text, dimension);\n}\n\n";
}

/// The function of one row, or nothing when a row of another dimension already gave the same signature.
std::string function(const OpRow& row, int variant, std::set<std::string>& signatures) {
  if (row.kind == OpKind::formula) return formula_function(row);
  Written out;
  for (const OpParameter& parameter : row.parameters) write_parameter(parameter, out);
  std::string operands;
  std::string dimension = std::to_string(row.dimension);
  if (row.kind == OpKind::combine) {
    out.arguments += std::string(out.arguments.empty() ? "" : ", ") + "std::vector<Shape> of";
    operands = ", std::move(of)";
  } else if (row.kind != OpKind::primitive) {
    out.arguments = "const Shape& of" + std::string(out.arguments.empty() ? "" : ", ") + out.arguments;
    operands = ", {of}";
  }
  if (row.kind != OpKind::primitive) dimension = "builder::kOfOperands";
  std::string text = "/// " + std::string(row.name) + ": " + std::string(row.exactness) +
                     (row.note.empty() ? "" : "; " + std::string(row.note)) + ".\n" + out.doc;
  const std::string signature = function_name(row.name) + "(" + out.arguments + ")";
  if (!signatures.insert(signature).second) return "";
  const std::string lint = row.name == "union" ? "  // NOLINT(readability-identifier-naming): a keyword" : "";
  text += "[[nodiscard]] inline Shape " + signature + " {" + lint + "\n";
  text += "  std::vector<double> numbers;\n" + out.numbers;
  text += "  return builder::made(\"" + std::string(row.name) + "\", " + dimension + ", numbers" +
          (operands.empty() && variant != 0 ? ", {}" : operands) +
          (variant != 0 ? ", " + std::to_string(variant) : "") + ");\n}\n\n";
  return text;
}

}  // namespace

std::string ops_header() {
  std::string text =
      R"(// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Every op of the language as a function; generated from the op table by `thalweg ops --header`, do not edit.
// A parameter out of its range throws std::invalid_argument with the error's text.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "thalweg/shape.h"

namespace thalweg {

namespace builder {
inline constexpr int kOfOperands = 0;  ///< the dimension is that of the operands
[[nodiscard]] Shape made(std::string_view op, int dimension, std::span<const double> numbers,
                         std::vector<Shape> of = {}, int variant = 0);
[[nodiscard]] Shape made_formula(std::string_view op, std::string_view text, int dimension);
}  // namespace builder

)";
  std::map<std::pair<std::string_view, int>, int> variants;
  std::set<std::string> signatures;
  for (const OpRow& row : op_table()) text += function(row, variants[{row.name, row.dimension}]++, signatures);
  return text + "}  // namespace thalweg\n";
}

}  // namespace thalweg
