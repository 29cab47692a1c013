// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/starts.h"

namespace thalweg {
namespace {

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
  if (index < 7) return kFirst[index];
  // The unit square folded onto the triangle keeps the points evenly spread.
  float u = radical_inverse(index - 6, 2);
  float v = radical_inverse(index - 6, 3);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return {1 - u - v, u, v};
}

}  // namespace thalweg
