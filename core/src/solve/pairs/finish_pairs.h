// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Findings of one shape-against-shape query into the caller's columns.
#pragma once

#include "solve/pairs/problem.h"

namespace thalweg {

/// What a row's columns say besides its finding.
struct PairRow {
  Status status = Status::undecided;
  bool claimed = false;
  std::uint32_t starts = 1, iterations = 0, evaluations = 0;
};

/// Unit normal out of the first shape from both gradients in A's frame; true when they cancel and a fixed one stands
/// in.
bool pair_normal(const float* gradient_a, const float* gradient_b, int dimension, float* normal);

void write_row(const PairTile& tile, std::size_t row, const PairFinding& found, const PairRow& of);
void write_normal(const PairTile& tile, std::size_t row, const float* normal, bool ambiguous, int dimension);
void write_bad_row(const PairTile& tile, std::size_t row, int dimension);

/// One contact into slot `slot` of its row.
struct PairContact {
  PairFinding found;
  float normal[3] = {};
  bool ambiguous = false;
};
void write_contact(const PairTile& tile, std::size_t row, std::size_t slot, const PairContact& contact, int dimension);
/// The normal of the contact at `at` of the flat columns anew.
void write_contact_normal(const PairTile& tile, std::size_t at, const float* normal, bool ambiguous, int dimension);

/// The status that a finding proves.
[[nodiscard]] Status status_of(const PairFinding& found, double slack, double tolerance, bool separated);

}  // namespace thalweg
