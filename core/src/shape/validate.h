// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Checks a node's numbers and operands against its op's declaration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ops/registry.h"
#include "thalweg/shape.h"

namespace thalweg::shape {

/// The first fault, or nothing; normalises directions and quaternions in place. The error's place is the
/// parameter's name, with the index of the number where it has several, or `of`.
[[nodiscard]] std::optional<Error> validate(const ops::Entry& entry, std::vector<double>& numbers,
                                            const std::vector<Shape>& of);

/// "a length in [1e-15, 1e+15]" and its like.
[[nodiscard]] std::string describe(const OpParameter& parameter);

/// A number as people write it.
[[nodiscard]] std::string to_text(double number);

}  // namespace thalweg::shape
