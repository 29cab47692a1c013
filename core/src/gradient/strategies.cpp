// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Each strategy displaces all points at once and asks the value kernel for whole columns. The arithmetic here is plain
// float32, so that it gives the same bits whatever the kernels' target.
#include "gradient/strategies.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg {
namespace {

constexpr int kBisections = 8;

class Probes {
 public:
  Probes(const Tape& tape, const Kernels& kernels, const GradientColumns& columns, float* kernel_scratch, Arena& arena)
      : tape_(tape), kernels_(kernels), columns_(columns), kernel_scratch_(kernel_scratch), arena_(arena) {
    for (std::size_t axis = 0; axis < dimension(); ++axis) displaced_[axis] = column();
    offset_ = column();
  }

  [[nodiscard]] std::size_t dimension() const { return static_cast<std::size_t>(tape_.dimension); }
  [[nodiscard]] std::size_t count() const { return columns_.count; }
  [[nodiscard]] float* column() { return arena_.take<float>(padded(columns_.count)); }
  [[nodiscard]] float* offset() { return offset_; }

  void value_at_points(float* value) { kernels_.value(tape_, columns_.points, count(), value, kernel_scratch_); }

  void choose_offset(ProbeOffset rule, const float* value) {
    for (std::size_t i = 0; i < count(); ++i) {
      offset_[i] = std::max(rule.absolute, rule.relative * std::fabs(value[i]));
    }
  }

  /// f at each point moved by its offset along `direction(i, axis)`.
  template <class Direction>
  void displaced_value(Direction direction, float* value) {
    for (std::size_t axis = 0; axis < dimension(); ++axis) {
      for (std::size_t i = 0; i < count(); ++i) {
        displaced_[axis][i] = columns_.points[axis][i] + offset_[i] * direction(i, axis);
      }
    }
    kernels_.value(tape_, displaced_, count(), value, kernel_scratch_);
  }

  /// Replaces differences by unit vectors; a zero difference stays zero.
  void normalise() {
    for (std::size_t i = 0; i < count(); ++i) {
      float square = 0;
      for (std::size_t axis = 0; axis < dimension(); ++axis) {
        square += columns_.gradient[axis][i] * columns_.gradient[axis][i];
      }
      const float inverse = square > 0 ? 1 / std::sqrt(square) : 0;
      for (std::size_t axis = 0; axis < dimension(); ++axis) columns_.gradient[axis][i] *= inverse;
    }
  }

