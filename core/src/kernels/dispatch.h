// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Picks a target's entry from a table that Highway's HWY_EXPORT made, without touching Highway's global choice.
#pragma once

#include <hwy/targets.h>

#include <cstdint>

#define THALWEG_ENTRY_OF(TABLE, target) (HWY_DISPATCH_TABLE(TABLE)[::thalweg::table_index(target)])

namespace thalweg {

inline std::size_t table_index(std::int64_t target) {
  hwy::ChosenTarget chosen;
  chosen.Update(target);
  return chosen.GetIndex();
}

}  // namespace thalweg
