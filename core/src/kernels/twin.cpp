// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "kernels/twin.h"

#include <algorithm>

#include "kernels/ranges.inl"

namespace thalweg {
namespace HWY_NAMESPACE {
namespace {

template <int D>
struct TwinCell {
  const Cell64* cell;

  [[nodiscard]] Real reach() const { return {cell->reach}; }
  [[nodiscard]] Real place() const { return {cell->place}; }
  [[nodiscard]] Interval<Real> offset(int axis) const {
    if (cell->is_box) return {{-cell->edges[axis]}, {cell->edges[axis]}};
    const double a = cell->edges[axis], b = cell->edges[D + axis], c = cell->edges[2 * D + axis];
    return {{std::min({a, b, c})}, {std::max({a, b, c})}};
  }
  [[nodiscard]] Real least_slope(Point<Real, D> g) const {
    const double slope[3] = {g.x.v, g.y.v, [&] {
                               if constexpr (D == 3) return g.z.v;
                               return 0.0;
                             }()};
    double least = 0;
    if (cell->is_box) {
      for (int axis = 0; axis < D; ++axis) least -= std::fabs(slope[axis]) * cell->edges[axis];
      return {least};
    }
    for (int vertex = 0; vertex < 3; ++vertex) {
      double sum = 0;
      for (int axis = 0; axis < D; ++axis) sum += slope[axis] * cell->edges[vertex * D + axis];
      least = vertex == 0 ? sum : std::min(least, sum);
    }
    return {least};
  }
  [[nodiscard]] Real most_distance(Point<Real, D> offset) const {
    const double o[3] = {offset.x.v, offset.y.v, [&] {
                           if constexpr (D == 3) return offset.z.v;
                           return 0.0;
                         }()};
    double most = 0;
    for (int vertex = 0; vertex < (cell->is_box ? 1 : 3); ++vertex) {
      double square = 0;
      for (int axis = 0; axis < D; ++axis) {
        const double edge = cell->edges[vertex * D + axis];
        const double x = cell->is_box ? edge + std::fabs(o[axis]) : edge + o[axis];
        square += x * x;
      }
      most = std::max(most, square);
    }
    return {std::sqrt(most)};
  }
};

Machine<Real> twin_machine(const Tape& tape, double* memory, std::uint32_t* definition, const double* point) {
  Machine<Real> m;
  m.instructions = tape.instructions.data();
  m.instruction_count = tape.instructions.size();
  m.pool = tape.constants64.data();
  m.positions = memory;
  m.registers = memory + static_cast<std::size_t>(tape.position_count) * static_cast<std::size_t>(tape.dimension);
  m.definition = definition;
  std::copy_n(point, tape.dimension, m.positions);
  return m;
}

template <int D>
double gradient_at(const Machine<Real>& m, double* gradient) {
  const Field<Real, D> f = divided(run(GradientMode<Real, D>{}, m));
  gradient[0] = f.gradient.x.v;
  gradient[1] = f.gradient.y.v;
  if constexpr (D == 3) gradient[2] = f.gradient.z.v;
  return f.value.v;
}

template <int D>
Enclosure64 enclosure_at(const Machine<Real>& m, const Cell64& cell, bool has_formulas) {
  if (has_formulas) {
    const auto f = run(RangeMode<Real, D, TwinCell<D>>{{&cell}}, m);
    const Interval<Real> said = said_of(f.lo, f.hi);
    return {said.lo.v, f.value.v, said.hi.v};
  }
  const auto f = run(EnclosureMode<Real, D, TwinCell<D>, false>{{&cell}}, m);
  return {f.lo.v, f.value.v, f.hi.v};
}

}  // namespace
}  // namespace HWY_NAMESPACE

namespace simd = HWY_NAMESPACE;

void Twin::use(const Tape& tape) {
  tape_ = &tape;
  const auto registers = static_cast<std::size_t>(tape.register_count);
  const auto positions = static_cast<std::size_t>(tape.position_count);
  memory_.resize(std::max(memory_.size(), registers * 5 + positions * 3 + 4));
  definition_.resize(std::max(definition_.size(), positions));
}

double Twin::value(const double* point) {
  const auto m = simd::twin_machine(*tape_, memory_.data(), definition_.data(), point);
  return tape_->dimension == 2 ? run(simd::ValueMode<simd::Real, 2>{}, m).value.v
                               : run(simd::ValueMode<simd::Real, 3>{}, m).value.v;
}

double Twin::gradient(const double* point, double* gradient) {
  const auto m = simd::twin_machine(*tape_, memory_.data(), definition_.data(), point);
  return tape_->dimension == 2 ? simd::gradient_at<2>(m, gradient) : simd::gradient_at<3>(m, gradient);
}

Enclosure64 Twin::enclose(const double* centre, const Cell64& cell) {
  const auto m = simd::twin_machine(*tape_, memory_.data(), definition_.data(), centre);
  return tape_->dimension == 2 ? simd::enclosure_at<2>(m, cell, tape_->has_formulas)
                               : simd::enclosure_at<3>(m, cell, tape_->has_formulas);
}

double evaluate_double(const Tape& tape, const double* point, double* gradient) {
  Twin twin(tape);
  return gradient == nullptr ? twin.value(point) : twin.gradient(point, gradient);
}

}  // namespace thalweg
