// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// 1. A triangle whose bound f(c) - L r is above the margin has no contact.
// 2. It is cut into a lattice as fine as the features asked for. A lattice point is a candidate when none of its six
//    neighbours is lower: on a face that lies flush all of them are.
// 3. Candidates that lie close together and face the same way are one, the deepest; the others are polished by a
// compass
//    search, which needs no gradient and so passes over kinks.
// 4. What is left at most `margin` is merged again, counted, and cut down to K.
// PhysX cuts large triangles into four as well, but starts one descent in each part and keeps what comes of it.
#include "solve/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/kernels.h"

namespace thalweg {
namespace {

constexpr std::size_t kMostPoints = kMostContacts;
/// Candidates that are polished, deepest first; more there are only where a triangle lies flush, and need none.
constexpr std::size_t kMostPolished = 64;
constexpr int kRounds = 32;
/// Normals with a greater cosine face the same way.
constexpr float kSameFacing = 0.9F;
/// Directions of the compass: the lattice's, which run along the edges, and as many evenly spread in the scene, because
/// those of a sliver are nearly one.
constexpr std::size_t kWays = 12;
/// The six directions of the lattice, in barycentric coordinates.
constexpr float kCompass[6][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}};

float square_between(const Contact& p, const Contact& q, std::size_t dimension) {
  float square = 0;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    square += (p.point[axis] - q.point[axis]) * (p.point[axis] - q.point[axis]);
  }
  return square;
}

bool deeper(const Contact& p, const Contact& q) {
  if (p.value != q.value) return p.value < q.value;
  return p.u != q.u ? p.u < q.u : p.v < q.v;
}

class Finder {
 public:
  Finder(const TriangleTile& tile, TileScratch& scratch) : tile_(tile), limits_(*tile.limits) {
    Arena& arena = scratch.arena;
    arena.reset();
    d_ = static_cast<std::size_t>(tile.tape->dimension);
    lipschitz_ = static_cast<float>(tile.tape->facts.lipschitz);
    const std::size_t room = padded(std::max({kMostPoints, kWays * kMostPolished, tile.count}));
    for (std::size_t axis = 0; axis < d_; ++axis) {
      points_[axis] = arena.take<float>(room);
      gradient_[axis] = arena.take<float>(room);
    }
    value_ = arena.take<float>(room);
    centre_ = arena.take<float>(room);
    step_ = arena.take<float>(kMostPolished);
    contacts_ = arena.take<Contact>(kMostPoints);
    kernel_scratch_ = arena.take<float>(scratch_floats(*tile.tape));
  }

  void run() {
    evaluate_centres();
    for (std::size_t q = 0; q < tile_.count; ++q) {
      row_ = tile_.rows + q * 3 * d_;
      evaluations_ = 1;
      count_ = 0;
      found_ = 0;
      if (is_good() && is_near(centre_[q])) find();
      write(q);
    }
  }

 private:
  [[nodiscard]] bool is_good() const {
    return std::all_of(row_, row_ + 3 * d_, [](float x) { return std::fabs(x) <= kLargestCoordinate; });
  }

  void locate(std::size_t at, float u, float v) {
    for (std::size_t axis = 0; axis < d_; ++axis) {
      const float a = row_[axis];
      points_[axis][at] = a + (u * (row_[d_ + axis] - a) + v * (row_[2 * d_ + axis] - a));
    }
  }

  void evaluate(std::size_t count) {
    tile_.kernels->value(*tile_.tape, points_, count, value_, kernel_scratch_);
    evaluations_ += static_cast<std::uint32_t>(count);
  }

  void evaluate_centres() {
    for (std::size_t q = 0; q < tile_.count; ++q) {
      row_ = tile_.rows + q * 3 * d_;
      locate(q, 1.0F / 3, 1.0F / 3);
      for (std::size_t axis = 0; axis < d_ && !is_good(); ++axis) points_[axis][q] = 0;
    }
    tile_.kernels->value(*tile_.tape, points_, tile_.count, centre_, kernel_scratch_);
  }

  [[nodiscard]] float edge(std::size_t from, std::size_t to) const {
    float square = 0;
    for (std::size_t axis = 0; axis < d_; ++axis) {
      const float x = row_[to * d_ + axis] - row_[from * d_ + axis];
      square += x * x;
    }
    return std::sqrt(square);
  }

  /// No point of a triangle is further from its centroid than two thirds of its longest edge.
  bool is_near(float centre) {
    longest_ = std::max({edge(0, 1), edge(1, 2), edge(2, 0)});
    // Not a number, where nothing bounds f, is near.
    return !(centre - lipschitz_ * longest_ * 0.6667F > margin());
  }

  [[nodiscard]] float margin() const { return static_cast<float>(limits_.margin); }

