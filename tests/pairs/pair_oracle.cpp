// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "pair_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

namespace thalweg::oracle {
namespace {

double& axis_of(Vec& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
double axis_of(const Vec& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

int root(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) i = parent[static_cast<std::size_t>(i)];
  return i;
}

}  // namespace

Placement placement(const float* row, int dimension) {
  Placement p;
  p.offset = {row[0], row[1], dimension == 3 ? row[2] : 0};
  if (dimension == 2) {
    const double c = std::cos(static_cast<double>(row[2])), s = std::sin(static_cast<double>(row[2]));
    p.turn = {c, -s, 0, s, c, 0, 0, 0, 1};
    return p;
  }
  double w = row[3];
  Vec v{row[4], row[5], row[6]};
  const double norm = std::sqrt(w * w + dot(v, v));
  w /= norm;
  v = v * (1 / norm);
  // Column k is e_k turned: e + 2 w (v x e) + 2 v x (v x e).
  const auto cross = [](Vec a, Vec b) {
    return Vec{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  for (int k = 0; k < 3; ++k) {
    Vec e;
    axis_of(e, k) = 1;
    const Vec t = cross(v, e) * 2;
    const Vec turned = e + t * w + cross(v, t);
    for (int i = 0; i < 3; ++i) p.turn[static_cast<std::size_t>(3 * i + k)] = axis_of(turned, i);
  }
  return p;
}

double PairField::operator()(Vec p) const {
  const Vec from = p - at_.offset;
  const auto& m = at_.turn;
  const Vec in_b{m[0] * from.x + m[3] * from.y + m[6] * from.z, m[1] * from.x + m[4] * from.y + m[7] * from.z,
                 m[2] * from.x + m[5] * from.y + m[8] * from.z};
  return std::max(a_(p), b_(in_b));
}

PairGrid::PairGrid(const PairField& field, const Box& box, int count) : lo_(box.lo) {
  const int d = field.dimension();
  double longest = 0;
  for (int axis = 0; axis < d; ++axis) longest = std::max(longest, axis_of(box.hi, axis) - axis_of(box.lo, axis));
  step_ = longest / (count - 1);
  half_step_ = step_ * std::sqrt(static_cast<double>(d)) / 2;
  for (int axis = 0; axis < d; ++axis) {
    const double side = axis_of(box.hi, axis) - axis_of(box.lo, axis);
    count_[static_cast<std::size_t>(axis)] = static_cast<int>(std::ceil(side / step_ - 1e-9)) + 1;
  }
  least_ = std::numeric_limits<double>::infinity();
  for (int z = 0; z < count_[2]; ++z) {
    for (int y = 0; y < count_[1]; ++y) {
      for (int x = 0; x < count_[0]; ++x) {
        const Vec p = lo_ + Vec{x * step_, y * step_, z * step_};
        const double g = field(p);
        values_.push_back(g);
        if (g >= least_) continue;
        least_ = g;
        least_at_ = p;
      }
    }
  }
}

std::size_t PairGrid::index(const std::array<int, 3>& at) const {
  return (static_cast<std::size_t>(at[2]) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(at[1])) *
             static_cast<std::size_t>(count_[0]) +
         static_cast<std::size_t>(at[0]);
}

std::vector<int> PairGrid::components(double level) const {
  std::vector<int> parent(values_.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto join = [&](std::size_t i, std::size_t j) {
    const int a = root(parent, static_cast<int>(i)), b = root(parent, static_cast<int>(j));
    parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    parent[i] = parent[j] = std::min(a, b);
  };
  for (int z = 0; z < count_[2]; ++z) {
    for (int y = 0; y < count_[1]; ++y) {
      for (int x = 0; x < count_[0]; ++x) {
        const std::size_t here = index({x, y, z});
        if (values_[here] > level) continue;
        for (int k = 0; k < 13; ++k) {
          // The 13 neighbours that come before this point.
          const std::array<int, 3> to = {x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1};
          const bool inside = to[0] >= 0 && to[0] < count_[0] && to[1] >= 0 && to[1] < count_[1] && to[2] >= 0;
          if (inside && values_[index(to)] <= level) join(here, index(to));
        }
      }
    }
  }
  std::vector<int> labels(values_.size(), -1);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (values_[i] <= level) labels[i] = root(parent, static_cast<int>(i));
  }
  return labels;
}

std::vector<int> PairGrid::labels_near(const std::vector<int>& labels, Vec p) const {
  std::vector<int> met;
  for (int corner = 0; corner < 8; ++corner) {
    std::array<int, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const double along = step_ > 0 ? (axis_of(p, axis) - axis_of(lo_, axis)) / step_ : 0;
      const auto k = static_cast<std::size_t>(axis);
      at[k] = std::clamp(static_cast<int>(std::floor(along)) + (corner >> axis & 1), 0, count_[k] - 1);
    }
    const int label = labels[index(at)];
    if (label >= 0 && std::find(met.begin(), met.end(), label) == met.end()) met.push_back(label);
  }
  return met;
}

Verdict pair_verdict(const PairField& field, const Box& box, std::size_t cap) {
  struct Cell {
    double lower;
    Vec centre, half;
    bool operator<(const Cell& other) const { return lower > other.lower; }
  };
  std::priority_queue<Cell> open;
  double least = std::numeric_limits<double>::infinity();
  std::size_t spent = 0;
  const auto visit = [&](Vec centre, Vec half) {
    const double g = field(centre);
    ++spent;
    least = std::min(least, g);
    const double lower = g - length(half) * (1 + 1e-12);
    if (lower <= 1e-12) open.push({lower, centre, half});
  };
  visit((box.lo + box.hi) * 0.5, (box.hi - box.lo) * 0.5);
  while (!open.empty() && spent < cap) {
    if (least < -1e-12) return Verdict::overlapping;
    const Cell cell = open.top();
    open.pop();
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (axis_of(cell.half, axis) > axis_of(cell.half, longest)) longest = axis;
    }
    Vec half = cell.half;
    axis_of(half, longest) /= 2;
    for (const double side : {-1.0, 1.0}) {
      Vec centre = cell.centre;
      axis_of(centre, longest) += side * axis_of(half, longest);
      visit(centre, half);
    }
  }
  if (least < -1e-12) return Verdict::overlapping;
  return open.empty() ? Verdict::separated : Verdict::cannot_tell;
}

}  // namespace thalweg::oracle
