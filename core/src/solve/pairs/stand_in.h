// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Shapes of many parts: near the rows of a tile a shortened tape stands in for a shape's own. A search may go further;
// so every evaluation asks where its points are, and no result depends on which tape gave it.
#pragma once

#include <cstddef>

#include "kernels/kernels.h"
#include "kernels/twin.h"
#include "solve/arena.h"

namespace thalweg {

/// A tape that has the bits of the shape's own all over a box of the shape's frame; none by default.
struct StandIn {
  const Tape* tape = nullptr;
  float lo[3] = {}, hi[3] = {};

  /// Whether all points lie in the box; columns, and a single one.
  [[nodiscard]] bool holds(const float* const* points, std::size_t count) const;
  [[nodiscard]] bool holds(const double* point) const;
};

/// A shape evaluated in float32.
class NearField {
 public:
  void begin(const Kernels& kernels, const Tape& whole, const StandIn& near, Arena& arena);

  [[nodiscard]] const Facts& facts() const { return whole_->facts; }
  /// The shortest tape that holds at all these points, and scratch for it.
  [[nodiscard]] const Tape& at(const float* const* points, std::size_t count) const {
    return near_->holds(points, count) ? *near_->tape : *whole_;
  }
  [[nodiscard]] float* scratch() const { return scratch_; }

  void values(const float* const* points, std::size_t count, float* value) const;
  void gradients(const float* const* points, std::size_t count, float* value, float* const* gradient) const;

 private:
  template <class Evaluate>
  void by_blocks(const float* const* points, std::size_t count, const Evaluate& evaluate) const;

  const Kernels* kernels_ = nullptr;
  const Tape* whole_ = nullptr;
  const StandIn* near_ = nullptr;
  float* scratch_ = nullptr;
};

/// A shape evaluated in double.
class NearTwin {
 public:
  NearTwin() = default;
  /// `near` of the tape that stands in, if there is one.
  NearTwin(Twin& whole, Twin& near, const StandIn& box) : whole_(&whole), near_(&near), box_(&box) {
    if (box.tape != nullptr) near.use(*box.tape);
  }

  [[nodiscard]] double value(const double* point) { return at(point).value(point); }
  double gradient(const double* point, double* gradient) { return at(point).gradient(point, gradient); }

 private:
  [[nodiscard]] Twin& at(const double* point) const { return box_->holds(point) ? *near_ : *whole_; }

  Twin* whole_ = nullptr;
  Twin* near_ = nullptr;
  const StandIn* box_ = nullptr;
};

/// Both shapes of a pair.
struct PairTwins {
  NearTwin of[2];
  NearTwin& operator[](int which) { return of[which]; }
};

}  // namespace thalweg
