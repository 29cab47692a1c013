// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Facts of a node from its op's declaration and its operands' facts.
#pragma once

#include "ops/declaration.h"
#include "thalweg/shape.h"

namespace thalweg::shape {

[[nodiscard]] Facts derive_facts(const Shape& shape);
[[nodiscard]] Bounds level_bounds(const Shape& shape, double level);

/// A box around the image of `box` under a similarity.
[[nodiscard]] Bounds image(const Bounds& box, const ops::Similarity& by, int dimension);

}  // namespace thalweg::shape
