// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batch queries: millions of points, triangles or circles against one tape, cut into tiles that run on all cores.
// Results are the same bits for every number of threads, tile size and SIMD target with fused multiply-add.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "thalweg/distance.h"
#include "thalweg/pairs.h"
#include "thalweg/query.h"
#include "thalweg/simd.h"
#include "thalweg/sweep.h"
#include "thalweg/tape.h"

namespace thalweg {

/// How a batch runs; never what it answers.
struct Execution {
  int threads = 0;                 ///< 0: every core of the caller's arena; 1: the calling thread alone, no pool
  std::size_t tile = 0;            ///< queries per tile; 0: chosen
  const Target* target = nullptr;  ///< null: default_target()
  std::atomic<std::size_t>* done = nullptr;      ///< when set, counts finished rows, for progress
  const std::atomic<bool>* cancelled = nullptr;  ///< when set and true, tiles not yet begun are left out
};

/// Totals over a batch.
struct Summary {
  std::size_t rows = 0;
  std::size_t by_status[5] = {};  ///< separated, overlapping, touching, undecided, bad rows
  std::uint64_t evaluations = 0;
  bool cancelled = false;
};

/// f at N points, rows (N,d) in C order, and its gradient by `autodiff`; `gradient` (N,d) and `value` (N) may be null.
/// A bad row gives NaN, as does one where a formula is undefined. Returns how many rows were bad.
std::size_t evaluate(const Tape& tape, const float* points, std::size_t count, float* value, float* gradient,
                     const Execution& execution = {});

/// Points (N,d) in C order.
struct Points {
  const float* rows = nullptr;
  std::size_t count = 0;
};

struct EvaluateSummary {
  std::size_t rows = 0, bad_rows = 0;
  std::size_t undefined_rows = 0;  ///< where a formula is not defined: NaN
  std::uint64_t evaluations = 0;
  bool cancelled = false;
};

/// f and its gradient by any strategy. A bad row gives NaN and 0 evaluations. Refuses a strategy or an offset that the
/// tape does not allow.
[[nodiscard]] Result<EvaluateSummary> evaluate(const Tape& tape, Points points, const GradientOptions& options,
                                               const PointColumns& columns, const Execution& execution = {});

/// Points on a regular grid: origin + i step[0] + j step[1] + k step[2] for i < size[0] and so on, each coordinate
/// rounded once from double. An axis of size 1 needs no step: a picture has two axes, of a slice in space too.
struct Grid {
  double origin[3] = {};
  double step[3][3] = {};
  std::size_t size[3] = {1, 1, 1};

  [[nodiscard]] std::size_t count() const { return size[0] * size[1] * size[2]; }
  /// The coordinates, as many as there are dimensions, that f is evaluated at.
  void point(std::size_t i, std::size_t j, std::size_t k, int dimension, float* coordinates) const;
};

/// What is wanted of a grid, its axis 0 running fastest; a null column is not computed.
struct GridColumns {
  float* value = nullptr;          ///< f, cut off to [-band, band]
  std::uint8_t* inside = nullptr;  ///< 1 where f < 0, else 0
  float band = std::numeric_limits<float>::infinity();
};

/// f over a grid, with the bits that `evaluate` has for its points, but in less time: tiles of the grid where f is
/// proven beyond the band, or of one sign where only that is asked, are filled without evaluating, and the others are
/// evaluated by what of the tape can decide there. `evaluations` counts the points evaluated. A bad point gives NaN,
/// and is not inside. Refuses a negative band.
[[nodiscard]] Result<EvaluateSummary> evaluate_grid(const Tape& tape, const Grid& grid, const GridColumns& columns,
                                                    const Execution& execution = {});

/// Triangles against the tape's shape. Refuses options that the method or the tape cannot honour.
[[nodiscard]] Result<Summary> collide_triangles(const Tape& tape, Queries triangles, const CollideOptions& options,
                                                const CollideColumns& columns, const Execution& execution = {});

/// Circles (2D) or spheres (3D) against the tape's shape.
[[nodiscard]] Result<Summary> collide_circles(const Tape& tape, Queries circles, const CollideOptions& options,
                                              const CollideColumns& columns, const Execution& execution = {});

/// Shape against shape, one pose a row: `certified`, `thesis` or `midsurface`. `columns` tells of g = max(f_a, f_b),
/// its `barycentric` is not written; `contacts` of every overlap region, where wanted. With goal `deepest`, or with
/// contacts, the search goes on to each region's deepest point; apart from that a pair proven apart is done. `lower` is
/// at most the tolerance for pairs proven apart, and 0 where a field may understate distances. Refuses two unbounded
/// shapes.
[[nodiscard]] Result<Summary> collide_pairs(const PairQueries& queries, const PairOptions& options,
                                            const CollideColumns& columns, const PairContacts& contacts = {},
                                            const Execution& execution = {}, const PairPaths& paths = {});

/// How far shapes are apart, one pose a row; see thalweg/distance.h. Refuses two unbounded shapes, and formulas.
[[nodiscard]] Result<Summary> measure_distances(const PairQueries& queries, const DistanceOptions& options,
                                                const DistanceColumns& columns, const Execution& execution = {});

/// When moving triangles first meet the shape; see thalweg/sweep.h. Refuses formulas, which have no Lipschitz constant.
[[nodiscard]] Result<Summary> sweep_triangles(const Tape& tape, const SweepQueries& queries,
                                              const SweepOptions& options, const SweepColumns& columns,
                                              const Execution& execution = {});

/// The same of circles (2D) or spheres (3D), by the motion of the scene.
[[nodiscard]] Result<Summary> sweep_circles(const Tape& tape, const SweepQueries& queries, const SweepOptions& options,
                                            const SweepColumns& columns, const Execution& execution = {});

/// The tolerance that stands for CollideOptions::tolerance = 0.
[[nodiscard]] double default_tolerance(const Tape& tape);

}  // namespace thalweg
