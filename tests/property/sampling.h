// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// How much the sampling tests sample, and the shapes they share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "random.h"
#include "thalweg/shape.h"

namespace thalweg::property {

/// THALWEG_FULL is set and not 0: the long run.
[[nodiscard]] bool full_run();
/// `quick`, or twenty times that in the long run: 5 000 triangles a scene become 100 000.
[[nodiscard]] std::size_t amount(std::size_t quick);

/// A shape with the seed that made it, for messages.
struct Drawn {
  std::uint64_t seed = 0;
  Shape shape;
};
/// Every primitive of the op table `each` times, then random trees of up to 40 nodes, half of them in 3D.
[[nodiscard]] std::vector<Drawn> drawn_primitives(std::uint64_t seed, std::size_t each);
[[nodiscard]] std::vector<Drawn> drawn_trees(std::uint64_t seed, std::size_t count);
/// Every operator of the op table over two random primitives, `each` times.
[[nodiscard]] std::vector<Drawn> drawn_operators(std::uint64_t seed, std::size_t each);

}  // namespace thalweg::property
