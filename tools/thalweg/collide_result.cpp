// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Result columns of `collide`.
#include "collide_result.h"

namespace thalweg::cli {

CollideResult::CollideResult(QueryKind kind, std::size_t count, int dimension)
    : kind_(kind), count_(count), dimension_(static_cast<std::size_t>(dimension)) {
  for (auto* bytes : {&status, &converged, &claimed, &ambiguous}) bytes->resize(count);
  for (auto* floats : {&value, &lower}) floats->resize(count);
  for (auto* vectors : {&point, &normal}) vectors->resize(count * dimension_);
  if (kind == QueryKind::triangles) barycentric.resize(count * 3);
  for (auto* numbers : {&starts, &iterations, &evaluations}) numbers->resize(count);
}

CollideColumns CollideResult::columns() {
  CollideColumns columns;
  columns.status = status.data();
  columns.value = value.data();
  columns.lower = lower.data();
  columns.converged = converged.data();
  columns.point = point.data();
  columns.normal = normal.data();
  columns.barycentric = kind_ == QueryKind::triangles ? barycentric.data() : nullptr;
  columns.claimed = claimed.data();
  columns.starts = starts.data();
  columns.iterations = iterations.data();
  columns.evaluations = evaluations.data();
  columns.ambiguous = ambiguous.data();
  columns.one_sided = one_sided.empty() ? nullptr : one_sided.data();
  return columns;
}

std::vector<Column> CollideResult::list() const {
  std::vector<Column> list = {
      {"status", Dtype::uint8, {count_}, status.data()},
      {"value", Dtype::float32, {count_}, value.data()},
      {"lower", Dtype::float32, {count_}, lower.data()},
      {"converged", Dtype::uint8, {count_}, converged.data()},
      {"point", Dtype::float32, {count_, dimension_}, point.data()},
      {"normal", Dtype::float32, {count_, dimension_}, normal.data()},
  };
  if (kind_ == QueryKind::triangles) list.push_back({"barycentric", Dtype::float32, {count_, 3}, barycentric.data()});
  list.push_back({"claimed", Dtype::uint8, {count_}, claimed.data()});
  list.push_back({"starts", Dtype::uint32, {count_}, starts.data()});
  list.push_back({"iterations", Dtype::uint32, {count_}, iterations.data()});
  list.push_back({"evaluations", Dtype::uint32, {count_}, evaluations.data()});
  list.push_back({"ambiguous", Dtype::uint8, {count_}, ambiguous.data()});
  if (!one_sided.empty()) list.push_back({"one_sided", Dtype::float32, {count_, 2, dimension_}, one_sided.data()});
  return list;
}

}  // namespace thalweg::cli
