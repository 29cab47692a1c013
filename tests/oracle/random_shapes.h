// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Random shapes drawn from the op table as it stands: a new op takes part as soon as it is declared. Sizes are of the
// order of 1, so that scenes fit in a box of a few units.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "random.h"
#include "thalweg/shape.h"

namespace thalweg::oracle {

/// A primitive of row `op_index` with random parameters; draws again while Shape::make refuses them.
[[nodiscard]] Shape random_primitive(Random& random, int op_index);
/// One of the primitives of that dimension.
[[nodiscard]] Shape random_primitive_of(Random& random, int dimension);
/// A CSG tree of at most `nodes` nodes, counting every operator and placement.
[[nodiscard]] Shape random_shape(Random& random, int dimension, int nodes);
/// An operator over given operands, or the operand itself when its row is a primitive.
[[nodiscard]] Shape random_operator(Random& random, int op_index, const Shape& a, const Shape& b);

/// Groups of four small primitives anywhere in a cube from 0 to 1000, every other group blended: a tape too long to be
/// asked as a whole.
[[nodiscard]] Shape scattered_parts(int dimension, int groups);

/// What a failing test prints: the seed and a scene file that reproduces the shape.
[[nodiscard]] std::string describe(const Shape& shape, std::uint64_t seed);

}  // namespace thalweg::oracle
