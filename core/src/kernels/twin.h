// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The same op templates in double precision, one point at a time: decides what falls inside the float32 slack.
#pragma once

#include <vector>

#include "thalweg/tape.h"

namespace thalweg {

/// A cell in double: its reach, and vertices relative to the centre (or half extents when `is_box`).
struct Cell64 {
  double reach = 0;
  double edges[9] = {};
  bool is_box = false;
  double place = 0;  ///< tapes with formulas: how far the places of its points may be off
};

struct Enclosure64 {
  double lo = 0;     ///< lower bound of f over the cell
  double value = 0;  ///< f at its centre
  double hi = 0;     ///< upper bound, of tapes with formulas
};

/// Evaluates one tape in double; holds the machine's memory, so one per thread.
class Twin {
 public:
  Twin() = default;
  explicit Twin(const Tape& tape) { use(tape); }
  /// From now on this tape. A shortened one will do: where it has the bits of the full tape in float32 it has them in
  /// double, whose errors are a small part of what regions are widened by.
  void use(const Tape& tape);
  [[nodiscard]] const Tape& tape() const { return *tape_; }
  [[nodiscard]] double value(const double* point);
  double gradient(const double* point, double* gradient);
  [[nodiscard]] Enclosure64 enclose(const double* centre, const Cell64& cell);

  /// The part of the float32 slack that double precision has: 2^-24 against 2^-53.
  static constexpr double kSlackRatio = 0x1p-29;

 private:
  const Tape* tape_ = nullptr;
  std::vector<double> memory_;
  std::vector<std::uint32_t> definition_;
};

}  // namespace thalweg
