// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The published local methods, one tile at a time. They may miss: what they find is a witness or an opinion.
#pragma once

#include "solve/tile.h"

namespace thalweg {

/// Triangles: `thesis` (Luneau 2025, 3.2) and `projected` (Macklin et al. 2020).
void descend_triangles(const TriangleTile& tile, TileScratch& scratch);

/// Circles: `published` (Luneau 2025, 3.1), f(centre) < radius.
void publish_circles(const CircleTile& tile, TileScratch& scratch);

}  // namespace thalweg