  void find() {
    const auto feature = static_cast<float>(limits_.feature);
    const float wanted = std::ceil(longest_ / feature);
    divisions_ = static_cast<std::uint32_t>(std::clamp(wanted, 4.0F, static_cast<float>(kMostDivisions)));
    spacing_ = longest_ / static_cast<float>(divisions_);
    near_ = std::max(feature, spacing_);
    sample_lattice();
    choose_candidates();
    take_normals();
    count_ = merge_contacts(contacts_, count_, near_, d_);
    polish(std::min(count_, kMostPolished));
    drop_high();
    take_normals();
    count_ = found_ = merge_contacts(contacts_, count_, near_, d_);
    count_ = reduce_contacts(contacts_, count_, limits_.contacts, value_);
  }

  [[nodiscard]] std::size_t lattice_index(std::uint32_t i, std::uint32_t j) const {
    // Row i has divisions + 1 - i points.
    return std::size_t{i} * (2 * divisions_ + 3 - i) / 2 + j;
  }

  void sample_lattice() {
    const float share = 1.0F / static_cast<float>(divisions_);
    for (std::uint32_t i = 0; i <= divisions_; ++i) {
      for (std::uint32_t j = 0; i + j <= divisions_; ++j) {
        locate(lattice_index(i, j), static_cast<float>(i) * share, static_cast<float>(j) * share);
      }
    }
    evaluate((divisions_ + 1) * (divisions_ + 2) / 2);
  }

  [[nodiscard]] bool is_lowest(std::uint32_t i, std::uint32_t j) const {
    const float here = value_[lattice_index(i, j)];
    for (const auto& step : kCompass) {
      const int k = static_cast<int>(i) + static_cast<int>(step[0]);
      const int l = static_cast<int>(j) + static_cast<int>(step[1]);
      if (k < 0 || l < 0 || k + l > static_cast<int>(divisions_)) continue;
      if (value_[lattice_index(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(l))] < here) return false;
    }
    return true;
  }

  void choose_candidates() {
    const float share = 1.0F / static_cast<float>(divisions_);
    for (std::uint32_t i = 0; i <= divisions_; ++i) {
      for (std::uint32_t j = 0; i + j <= divisions_; ++j) {
        const float here = value_[lattice_index(i, j)];
        if (here - lipschitz_ * spacing_ > margin() || !is_lowest(i, j)) continue;
        Contact& made = contacts_[count_++];
        made.u = static_cast<float>(i) * share;
        made.v = static_cast<float>(j) * share;
        made.value = here;
        std::fill_n(made.point, 3, 0.0F);
        std::fill_n(made.normal, 3, 0.0F);
      }
    }
  }

  /// Points and unit normals of all contacts.
  void take_normals() {
    for (std::size_t i = 0; i < count_; ++i) locate(i, contacts_[i].u, contacts_[i].v);
    tile_.kernels->gradient(*tile_.tape, points_, count_, value_, gradient_, kernel_scratch_);
    evaluations_ += static_cast<std::uint32_t>(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      float square = 0;
      for (std::size_t axis = 0; axis < d_; ++axis) square += gradient_[axis][i] * gradient_[axis][i];
      const bool vanishes = !(square > 1e-6F);
      const float inverse = vanishes ? 0 : 1 / std::sqrt(square);
      for (std::size_t axis = 0; axis < d_; ++axis) {
        contacts_[i].point[axis] = points_[axis][i];
        contacts_[i].normal[axis] = vanishes ? (axis + 1 == d_ ? 1.0F : 0.0F) : inverse * gradient_[axis][i];
      }
    }
  }

  /// Directions for the triangle at hand, of about the same length as the lattice's.
  void choose_ways() {
    float uu = 0;
    float uv = 0;
    float vv = 0;
    for (std::size_t axis = 0; axis < d_; ++axis) {
      const float e1 = row_[d_ + axis] - row_[axis];
      const float e2 = row_[2 * d_ + axis] - row_[axis];
      uu += e1 * e1;
      uv += e1 * e2;
      vv += e2 * e2;
    }
    // |u e1 + v e2| = longest for u = p / l11 - q l21 / (l11 l22), v = q / l22 (Cholesky), (p, q) on a circle.
    const float l11 = std::sqrt(uu);
    const float l21 = l11 > 0 ? uv / l11 : 0;
    const float l22 = std::sqrt(std::max(0.0F, vv - l21 * l21));
    const bool is_flat = !(l22 > 1e-6F * longest_) || !(l11 > 1e-6F * longest_);
    constexpr float kHalf = 0.8660254F;
    constexpr float kCircle[6][2] = {{1, 0}, {0.5F, kHalf}, {-0.5F, kHalf}, {-1, 0}, {-0.5F, -kHalf}, {0.5F, -kHalf}};
    for (std::size_t k = 0; k < 6; ++k) {
      ways_[k] = {kCompass[k][0], kCompass[k][1]};
      const float v = is_flat ? kCompass[k][1] : longest_ * kCircle[k][1] / l22;
      const float u = is_flat ? kCompass[k][0] : (longest_ * kCircle[k][0] - v * l21) / l11;
      ways_[6 + k] = {u, v};
    }
  }

