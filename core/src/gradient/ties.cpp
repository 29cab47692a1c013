// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "gradient/ties.h"

#include <algorithm>
#include <cmath>

namespace thalweg {
namespace {

constexpr float kThird = 0.57735027F;
constexpr float kFlat[3][3] = {{1, 0, 0}, {-0.5F, 0.8660254F, 0}, {-0.5F, -0.8660254F, 0}};
constexpr float kSpace[4][3] = {
    {kThird, kThird, kThird}, {kThird, -kThird, -kThird}, {-kThird, kThird, -kThird}, {-kThird, -kThird, kThird}};
/// Shorter gradients have no direction.
constexpr float kVanishing = 1e-3F;

class TieSearch {
 public:
  TieSearch(const Tape& tape, const float* const* points, std::size_t count, Arena& arena)
      : tape_(tape), points_(points), count_(count), d_(static_cast<std::size_t>(tape.dimension)) {
    for (std::size_t axis = 0; axis < d_; ++axis) {
      displaced_[axis] = arena.take<float>(padded(count));
      for (auto& around : gradients_) around[axis] = arena.take<float>(padded(count));
    }
    reach_ = arena.take<float>(padded(count));
    for (std::size_t i = 0; i < count; ++i) reach_[i] = tie_reach(tape, largest(i));
  }

  void look_around(const Kernels& kernels, float* scratch) {
    kernels.gradient(tape_, points_, count_, nullptr, here(), scratch);
    for (std::size_t vertex = 0; vertex <= d_; ++vertex) {
      const float* direction = d_ == 2 ? kFlat[vertex] : kSpace[vertex];
      for (std::size_t axis = 0; axis < d_; ++axis) {
        for (std::size_t i = 0; i < count_; ++i) {
          displaced_[axis][i] = points_[axis][i] + reach_[i] * direction[axis];
        }
      }
      kernels.gradient(tape_, displaced_, count_, nullptr, gradients_[vertex], scratch);
    }
  }

  /// Over whole columns and without branches, which compilers turn into vectors.
  void mark(const Ties& ties, Arena& arena) {
    auto* flag = arena.take<float>(padded(count_));
    auto* square = arena.take<float>(padded(count_) * (d_ + 1));
    const std::size_t room = padded(count_);
    sum_products(here(), here(), square);
    for (std::size_t i = 0; i < count_; ++i) flag[i] = square[i] > kVanishing * kVanishing ? 0.0F : 1.0F;
    for (std::size_t a = 0; a <= d_; ++a) sum_products(gradients_[a], gradients_[a], square + a * room);
    auto* product = arena.take<float>(room);
    for (std::size_t a = 0; a <= d_; ++a) {
      for (std::size_t b = a + 1; b <= d_; ++b) {
        sum_products(gradients_[a], gradients_[b], product);
        const float* aa = square + a * room;
        const float* bb = square + b * room;
        for (std::size_t i = 0; i < count_; ++i) {
          // The cosine is below the threshold where its product with its size is.
          const float turned =
              product[i] * std::fabs(product[i]) < kTieCosine * kTieCosine * aa[i] * bb[i] ? 1.0F : 0.0F;
          const float exists = std::min(aa[i], bb[i]) > kVanishing * kVanishing ? turned : 0.0F;
          flag[i] = std::max(flag[i], exists);
        }
      }
    }
    for (std::size_t i = 0; i < count_; ++i) ties.tied[i] = flag[i] > 0 ? 1 : 0;
  }

  void choose_sides(const Ties& ties) {
    for (std::size_t i = 0; i < count_; ++i) choose_sides(ties, i);
  }

 private:
  struct Unit {
    float x[3] = {};
    bool vanishes = false;
  };

  [[nodiscard]] float** here() { return gradients_[d_ + 1]; }

  [[nodiscard]] float largest(std::size_t i) const {
    float most = 0;
    for (std::size_t axis = 0; axis < d_; ++axis) most = std::max(most, std::fabs(points_[axis][i]));
    return most;
  }

  [[nodiscard]] Unit unit(const float* const* columns, std::size_t i) const {
    Unit u;
    float square = 0;
    for (std::size_t axis = 0; axis < d_; ++axis) square += columns[axis][i] * columns[axis][i];
    u.vanishes = !(square > kVanishing * kVanishing);
    const float inverse = u.vanishes ? 0 : 1 / std::sqrt(square);
    for (std::size_t axis = 0; axis < d_; ++axis) u.x[axis] = columns[axis][i] * inverse;
    return u;
  }

  [[nodiscard]] float cosine(const Unit& a, const Unit& b) const {
    float sum = 0;
    for (std::size_t axis = 0; axis < d_; ++axis) sum += a.x[axis] * b.x[axis];
    return sum;
  }

  void sum_products(const float* const* a, const float* const* b, float* sum) const {
    for (std::size_t i = 0; i < count_; ++i) sum[i] = a[0][i] * b[0][i];
    for (std::size_t axis = 1; axis < d_; ++axis) {
      for (std::size_t i = 0; i < count_; ++i) sum[i] += a[axis][i] * b[axis][i];
    }
  }

  void choose_sides(const Ties& ties, std::size_t i) {
    const Unit at_point = unit(here(), i);
    const Unit* pair[2] = {&at_point, &at_point};
    Unit around[4];
    float least = 2;
    for (std::size_t a = 0; a <= d_ && ties.tied[i] != 0; ++a) {
      around[a] = unit(gradients_[a], i);
      for (std::size_t b = 0; b < a; ++b) {
        if (around[a].vanishes || around[b].vanishes || !(cosine(around[a], around[b]) < least)) continue;
        least = cosine(around[a], around[b]);
        pair[0] = &around[b];
        pair[1] = &around[a];
      }
    }
    if (cosine(*pair[1], at_point) > cosine(*pair[0], at_point)) std::swap(pair[0], pair[1]);
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t axis = 0; axis < d_; ++axis) ties.sides[side][axis][i] = pair[side]->x[axis];
    }
  }

  const Tape& tape_;
  const float* const* points_;
  std::size_t count_, d_;
  float* displaced_[3] = {};
  float* gradients_[5][3] = {};  ///< at the vertices, and after them at the point itself
  float* reach_ = nullptr;
};

}  // namespace

Ties Ties::make(Arena& arena, int dimension, std::size_t count, bool with_sides) {
  Ties ties;
  ties.tied = arena.take<std::uint8_t>(padded(count));
  if (!with_sides) return ties;
  for (auto& side : ties.sides) {
    for (int axis = 0; axis < dimension; ++axis) side[axis] = arena.take<float>(padded(count));
  }
  return ties;
}

float tie_reach(const Tape& tape, float largest) {
  const double size = static_cast<double>(largest);
  // A few steps of the float32 grid at least, or the vertices would be the point.
  const Affine& slack = tape.has_formulas ? tape.enclosure_slack : tape.slack;
  return static_cast<float>(std::max(2 * slack(size), 0x1p-21 * size));
}

void find_ties(const Tape& tape, const Kernels& kernels, const float* const* points, std::size_t count,
               const Ties& ties, float* kernel_scratch, Arena& arena) {
  TieSearch search(tape, points, count, arena);
  search.look_around(kernels, kernel_scratch);
  search.mark(ties, arena);
  if (ties.sides[0][0] != nullptr) search.choose_sides(ties);
}

}  // namespace thalweg
