// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A lane is one start. The arithmetic between evaluations is plain float32: the same bits on every target.
#include "solve/pairs/local.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gradient/strategies.h"
#include "solve/pairs/finish_pairs.h"
#include "solve/pairs/strategy_normals.h"

namespace thalweg {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The thesis leaves its learning factor open; a fixed part of the smaller box's diagonal crosses it in 64 steps.
constexpr double kThesisStep = 1.0 / 64;
/// Steps shorter than this part of the diagonal stop it.
constexpr double kThesisStop = 1e-5;

// MuJoCo's line search, whose step of 2 is halved before the first trial.
constexpr float kFirstStep = 1;
constexpr float kLastStep = 1e-4F;
constexpr float kArmijo = 0.1F;

double radical_inverse(std::uint32_t index, std::uint32_t base) {
  double digit = 1.0 / base, result = 0;
  for (; index > 0; index /= base, digit /= base) result += digit * (index % base);
  return result;
}

/// Columns of one query's lanes.
struct LocalLanes {
  float* at[3] = {};     ///< in A's frame
  float* trial[3] = {};  ///< points under evaluation, in A's frame
  float* in_b[3] = {};   ///< the same in B's
  float* gradient_a[3] = {};
  float* gradient_b[3] = {};
  float* value_a = nullptr;
  float* value_b = nullptr;
  float* objective = nullptr;
  float* slope[3] = {};           ///< gradient of the objective
  std::uint32_t* lane = nullptr;  ///< of each trial
  std::uint32_t* spent_a = nullptr;
  std::uint32_t* spent_b = nullptr;

  void take(Arena& arena, std::size_t room, int dimension) {
    for (int axis = 0; axis < dimension; ++axis) {
      for (float** column :
           {&at[axis], &trial[axis], &in_b[axis], &gradient_a[axis], &gradient_b[axis], &slope[axis]}) {
        *column = arena.take<float>(room);
      }
    }
    for (float** column : {&value_a, &value_b, &objective}) *column = arena.take<float>(room);
    for (std::uint32_t** column : {&lane, &spent_a, &spent_b}) *column = arena.take<std::uint32_t>(room);
  }
};

class LocalSearch {
 public:
  LocalSearch(const PairTile& tile, PairScratch& scratch) : tile_(tile), scratch_(scratch) {}

  void run(std::size_t row) {
    const int dimension = tile_.queries->shapes[shapes_of(*tile_.queries, row).first]->dimension;
    if (!prepare(*tile_.queries, *tile_.options, row, problem_)) return write_bad_row(tile_, row, dimension);
    row_ = row;
    d_ = dimension;
    begin();
    const bool midsurface = problem_.limits.method == Method::midsurface;
    midsurface ? search_midsurface() : search_by_projection();
    finish();
  }

 private:
  void begin() {
    Arena& arena = scratch_.query;
    arena.reset();
    starts_ = problem_.limits.starts;
    lanes_.take(arena, padded(starts_), d_);
    active_ = arena.take<bool>(starts_);
    a_.begin(*tile_.kernels, *problem_.a, tile_.near[0], arena);
    b_.begin(*tile_.kernels, *problem_.b, tile_.near[1], arena);
    evaluations_ = iterations_ = 0;
    for (int i = 0; i < 9; ++i) rotation_[i] = static_cast<float>(problem_.pose.rotation[i]);
    for (int axis = 0; axis < 3; ++axis) translation_[axis] = static_cast<float>(problem_.pose.translation[axis]);
    for (std::uint32_t start = 0; start < starts_; ++start) {
      float point[3] = {};
      halton_start(problem_, start, point);
      for (int axis = 0; axis < d_; ++axis) lanes_.at[axis][start] = point[axis];
      active_[start] = true;
      if (tile_.paths.length != nullptr) tile_.paths.length[row_ * starts_ + start] = 0;
      keep_path(start);
    }
  }

  // --- evaluation
  // --------------------------------------------------------------------------------------------------------

  void place(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      float from[3] = {};
      for (int axis = 0; axis < d_; ++axis) from[axis] = lanes_.trial[axis][i] - translation_[axis];
      for (int column = 0; column < d_; ++column) {
        float sum = 0;
        for (int row = 0; row < d_; ++row) sum += rotation_[3 * row + column] * from[row];
        lanes_.in_b[column][i] = sum;
      }
    }
  }

