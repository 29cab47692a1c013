// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Random triangles and circles or spheres around a shape, with the kinds that break collision code: slivers, segments
// and points, triangles flush with the surface, touching it at one point, huge and tiny ones.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "oracle.h"
#include "random.h"

namespace thalweg::oracle {

enum class QueryKind { plain, sliver, segment, point, flush, touching, huge, tiny };
inline constexpr std::array kQueryKinds = {QueryKind::plain, QueryKind::sliver,   QueryKind::segment, QueryKind::point,
                                           QueryKind::flush, QueryKind::touching, QueryKind::huge,    QueryKind::tiny};
[[nodiscard]] std::string_view name(QueryKind kind);

/// Where queries are placed: a box in scene units.
struct Region {
  Vec lo, hi;
};
/// The shape's bounds grown by a quarter, or a box of a few units where they are not finite.
[[nodiscard]] Region region_of(const Shape& shape);

[[nodiscard]] Vec point_in(Random& random, const Region& region);

/// A point of {f = 0}, by bisection between random points of the region, and the direction in which f grows there.
struct SurfacePoint {
  bool found = false;
  Vec point, normal;
};
[[nodiscard]] SurfacePoint random_surface_point(Random& random, const Field& field, const Region& region);

/// Rows as the batch queries take them: triangles (N,3,d), circles (N,d+1).
[[nodiscard]] std::vector<float> random_triangles(Random& random, const Field& field, const Region& region,
                                                  QueryKind kind, std::size_t count);
[[nodiscard]] std::vector<float> random_circles(Random& random, const Field& field, const Region& region,
                                                QueryKind kind, std::size_t count);
/// Half of them plain, the others of every kind in turn.
[[nodiscard]] std::vector<float> mixed_triangles(Random& random, const Field& field, const Region& region,
                                                 std::size_t count);
[[nodiscard]] std::vector<float> mixed_circles(Random& random, const Field& field, const Region& region,
                                               std::size_t count);

/// One row of a triangle column, read as the query is: the float32 coordinates themselves.
[[nodiscard]] std::array<Vec, 3> triangle_at(const std::vector<float>& rows, std::size_t row, int dimension);
[[nodiscard]] Vec point_at(const float* rows, std::size_t row, int dimension);

}  // namespace thalweg::oracle
