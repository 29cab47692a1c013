// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Checks a proof of a verdict (core/include/thalweg/proof.h says what one holds) without knowing how it was found: that
// the cells cover the query, in exact integers; that each bound is valid for the field, by the oracle's own enclosures;
// that the witness lies in the query; and that all this gives the verdict.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "oracle.h"

namespace thalweg::oracle {

/// What was asked.
struct ProvenQuery {
  bool is_ball = false;
  std::array<Vec, 3> corners;  ///< of the triangle; the ball's centre first
  double radius = 0;
  double tolerance = 0;
};

/// What is claimed to be proven of it.
struct ProofClaim {
  std::string status;   ///< separated, overlapping, touching or undecided
  Vec point;            ///< as reported, rounded to float32
  double u = 0, v = 0;  ///< triangles: barycentric coordinates of the second and third corner
  double value = 0;     ///< f at the point
  struct Cell {
    std::array<double, 6> at;
    double bound;
  };
  std::vector<Cell> cells;
};

/// Why the claim does not hold, or nothing. `most_evaluations` is for all cells together.
[[nodiscard]] std::string fault_of(const Field& field, const ProvenQuery& query, const ProofClaim& claim,
                                   std::size_t most_evaluations = 4'000'000);

/// Reads the JSON that `thalweg collide --explain` writes; throws std::exception when it is none.
void read_proof(std::string_view json, ProvenQuery& query, ProofClaim& claim);

}  // namespace thalweg::oracle