  /// Compass search from the first contacts at once; each goes to the lowest of its ways or halves its step.
  void polish(std::size_t count) {
    choose_ways();
    std::fill_n(step_, count, 0.5F / static_cast<float>(divisions_));
    for (int round = 0; round < kRounds && count > 0; ++round) {
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < kWays; ++k) {
          const auto [u, v] = neighbour(contacts_[i], step_[i], k);
          locate(kWays * i + k, u, v);
        }
      }
      evaluate(kWays * count);
      for (std::size_t i = 0; i < count; ++i) {
        const float* ways = value_ + kWays * i;
        const auto k = static_cast<std::size_t>(std::min_element(ways, ways + kWays) - ways);
        if (ways[k] < contacts_[i].value) {
          const auto [u, v] = neighbour(contacts_[i], step_[i], k);
          contacts_[i].u = u;
          contacts_[i].v = v;
          contacts_[i].value = ways[k];
        } else {
          step_[i] *= 0.5F;
        }
      }
    }
  }

  struct Place {
    float u, v;
  };
  /// A step in a direction of the compass, or none where it would leave the triangle.
  [[nodiscard]] Place neighbour(const Contact& from, float step, std::size_t direction) const {
    const float u = from.u + step * ways_[direction].u;
    const float v = from.v + step * ways_[direction].v;
    return u >= 0 && v >= 0 && u + v <= 1 ? Place{u, v} : Place{from.u, from.v};
  }

  void drop_high() {
    const float most = margin();
    Contact* end =
        std::remove_if(contacts_, contacts_ + count_, [most](const Contact& c) { return !(c.value <= most); });
    count_ = static_cast<std::size_t>(end - contacts_);
  }

  void write(std::size_t q) const {
    const ContactColumns& out = tile_.columns.contacts;
    if (out.found != nullptr) out.found[q] = static_cast<std::uint32_t>(found_);
    if (out.kept != nullptr) out.kept[q] = static_cast<std::uint32_t>(count_);
    if (tile_.columns.evaluations != nullptr && is_good()) tile_.columns.evaluations[q] += evaluations_;
    for (std::size_t i = 0; i < count_; ++i) {
      const Contact& c = contacts_[i];
      const std::size_t at = q * limits_.contacts + i;
      if (out.value != nullptr) out.value[at] = c.value;
      if (out.point != nullptr) std::copy_n(c.point, d_, out.point + at * d_);
      if (out.normal != nullptr) std::copy_n(c.normal, d_, out.normal + at * d_);
      if (out.barycentric == nullptr) continue;
      const float first = std::max(0.0F, 1 - c.u - c.v);
      const float weights[3] = {first, c.u, c.v};
      std::copy_n(weights, 3, out.barycentric + at * 3);
    }
  }

  const TriangleTile& tile_;
  const SolveLimits& limits_;
  std::size_t d_ = 2;
  float lipschitz_ = 1;
  float* points_[3] = {};
  float* gradient_[3] = {};
  float* value_ = nullptr;
  float* centre_ = nullptr;
  float* step_ = nullptr;
  Contact* contacts_ = nullptr;
  float* kernel_scratch_ = nullptr;
  // Of the triangle at hand.
  const float* row_ = nullptr;
  float longest_ = 0;
  float spacing_ = 0;
  float near_ = 0;
  std::uint32_t divisions_ = 0;
  Place ways_[kWays] = {};
  std::uint32_t evaluations_ = 0;
  std::size_t count_ = 0;
  std::size_t found_ = 0;
};

}  // namespace

std::size_t merge_contacts(Contact* contacts, std::size_t count, float near, std::size_t dimension) {
  std::sort(contacts, contacts + count, deeper);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Contact candidate = contacts[i];
    const bool is_other = std::all_of(contacts, contacts + kept, [&](const Contact& other) {
      float cosine = 0;
      for (std::size_t axis = 0; axis < dimension; ++axis) cosine += candidate.normal[axis] * other.normal[axis];
      // Points that coincide are one contact whatever a kink says of the normal.
      const float square = square_between(candidate, other, dimension);
      return square > near * near || (cosine < kSameFacing && square > 1e-4F * near * near);
    });
    if (is_other) contacts[kept++] = candidate;
  }
  return kept;
}

std::size_t reduce_contacts(Contact* contacts, std::size_t count, std::size_t most, float* distance) {
  if (count <= most) return count;
  std::fill_n(distance, count, std::numeric_limits<float>::infinity());
  std::size_t next = 0;
  for (std::size_t kept = 0; kept < most; ++kept) {
    // Kept contacts have distance -1 from now on.
    distance[next] = -1;
    for (std::size_t i = 0; i < count; ++i) {
      if (distance[i] >= 0) distance[i] = std::min(distance[i], square_between(contacts[i], contacts[next], 3));
    }
    next = static_cast<std::size_t>(std::max_element(distance, distance + count) - distance);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (distance[i] == -1) contacts[kept++] = contacts[i];
  }
  return kept;
}

void find_contacts(const TriangleTile& tile, TileScratch& scratch) { Finder(tile, scratch).run(); }

}  // namespace thalweg
