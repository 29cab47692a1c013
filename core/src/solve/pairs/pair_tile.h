// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One tile of shape-against-shape queries: what a pair solver reads and writes. Queries are solved one after the
// other: each has cells enough to fill the lanes, and so a row can depend on nothing but itself.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "kernels/kernels.h"
#include "kernels/twin.h"
#include "solve/pairs/stand_in.h"
#include "thalweg/pairs.h"

namespace thalweg {

/// Options with every default filled in. Lengths that follow from the shapes are of one pair of tapes.
struct PairLimits {
  Goal goal = Goal::verdict;
  Method method = Method::certified;
  std::uint32_t starts = 1;
  std::uint32_t iterations = 1;
  std::uint32_t budget = 4096;
  double tolerance = 1e-4;
  double region = 1;
  double size = 1;  ///< diagonal of the smaller bounding box
};

struct PairTile {
  const PairQueries* queries = nullptr;
  const PairOptions* options = nullptr;
  const Kernels* kernels = nullptr;
  std::size_t begin = 0;  ///< rows of the queries, from here on
  std::size_t count = 0;
  const std::uint32_t* rows = nullptr;  ///< instead, where they are not one after the other
  StandIn near[2];                      ///< of the first shape and of the second
  CollideColumns columns;               ///< of all rows; `barycentric` is not used
  PairContacts contacts;
  PairPaths paths;

  [[nodiscard]] std::size_t row(std::size_t i) const { return rows == nullptr ? begin + i : rows[i]; }
};

/// An open cell of the search in double: a box by centre and half extents in A's frame, and its bound.
struct PairHeapCell {
  double lo;
  double at[3];
  double half[3];
};

/// A worker's memory, reused from tile to tile.
struct PairScratch {
  Arena arena;   ///< of a tile
  Arena query;   ///< of what grows with one query
  Arena cohort;  ///< of rows searched side by side
  std::vector<PairHeapCell> heap;
  std::vector<std::unique_ptr<Twin>> twins;  ///< one per shape, made when first needed
  Twin near[2];                              ///< of the tapes that stand in

  /// For other shapes from now on.
  void begin(const PairQueries& queries) {
    for (std::size_t i = 0; i < twins.size() && i < queries.shape_count; ++i) {
      if (twins[i] != nullptr) twins[i]->use(*queries.shapes[i]);
    }
  }
  Twin& twin(const PairQueries& queries, std::size_t shape) {
    if (twins.size() < queries.shape_count) twins.resize(queries.shape_count);
    if (twins[shape] == nullptr) twins[shape] = std::make_unique<Twin>(*queries.shapes[shape]);
    return *twins[shape];
  }
};

/// What is known of one overlap region, or of the whole query.
struct PairFinding {
  float point[3] = {};
  float value = std::numeric_limits<float>::infinity();
  float lower = std::numeric_limits<float>::infinity();
  bool witness = false;    ///< g < 0 is proven at the point
  bool converged = false;  ///< value - lower <= tolerance
};

}  // namespace thalweg
