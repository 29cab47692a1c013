// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The methods of Macklin et al. (2020), which move barycentric coordinates: projected gradient descent as PhysX ships
// it, Frank-Wolfe with its fixed steps and with a line search, and golden section along the edges.
#include <algorithm>

#include "solve/descend.h"
#include "solve/descent.h"

namespace thalweg {
namespace {

constexpr float kGolden = 0.61803399F;
/// Evaluations of one line search.
constexpr std::uint32_t kSearch = 16;

Barycentric between(const Barycentric& p, const Barycentric& q, float t) {
  return {p.a + t * (q.a - p.a), p.b + t * (q.b - p.b), p.c + t * (q.c - p.c)};
}

Barycentric corner(std::size_t index) {
  return {index == 0 ? 1.0F : 0.0F, index == 1 ? 1.0F : 0.0F, index == 2 ? 1.0F : 0.0F};
}

/// The corner with the least g . (v - x); of equal ones the first. `gap` is how far f can fall, if it is convex.
Barycentric lowest_corner(const LaneView& lane, float& gap) {
  std::size_t lowest = 0;
  float least = lane.slope_to(0);
  for (std::size_t k = 1; k < 3; ++k) {
    const float slope = lane.slope_to(k);
    if (!(slope < least)) continue;
    least = slope;
    lowest = k;
  }
  gap = -least;
  return corner(lowest);
}

class Projected {
 public:
  struct Memory {
    float step;
  };
  static constexpr bool kNeedsValue = false;
  static constexpr bool kKeepsBest = false;

  Projected(const Tape&, const SolveLimits& limits) : stop_(static_cast<float>(limits.stop)) {}

  /// The first step is 1 / (2 max |corner - point|).
  [[nodiscard]] static Barycentric begin(const LaneView& lane, Memory& memory) {
    float most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      float square = 0;
      for (std::size_t axis = 0; axis < lane.dimension; ++axis) {
        const float x = lane.corners[k * lane.dimension + axis] - lane.point[axis];
        square += x * x;
      }
      most = std::max(most, square);
    }
    memory.step = most > 0 ? 0.5F / std::sqrt(most) : 0;
    return lane.at;
  }
  [[nodiscard]] static bool wants_gradient(std::uint32_t) { return true; }
  [[nodiscard]] static bool ends_iteration(std::uint32_t) { return true; }
  [[nodiscard]] static std::uint32_t extra_cost() { return 0; }

  /// Projected gradient in barycentric coordinates; the step shrinks by 0.8 each time.
  Stop step(const LaneView& lane, std::uint32_t, Memory& memory, Barycentric& next) const {
    const float step = memory.step;
    memory.step *= 0.8F;
    next = project_on_simplex(lane.at.a - step * lane.slope_to(0), lane.at.b - step * lane.slope_to(1),
                              lane.at.c - step * lane.slope_to(2));
    return distance(lane.at, next) < stop_ ? Stop::small_step : Stop::none;
  }

 private:
  float stop_;
};

class FrankWolfe {
 public:
  struct Memory {};
  static constexpr bool kNeedsValue = false;
  static constexpr bool kKeepsBest = false;

  FrankWolfe(const Tape&, const SolveLimits& limits) : stop_(static_cast<float>(limits.stop)) {}

  [[nodiscard]] static Barycentric begin(const LaneView& lane, Memory&) { return lane.at; }
  [[nodiscard]] static bool wants_gradient(std::uint32_t) { return true; }
  [[nodiscard]] static bool ends_iteration(std::uint32_t) { return true; }
  [[nodiscard]] static std::uint32_t extra_cost() { return 0; }

  Stop step(const LaneView& lane, std::uint32_t pass, Memory&, Barycentric& next) const {
    float gap = 0;
    const Barycentric v = lowest_corner(lane, gap);
    if (!(gap > 0)) return Stop::stationary;
    next = between(lane.at, v, 2.0F / static_cast<float>(pass + 2));
    return distance(lane.at, next) < stop_ ? Stop::small_step : Stop::none;
  }

 private:
  float stop_;
};

/// Golden section over [lo, hi], one evaluation at a time; keeps two inner points.
struct Section {
  float lo, hi;
  float at[2];     ///< inner points, in order
  float value[2];  ///< f there; what is not known yet is asked for by `wanted`
  int wanted;

