// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A formula's steps as records of the SSA form.
#pragma once

#include <functional>

#include "compile/ssa.h"
#include "formula/formula.h"

namespace thalweg::compiler {

/// Where a formula stands: the similarity that is left to do, at a position that `made` describes.
struct FormulaPlace {
  const ops::Similarity& at;
  int position;
  const Position& made;
  int dimension;
};

/// Adds a formula's values, with `add` for each, which returns the index of an equal one that it has; the last index.
[[nodiscard]] int lower(const formula::Formula& formula, const FormulaPlace& place,
                        const std::function<int(Value)>& add);

}  // namespace thalweg::compiler
