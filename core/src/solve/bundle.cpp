// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The least point of a piecewise linear convex function is a corner, a point of an edge where two pieces meet, or an
// inner point where three do. There are few, so all are tried.
#include "solve/bundle.h"

#include <cmath>
#include <limits>

namespace thalweg {
namespace {

class Search {
 public:
  Search(const Cut* cuts, std::size_t count) : cuts_(cuts), count_(count) {}

  void consider(float u, float v) {
    float greatest = cuts_[0].at(u, v);
    for (std::size_t i = 1; i < count_; ++i) greatest = std::fmax(greatest, cuts_[i].at(u, v));
    if (greatest < best_.value) best_ = {u, v, greatest};
  }

  /// Along p + t e, 0 < t < 1.
  void consider_edge(float u0, float v0, float du, float dv) {
    for (std::size_t i = 1; i < count_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const float rise = (cuts_[j].fu - cuts_[i].fu) * du + (cuts_[j].fv - cuts_[i].fv) * dv;
        const float t = (cuts_[i].at(u0, v0) - cuts_[j].at(u0, v0)) / rise;
        if (t > 0 && t < 1) consider(u0 + t * du, v0 + t * dv);
      }
    }
  }

  void consider_inside() {
    for (std::size_t i = 2; i < count_; ++i) {
      for (std::size_t j = 1; j < i; ++j) {
        for (std::size_t k = 0; k < j; ++k) consider_meeting(cuts_[i], cuts_[j], cuts_[k]);
      }
    }
  }

  [[nodiscard]] const ModelPoint& best() const { return best_; }

 private:
  void consider_meeting(const Cut& p, const Cut& q, const Cut& r) {
    const float a = p.fu - r.fu;
    const float b = p.fv - r.fv;
    const float c = q.fu - r.fu;
    const float d = q.fv - r.fv;
    const float e = r.f0 - p.f0;
    const float f = r.f0 - q.f0;
    const float determinant = a * d - b * c;
    const float u = (e * d - b * f) / determinant;
    const float v = (a * f - c * e) / determinant;
    // Not a number where the cuts are parallel: refused by the comparisons.
    if (u > 0 && v > 0 && u + v < 1) consider(u, v);
  }

  const Cut* cuts_;
  std::size_t count_;
  ModelPoint best_{0, 0, std::numeric_limits<float>::infinity()};
};

}  // namespace

ModelPoint least_of_greatest(const Cut* cuts, std::size_t count) {
  Search search(cuts, count);
  search.consider(0, 0);
  search.consider(1, 0);
  search.consider(0, 1);
  if (count > 1) {
    search.consider_edge(0, 0, 1, 0);
    search.consider_edge(0, 0, 0, 1);
    search.consider_edge(1, 0, -1, 1);
    search.consider_inside();
  }
  return search.best();
}

}  // namespace thalweg
