// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "solve/pairs/finish_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg {
namespace {

template <class T>
void put(T* column, std::size_t at, T value) {
  if (column != nullptr) column[at] = value;
}

void put_vector(float* column, std::size_t at, const float* vector, int dimension) {
  if (column == nullptr) return;
  std::copy_n(vector, dimension, column + at * static_cast<std::size_t>(dimension));
}

}  // namespace

bool pair_normal(const float* gradient_a, const float* gradient_b, int dimension, float* normal) {
  float square = 0;
  for (int axis = 0; axis < dimension; ++axis) {
    normal[axis] = gradient_a[axis] - gradient_b[axis];
    square += normal[axis] * normal[axis];
  }
  if (!(square > 1e-6F)) {
    for (int axis = 0; axis < dimension; ++axis) normal[axis] = axis + 1 == dimension ? 1.0F : 0.0F;
    return true;
  }
  const float length = std::sqrt(square);
  for (int axis = 0; axis < dimension; ++axis) normal[axis] /= length;
  return false;
}

void write_row(const PairTile& tile, std::size_t row, const PairFinding& found, const PairRow& of) {
  const CollideColumns& out = tile.columns;
  const int dimension = tile.queries->shapes[shapes_of(*tile.queries, row).first]->dimension;
  put(out.status, row, static_cast<std::uint8_t>(of.status));
  put(out.value, row, found.value);
  put(out.lower, row, std::min(found.lower, found.value));
  put(out.converged, row, static_cast<std::uint8_t>(found.converged ? 1 : 0));
  put_vector(out.point, row, found.point, dimension);
  put(out.claimed, row, static_cast<std::uint8_t>(of.claimed ? 1 : 0));
  put(out.starts, row, of.starts);
  put(out.iterations, row, of.iterations);
  put(out.evaluations, row, of.evaluations);
}

void write_normal(const PairTile& tile, std::size_t row, const float* normal, bool ambiguous, int dimension) {
  put_vector(tile.columns.normal, row, normal, dimension);
  put(tile.columns.ambiguous, row, static_cast<std::uint8_t>(ambiguous ? 1 : 0));
}

void write_bad_row(const PairTile& tile, std::size_t row, int dimension) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const float nowhere[3] = {kNan, kNan, kNan};
  PairFinding found;
  found.value = found.lower = kNan;
  std::copy_n(nowhere, 3, found.point);
  write_row(tile, row, found, {.status = Status::bad_row, .claimed = false, .starts = 0});
  write_normal(tile, row, nowhere, false, dimension);
  put(tile.contacts.found, row, std::uint32_t{0});
}

void write_contact(const PairTile& tile, std::size_t row, std::size_t slot, const PairContact& contact, int dimension) {
  const PairContacts& out = tile.contacts;
  const std::size_t at = row * out.capacity + slot;
  put_vector(out.point, at, contact.found.point, dimension);
  put(out.value, at, contact.found.value);
  put(out.lower, at, std::min(contact.found.lower, contact.found.value));
  put(out.converged, at, static_cast<std::uint8_t>(contact.found.converged ? 1 : 0));
  write_contact_normal(tile, at, contact.normal, contact.ambiguous, dimension);
}

void write_contact_normal(const PairTile& tile, std::size_t at, const float* normal, bool ambiguous, int dimension) {
  put_vector(tile.contacts.normal, at, normal, dimension);
  put(tile.contacts.ambiguous, at, static_cast<std::uint8_t>(ambiguous ? 1 : 0));
}

Status status_of(const PairFinding& found, double slack, double tolerance, bool separated) {
  if (found.witness) return Status::overlapping;
  if (separated) return Status::separated;
  const bool brackets =
      static_cast<double>(found.value) + slack <= tolerance && static_cast<double>(found.lower) >= -tolerance;
  return brackets ? Status::touching : Status::undecided;
}

}  // namespace thalweg
