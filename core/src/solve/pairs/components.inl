// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Connected components of a set of cells: two cells are joined when their closed boxes touch, corners included.
//
// On a small lattice a row of cells along one axis is a word of bits, and a run of set bits is one element of the
// union-find: a few runs stand for hundreds of cells, and rows meet by shifts and masks. On a lattice too fine for that
// boxes sorted along one axis are compared. Included once per SIMD target, for its bit counting instructions.
#if defined(THALWEG_SOLVE_PAIRS_COMPONENTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_COMPONENTS_INL
#undef THALWEG_SOLVE_PAIRS_COMPONENTS_INL
#else
#define THALWEG_SOLVE_PAIRS_COMPONENTS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "solve/arena.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Boxes of dyadic size on one lattice: centre and half extent, exact.
struct CellBoxes {
  int dimension = 3;
  const float* at[3] = {};
  const float* size = nullptr;
  size_t count = 0;
};

/// The least index of a set is its root, so that roots do not depend on the order of unions.
class DisjointSets {
 public:
  void take(Arena& arena, size_t count) {
    parent_ = arena.take<uint32_t>(count);
    std::iota(parent_, parent_ + count, 0U);
  }
  HWY_INLINE uint32_t root(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  HWY_INLINE void unite(uint32_t i, uint32_t j) {
    i = root(i);
    j = root(j);
    if (i < j) parent_[j] = i;
    if (j < i) parent_[i] = j;
  }

 private:
  uint32_t* parent_ = nullptr;
};

class TouchingCells {
 public:
  /// Joins the cells; writes each one's component, numbered in the order of first appearance.
  TouchingCells(const CellBoxes& cells, uint32_t* component, Arena& arena, bool by_sweep = false)
      : cells_(cells), component_(component) {
    if (cells.count == 0) return;
    set_lattice();
    if (by_sweep || !choose_axes()) {
      sweep(arena);
    } else {
      run_over_rows(arena);
    }
  }

  [[nodiscard]] uint32_t count() const { return count_; }

 private:
  static constexpr int32_t kWord = 64;
  static constexpr int32_t kMostRows = 16384;
  static constexpr uint64_t kAll = ~uint64_t{0};
  static constexpr uint32_t kNone = ~uint32_t{0};

  void set_lattice() {
    const float least = *std::min_element(cells_.size, cells_.size + cells_.count);
    per_unit_ = 0.5F / least;
    for (int axis = 0; axis < cells_.dimension; ++axis) {
      float lo = cells_.at[axis][0];
      float hi = lo;
      for (size_t i = 0; i < cells_.count; ++i) {
        lo = std::min(lo, cells_.at[axis][i] - cells_.size[i]);
        hi = std::max(hi, cells_.at[axis][i] + cells_.size[i]);
      }
      base_[axis] = lo;
      // Beyond what choose_axes() accepts the number itself does not matter.
      extent_[axis] = static_cast<int32_t>(std::min((hi - lo) * per_unit_ + 0.5F, 1e6F));
    }
  }

  /// Bits run along the longest axis that fits a word. False when there is none, or too many rows.
  bool choose_axes() {
    for (int axis = 1; axis < cells_.dimension; ++axis) {
      const bool longer = extent_[axis] > extent_[axes_[0]];
      if (extent_[axis] <= kWord && (longer || extent_[axes_[0]] > kWord)) std::swap(axes_[0], axes_[axis]);
    }
    rows_[0] = extent_[axes_[1]];
    rows_[1] = extent_[axes_[2]];
    return extent_[axes_[0]] <= kWord && rows_[0] <= kMostRows && rows_[1] <= kMostRows &&
           int64_t{rows_[0] + 2} * (rows_[1] + 2) <= kMostRows;
  }

  /// Exact: cells lie on the lattice of the smallest.
  HWY_INLINE int32_t first(int axis, size_t i) const {
    return static_cast<int32_t>((cells_.at[axis][i] - cells_.size[i] - base_[axis]) * per_unit_);
  }
  HWY_INLINE int32_t row(int32_t y, int32_t z) const { return (z + 1) * (rows_[0] + 2) + y + 1; }

  struct RowCell {
    int32_t row;
    int32_t bit;
  };