 private:
  const Tape& tape_;
  const Kernels& kernels_;
  const GradientColumns& columns_;
  float* kernel_scratch_;
  Arena& arena_;
  float* displaced_[3] = {};
  float* offset_ = nullptr;
};

float along_axis(std::size_t wanted, std::size_t axis, float sign) { return axis == wanted ? sign : 0.0F; }

void central(Probes& probes, const GradientColumns& out) {
  float* behind = probes.column();
  for (std::size_t k = 0; k < probes.dimension(); ++k) {
    probes.displaced_value([k](std::size_t, std::size_t axis) { return along_axis(k, axis, 1); }, out.gradient[k]);
    probes.displaced_value([k](std::size_t, std::size_t axis) { return along_axis(k, axis, -1); }, behind);
    for (std::size_t i = 0; i < probes.count(); ++i) out.gradient[k][i] -= behind[i];
  }
}

void forward(Probes& probes, const GradientColumns& out) {
  for (std::size_t k = 0; k < probes.dimension(); ++k) {
    probes.displaced_value([k](std::size_t, std::size_t axis) { return along_axis(k, axis, 1); }, out.gradient[k]);
    for (std::size_t i = 0; i < probes.count(); ++i) out.gradient[k][i] -= out.value[i];
  }
}

/// Values at the vertices of a regular simplex around the point: their sum weighted by the vertices is the gradient
/// up to a factor, because the vertices sum to zero.
void simplex(Probes& probes, const GradientColumns& out) {
  static constexpr float kVertices2[3][3] = {{1, 0, 0}, {-0.5F, 0.8660254F, 0}, {-0.5F, -0.8660254F, 0}};
  static constexpr float kThird = 0.57735027F;
  static constexpr float kVertices3[4][3] = {
      {kThird, kThird, kThird}, {kThird, -kThird, -kThird}, {-kThird, kThird, -kThird}, {-kThird, -kThird, kThird}};
  const auto* vertices = probes.dimension() == 2 ? kVertices2 : kVertices3;
  float* value = probes.column();
  for (std::size_t axis = 0; axis < probes.dimension(); ++axis) std::fill_n(out.gradient[axis], probes.count(), 0.0F);
  for (std::size_t vertex = 0; vertex <= probes.dimension(); ++vertex) {
    const float* v = vertices[vertex];
    probes.displaced_value([v](std::size_t, std::size_t axis) { return v[axis]; }, value);
    for (std::size_t axis = 0; axis < probes.dimension(); ++axis) {
      for (std::size_t i = 0; i < probes.count(); ++i) out.gradient[axis][i] += v[axis] * value[i];
    }
  }
}

/// The direction of greatest f on a small circle, by bisection of the best third; `verbatim` looks for the greatest
/// |f|, as the published code does, and gives the direction in which f itself grows.
void dichotomy(Probes& probes, const GradientColumns& out, bool verbatim) {
  constexpr float kThirdTurn = 2 * std::numbers::pi_v<float> / 3;
  float* angle[2] = {probes.column(), probes.column()};
  float* value[4] = {probes.column(), probes.column(), probes.column(), probes.column()};
  float* cosine = probes.column();
  float* sine = probes.column();
  const auto probe = [&](auto angle_of, float* to) {
    for (std::size_t i = 0; i < probes.count(); ++i) {
      const float a = angle_of(i);
      cosine[i] = std::cos(a);
      sine[i] = std::sin(a);
    }
    probes.displaced_value([&](std::size_t i, std::size_t axis) { return axis == 0 ? cosine[i] : sine[i]; }, to);
    if (!verbatim) return;
    for (std::size_t i = 0; i < probes.count(); ++i) to[i] = std::fabs(to[i]);
  };
  const auto probe_angle = [](int k) { return kThirdTurn / 2 + static_cast<float>(k) * kThirdTurn; };
  for (int k = 0; k < 3; ++k) probe([&](std::size_t) { return probe_angle(k); }, value[k]);
  for (std::size_t i = 0; i < probes.count(); ++i) {
    // Pairs (0, 1), (1, 2) and (2, 0); the last one passes the full turn.
    const float sums[3] = {value[0][i] + value[1][i], value[1][i] + value[2][i], value[2][i] + value[0][i]};
    const auto first = static_cast<int>(std::max_element(sums, sums + 3) - sums);
    const float ends[2] = {value[first][i], value[(first + 1) % 3][i]};
    angle[0][i] = probe_angle(first);
    angle[1][i] = probe_angle(first + 1);
    value[0][i] = ends[0];
    value[1][i] = ends[1];
  }
  for (int step = 0; step < kBisections; ++step) {
    probe([&](std::size_t i) { return 0.5F * (angle[0][i] + angle[1][i]); }, value[3]);
    for (std::size_t i = 0; i < probes.count(); ++i) {
      const int end = value[0][i] < value[1][i] ? 0 : 1;
      angle[end][i] = 0.5F * (angle[0][i] + angle[1][i]);
      value[end][i] = value[3][i];
    }
  }
  for (std::size_t i = 0; i < probes.count(); ++i) {
    const float a = 0.5F * (angle[0][i] + angle[1][i]);
    const float sign = verbatim && out.value[i] < 0 ? -1.0F : 1.0F;
    out.gradient[0][i] = sign * std::cos(a);
    out.gradient[1][i] = sign * std::sin(a);
  }
}

}  // namespace

std::uint32_t evaluations_of(Gradient strategy, int dimension) {
  const auto d = static_cast<std::uint32_t>(dimension);
  switch (strategy) {
    case Gradient::autodiff:
      return 1;
    case Gradient::central:
      return 2 * d;
    case Gradient::forward:
    case Gradient::simplex:
      return d + 1;
    case Gradient::dichotomy:
    case Gradient::dichotomy_verbatim:
      return 1 + 3 + kBisections;
  }
  return 0;
}

void evaluate_gradient(Gradient strategy, const Tape& tape, const Kernels& kernels, const GradientColumns& columns,
                       ProbeOffset offset, float* kernel_scratch, Arena& arena) {
  if (strategy == Gradient::autodiff) {
    kernels.gradient(tape, columns.points, columns.count, columns.value, columns.gradient, kernel_scratch);
    return;
  }
  Probes probes(tape, kernels, columns, kernel_scratch, arena);
  probes.value_at_points(columns.value);
  if (strategy == Gradient::dichotomy_verbatim) offset.relative = 0;
  probes.choose_offset(offset, columns.value);
  switch (strategy) {
    case Gradient::central:
      central(probes, columns);
      return probes.normalise();
    case Gradient::forward:
      forward(probes, columns);
      return probes.normalise();
    case Gradient::simplex:
      simplex(probes, columns);
      return probes.normalise();
    default:
      return dichotomy(probes, columns, strategy == Gradient::dichotomy_verbatim);
  }
}

}  // namespace thalweg
