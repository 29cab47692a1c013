// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Coverage is proven by taking the query apart: a region is covered when a cell is that region, or when it can be
// halved so that every cell lies in one half and both halves are covered. Cells have dyadic coordinates; scaled to
// integers, all of it is exact.
#include "proof_check.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace thalweg::oracle {
namespace {

__extension__ using Wide = __int128;

constexpr int kScaleBits = 58;

struct Grid2 {
  std::int64_t u, v;
  friend bool operator==(const Grid2&, const Grid2&) = default;
};
using GridTriangle = std::array<Grid2, 3>;

/// A number of [-2, 2] as a multiple of 2^-58, if it is one.
std::optional<std::int64_t> on_grid(double x) {
  if (!(std::abs(x) <= 2)) return std::nullopt;
  const double scaled = std::ldexp(x, kScaleBits);
  if (scaled != std::floor(scaled)) return std::nullopt;
  return static_cast<std::int64_t>(scaled);
}

Wide turn(Grid2 a, Grid2 b, Grid2 c) {
  return static_cast<Wide>(b.u - a.u) * (c.v - a.v) - static_cast<Wide>(b.v - a.v) * (c.u - a.u);
}

bool contains(const GridTriangle& t, Grid2 p) {
  const Wide s[3] = {turn(t[0], t[1], p), turn(t[1], t[2], p), turn(t[2], t[0], p)};
  const bool left = s[0] >= 0 && s[1] >= 0 && s[2] >= 0;
  const bool right = s[0] <= 0 && s[1] <= 0 && s[2] <= 0;
  return left || right;
}

bool contains(const GridTriangle& t, const GridTriangle& inner) {
  return std::all_of(inner.begin(), inner.end(), [&](Grid2 p) { return contains(t, p); });
}

bool same(const GridTriangle& a, const GridTriangle& b) {
  return std::all_of(a.begin(), a.end(), [&](Grid2 p) { return std::find(b.begin(), b.end(), p) != b.end(); }) &&
         std::all_of(b.begin(), b.end(), [&](Grid2 p) { return std::find(a.begin(), a.end(), p) != a.end(); });
}

bool covers(const std::vector<GridTriangle>& cells, const GridTriangle& region) {
  if (std::any_of(cells.begin(), cells.end(), [&](const GridTriangle& c) { return same(c, region); })) return true;
  for (std::size_t k = 0; k < 3 && !cells.empty(); ++k) {
    const Grid2 a = region[k], b = region[(k + 1) % 3], c = region[(k + 2) % 3];
    if ((a.u + b.u) % 2 != 0 || (a.v + b.v) % 2 != 0) continue;
    const Grid2 middle{(a.u + b.u) / 2, (a.v + b.v) / 2};
    const GridTriangle halves[2] = {{a, middle, c}, {middle, b, c}};
    std::vector<GridTriangle> parts[2];
    bool fits = true;
    for (const GridTriangle& cell : cells) {
      const std::size_t half = contains(halves[0], cell) ? 0 : 1;
      fits = fits && contains(halves[half], cell);
      parts[half].push_back(cell);
    }
    if (fits && covers(parts[0], halves[0]) && covers(parts[1], halves[1])) return true;
  }
  return false;
}

/// Boxes of the ball's own frame: centre and half size in radii.
struct GridBox {
  std::array<std::int64_t, 3> centre;
  std::int64_t half;
  friend bool operator==(const GridBox&, const GridBox&) = default;
};

bool misses_ball(const GridBox& box, int dimension) {
  double square = 0;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
    const double gap = std::ldexp(static_cast<double>(std::abs(box.centre[axis]) - box.half), -kScaleBits);
    square += std::max(0.0, gap) * std::max(0.0, gap);
  }
  return square > 1 + 1e-12;
}

bool contains(const GridBox& outer, const GridBox& inner, int dimension) {
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
    if (std::abs(outer.centre[axis] - inner.centre[axis]) > outer.half - inner.half) return false;
  }
  return true;
}

bool covers(const std::vector<GridBox>& cells, const GridBox& region, int dimension) {
  if (misses_ball(region, dimension)) return true;
  if (std::find(cells.begin(), cells.end(), region) != cells.end()) return true;
  if (cells.empty() || region.half % 2 != 0) return false;
  for (std::size_t child = 0; child < std::size_t{1} << dimension; ++child) {
    GridBox part{region.centre, region.half / 2};
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
      part.centre[axis] += (child >> axis & 1) != 0 ? part.half : -part.half;
    }
    std::vector<GridBox> inside;
    std::copy_if(cells.begin(), cells.end(), std::back_inserter(inside),
                 [&](const GridBox& cell) { return contains(part, cell, dimension); });
    if (!covers(inside, part, dimension)) return false;
  }
  return true;
}

