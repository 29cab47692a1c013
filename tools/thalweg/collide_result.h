// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The result columns of `collide`: owned here, lent to the batch, listed for the result file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "array.h"
#include "thalweg/query.h"

namespace thalweg::cli {

enum class QueryKind : std::uint8_t { triangles, circles };

class CollideResult {
 public:
  /// With room for `contacts` contacts a row.
  CollideResult(QueryKind kind, std::size_t count, int dimension, std::uint32_t contacts = 0);

  [[nodiscard]] CollideColumns columns();  ///< for the batch
  /// After the batch: closes the gaps between the rows' contacts.
  void flatten_contacts();
  [[nodiscard]] std::vector<Column> list() const;  ///< for the file

  void want_one_sided() { one_sided.resize(2 * count_ * dimension_); }

  std::vector<std::uint8_t> status, converged, claimed, ambiguous, stop;
  std::vector<float> value, lower, point, normal, barycentric, one_sided;
  std::vector<std::uint32_t> starts, iterations, evaluations;
  std::vector<std::uint32_t> contact_found, contact_offset;  ///< offset: (N+1), row i has [offset[i], offset[i + 1])
  std::vector<float> contact_value, contact_point, contact_normal, contact_barycentric;

 private:
  QueryKind kind_;
  std::size_t count_;
  std::size_t dimension_;
  std::size_t contacts_;  ///< room for each row; 0: none are asked for
};

}  // namespace thalweg::cli
