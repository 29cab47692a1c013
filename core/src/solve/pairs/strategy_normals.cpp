// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/pairs/strategy_normals.h"

#include <algorithm>

#include "gradient/strategies.h"
#include "solve/pairs/finish_pairs.h"

namespace thalweg {
namespace {

/// The points of one row, its own first, and the gradients of one of its shapes there.
struct NormalColumns {
  float* points[3] = {};
  float* gradient[3] = {};
  std::uint32_t* evaluations = nullptr;

  void take(Arena& arena, std::size_t count, int dimension) {
    for (int axis = 0; axis < dimension; ++axis) {
      points[axis] = arena.take<float>(padded(count));
      gradient[axis] = arena.take<float>(padded(count));
    }
    evaluations = arena.take<std::uint32_t>(padded(count));
    std::fill_n(evaluations, count, 0);
  }
};

class Renewal {
 public:
  Renewal(const PairTile& tile, PairScratch& scratch) : tile_(tile), arena_(scratch.query) {}

  void run(std::size_t row) {
    if (!prepare(*tile_.queries, *tile_.options, row, problem_)) return;
    const std::size_t kept =
        tile_.contacts.found == nullptr ? 0 : std::min<std::size_t>(tile_.contacts.found[row], tile_.contacts.capacity);
    count_ = 1 + kept;
    arena_.reset();
    for (NormalColumns* columns : {&a_, &b_}) columns->take(arena_, count_, problem_.dimension);
    place(0, tile_.columns.point + row * dimension());
    for (std::size_t k = 0; k < kept; ++k) place(1 + k, tile_.contacts.point + slot(row, k) * dimension());
    evaluate(*problem_.a, 0, a_);
    evaluate(*problem_.b, 1, b_);
    for (std::size_t i = 0; i < count_; ++i) {
      write(row, i);
      tile_.columns.evaluations[row] += std::max(a_.evaluations[i], b_.evaluations[i]);
    }
  }

 private:
  [[nodiscard]] std::size_t dimension() const { return static_cast<std::size_t>(problem_.dimension); }
  [[nodiscard]] std::size_t slot(std::size_t row, std::size_t k) const { return row * tile_.contacts.capacity + k; }

  void place(std::size_t i, const float* point) {
    double in_a[3] = {}, in_b[3] = {};
    std::copy_n(point, dimension(), in_a);
    problem_.pose.to_b(in_a, in_b, problem_.dimension);
    for (std::size_t axis = 0; axis < dimension(); ++axis) {
      a_.points[axis][i] = point[axis];
      b_.points[axis][i] = static_cast<float>(in_b[axis]);
    }
  }

  void evaluate(const Tape& whole, std::size_t which, const NormalColumns& columns) {
    NearField field;
    field.begin(*tile_.kernels, whole, tile_.near[which], arena_);
    const Tape& tape = field.at(columns.points, count_);
    const GradientRule rule = rule_of(tape, strategy_of(*tile_.options), tile_.options->gradient_offset);
    const GradientColumns asked{
        .points = columns.points, .count = count_, .gradient = columns.gradient, .evaluations = columns.evaluations};
    evaluate_gradient(rule, tape, *tile_.kernels, asked, field.scratch());
  }

  void write(std::size_t row, std::size_t i) const {
    double of_b[3] = {}, turned[3] = {};
    float gradient_a[3] = {}, gradient_b[3] = {}, normal[3] = {};
    for (std::size_t axis = 0; axis < dimension(); ++axis) of_b[axis] = static_cast<double>(b_.gradient[axis][i]);
    problem_.pose.turn_to_a(of_b, turned, problem_.dimension);
    for (std::size_t axis = 0; axis < dimension(); ++axis) {
      gradient_a[axis] = a_.gradient[axis][i];
      gradient_b[axis] = static_cast<float>(turned[axis]);
    }
    const bool ambiguous = pair_normal(gradient_a, gradient_b, problem_.dimension, normal);
    if (i == 0) return write_normal(tile_, row, normal, ambiguous, problem_.dimension);
    write_contact_normal(tile_, slot(row, i - 1), normal, ambiguous, problem_.dimension);
  }

  const PairTile& tile_;
  Arena& arena_;
  PairProblem problem_;
  std::size_t count_ = 0;
  NormalColumns a_, b_;
};

}  // namespace

void renew_normals(const PairTile& tile, PairScratch& scratch) {
  Renewal renewal(tile, scratch);
  for (std::size_t i = 0; i < tile.count; ++i) renewal.run(tile.row(i));
}

}  // namespace thalweg
