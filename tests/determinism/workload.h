// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Batches whose every result bit is hashed. Inputs come from a seeded generator and plain arithmetic, so they are the
// same everywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "thalweg/batch.h"

namespace thalweg::determinism {

/// FNV-1a over bytes, 64 bits.
class Hash {
 public:
  void add(const void* bytes, std::size_t count);
  template <class T>
  void add(const std::vector<T>& column) {
    add(column.data(), column.size() * sizeof(T));
  }
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325U;
};

/// One query kind on one scene.
class Workload {
 public:
  /// One of the names of golden.h.
  explicit Workload(std::string_view name);

  /// Runs it and hashes every column; the columns are filled with a pattern first, so an unwritten entry shows.
  [[nodiscard]] std::uint64_t run(const Execution& execution) const;
  [[nodiscard]] const Tape& tape() const { return tape_; }

 private:
  enum class Kind { triangles, circles, points, grid, pairs, distances, sweeps };

  [[nodiscard]] std::uint64_t run_queries(const Execution& execution) const;
  [[nodiscard]] std::uint64_t run_points(const Execution& execution) const;
  [[nodiscard]] std::uint64_t run_grid(const Execution& execution) const;
  [[nodiscard]] std::uint64_t run_pairs(const Execution& execution) const;
  [[nodiscard]] std::uint64_t run_distances(const Execution& execution) const;
  [[nodiscard]] std::uint64_t run_sweeps(const Execution& execution) const;
  [[nodiscard]] PairQueries pair_queries(const Tape* const* shapes) const;

  Kind kind_ = Kind::triangles;
  Tape tape_;
  Tape second_;  ///< pairs and distances
  CollideOptions options_;
  Gradient gradient_ = Gradient::autodiff;
  std::vector<float> rows_;
  std::vector<float> moves_;  ///< sweeps: ends of triangles or motions of the scene
  bool moves_scene_ = false;
  bool has_circles_ = false;
  std::size_t count_ = 0;
};

}  // namespace thalweg::determinism
