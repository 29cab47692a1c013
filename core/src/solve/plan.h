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

/// The part of the columns that begins at a row.
[[nodiscard]] CollideColumns columns_from(const CollideColumns& columns, std::size_t row, int dimension,
                                          std::uint32_t contacts = 0);

}  // namespace thalweg
