// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The methods as data: names, what each does in mathematics, where it comes from, and what it takes when the caller
// does not say. Parsing, `collide --help`, the plan of a query, the comparison table and the tests all read it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "thalweg/query.h"

namespace thalweg {

struct MethodRow {
  Method method = Method::certified;
  std::string_view name = {};
  std::string_view alias = {};  ///< another accepted name, or empty
  bool triangles = true;        ///< answers triangles; circles otherwise, but for `certified`, which answers both
  bool pairs = false;           ///< answers pairs of shapes alone
  bool proves = false;          ///< reports what it proves; a local method proves an overlap at the most
  Gradient gradient = Gradient::autodiff;
  Start start = Start::centroid;
  std::uint32_t iterations = 1;
  double step = 0;                    ///< alpha, where the method has one
  double floor = 0;                   ///< mu, in scene units
  double stop = 0;                    ///< least move in barycentric coordinates
  std::string_view mathematics = {};  ///< one iteration, in a line
  std::string_view source = {};
};

/// Every method, in the order of the enumeration.
[[nodiscard]] std::span<const MethodRow> method_table();
[[nodiscard]] const MethodRow& method_row(Method method);

}  // namespace thalweg
