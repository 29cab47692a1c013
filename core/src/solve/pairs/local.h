// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The published local methods for pairs of shapes. They may miss: what they find is a witness or an opinion.
#pragma once

#include "solve/pairs/problem.h"

namespace thalweg {

/// `thesis` (Luneau 2025, section 3.3, after Liu et al. 2024) and `midsurface` (MuJoCo's collisions between signed
/// distance fields), all starts of a query side by side.
void search_locally(const PairTile& tile, PairScratch& scratch);

/// The solver of a target for a method.
void solve(const PairTile& tile, PairScratch& scratch);

/// Where start `index` lies in a box: its middle, then Halton points in bases 2, 3 and 5.
void halton_start(const PairProblem& problem, std::uint32_t index, float* point);

}  // namespace thalweg
