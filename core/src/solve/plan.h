// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// From what a caller asks to what a solver needs: defaults filled in, requests that make no sense refused.
#pragma once

#include "solve/tile.h"

namespace thalweg {

enum class QueryKind : std::uint8_t { triangles, circles };

[[nodiscard]] Result<SolveLimits> plan(const Tape& tape, QueryKind kind, const CollideOptions& options);

/// The solver of a target for a method.
void solve(const TriangleTile& tile, TileScratch& scratch);
void solve(const CircleTile& tile, TileScratch& scratch);

/// Calls `visit(width, columns.c...)` for every column c but those of contacts, with its numbers per row.
template <class Visit, class... Columns>
void for_each_column(int dimension, Visit&& visit, Columns&... columns) {
  const auto d = static_cast<std::size_t>(dimension);
  visit(std::size_t{1}, columns.status...);
  visit(std::size_t{1}, columns.value...);
  visit(std::size_t{1}, columns.lower...);
  visit(std::size_t{1}, columns.converged...);
  visit(d, columns.point...);
  visit(d, columns.normal...);
  visit(std::size_t{3}, columns.barycentric...);
  visit(std::size_t{1}, columns.claimed...);
  visit(std::size_t{1}, columns.starts...);
  visit(std::size_t{1}, columns.iterations...);
  visit(std::size_t{1}, columns.evaluations...);
  visit(std::size_t{1}, columns.ambiguous...);
  visit(2 * d, columns.one_sided...);
  visit(std::size_t{1}, columns.stop...);
}

/// The part of the columns that begins at a row.
[[nodiscard]] CollideColumns columns_from(const CollideColumns& columns, std::size_t row, int dimension,
                                          std::uint32_t contacts = 0);

}  // namespace thalweg
