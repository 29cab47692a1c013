// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The local methods, one tile at a time. They may miss: what they find is a witness or an opinion.
#pragma once

#include "solve/tile.h"

namespace thalweg {

// Triangles; the rows of method_table() say what each does.
void descend_in_space(const TriangleTile& tile, TileScratch& scratch);  ///< the thesis' and `distance_step`
void descend_projected(const TriangleTile& tile, TileScratch& scratch);
void descend_frank_wolfe(const TriangleTile& tile, TileScratch& scratch);
void descend_frank_wolfe_search(const TriangleTile& tile, TileScratch& scratch);
void descend_golden_section(const TriangleTile& tile, TileScratch& scratch);
void descend_accelerated(const TriangleTile& tile, TileScratch& scratch);

/// Circles: `published` (Luneau 2025, 3.1), f(centre) < radius.
void publish_circles(const CircleTile& tile, TileScratch& scratch);

}  // namespace thalweg
