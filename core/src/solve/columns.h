// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Result columns one by one, and such columns of a worker's own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "solve/arena.h"
#include "thalweg/query.h"

namespace thalweg {

/// Calls `visit(width, columns.c...)` for every column c but those of contacts, with its numbers per row.
template <class Visit, class... Columns>
void for_each_column(int dimension, Visit&& visit, Columns&... columns) {
  const auto d = static_cast<std::size_t>(dimension);
  visit(std::size_t{1}, columns.status...);
  visit(std::size_t{1}, columns.value...);
  visit(std::size_t{1}, columns.lower...);
  visit(std::size_t{1}, columns.converged...);
  visit(d, columns.point...);
  visit(d, columns.normal...);
  visit(std::size_t{3}, columns.barycentric...);
  visit(std::size_t{1}, columns.claimed...);
  visit(std::size_t{1}, columns.starts...);
  visit(std::size_t{1}, columns.iterations...);
  visit(std::size_t{1}, columns.evaluations...);
  visit(std::size_t{1}, columns.ambiguous...);
  visit(2 * d, columns.one_sided...);
  visit(std::size_t{1}, columns.stop...);
}

/// Calls `visit(width, columns.c...)` for the columns that have K contacts a row, with the numbers of each contact.
template <class Visit, class... Columns>
void for_each_contact_column(int dimension, Visit&& visit, Columns&... columns) {
  const auto d = static_cast<std::size_t>(dimension);
  visit(std::size_t{1}, columns.value...);
  visit(d, columns.point...);
  visit(d, columns.normal...);
  visit(std::size_t{3}, columns.barycentric...);
}

/// A tile's own result columns, for rows that are answered in another order than the caller's.
class ResultBuffer {
 public:
  /// Room for `count` rows of every column that `wanted` has, with so many contacts a row.
  const CollideColumns& take(const CollideColumns& wanted, std::size_t count, int dimension, std::size_t contacts = 0) {
    arena_.reset();
    const auto take_rows = [&](std::size_t rows) {
      return [this, rows]<class T>(std::size_t width, T*& own, T* const& asked) {
        own = asked == nullptr ? nullptr : arena_.take<T>(rows * width);
      };
    };
    for_each_column(dimension, take_rows(count), columns_, wanted);
    columns_.contacts = {};
    if (contacts == 0) return columns_;
    for_each_contact_column(dimension, take_rows(count * contacts), columns_.contacts, wanted.contacts);
    take_rows(count)(1, columns_.contacts.found, wanted.contacts.found);
    // Which contacts a row has is asked when they are scattered.
    columns_.contacts.kept = arena_.take<std::uint32_t>(count);
    return columns_;
  }
  /// Asks for the memory of rows that will be written.
  static void prefetch(std::span<const std::uint32_t> order, const CollideColumns& to, int dimension) {
    for_each_column(
        dimension,
        [&]<class T>(std::size_t width, T* const& out) {
          if (out == nullptr) return;
          for (const std::uint32_t row : order) __builtin_prefetch(out + width * row, 1, 2);
        },
        to);
  }
  /// Row i goes to row order[i] of the caller's columns.
  void scatter(std::span<const std::uint32_t> order, const CollideColumns& to, int dimension) const {
    for_each_column(
        dimension,
        [&]<class T>(std::size_t width, T* const& own, T* const& out) {
          if (out == nullptr) return;
          if (width == 1) {
            for (std::size_t i = 0; i < order.size(); ++i) out[order[i]] = own[i];
          } else if (width == 2) {
            for (std::size_t i = 0; i < order.size(); ++i) std::copy_n(own + 2 * i, 2, out + 2 * std::size_t{order[i]});
          } else {
            for (std::size_t i = 0; i < order.size(); ++i) std::copy_n(own + width * i, width, out + width * order[i]);
          }
        },
        columns_, to);
  }
  /// The same of contacts; what is beyond a row's own stays as it is.
  void scatter_contacts(std::span<const std::uint32_t> order, const ContactColumns& to, int dimension,
                        std::size_t contacts) const {
    const ContactColumns& from = columns_.contacts;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::size_t row = order[i];
      if (to.found != nullptr) to.found[row] = from.found[i];
      if (to.kept != nullptr) to.kept[row] = from.kept[i];
      for_each_contact_column(
          dimension,
          [&](std::size_t width, const float* own, float* out) {
            if (out == nullptr) return;
            std::copy_n(own + i * contacts * width, from.kept[i] * width, out + row * contacts * width);
          },
          from, to);
    }
  }

 private:
  Arena arena_;
  CollideColumns columns_;
};

}  // namespace thalweg
