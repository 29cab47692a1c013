// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One batch of pairs with every column, and the poses that tests ask about.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "oracle/oracle.h"
#include "oracle/random_shapes.h"
#include "thalweg/batch.h"

namespace thalweg {

struct AskedPairs {
  static constexpr std::size_t kContacts = 8;

  AskedPairs(const Shape& first, const Shape& second, std::vector<float> rows, Goal goal,
             Method method = Method::certified, std::uint32_t starts = 0, const Execution& execution = {});

  [[nodiscard]] Status status_at(std::size_t row) const { return static_cast<Status>(status[row]); }
  [[nodiscard]] const float* pose_at(std::size_t row) const { return poses.data() + row * width; }
  [[nodiscard]] oracle::Vec point_at(std::size_t row) const { return vec(point.data() + row * d); }
  [[nodiscard]] std::size_t contacts_of(std::size_t row) const { return std::min<std::size_t>(found[row], kContacts); }
  [[nodiscard]] oracle::Vec contact_at(std::size_t row, std::size_t slot) const {
    return vec(contact_point.data() + (row * kContacts + slot) * d);
  }
  [[nodiscard]] bool same_bits(const AskedPairs& other) const;

  Tape a, b;
  std::size_t d, width, count;
  double tolerance, region, size;
  std::vector<float> poses;
  std::vector<std::uint8_t> status, converged, claimed, ambiguous;
  std::vector<float> value, lower, point, normal;
  std::vector<std::uint32_t> starts_run, iterations, evaluations, found;
  std::vector<float> contact_point, contact_normal, contact_value, contact_lower;

 private:
  [[nodiscard]] oracle::Vec vec(const float* at) const { return {at[0], at[1], d == 3 ? at[2] : 0}; }
};

/// Offsets uniform in [-0.5, 0.5]^3, rotations uniform.
[[nodiscard]] std::vector<float> torus_poses(std::size_t count);

/// Two random bounded shapes and a pose that brings their boxes together.
struct RandomPair {
  RandomPair(oracle::Random& random, int dimension, int nodes);
  Shape a, b;
  std::vector<float> pose;
  [[nodiscard]] std::string describe() const;
};

}  // namespace thalweg
