// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The local method of this project. Every evaluation gives a value and a gradient, and nothing of it is thrown away:
//
// 1. Within a basin, the next point is the least point of a bundle of tangents, max_i f_i + g_i . (x - x_i) (Kelley
//    1960). On a flat or convex part of f that is the minimum after two or three points, across kinks as well, where a
//    descent zigzags. Tangents that run above the best value at its own point (f is not convex there) are left out.
// 2. A basin is done when its model leaves nothing to gain. The next one begins where a lower value is least excluded:
//    f(x) >= f_i - L |x - x_i| (Piyavskii 1972) holds for certain, f_i + g_i . (x - x_i) for convex f, and their mean
//    is what is expected.
// 3. It stops when no place is expected to hold what is looked for: a negative value for a verdict, a lower one for the
//    deepest point.
#include <algorithm>

#include "solve/bundle.h"
#include "solve/descend.h"
#include "solve/descent.h"

namespace thalweg {
namespace {

constexpr std::size_t kMostSamples = 64;
/// Places where a basin may begin: the points of a lattice that divides each edge by this.
constexpr std::uint32_t kLattice = 8;
constexpr std::uint32_t kPlaces = (kLattice + 1) * (kLattice + 2) / 2;
/// Share of the tangent in what is expected of a place.
constexpr float kTangentShare = 0.55F;
/// How far around a place, in steps of the lattice, f must be proven positive.
constexpr float kAround = 0.7F;
/// A deepest point is looked for where it is expected to be lower by this share of the longest edge.
constexpr float kLeastGain = 0.04F;
/// Points closer than this share of the longest edge are the same.
constexpr float kSamePoint = 1e-2F;

struct Sample {
  float u, v;    ///< barycentric coordinates of the second and third corner
  float f;       ///< the value there
  float fu, fv;  ///< its slopes along them
};

class Accelerated {
 public:
  struct Memory {
    Sample samples[kMostSamples];
    std::uint32_t count;
    std::uint32_t basin;      ///< first sample of the basin
    std::uint32_t best;       ///< the lowest sample of all
    std::uint32_t learned;    ///< samples that the places know of
    float uu, uv, vv;         ///< squared lengths: |du e1 + dv e2|^2 = uu du^2 + 2 uv du dv + vv dv^2
    float proven[kPlaces];    ///< lower bound of f at each place, from all samples
    float expected[kPlaces];  ///< what is likely there
  };
  static constexpr bool kNeedsValue = true;
  static constexpr bool kKeepsBest = true;

  Accelerated(const Tape& tape, const SolveLimits& limits)
      // Where there is no constant a distance's is taken: nothing is proven from it here.
      : lipschitz_(std::isfinite(tape.facts.lipschitz) ? static_cast<float>(tape.facts.lipschitz) : 1.0F),
        tolerance_(static_cast<float>(limits.tolerance)),
        wants_verdict_(limits.goal == Goal::verdict) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i <= kLattice; ++i) {
      for (std::uint32_t j = 0; i + j <= kLattice; ++j) {
        places_u_[count] = static_cast<float>(i) / kLattice;
        places_v_[count++] = static_cast<float>(j) / kLattice;
      }
    }
  }

  [[nodiscard]] static Barycentric begin(const LaneView& lane, Memory& m) {
    m.count = m.basin = m.best = m.learned = 0;
    std::fill_n(m.proven, kPlaces, -std::numeric_limits<float>::infinity());
    std::fill_n(m.expected, kPlaces, -std::numeric_limits<float>::infinity());
    m.uu = m.uv = m.vv = 0;
    for (std::size_t axis = 0; axis < lane.dimension; ++axis) {
      const float e1 = lane.corners[lane.dimension + axis] - lane.corners[axis];
      const float e2 = lane.corners[2 * lane.dimension + axis] - lane.corners[axis];
      m.uu += e1 * e1;
      m.uv += e1 * e2;
      m.vv += e2 * e2;
    }
    return lane.at;
  }
  [[nodiscard]] static bool wants_gradient(std::uint32_t) { return true; }
  [[nodiscard]] static bool ends_iteration(std::uint32_t) { return true; }
  [[nodiscard]] static std::uint32_t extra_cost() { return 0; }

  Stop step(const LaneView& lane, std::uint32_t, Memory& m, Barycentric& next) const {
    if (wants_verdict_ && lane.value < -lane.slack) return Stop::witness;
    m.samples[m.count] = {lane.at.b, lane.at.c, lane.value, lane.slope_along(1), lane.slope_along(2)};
    if (lane.value < m.samples[m.best].f) m.best = m.count;
    if (++m.count == kMostSamples) return Stop::iterations;
    if (descend_in_basin(m, next) || enter_basin(m, next) || polish(m, next)) return Stop::none;
    return m.count == 1 ? Stop::excluded : Stop::stationary;
  }

