// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/starts.h"

#include <limits>

namespace thalweg {
namespace {

constexpr std::uint32_t kCorners = 1;  ///< first of them in the sequence
constexpr std::uint32_t kMidEdges = 4;
constexpr std::uint32_t kHalton = 7;

float radical_inverse(std::uint32_t index, std::uint32_t base) {
  double result = 0;
  double digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) result += digit * (index % base);
  return static_cast<float>(result);
}

}  // namespace

Barycentric start_point(std::uint32_t index) {
  constexpr float kThird = 1.0F / 3.0F;
  constexpr Barycentric kFirst[] = {{kThird, kThird, kThird}, {1, 0, 0},       {0, 1, 0},      {0, 0, 1},
                                    {0.5F, 0.5F, 0},          {0, 0.5F, 0.5F}, {0.5F, 0, 0.5F}};
  if (index < kHalton) return kFirst[index];
  // The unit square folded onto the triangle keeps the points evenly spread.
  float u = radical_inverse(index - kHalton + 1, 2);
  float v = radical_inverse(index - kHalton + 1, 3);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return {1 - u - v, u, v};
}

Barycentric start_point(Start policy, std::uint32_t index) {
  switch (policy) {
    case Start::vertices:
      return start_point(kCorners + index);
    case Start::mid_edges:
      return start_point(kMidEdges + index);
    case Start::halton:
      return start_point(kHalton + index);
    default:
      return start_point(index);
  }
}

std::uint32_t usual_starts(Start policy) {
  switch (policy) {
    case Start::vertices:
    case Start::mid_edges:
      return 3;
    case Start::halton:
    case Start::sequence:
      return 8;
    default:
      return 1;
  }
}

std::uint32_t most_starts(Start policy) {
  const bool is_list = policy == Start::halton || policy == Start::sequence;
  return is_list ? std::numeric_limits<std::uint32_t>::max() : usual_starts(policy);
}

}  // namespace thalweg
