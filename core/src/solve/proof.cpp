// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "thalweg/proof.h"

#include <algorithm>
#include <limits>
#include <string>

#include "solve/plan.h"
#include "solve/record.h"
#include "thalweg/simd.h"

namespace thalweg {
namespace {

/// A proof may take more than the row did: it repeats in double what float32 has seen.
constexpr std::uint32_t kLeastEvaluations = 1U << 18;

template <class Tile>
Result<Proof> prove(QueryKind kind, const Tape& tape, const float* row, const CollideOptions& options) {
  const auto d = static_cast<std::size_t>(tape.dimension);
  if (options.method != Method::certified) {
    return Error{.file = "",
                 .place = "--method",
                 .expected = "certified, which proves",
                 .found = std::string(name(options.method))};
  }
  auto limits = plan(tape, kind, options);
  if (!limits) return limits.error();
  Proof proof;
  proof.dimension = tape.dimension;
  proof.is_ball = kind == QueryKind::circles;
  proof.tolerance = limits->tolerance;
  Region64 region;
  region.dimension = tape.dimension;
  region.is_ball = proof.is_ball;
  for (std::size_t corner = 0; corner < (proof.is_ball ? 1U : 3U); ++corner) {
    for (std::size_t axis = 0; axis < d; ++axis) {
      region.corner[corner][axis] = proof.corners[corner][axis] = row[corner * d + axis];
    }
  }
  if (proof.is_ball) region.radius = proof.radius = row[d];

  TileScratch scratch(tape);
  Tile tile;
  std::uint8_t status = 0;
  float barycentric[3] = {};
  tile.tape = &tape;
  tile.kernels = default_target().kernels;
  tile.limits = &*limits;
  tile.rows = row;
  tile.count = 1;
  tile.columns.status = &status;
  tile.columns.point = proof.point;
  tile.columns.barycentric = proof.is_ball ? nullptr : barycentric;
  solve(tile, scratch);
  proof.row_status = static_cast<Status>(status);
  if (proof.row_status == Status::bad_row) {
    return Error{.file = "", .place = "row", .expected = "finite coordinates of at most 1e15", .found = "others"};
  }
  proof.u = barycentric[1];
  proof.v = barycentric[2];
  // What touches is to be shown to touch, and no more is to be spent on it. A sign is to be shown again by enclosures
  // alone, whatever it takes: the row's own search also had far points.
  SolveLimits again = *limits;
  const bool is_sure = proof.row_status == Status::separated || proof.row_status == Status::overlapping;
  if (is_sure) again.budget = std::numeric_limits<std::uint32_t>::max();
  if (proof.row_status == Status::touching) again.budget = 1;
  record_in_double(region, again, std::max(limits->budget, kLeastEvaluations), scratch, proof);
  return proof;
}

}  // namespace

Result<Proof> prove_triangle(const Tape& tape, const float* row, const CollideOptions& options) {
  return prove<TriangleTile>(QueryKind::triangles, tape, row, options);
}

Result<Proof> prove_circle(const Tape& tape, const float* row, const CollideOptions& options) {
  return prove<CircleTile>(QueryKind::circles, tape, row, options);
}

}  // namespace thalweg
