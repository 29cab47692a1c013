// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Many contacts of one triangle with the shape: the local minima of f over it that are at most `margin`.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solve/tile.h"

namespace thalweg {

struct Contact {
  float u, v;  ///< barycentric coordinates of the second and third corner
  float value;
  float point[3];
  float normal[3];  ///< unit
};

/// A lattice divides each edge by at most this.
inline constexpr std::uint32_t kMostDivisions = 24;
/// One contact for each point of the lattice is as many as can be told apart.
inline constexpr std::uint32_t kMostContacts = (kMostDivisions + 1) * (kMostDivisions + 2) / 2;

/// Fills in tile.columns.contacts, whatever method answered the tile, and adds to its evaluations.
void find_contacts(const TriangleTile& tile, TileScratch& scratch);

/// Sorts deepest first and drops every contact that is within `near` of a deeper one and faces the same way; returns
/// how many are left.
std::size_t merge_contacts(Contact* contacts, std::size_t count, float near, std::size_t dimension);

/// Keeps `most` of sorted contacts: the deepest, then time and again the one furthest from those kept (of equal ones
/// the deepest); they stay sorted. `distance` is scratch for `count` numbers. Returns how many are left.
std::size_t reduce_contacts(Contact* contacts, std::size_t count, std::size_t most, float* distance);

}  // namespace thalweg