  void values(std::size_t count) {
    place(count);
    a_.values(lanes_.trial, count, lanes_.value_a);
    b_.values(lanes_.in_b, count, lanes_.value_b);
    evaluations_ += static_cast<std::uint32_t>(count);
  }

  /// Fields and gradients of the lanes still active, in both cases in A's frame.
  std::size_t gradients_of_active() {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < starts_; ++i) {
      if (!active_[i]) continue;
      lanes_.lane[count] = i;
      for (int axis = 0; axis < d_; ++axis) lanes_.trial[axis][count] = lanes_.at[axis][i];
      ++count;
    }
    gradients(count);
    return count;
  }

  void by_strategy(const NearField& field, const GradientColumns& columns) const {
    std::fill_n(columns.evaluations, columns.count, 0);
    const Tape& tape = field.at(columns.points, columns.count);
    const GradientRule rule = rule_of(tape, strategy_of(*tile_.options), tile_.options->gradient_offset);
    evaluate_gradient(rule, tape, *tile_.kernels, columns, field.scratch());
  }

  void gradients(std::size_t count) {
    place(count);
    by_strategy(a_, {lanes_.trial, count, lanes_.value_a, lanes_.gradient_a, lanes_.spent_a});
    by_strategy(b_, {lanes_.in_b, count, lanes_.value_b, lanes_.gradient_b, lanes_.spent_b});
    for (std::size_t i = 0; i < count; ++i) evaluations_ += std::max(lanes_.spent_a[i], lanes_.spent_b[i]);
    for (std::size_t i = 0; i < count; ++i) {
      float turned[3] = {};
      for (int row = 0; row < d_; ++row) {
        for (int column = 0; column < d_; ++column) {
          turned[row] += rotation_[3 * row + column] * lanes_.gradient_b[column][i];
        }
      }
      for (int axis = 0; axis < d_; ++axis) lanes_.gradient_b[axis][i] = turned[axis];
    }
  }

  void keep_path(std::uint32_t start) {
    const PairPaths& paths = tile_.paths;
    if (paths.length == nullptr) return;
    std::uint32_t& length = paths.length[row_ * starts_ + start];
    if (length == paths.capacity) return;
    float* to = paths.points + ((row_ * starts_ + start) * paths.capacity + length) * static_cast<std::size_t>(d_);
    for (int axis = 0; axis < d_; ++axis) to[axis] = lanes_.at[axis][start];
    ++length;
  }

  // --- thesis
  // ------------------------------------------------------------------------------------------------------------

  /// P <- V(P - alpha grad f_b), V(P) = P where f_a <= 0, else P - f_a grad f_a; stops where both fields are negative
  /// or the step is short.
  void search_by_projection() {
    const auto alpha = static_cast<float>(kThesisStep * problem_.limits.size);
    const auto stop = static_cast<float>(kThesisStop * problem_.limits.size);
    project(gradients_of_active());
    for (std::uint32_t k = 0; k < problem_.limits.iterations; ++k) {
      const std::size_t count = gradients_of_active();
      if (count == 0) return;
      ++iterations_;
      std::size_t moving = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t lane = lanes_.lane[i];
        if (lanes_.value_a[i] < 0 && lanes_.value_b[i] < 0) {
          active_[lane] = false;
          continue;
        }
        for (int axis = 0; axis < d_; ++axis) {
          lanes_.slope[axis][lane] = lanes_.at[axis][lane];
          lanes_.at[axis][lane] -= alpha * lanes_.gradient_b[axis][i];
        }
        ++moving;
      }
      if (moving == 0) return;
      project(gradients_of_active());
      for (std::uint32_t lane = 0; lane < starts_; ++lane) {
        if (!active_[lane]) continue;
        keep_path(lane);
        float square = 0;
        for (int axis = 0; axis < d_; ++axis) {
          const float moved = lanes_.at[axis][lane] - lanes_.slope[axis][lane];
          square += moved * moved;
        }
        if (square < stop * stop) active_[lane] = false;
      }
    }
  }

  /// V of the lanes just evaluated.
  void project(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (lanes_.value_a[i] <= 0) continue;
      const std::uint32_t lane = lanes_.lane[i];
      for (int axis = 0; axis < d_; ++axis) {
        lanes_.at[axis][lane] -= lanes_.value_a[i] * lanes_.gradient_a[axis][i];
      }
    }
  }

  // --- midsurface
  // --------------------------------------------------------------------------------------------------------

  /// f_a + f_b + |max(f_a, f_b)|, or max(f_a, f_b) in the last step.
  static float objective(float a, float b, bool last) {
    const float greater = std::max(a, b);
    return last ? greater : a + b + std::fabs(greater);
  }

  void search_midsurface() {
    for (std::uint32_t k = 0; k < problem_.limits.iterations; ++k) {
      if (!line_search(false)) break;
      ++iterations_;
    }
    std::fill_n(active_, starts_, true);
    line_search(true);
  }

  /// One step of every active lane down the objective's gradient, halved until Armijo's rule holds; a lane that cannot
  /// go down stops. False when none was active.
  bool line_search(bool last) {
    const std::size_t count = gradients_of_active();
    for (std::size_t i = 0; i < count; ++i) set_slope(i, last);
    std::size_t pending = count;
    for (float step = kFirstStep; pending > 0 && step >= kLastStep; step *= 0.5F) {
      for (std::size_t i = 0; i < pending; ++i) {
        const std::uint32_t lane = lanes_.lane[i];
        for (int axis = 0; axis < d_; ++axis) {
          lanes_.trial[axis][i] = lanes_.at[axis][lane] - step * lanes_.slope[axis][lane];
        }
      }
      values(pending);
      pending = take_trials(pending, step, last);
    }
    for (std::size_t i = 0; i < pending; ++i) active_[lanes_.lane[i]] = false;
    return count > 0;
  }

  void set_slope(std::size_t i, bool last) {
    const std::uint32_t lane = lanes_.lane[i];
    const float a = lanes_.value_a[i], b = lanes_.value_b[i];
    lanes_.objective[lane] = objective(a, b, last);
    const float sign = std::max(a, b) < 0 ? -1.0F : 1.0F;
    for (int axis = 0; axis < d_; ++axis) {
      const float of_a = lanes_.gradient_a[axis][i], of_b = lanes_.gradient_b[axis][i];
      const float of_greater = a > b ? of_a : of_b;
      lanes_.slope[axis][lane] = last ? of_greater : of_a + of_b + sign * of_greater;
    }
  }

  /// Lanes whose trial goes down enough move; returns how many are left, packed at the front.
  std::size_t take_trials(std::size_t pending, float step, bool last) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < pending; ++i) {
      const std::uint32_t lane = lanes_.lane[i];
      float square = 0;
      for (int axis = 0; axis < d_; ++axis) square += lanes_.slope[axis][lane] * lanes_.slope[axis][lane];
      const float reached = objective(lanes_.value_a[i], lanes_.value_b[i], last);
      if (reached - lanes_.objective[lane] > -kArmijo * step * square || square == 0) {
        lanes_.lane[left++] = lane;
        continue;
      }
      for (int axis = 0; axis < d_; ++axis) lanes_.at[axis][lane] = lanes_.trial[axis][i];
      keep_path(lane);
    }
    return left;
  }

  // --- results
  // -----------------------------------------------------------------------------------------------------------

  /// What each start ended at: those with g <= 0, deepest first, without those near a deeper one, are contacts.
  void finish() {
    for (std::uint32_t i = 0; i < starts_; ++i) {
      for (int axis = 0; axis < d_; ++axis) lanes_.trial[axis][i] = lanes_.at[axis][i];
    }
    gradients(starts_);
    auto* order = scratch_.query.take<std::uint32_t>(starts_);
    const auto value = [this](std::uint32_t i) { return std::max(lanes_.value_a[i], lanes_.value_b[i]); };
    for (std::uint32_t i = 0; i < starts_; ++i) order[i] = i;
    std::sort(order, order + starts_,
              [&](std::uint32_t i, std::uint32_t j) { return value(i) != value(j) ? value(i) < value(j) : i < j; });
    const PairContact best = contact_at(order[0], value(order[0]));
    const double slack = slack_of_points();
    PairRow row{.status = status_of(best.found, slack, -1, false),
                .claimed = best.found.value <= 0,
                .starts = starts_,
                .iterations = iterations_,
                .evaluations = evaluations_};
    write_row(tile_, row_, best.found, row);
    write_normal(tile_, row_, best.normal, best.ambiguous, d_);
    if (tile_.contacts.found != nullptr) write_contacts(order);
  }

  [[nodiscard]] double slack_of_points() const {
    double largest = 0;
    for (int axis = 0; axis < d_; ++axis) {
      for (std::uint32_t i = 0; i < starts_; ++i) {
        largest = std::max(largest, std::fabs(static_cast<double>(lanes_.at[axis][i])));
      }
    }
    return problem_.slack(largest);
  }

  [[nodiscard]] PairContact contact_at(std::uint32_t i, float value) const {
    PairContact contact;
    contact.found.value = value;
    contact.found.lower = -kInfinity;
    contact.found.witness = static_cast<double>(value) < -slack_of_points();
    contact.found.converged = problem_.limits.goal == Goal::verdict && contact.found.witness;
    float of_a[3] = {}, of_b[3] = {};
    for (int axis = 0; axis < d_; ++axis) {
      contact.found.point[axis] = lanes_.at[axis][i];
      of_a[axis] = lanes_.gradient_a[axis][i];
      of_b[axis] = lanes_.gradient_b[axis][i];
    }
    contact.ambiguous = pair_normal(of_a, of_b, d_, contact.normal);
    return contact;
  }

  void write_contacts(const std::uint32_t* order) {
    auto* kept = scratch_.query.take<std::uint32_t>(starts_);
    std::uint32_t found = 0;
    const auto near = static_cast<float>(problem_.limits.region);
    for (std::uint32_t k = 0; k < starts_; ++k) {
      const std::uint32_t i = order[k];
      const float value = std::max(lanes_.value_a[i], lanes_.value_b[i]);
      if (!(value <= 0)) break;
      const bool apart = std::all_of(kept, kept + found, [&](std::uint32_t j) {
        float square = 0;
        for (int axis = 0; axis < d_; ++axis) {
          const float x = lanes_.at[axis][i] - lanes_.at[axis][j];
          square += x * x;
        }
        return square > near * near;
      });
      if (!apart) continue;
      if (found < tile_.contacts.capacity) write_contact(tile_, row_, found, contact_at(i, value), d_);
      kept[found++] = i;
    }
    tile_.contacts.found[row_] = found;
  }

  const PairTile& tile_;
  PairScratch& scratch_;
  PairProblem problem_;
  LocalLanes lanes_;
  int d_ = 2;
  std::size_t row_ = 0;
  std::uint32_t starts_ = 1;
  bool* active_ = nullptr;
  NearField a_, b_;
  float rotation_[9] = {};
  float translation_[3] = {};
  std::uint32_t evaluations_ = 0, iterations_ = 0;
};

}  // namespace

void halton_start(const PairProblem& problem, std::uint32_t index, float* point) {
  constexpr std::uint32_t kBases[] = {2, 3, 5};
  for (int axis = 0; axis < problem.dimension; ++axis) {
    const double along = index == 0 ? 0.5 : radical_inverse(index, kBases[axis]);
    const double lo = std::min(problem.lo[axis], problem.hi[axis]);
    const double hi = std::max(problem.lo[axis], problem.hi[axis]);
    const double at = lo + along * (hi - lo);
    point[axis] = static_cast<float>(std::isfinite(at) ? at : 0.0);
  }
}

void search_locally(const PairTile& tile, PairScratch& scratch) {
  LocalSearch search(tile, scratch);
  for (std::size_t i = 0; i < tile.count; ++i) search.run(tile.row(i));
}

void solve(const PairTile& tile, PairScratch& scratch) {
  if (tile.options->method != Method::certified) return search_locally(tile, scratch);
  tile.kernels->certify_pairs(tile, scratch);
  const bool wants_normals = tile.columns.normal != nullptr || tile.contacts.normal != nullptr;
  if (wants_normals && strategy_of(*tile.options) != Gradient::autodiff) renew_normals(tile, scratch);
}

}  // namespace thalweg
