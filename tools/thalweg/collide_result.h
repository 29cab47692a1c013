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
  CollideResult(QueryKind kind, std::size_t count, int dimension);

  [[nodiscard]] CollideColumns columns();          ///< for the batch
  [[nodiscard]] std::vector<Column> list() const;  ///< for the file

  void want_one_sided() { one_sided.resize(2 * count_ * dimension_); }

  std::vector<std::uint8_t> status, converged, claimed, ambiguous;
  std::vector<float> value, lower, point, normal, barycentric, one_sided;
  std::vector<std::uint32_t> starts, iterations, evaluations;

 private:
  QueryKind kind_;
  std::size_t count_;
  std::size_t dimension_;
};

}  // namespace thalweg::cli