  void begin() {
    lo = 0;
    hi = 1;
    at[0] = 1 - kGolden;
    at[1] = kGolden;
    wanted = 0;
  }
  /// Takes f at at[wanted] and chooses the next point; `known` says whether both values are.
  void take(float f, bool known) {
    value[wanted] = f;
    if (!known) {
      wanted = 1;
      return;
    }
    if (value[0] < value[1]) {
      hi = at[1];
      at[1] = at[0];
      value[1] = value[0];
      at[0] = hi - kGolden * (hi - lo);
      wanted = 0;
    } else {
      lo = at[0];
      at[0] = at[1];
      value[0] = value[1];
      at[1] = lo + kGolden * (hi - lo);
      wanted = 1;
    }
  }
};

class FrankWolfeSearch {
 public:
  struct Memory {
    Barycentric from, to, best;
    float best_value;
    Section section;
  };
  static constexpr bool kNeedsValue = true;
  static constexpr bool kKeepsBest = false;

  FrankWolfeSearch(const Tape&, const SolveLimits& limits) : stop_(static_cast<float>(limits.stop)) {}

  [[nodiscard]] static Barycentric begin(const LaneView& lane, Memory&) { return lane.at; }
  [[nodiscard]] static bool wants_gradient(std::uint32_t pass) { return pass % (kSearch + 1) == 0; }
  [[nodiscard]] static bool ends_iteration(std::uint32_t pass) { return pass % (kSearch + 1) == kSearch; }
  [[nodiscard]] static std::uint32_t extra_cost() { return 0; }

  Stop step(const LaneView& lane, std::uint32_t pass, Memory& m, Barycentric& next) const {
    if (wants_gradient(pass)) {
      float gap = 0;
      m.from = m.best = lane.at;
      m.best_value = lane.value;
      m.to = lowest_corner(lane, gap);
      if (!(gap > 0)) return Stop::stationary;
      m.section.begin();
      next = between(m.from, m.to, m.section.at[0]);
      return Stop::none;
    }
    if (lane.value < m.best_value) {
      m.best_value = lane.value;
      m.best = lane.at;
    }
    m.section.take(lane.value, pass % (kSearch + 1) > 1);
    if (!ends_iteration(pass)) {
      next = between(m.from, m.to, m.section.at[m.section.wanted]);
      return Stop::none;
    }
    next = m.best;
    return distance(m.from, m.best) < stop_ ? Stop::small_step : Stop::none;
  }

 private:
  float stop_;
};

/// A lane searches the edge that its start is the middle of.
class GoldenSection {
 public:
  struct Memory {
    Barycentric from, to;
    Section section;
  };
  static constexpr bool kNeedsValue = false;
  static constexpr bool kKeepsBest = true;

  GoldenSection(const Tape&, const SolveLimits&) {}

  [[nodiscard]] static Barycentric begin(const LaneView& lane, Memory& m) {
    const std::size_t opposite = lane.at.a == 0 ? 0 : lane.at.b == 0 ? 1 : 2;
    m.from = corner((opposite + 1) % 3);
    m.to = corner((opposite + 2) % 3);
    m.section.begin();
    return between(m.from, m.to, m.section.at[0]);
  }
  [[nodiscard]] static bool wants_gradient(std::uint32_t) { return false; }
  [[nodiscard]] static bool ends_iteration(std::uint32_t) { return true; }
  [[nodiscard]] static std::uint32_t extra_cost() { return 0; }

  Stop step(const LaneView& lane, std::uint32_t pass, Memory& m, Barycentric& next) const {
    m.section.take(lane.value, pass > 0);
    next = between(m.from, m.to, m.section.at[m.section.wanted]);
    return Stop::none;
  }
};

}  // namespace

void descend_projected(const TriangleTile& tile, TileScratch& scratch) { Descent<Projected>(tile, scratch).run(); }
void descend_frank_wolfe(const TriangleTile& tile, TileScratch& scratch) { Descent<FrankWolfe>(tile, scratch).run(); }
void descend_frank_wolfe_search(const TriangleTile& tile, TileScratch& scratch) {
  Descent<FrankWolfeSearch>(tile, scratch).run();
}
void descend_golden_section(const TriangleTile& tile, TileScratch& scratch) {
  Descent<GoldenSection>(tile, scratch).run();
}

}  // namespace thalweg
