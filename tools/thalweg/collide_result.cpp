// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Result columns of `collide`.
#include "collide_result.h"

#include <algorithm>

namespace thalweg::cli {

CollideResult::CollideResult(QueryKind kind, std::size_t count, int dimension, std::uint32_t contacts)
    : kind_(kind), count_(count), dimension_(static_cast<std::size_t>(dimension)), contacts_(contacts) {
  for (auto* bytes : {&status, &converged, &claimed, &ambiguous, &stop}) bytes->resize(count);
  for (auto* floats : {&value, &lower}) floats->resize(count);
  for (auto* vectors : {&point, &normal}) vectors->resize(count * dimension_);
  if (kind == QueryKind::triangles) barycentric.resize(count * 3);
  for (auto* numbers : {&starts, &iterations, &evaluations}) numbers->resize(count);
  if (contacts == 0) return;
  contact_found.resize(count);
  contact_offset.resize(count + 1);
  const std::size_t room = count * contacts_;
  contact_value.resize(room);
  for (auto* vectors : {&contact_point, &contact_normal}) vectors->resize(room * dimension_);
  contact_barycentric.resize(room * 3);
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
  columns.stop = stop.data();
  if (contacts_ == 0) return columns;
  columns.contacts.found = contact_found.data();
  columns.contacts.kept = contact_offset.data() + 1;
  columns.contacts.value = contact_value.data();
  columns.contacts.point = contact_point.data();
  columns.contacts.normal = contact_normal.data();
  columns.contacts.barycentric = contact_barycentric.data();
  return columns;
}

void CollideResult::flatten_contacts() {
  if (contacts_ == 0) return;
  std::size_t total = 0;
  for (std::size_t row = 0; row < count_; ++row) {
    const std::size_t kept = contact_offset[row + 1];
    const auto close = [&](std::vector<float>& column, std::size_t width) {
      const auto from = column.begin() + static_cast<std::ptrdiff_t>(row * contacts_ * width);
      std::copy_n(from, kept * width, column.begin() + static_cast<std::ptrdiff_t>(total * width));
    };
    close(contact_value, 1);
    close(contact_point, dimension_);
    close(contact_normal, dimension_);
    close(contact_barycentric, 3);
    total += kept;
    contact_offset[row + 1] = static_cast<std::uint32_t>(total);
  }
  contact_value.resize(total);
  for (auto* vectors : {&contact_point, &contact_normal}) vectors->resize(total * dimension_);
  contact_barycentric.resize(total * 3);
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
  list.push_back({"stop", Dtype::uint8, {count_}, stop.data()});
  if (contacts_ == 0) return list;
  const std::size_t total = contact_value.size();
  list.push_back({"contact_offset", Dtype::uint32, {count_ + 1}, contact_offset.data()});
  list.push_back({"contact_found", Dtype::uint32, {count_}, contact_found.data()});
  list.push_back({"contact_value", Dtype::float32, {total}, contact_value.data()});
  list.push_back({"contact_point", Dtype::float32, {total, dimension_}, contact_point.data()});
  list.push_back({"contact_normal", Dtype::float32, {total, dimension_}, contact_normal.data()});
  list.push_back({"contact_barycentric", Dtype::float32, {total, 3}, contact_barycentric.data()});
  return list;
}

}  // namespace thalweg::cli
