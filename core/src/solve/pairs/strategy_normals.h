// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Normals of pairs by a strategy that the caller chose, after a search that has its own.
#pragma once

#include "solve/pairs/problem.h"

namespace thalweg {

/// Writes the normals of a tile's rows and contacts anew, and counts what they take: an evaluation is one of both
/// fields.
void renew_normals(const PairTile& tile, PairScratch& scratch);

}  // namespace thalweg