  void run_over_rows(Arena& arena) {
    const auto rows = static_cast<size_t>(rows_[0] + 2) * static_cast<size_t>(rows_[1] + 2);
    bits_ = arena.take<uint64_t>(rows);
    first_run_ = arena.take<uint32_t>(rows);
    std::fill_n(bits_, rows, 0);
    auto* places = arena.take<RowCell>(cells_.count);
    for (size_t i = 0; i < cells_.count; ++i) places[i] = mark(i);
    uint32_t runs = 0;
    for (size_t at = 0; at < rows; ++at) {
      if (bits_[at] == 0) continue;
      first_run_[at] = runs;
      runs += static_cast<uint32_t>(std::popcount(starts(bits_[at])));
    }
    sets_.take(arena, runs);
    const int32_t stride = rows_[0] + 2;
    for (int32_t at = stride; at < static_cast<int32_t>(rows) - stride; ++at) {
      if (bits_[at] == 0) continue;
      for (const int32_t before : {1, stride - 1, stride, stride + 1}) {
        if (bits_[at - before] != 0) meet(at, at - before);
      }
    }
    number(places, runs, arena);
  }

  HWY_INLINE RowCell mark(size_t i) {
    const auto size = static_cast<int32_t>(2 * cells_.size[i] * per_unit_);
    const int32_t bit = first(axes_[0], i);
    const uint64_t mask = (kAll >> (kWord - size)) << bit;
    const int32_t y = first(axes_[1], i);
    const bool flat = cells_.dimension == 2;
    const int32_t z = flat ? 0 : first(axes_[2], i);
    for (int32_t k = 0; k < (flat ? 1 : size); ++k) {
      for (int32_t j = 0; j < size; ++j) bits_[row(y + j, z + k)] |= mask;
    }
    return {row(y, z), bit};
  }

  static HWY_INLINE uint64_t starts(uint64_t bits) { return bits & ~(bits << 1); }
  static HWY_INLINE uint64_t lowest_run(uint64_t bits) { return bits & ~(bits + (bits & (~bits + 1))); }
  HWY_INLINE uint32_t run_at(int32_t at, int bit) const {
    const uint64_t up_to = starts(bits_[at]) & (kAll >> (kWord - 1 - bit));
    return first_run_[at] + static_cast<uint32_t>(std::popcount(up_to)) - 1;
  }

  HWY_INLINE void meet(int32_t at, int32_t other) {
    uint32_t run = first_run_[at];
    for (uint64_t left = bits_[at]; left != 0; ++run) {
      const uint64_t own = lowest_run(left);
      left &= ~own;
      uint64_t touched = bits_[other] & (own | own << 1 | own >> 1);
      while (touched != 0) {
        sets_.unite(run, run_at(other, std::countr_zero(touched)));
        touched &= ~lowest_run(touched);
      }
    }
  }

  void number(const RowCell* places, uint32_t runs, Arena& arena) {
    auto* numbers = arena.take<uint32_t>(runs);
    std::fill_n(numbers, runs, kNone);
    for (size_t i = 0; i < cells_.count; ++i) {
      uint32_t& of_root = numbers[sets_.root(run_at(places[i].row, places[i].bit))];
      if (of_root == kNone) of_root = count_++;
      component_[i] = of_root;
    }
  }

  [[nodiscard]] bool touch(size_t i, size_t j) const {
    for (int axis = 0; axis < cells_.dimension; ++axis) {
      if (std::fabs(cells_.at[axis][i] - cells_.at[axis][j]) > cells_.size[i] + cells_.size[j]) return false;
    }
    return true;
  }

  void sweep(Arena& arena) {
    const auto count = static_cast<uint32_t>(cells_.count);
    auto* order = arena.take<uint32_t>(count);
    std::iota(order, order + count, 0U);
    sets_.take(arena, count);
    const auto lo = [this](uint32_t i) { return cells_.at[0][i] - cells_.size[i]; };
    std::sort(order, order + count, [&](uint32_t i, uint32_t j) { return lo(i) != lo(j) ? lo(i) < lo(j) : i < j; });
    for (uint32_t k = 0; k < count; ++k) {
      const uint32_t i = order[k];
      const float hi = cells_.at[0][i] + cells_.size[i];
      for (uint32_t l = k + 1; l < count && lo(order[l]) <= hi; ++l) {
        if (touch(i, order[l])) sets_.unite(i, order[l]);
      }
    }
    // Roots are the least index of their component, so numbers come in the order of first appearance.
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t root = sets_.root(i);
      component_[i] = root == i ? count_++ : component_[root];
    }
  }

  const CellBoxes& cells_;
  uint32_t* component_;
  uint32_t count_ = 0;
  // In units of the smallest cell: where the lattice begins, and how far the cells reach.
  float base_[3] = {};
  float per_unit_ = 0;
  int32_t extent_[3] = {1, 1, 1};
  // Bit rows along axes_[0]; the other two number the rows, within a border of empty ones.
  int axes_[3] = {0, 1, 2};
  int32_t rows_[2] = {1, 1};
  uint64_t* bits_ = nullptr;
  uint32_t* first_run_ = nullptr;  ///< per row that is not empty
  DisjointSets sets_;              ///< of runs, or of cells
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
