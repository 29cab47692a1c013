// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A second reader of `.vm` programs, which evaluates them step by step in the number type that is asked for, with the
// functions of the C++ library. Shares nothing with core/src.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "random.h"

namespace thalweg::oracle {

class Program {
 public:
  /// Throws std::invalid_argument for what it cannot read.
  explicit Program(std::string_view text);

  /// NaN where some step is not defined.
  template <class Number>
  [[nodiscard]] Number evaluate(Number x, Number y, Number z) const;

 private:
  struct Step {
    std::string opcode;
    int a = -1, b = -1;
    double constant = 0;
  };
  std::vector<Step> steps_;
};

/// The functions of formulas by their opcode, or by their name where they have none; NaN where they are not defined.
[[nodiscard]] double library_function(std::string_view opcode, double a, double b);

/// The text of a file, or nothing where there is none.
[[nodiscard]] std::string file_text(const std::string& path);

/// A program of random steps, the last of which depends on many.
[[nodiscard]] std::string random_program(Random& random, int steps, bool with_functions, int dimension);

}  // namespace thalweg::oracle
