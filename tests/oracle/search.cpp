// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Branch and bound over a triangle or a ball, best bound first. Most queries end at their first sample, so the cheap
// Lipschitz bound is tried alone at first and the enclosure joins in where it does not settle the matter.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "oracle.h"

namespace thalweg::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kCheapSamples = 6;

struct TriangleCell {
  std::array<Vec, 3> corners;

  [[nodiscard]] Vec sample() const { return (corners[0] + corners[1] + corners[2]) * (1.0 / 3); }
  [[nodiscard]] bool empty() const { return false; }
  [[nodiscard]] double reach(Vec from) const {
    return std::max({distance(corners[0], from), distance(corners[1], from), distance(corners[2], from)});
  }
  [[nodiscard]] Interval enclosure(const Field& field) const {
    return field.enclose(sample(), corners.data(), corners.size());
  }
  /// Halves the longest edge, so that slivers become compact.
  [[nodiscard]] std::array<TriangleCell, 2> split() const {
    std::size_t longest = 0;
    double most = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double edge = distance(corners[i], corners[(i + 1) % 3]);
      if (edge > most) most = edge, longest = i;
    }
    const Vec a = corners[longest], b = corners[(longest + 1) % 3], c = corners[(longest + 2) % 3];
    const Vec middle = (a + b) * 0.5;
    return {TriangleCell{{a, middle, c}}, TriangleCell{{middle, b, c}}};
  }
};

/// The part of a ball inside a box.
struct BallCell {
  Vec ball;
  double radius = 0;
  int dimension = 2;
  Vec lo, hi;

  [[nodiscard]] Vec centre() const { return (lo + hi) * 0.5; }
  /// The box centre, moved into the ball.
  [[nodiscard]] Vec sample() const {
    const Vec out = centre() - ball;
    const double far = length(out);
    return far > radius ? ball + out * (radius / far) : centre();
  }
  [[nodiscard]] bool empty() const {
    const Vec nearest{std::clamp(ball.x, lo.x, hi.x), std::clamp(ball.y, lo.y, hi.y), std::clamp(ball.z, lo.z, hi.z)};
    return distance(nearest, ball) > radius * (1 + 1e-12);
  }
  [[nodiscard]] std::array<Vec, 8> corners() const {
    std::array<Vec, 8> all;
    for (std::size_t i = 0; i < 8; ++i) all[i] = {i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z};
    return all;
  }
  [[nodiscard]] double reach(Vec from) const {
    double most = 0;
    for (const Vec corner : corners()) most = std::max(most, distance(corner, from));
    return most;
  }
  [[nodiscard]] Interval enclosure(const Field& field) const {
    const auto all = corners();
    return field.enclose(centre(), all.data(), dimension == 2 ? 4 : 8);
  }
  [[nodiscard]] std::array<BallCell, 2> split() const {
    BallCell low = *this, high = *this;
    const Vec middle = centre(), size = hi - lo;
    if (size.x >= size.y && size.x >= size.z) {
      low.hi.x = high.lo.x = middle.x;
    } else if (size.y >= size.z) {
      low.hi.y = high.lo.y = middle.y;
    } else {
      low.hi.z = high.lo.z = middle.z;
    }
    return {low, high};
  }
};

template <class Cell>
class Search {
 public:
  Search(const Field& field, const Limits& limits, double magnitude)
      : field_(field), limits_(limits), margin_(field.margin(magnitude)) {
    bracket_.upper = kInfinity;
  }

  Bracket run(const Cell& root) {
    push(root);
    while (!heap_.empty() && !finished()) {
      std::pop_heap(heap_.begin(), heap_.end(), by_bound);
      const Open open = heap_.back();
      heap_.pop_back();
      for (const Cell& half : open.cell.split()) {
        if (!half.empty()) push(half);
      }
    }
    bracket_.lower = std::min(bracket_.upper, heap_.empty() ? kInfinity : heap_.front().bound);
    return bracket_;
  }

 private:
  struct Open {
    double bound;
    Cell cell;
  };
  static bool by_bound(const Open& a, const Open& b) { return a.bound > b.bound; }

  void push(const Cell& cell) {
    const Vec at = cell.sample();
    const double value = field_(at);
    ++bracket_.evaluations;
    if (value < bracket_.upper) bracket_.upper = value, bracket_.witness = at;
    double bound = value - cell.reach(at);
    const bool open = limits_.verdict_only ? bound <= margin_ : bound < bracket_.upper - limits_.width;
    if (open && bracket_.evaluations > kCheapSamples) {
      bound = std::max(bound, cell.enclosure(field_).lower);
      ++bracket_.evaluations;
    }
    heap_.push_back({std::min(bound, value), cell});
    std::push_heap(heap_.begin(), heap_.end(), by_bound);
  }

  bool finished() {
    const double lower = heap_.front().bound;
    const bool signed_already = lower > margin_ || bracket_.upper < -margin_;
    bracket_.decided = limits_.verdict_only ? signed_already : bracket_.upper - lower <= limits_.width;
    // Within rounding of each other: no further cell tells anything.
    const bool exhausted = bracket_.upper - lower <= margin_;
    return bracket_.decided || exhausted || bracket_.evaluations >= limits_.cap;
  }

  const Field& field_;
  const Limits& limits_;
  double margin_;
  Bracket bracket_;
  std::vector<Open> heap_;
};

double largest(Vec a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

}  // namespace

Bracket minimum_over_triangle(const Field& field, const std::array<Vec, 3>& triangle, const Limits& limits) {
  const double magnitude = std::max({largest(triangle[0]), largest(triangle[1]), largest(triangle[2])});
  return Search<TriangleCell>(field, limits, magnitude).run({triangle});
}

Bracket minimum_over_ball(const Field& field, Vec centre, double radius, const Limits& limits) {
  const Vec half{radius, radius, field.dimension() == 3 ? radius : 0};
  const BallCell root{centre, radius, field.dimension(), centre - half, centre + half};
  return Search<BallCell>(field, limits, largest(centre) + radius).run(root);
}

Verdict verdict(const Field& field, const Bracket& bracket, double magnitude) {
  const double margin = field.margin(magnitude);
  if (bracket.upper < -margin) return Verdict::overlapping;
  if (bracket.lower > margin) return Verdict::separated;
  return Verdict::cannot_tell;
}

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::separated:
      return "separated";
    case Verdict::overlapping:
      return "overlapping";
    default:
      return "cannot tell";
  }
}

}  // namespace thalweg::oracle
