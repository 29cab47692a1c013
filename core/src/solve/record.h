// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The search in double with everything that it closes kept, for a proof.
#pragma once

#include "solve/decide.h"
#include "thalweg/proof.h"

namespace thalweg {

/// Searches from proof.point, .u and .v, spends at most `evaluations`, and fills in what is proven.
void record_in_double(const Region64& region, const SolveLimits& limits, std::uint32_t evaluations,
                      TileScratch& scratch, Proof& proof);

}  // namespace thalweg
