// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/pairs/stand_in.h"

#include <algorithm>

namespace thalweg {
namespace {

/// Points that are asked about together, a chunk of values: a stray one costs them the short tape.
constexpr std::size_t kBlock = kColumnPadding;

}  // namespace

bool StandIn::holds(const float* const* points, std::size_t count) const {
  if (tape == nullptr) return false;
  for (int axis = 0; axis < tape->dimension; ++axis) {
    const float* const column = points[axis];
    const float least = lo[axis], most = hi[axis];
    // Without a way out of the loop it is one of vectors.
    unsigned outside = 0;
    for (std::size_t i = 0; i < count; ++i) outside |= column[i] >= least && column[i] <= most ? 0U : 1U;
    if (outside != 0) return false;
  }
  return true;
}

bool StandIn::holds(const double* point) const {
  if (tape == nullptr) return false;
  for (int axis = 0; axis < tape->dimension; ++axis) {
    const bool inside = point[axis] >= static_cast<double>(lo[axis]) && point[axis] <= static_cast<double>(hi[axis]);
    if (!inside) return false;
  }
  return true;
}

void NearField::begin(const Kernels& kernels, const Tape& whole, const StandIn& near, Arena& arena) {
  kernels_ = &kernels;
  whole_ = &whole;
  near_ = &near;
  // Shortened tapes keep the numbers of their registers.
  scratch_ = arena.take<float>(scratch_floats(whole));
}

template <class Evaluate>
void NearField::by_blocks(const float* const* points, std::size_t count, const Evaluate& evaluate) const {
  if (near_->tape == nullptr) return evaluate(*whole_, points, 0, count);
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t size = std::min(kBlock, count - begin);
    const float* block[3] = {};
    for (int axis = 0; axis < whole_->dimension; ++axis) block[axis] = points[axis] + begin;
    evaluate(at(block, size), block, begin, size);
  }
}

void NearField::values(const float* const* points, std::size_t count, float* value) const {
  by_blocks(points, count, [&](const Tape& tape, const float* const* block, std::size_t begin, std::size_t size) {
    kernels_->value(tape, block, size, value + begin, scratch_);
  });
}

void NearField::gradients(const float* const* points, std::size_t count, float* value, float* const* gradient) const {
  by_blocks(points, count, [&](const Tape& tape, const float* const* block, std::size_t begin, std::size_t size) {
    float* own[3] = {};
    for (int axis = 0; axis < whole_->dimension; ++axis) own[axis] = gradient[axis] + begin;
    kernels_->gradient(tape, block, size, value + begin, own, scratch_);
  });
}

}  // namespace thalweg
