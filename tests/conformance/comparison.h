// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Runs the kernels of a target over columns, and holds what they say against the oracle.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cases.h"
#include "kernels/kernels.h"
#include "oracle.h"
#include "solve/arena.h"
#include "thalweg/simd.h"
#include "thalweg/tape.h"

namespace thalweg::conformance {

/// The columns that a kernel fills.
struct Columns {
  std::vector<float> value;
  std::vector<float> gradient[3];
  std::vector<float> lower;
};

[[nodiscard]] Columns run_value(const Tape& tape, const Target& target, const Points& points);
[[nodiscard]] Columns run_gradient(const Tape& tape, const Target& target, const Points& points);

/// Cells around centres: triangles (vertices relative to the centre) or boxes (half extents).
struct Cells {
  explicit Cells(int dimension) : centres(dimension) {}
  Points centres;
  bool is_box = false;
  std::vector<float> reach;
  std::vector<float> edges[9];

  void add_triangle(const oracle::Vec (&corners)[3]);
  void add_box(oracle::Vec centre, oracle::Vec half);
  void pad();
};
[[nodiscard]] Columns run_enclosure(const Tape& tape, const Target& target, const Cells& cells);

/// |found - expected| in units of the allowance, over a column.
struct Comparison {
  std::string fault;  ///< the first entry that exceeds its allowance, or nothing
  double worst = 0;   ///< largest |found - expected| / slack
  std::size_t count = 0;

  void add(double found, double expected, double slack, double margin, oracle::Vec at);
};

/// A value column against the oracle: within the tape's slack at each point's magnitude, and never NaN.
[[nodiscard]] Comparison compare_values(const Tape& tape, const oracle::Field& field, const Points& points,
                                        const std::vector<float>& value);

}  // namespace thalweg::conformance
