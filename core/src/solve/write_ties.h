// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The columns that tell of kinks, after all others: what finds no room in a normal.
#pragma once

#include "solve/finish.h"

namespace thalweg {

/// Adds kinks to `ambiguous` and writes `one_sided`. Rows proven separated are left out under Goal::verdict: their
/// point is only where the search ended.
void write_ties(const QueryTile& tile, const QueryState& state, float* kernel_scratch, Arena& arena);

}  // namespace thalweg
