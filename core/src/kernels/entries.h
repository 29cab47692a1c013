// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Each kernel of a Highway target (one bit of hwy/targets.h), from the file that compiles it for all of them.
#pragma once

#include <cstdint>

#include "kernels/kernels.h"

namespace thalweg {

[[nodiscard]] ValueKernel value_entry(std::int64_t target);
[[nodiscard]] GradientKernel gradient_entry(std::int64_t target);
[[nodiscard]] StrategyKernel strategy_entry(std::int64_t target);
[[nodiscard]] RowsKernel rows_entry(std::int64_t target);
[[nodiscard]] EnclosureKernel enclosure_entry(std::int64_t target);
[[nodiscard]] RegionKernel regions_entry(std::int64_t target);
[[nodiscard]] std::size_t most_pieces_of(std::int64_t target);
[[nodiscard]] RangeKernel ranges_entry(std::int64_t target);
[[nodiscard]] FinishKernel finish_entry(std::int64_t target);
[[nodiscard]] TriangleSolver certify_triangles_entry(std::int64_t target);
[[nodiscard]] CircleSolver certify_circles_entry(std::int64_t target);
[[nodiscard]] PairSolver certify_pairs_entry(std::int64_t target);
[[nodiscard]] DistanceSolver certify_distances_entry(std::int64_t target);
[[nodiscard]] TriangleSweeper sweep_triangles_entry(std::int64_t target);
[[nodiscard]] BallSweeper sweep_balls_entry(std::int64_t target);

}  // namespace thalweg