 private:
  static float square_between(const Memory& m, float u, float v, const Sample& s) {
    const float du = u - s.u;
    const float dv = v - s.v;
    return m.uu * du * du + 2 * m.uv * du * dv + m.vv * dv * dv;
  }

  static bool is_new(const Memory& m, float u, float v) {
    const float near = kSamePoint * kSamePoint * std::max(m.uu, m.vv);
    for (std::uint32_t i = 0; i < m.count; ++i) {
      if (!(square_between(m, u, v, m.samples[i]) > near)) return false;
    }
    return true;
  }

  bool descend_in_basin(const Memory& m, Barycentric& next) const {
    const Sample* lowest = &m.samples[m.basin];
    for (std::uint32_t i = m.basin + 1; i < m.count; ++i) {
      if (m.samples[i].f < lowest->f) lowest = &m.samples[i];
    }
    return follow_model(
        m, *lowest, [&](const Sample& s) { return &s >= &m.samples[m.basin]; }, next);
  }

  /// Around the lowest sample of all, with what is known there from any basin.
  bool polish(const Memory& m, Barycentric& next) const {
    const Sample& lowest = m.samples[m.best];
    const float near = 4 * std::max(m.uu, m.vv) / (kLattice * kLattice);
    return follow_model(
        m, lowest, [&](const Sample& s) { return square_between(m, s.u, s.v, lowest) < near; }, next);
  }

  /// The least point of the model that the chosen samples make, if it is low enough and new.
  template <class Choose>
  bool follow_model(const Memory& m, const Sample& lowest, Choose choose, Barycentric& next) const {
    Cut cuts[kMostCuts];
    std::size_t count = 0;
    const auto add = [&](const Sample& s) { cuts[count++] = {s.f - (s.fu * s.u + s.fv * s.v), s.fu, s.fv}; };
    add(lowest);
    for (std::uint32_t i = m.count; i-- > 0 && count < kMostCuts;) {
      const Sample& s = m.samples[i];
      if (&s == &lowest || !choose(s)) continue;
      add(s);
      if (cuts[count - 1].at(lowest.u, lowest.v) > lowest.f) --count;
    }
    const ModelPoint least = least_of_greatest(cuts, count);
    const float goal = wants_verdict_ ? 0 : lowest.f - tolerance_;
    if (!(least.value < goal) || !is_new(m, least.u, least.v)) return false;
    next = {std::max(0.0F, 1 - least.u - least.v), least.u, least.v};
    return true;
  }

  /// What a sample says of every place: f is at least f_i less the most that it can fall on the way, and likely the
  /// mean of that and the tangent.
  void learn(Memory& m, const Sample& s) const {
    for (std::uint32_t i = 0; i < kPlaces; ++i) {
      const float du = places_u_[i] - s.u;
      const float dv = places_v_[i] - s.v;
      const float away = std::sqrt(std::max(0.0F, m.uu * du * du + 2 * m.uv * du * dv + m.vv * dv * dv));
      const float tangent = s.fu * du + s.fv * dv;
      const float least = s.f - lipschitz_ * away;
      m.proven[i] = std::max(m.proven[i], least);
      m.expected[i] = std::max(m.expected[i], least + kTangentShare * (tangent + lipschitz_ * away));
    }
  }

  /// As long as nothing negative is known, a place counts when f is not proven positive around it; then only when
  /// something lower is likely there.
  bool enter_basin(Memory& m, Barycentric& next) const {
    while (m.learned < m.count) learn(m, m.samples[m.learned++]);
    const float longest = std::sqrt(std::max(m.uu, m.vv));
    const bool sign_is_open = m.samples[m.best].f > 0;
    const float around = kAround * lipschitz_ * longest / kLattice;
    const float gain = std::max(tolerance_, kLeastGain * lipschitz_ * longest);
    const bool found = (sign_is_open && choose_place(m, m.proven, around, next)) ||
                       (!wants_verdict_ && choose_place(m, m.expected, m.samples[m.best].f - gain, next));
    m.basin = m.count;
    return found;
  }

  bool choose_place(const Memory& m, const float* bound, float below, Barycentric& next) const {
    bool found = false;
    for (std::uint32_t i = 0; i < kPlaces; ++i) {
      if (!(bound[i] < below) || !is_new(m, places_u_[i], places_v_[i])) continue;
      below = bound[i];
      next = {1 - places_u_[i] - places_v_[i], places_u_[i], places_v_[i]};
      found = true;
    }
    return found;
  }

  float lipschitz_;
  float tolerance_;
  bool wants_verdict_;
  float places_u_[kPlaces];
  float places_v_[kPlaces];
};

}  // namespace

void descend_accelerated(const TriangleTile& tile, TileScratch& scratch) { Descent<Accelerated>(tile, scratch).run(); }

}  // namespace thalweg
