// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The list of targets. Highway says what this machine supports and what was compiled in.
#include "thalweg/simd.h"

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <deque>
#include <string>
#include <vector>

#include "kernels/entries.h"

namespace thalweg {
namespace {

struct TargetList {
  std::deque<Kernels> kernels;
  std::vector<Target> targets;
};

bool fuses_multiply_add(std::int64_t target) { return (target & (HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL | HWY_NEON)) != 0; }

TargetList make_targets() {
  TargetList list;
  // Better targets have lower bits.
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) {
    const std::int64_t target = left & -left;
    list.kernels.push_back({.value = value_entry(target),
                            .gradient = gradient_entry(target),
                            .strategy = strategy_entry(target),
                            .rows = rows_entry(target),
                            .enclosure = enclosure_entry(target),
                            .regions = regions_entry(target),
                            .pieces = most_pieces_of(target),
                            .ranges = ranges_entry(target),
                            .finish = finish_entry(target),
                            .certify_triangles = certify_triangles_entry(target),
                            .certify_circles = certify_circles_entry(target),
                            .certify_pairs = certify_pairs_entry(target),
                            .certify_distances = certify_distances_entry(target),
                            .sweep_triangles = sweep_triangles_entry(target),
                            .sweep_balls = sweep_balls_entry(target)});
    list.targets.push_back({.name = hwy::TargetName(target),
                            .fused_multiply_add = fuses_multiply_add(target),
                            .kernels = &list.kernels.back()});
  }
  return list;
}

const TargetList& target_list() {
  static const TargetList list = make_targets();
  return list;
}

bool equal_in_any_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace

std::span<const Target> targets() { return target_list().targets; }

const Target* find_target(std::string_view name) {
  for (const Target& target : targets()) {
    if (equal_in_any_case(target.name, name)) return &target;
  }
  return nullptr;
}

const Target& default_target() {
  static const Target& chosen = [&]() -> const Target& {
    const char* forced = std::getenv("THALWEG_ISA");
    const Target* found = forced == nullptr ? nullptr : find_target(forced);
    return found == nullptr ? targets().front() : *found;
  }();
  return chosen;
}

}  // namespace thalweg
