// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `collide --explain ROW`: the proof of one row's verdict as JSON, for thalweg_check_proof or any other checker.
#pragma once

#include "array.h"
#include "collide_result.h"
#include "report.h"
#include "thalweg/batch.h"

namespace thalweg::cli {

/// The proof of row `row` of `rows`; refuses rows that are not there and what the library refuses.
[[nodiscard]] Json explain_row(const Tape& tape, QueryKind kind, const Array& rows, std::size_t row,
                               const CollideOptions& options);

}  // namespace thalweg::cli
