// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The oracle's primitives by name: which function, which parameters in which order, and whether the field is convex.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "oracle.h"

namespace thalweg::oracle {

struct PrimitiveEntry {
  std::string_view op;
  int dimension = 2;
  /// Parameter names in the order in which `evaluate` reads their numbers, separated by blanks.
  std::string_view order;
  Field::Primitive evaluate = nullptr;
  /// Whether f is a convex function for these numbers; null: never.
  bool (*convex)(const double* numbers) = nullptr;
  bool never_negative = false;
};

[[nodiscard]] std::span<const PrimitiveEntry> primitives();

}  // namespace thalweg::oracle