std::string cover_fault(const ProvenQuery& query, const ProofClaim& claim, int dimension) {
  std::vector<GridTriangle> triangles;
  std::vector<GridBox> boxes;
  for (const ProofClaim::Cell& cell : claim.cells) {
    std::array<std::int64_t, 6> at{};
    for (std::size_t i = 0; i < 6; ++i) {
      const auto number = on_grid(cell.at[i]);
      if (!number) return "a cell's coordinates are not dyadic";
      at[i] = *number;
    }
    triangles.push_back({{{at[0], at[1]}, {at[2], at[3]}, {at[4], at[5]}}});
    boxes.push_back({{at[0], at[1], at[2]}, at[3]});
  }
  constexpr std::int64_t kOne = std::int64_t{1} << kScaleBits;
  const bool covered =
      query.is_ball ? covers(boxes, {{0, 0, 0}, kOne}, dimension) : covers(triangles, {{{0, 0}, {kOne, 0}, {0, kOne}}});
  return covered ? "" : "the cells do not cover the query";
}

/// A cell in scene units: three corners of a triangle, or four or eight of a box.
struct Body {
  std::array<Vec, 8> corners;
  std::size_t count;

  [[nodiscard]] Vec centre() const {
    Vec sum;
    for (std::size_t i = 0; i < count; ++i) sum = sum + corners[i];
    return sum * (1.0 / static_cast<double>(count));
  }
};

Vec located(const ProvenQuery& query, double u, double v) {
  return query.corners[0] + (query.corners[1] - query.corners[0]) * u + (query.corners[2] - query.corners[0]) * v;
}

Body body_of(const ProvenQuery& query, const ProofClaim::Cell& cell, int dimension) {
  Body body{};
  if (!query.is_ball) {
    body.count = 3;
    for (std::size_t k = 0; k < 3; ++k) body.corners[k] = located(query, cell.at[2 * k], cell.at[2 * k + 1]);
    return body;
  }
  body.count = std::size_t{1} << dimension;
  const double half = cell.at[3] * query.radius;
  for (std::size_t i = 0; i < body.count; ++i) {
    const auto side = [&](std::size_t axis) { return (i >> axis & 1) != 0 ? half : -half; };
    const Vec offset = Vec{cell.at[0], cell.at[1], cell.at[2]} * query.radius;
    body.corners[i] = query.corners[0] + offset + Vec{side(0), side(1), dimension == 3 ? side(2) : 0};
  }
  return body;
}

std::array<Body, 2> halves_of(const Body& body) {
  std::array<Body, 2> halves = {body, body};
  if (body.count == 3) {
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      const auto edge = [&](std::size_t i) { return distance(body.corners[i], body.corners[(i + 1) % 3]); };
      if (edge(k) > edge(longest)) longest = k;
    }
    const std::size_t next = (longest + 1) % 3;
    halves[0].corners[next] = halves[1].corners[longest] = (body.corners[longest] + body.corners[next]) * 0.5;
    return halves;
  }
  // Boxes: across the longest side; corner i and its partner differ in one bit.
  std::size_t axis = 0;
  for (std::size_t bit = 1; bit < body.count; bit *= 2) {
    if (distance(body.corners[0], body.corners[bit]) >
        distance(body.corners[0], body.corners[std::size_t{1} << axis])) {
      axis = static_cast<std::size_t>(std::countr_zero(bit));
    }
  }
  const std::size_t bit = std::size_t{1} << axis;
  for (std::size_t i = 0; i < body.count; ++i) {
    const Vec middle = (body.corners[i] + body.corners[i ^ bit]) * 0.5;
    halves[(i & bit) != 0 ? 0 : 1].corners[i] = middle;
  }
  return halves;
}

