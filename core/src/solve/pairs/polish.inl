// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A short descent of g = max(f_a, f_b) from a good start. With fields and gradients at x, the proximal step of length t
// minimises max(f_a + g_a . s, f_b + g_b . s) + |s|^2 / (2 t), a quadratic programme in one weight:
//
//   s = -t (w g_a + (1 - w) g_b),   w = clamp(((f_a - f_b) / t - (g_a - g_b) . g_b) / |g_a - g_b|^2).
//
// It jumps onto the ridge f_a = f_b and runs along it at once. The right t is the valley's radius of curvature, which
// nobody knows: a ladder of them fills the lanes of one evaluation, and the best is taken. Included once per SIMD
// target.
#if defined(THALWEG_SOLVE_PAIRS_POLISH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_SOLVE_PAIRS_POLISH_INL
#undef THALWEG_SOLVE_PAIRS_POLISH_INL
#else
#define THALWEG_SOLVE_PAIRS_POLISH_INL
#endif

#include <cmath>

#include "solve/pairs/cells.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Step lengths tried at once; a chunk of gradients on no target is shorter than half of this.
inline constexpr size_t kRungs = 16;
inline constexpr float kRungRatio = 1.7F;
/// Steps of a descent that looks for a witness, and of one that looks for a region's deepest point.
inline constexpr uint32_t kWitnessSteps = 4;
inline constexpr uint32_t kDeepestSteps = 12;
/// Far distances tried at once.
inline constexpr size_t kFarRungs = 8;

/// Evaluates both fields of one query.
template <int D>
struct PairFields {
  NearField a, b;
  PairFrame<D> frame;

  void begin(const PairTile& tile, const PairProblem& problem, Arena& arena) {
    a.begin(*tile.kernels, *problem.a, tile.near[0], arena);
    b.begin(*tile.kernels, *problem.b, tile.near[1], arena);
  }
  void values(PairPoints& points, size_t count) const {
    a.values(points.a, count, points.value_a);
    b.values(points.b, count, points.value_b);
  }
  void gradients(PairPoints& points, size_t count) const {
    a.gradients(points.a, count, points.value_a, points.gradient_a);
    b.gradients(points.b, count, points.value_b, points.gradient_b);
  }
};

/// Where a descent stands: a point, both fields, and both gradients in A's frame.
template <int D>
struct PairState {
  float point[D];
  float a, b;
  float gradient_a[D], gradient_b[D];
  [[nodiscard]] float value() const { return std::max(a, b); }
};

template <int D>
class PairPolisher {
 public:
  void take(Arena& arena) { points_.take<D>(arena, padded(kRungs)); }

  /// Descends from `start` with steps up to `longest`, at most `iterations` times. Returns evaluations made.
  uint32_t descend(const PairFields<D>& fields, const float* start, float longest, uint32_t iterations,
                   PairState<D>& state) {
    for (size_t axis = 0; axis < D; ++axis) points_.a[axis][0] = start[axis];
    evaluate(fields, 1);
    state = state_at(fields.frame, 0);
    uint32_t evaluations = 1;
    float largest = longest;
    for (uint32_t k = 0; k < iterations; ++k) {
      take_steps(state, largest);
      evaluate(fields, kRungs);
      evaluations += kRungs;
      size_t best = 0;
      for (size_t i = 1; i < kRungs; ++i) {
        if (std::max(points_.value_a[i], points_.value_b[i]) < std::max(points_.value_a[best], points_.value_b[best])) {
          best = i;
        }
      }
      const PairState<D> next = state_at(fields.frame, best);
      const float gain = state.value() - next.value();
      if (!(gain > 0)) {
        // Every step was too long, or this is the bottom.
        if (k > 0) break;
        largest *= 0.001F;
        continue;
      }
      state = next;
      if (gain <= least_gain_) break;
    }
    return evaluations;
  }
  void stop_below(float gain) { least_gain_ = gain; }

  /// The far distance, of those that halve from `longest`, that costs a linear bound over a cell of reach r least.
  /// Writes that of each field and returns evaluations made.
  uint32_t choose_far(const PairFields<D>& fields, const PairState<D>& at, float longest, float reach, float* far_a,
                      float* far_b) {
    float length = longest;
    for (size_t i = 0; i < kFarRungs; ++i, length *= 0.5F) {
      for (size_t axis = 0; axis < D; ++axis) {
        points_.a[axis][i] = at.point[axis] + length * at.gradient_a[axis];
        points_.a[axis][kFarRungs + i] = at.point[axis] + length * at.gradient_b[axis];
      }
    }
    place_points(fields.frame, points_, 2 * kFarRungs);
    fields.values(points_, 2 * kFarRungs);
    *far_a = best_far(points_.value_a, at.a, longest, fields.frame.lipschitz_a, reach);
    *far_b = best_far(points_.value_b + kFarRungs, at.b, longest, fields.frame.lipschitz_b, reach);
    return kFarRungs;
  }

 private:
  static float best_far(const float* values, float value, float longest, float lipschitz, float reach) {
    float best = longest;
    float least = kNoBound;
    float length = longest;
    for (size_t i = 0; i < kFarRungs; ++i, length *= 0.5F) {
      const float loss = value + lipschitz * length - values[i] + lipschitz * reach * reach / (2 * length);
      if (!(loss < least)) continue;
      least = loss;
      best = length;
    }
    return best;
  }

  void evaluate(const PairFields<D>& fields, size_t count) {
    place_points(fields.frame, points_, count);
    fields.gradients(points_, count);
  }

  PairState<D> state_at(const PairFrame<D>& frame, size_t i) const {
    PairState<D> s;
    s.a = points_.value_a[i];
    s.b = points_.value_b[i];
    for (size_t row = 0; row < D; ++row) {
      s.point[row] = points_.a[row][i];
      s.gradient_a[row] = points_.gradient_a[row][i];
      float turned = 0;
      for (size_t column = 0; column < D; ++column)
        turned += frame.rotation[row][column] * points_.gradient_b[column][i];
      s.gradient_b[row] = turned;
    }
    return s;
  }

  void take_steps(const PairState<D>& s, float longest) {
    float square = 0;
    float along = 0;
    for (size_t axis = 0; axis < D; ++axis) {
      const float difference = s.gradient_a[axis] - s.gradient_b[axis];
      square += difference * difference;
      along += difference * s.gradient_b[axis];
    }
    float length = longest;
    for (size_t i = 0; i < kRungs; ++i, length /= kRungRatio) {
      float weight = s.a > s.b ? 1.0F : 0.0F;
      if (square > 1e-8F) weight = std::clamp(((s.a - s.b) / length - along) / square, 0.0F, 1.0F);
      for (size_t axis = 0; axis < D; ++axis) {
        const float slope = weight * s.gradient_a[axis] + (1 - weight) * s.gradient_b[axis];
        points_.a[axis][i] = s.point[axis] - length * slope;
      }
    }
  }

  PairPoints points_;
  float least_gain_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
