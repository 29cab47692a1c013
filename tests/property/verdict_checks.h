// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Holds the columns of a batch of collision queries against the oracle, row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "oracle.h"
#include "thalweg/batch.h"

namespace thalweg::property {

enum class Form { triangles, circles };

/// Queries with every column that the batch fills.
struct Answers {
  Form form = Form::triangles;
  int dimension = 2;
  std::vector<float> rows;
  CollideOptions options;
  double tolerance = 0;
  Summary summary;
  std::vector<std::uint8_t> status, converged, claimed, ambiguous;
  std::vector<float> value, lower, point, normal, barycentric;
  std::vector<std::uint32_t> starts, iterations, evaluations;

  [[nodiscard]] std::size_t count() const { return status.size(); }
};

/// Runs the batch; throws std::invalid_argument when it is refused.
[[nodiscard]] Answers answer(const Tape& tape, Form form, std::vector<float> rows, const CollideOptions& options);

/// What the oracle found wrong with the rows, or nothing; the first fault with its row's coordinates.
struct Findings {
  std::string fault;
  std::size_t unknown = 0;      ///< rows whose sign the oracle could not tell
  std::size_t undecided = 0;    ///< status 3
  std::size_t unconverged = 0;  ///< goal not reached within the budget
  std::size_t over_budget = 0;  ///< more evaluations than allowed
};
[[nodiscard]] Findings check_rows(const oracle::Field& field, const Tape& tape, const Answers& answers);

/// min f over one row's query.
[[nodiscard]] oracle::Bracket oracle_minimum(const oracle::Field& field, const Answers& answers, std::size_t row,
                                             const oracle::Limits& limits);

}  // namespace thalweg::property
