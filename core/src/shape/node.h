// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The storage behind a Shape handle. Immutable once a handle to it has left Shape::make.
#pragma once

#include <string>
#include <vector>

#include "formula/formula.h"
#include "thalweg/shape.h"

namespace thalweg {

struct Shape::Node {
  int op = 0;                      ///< row of the op table
  int depth = 1;                   ///< longest chain of operands below, counting this node
  std::vector<double> parameters;  ///< flattened, directions and quaternions normalised
  std::vector<Shape> operands;
  std::string text;          ///< formulas only
  formula::Formula formula;  ///< formulas only
  Facts facts;
};

}  // namespace thalweg