class BoundCheck {
 public:
  BoundCheck(const Field& field, const ProvenQuery& query, std::size_t most_evaluations)
      : field_(field), query_(query), left_(most_evaluations) {
    for (const Vec c : query.corners) {
      magnitude_ = std::max({magnitude_, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
    }
    magnitude_ += query.radius;
    margin_ = 4 * field.margin(magnitude_);
  }

  [[nodiscard]] double margin() const { return margin_; }
  [[nodiscard]] double magnitude() const { return magnitude_; }

  /// Why f may be below `bound` in the part of the query that the body holds, or nothing.
  std::string fault(const Body& root, double bound) {
    std::vector<Body> open = {root};
    while (!open.empty()) {
      const Body body = open.back();
      open.pop_back();
      if (query_.is_ball && outside(body)) continue;
      if (left_ == 0) return "a bound could not be verified";
      --left_;
      const Vec centre = body.centre();
      if (field_.enclose(centre, body.corners.data(), body.count).lower >= bound - margin_) continue;
      for (std::size_t i = 0; i < body.count; ++i) {
        if (in_query(body.corners[i]) && field_(body.corners[i]) < bound - margin_) return "a bound exceeds f";
      }
      if (in_query(centre) && field_(centre) < bound - margin_) return "a bound exceeds f";
      for (const Body& half : halves_of(body)) open.push_back(half);
    }
    return "";
  }

 private:
  [[nodiscard]] bool in_query(Vec p) const {
    return !query_.is_ball || distance(p, query_.corners[0]) <= query_.radius;
  }
  [[nodiscard]] bool outside(const Body& body) const {
    Vec lo = body.corners[0], hi = body.corners[0];
    for (std::size_t i = 1; i < body.count; ++i) {
      const Vec c = body.corners[i];
      lo = {std::min(lo.x, c.x), std::min(lo.y, c.y), std::min(lo.z, c.z)};
      hi = {std::max(hi.x, c.x), std::max(hi.y, c.y), std::max(hi.z, c.z)};
    }
    const Vec c = query_.corners[0];
    const Vec nearest{std::clamp(c.x, lo.x, hi.x), std::clamp(c.y, lo.y, hi.y), std::clamp(c.z, lo.z, hi.z)};
    return distance(nearest, c) > query_.radius * (1 + 1e-12);
  }

  const Field& field_;
  const ProvenQuery& query_;
  std::size_t left_;
  double magnitude_ = 0;
  double margin_ = 0;
};

/// Where the witness really is; the reported point is within float32 rounding of it.
std::string witness_fault(const ProvenQuery& query, const ProofClaim& claim, double magnitude, Vec& exact) {
  const double rounding = 2e-7 * magnitude;
  if (query.is_ball) {
    exact = claim.point;
    const double out = distance(exact, query.corners[0]) - query.radius;
    if (out > rounding) return "the point lies outside the query";
    if (out > 0) exact = query.corners[0] + (exact - query.corners[0]) * (query.radius / (query.radius + out));
    return "";
  }
  if (!(claim.u >= 0 && claim.v >= 0 && claim.u + claim.v <= 1 + 1e-6)) return "the point lies outside the query";
  const double over = std::max(1.0, claim.u + claim.v);
  exact = located(query, claim.u / over, claim.v / over);
  return distance(exact, claim.point) <= 8 * rounding ? "" : "the point is not where its coordinates say";
}

}  // namespace

std::string fault_of(const Field& field, const ProvenQuery& query, const ProofClaim& claim,
                     std::size_t most_evaluations) {
  BoundCheck bounds(field, query, most_evaluations);
  Vec exact;
  if (std::string fault = witness_fault(query, claim, bounds.magnitude(), exact); !fault.empty()) return fault;
  if (std::abs(field(claim.point) - claim.value) > bounds.margin()) return "the value is not f at the point";
  if (claim.status == "overlapping") return field(exact) < 0 ? "" : "f is not negative at the point";
  if (std::string fault = cover_fault(query, claim, field.dimension()); !fault.empty()) return fault;
  double least = std::numeric_limits<double>::infinity();
  for (const ProofClaim::Cell& cell : claim.cells) {
    least = std::min(least, cell.bound);
    if (!std::isfinite(cell.bound)) return "a bound is not a number";
    std::string fault = bounds.fault(body_of(query, cell, field.dimension()), cell.bound);
    if (!fault.empty()) return fault;
  }
  if (claim.status == "separated") return least > 0 ? "" : "a bound is not above 0";
  if (claim.status == "undecided") return "";
  if (claim.status != "touching") return "no such status";
  if (least < -query.tolerance) return "a bound is below the tolerance";
  return claim.value <= query.tolerance ? "" : "f at the point is above the tolerance";
}

}  // namespace thalweg::oracle
