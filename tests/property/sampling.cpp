// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "sampling.h"

#include <cstdlib>
#include <string_view>

#include "random_shapes.h"
#include "thalweg/op_table.h"

namespace thalweg::property {

using oracle::Random;

bool full_run() {
  const char* value = std::getenv("THALWEG_FULL");
  return value != nullptr && *value != '\0' && std::string_view(value) != "0";
}

std::size_t amount(std::size_t quick) { return full_run() ? 20 * quick : quick; }

std::vector<Drawn> drawn_primitives(std::uint64_t seed, std::size_t each) {
  std::vector<Drawn> drawn;
  const auto table = op_table();
  for (std::size_t op = 0; op < table.size(); ++op) {
    if (table[op].kind != OpKind::primitive) continue;
    for (std::size_t i = 0; i < each; ++i) {
      Random random(++seed);
      drawn.push_back({seed, oracle::random_primitive(random, static_cast<int>(op))});
    }
  }
  return drawn;
}

std::vector<Drawn> drawn_trees(std::uint64_t seed, std::size_t count) {
  std::vector<Drawn> drawn;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(++seed);
    const int nodes = 2 + static_cast<int>(random.index(39));
    drawn.push_back({seed, oracle::random_shape(random, i % 2 == 0 ? 2 : 3, nodes)});
  }
  return drawn;
}

std::vector<Drawn> drawn_operators(std::uint64_t seed, std::size_t each) {
  std::vector<Drawn> drawn;
  const auto table = op_table();
  for (std::size_t op = 0; op < table.size(); ++op) {
    if (table[op].kind == OpKind::primitive || table[op].kind == OpKind::formula) continue;
    for (std::size_t i = 0; i < each; ++i) {
      Random random(++seed);
      const int dimension = table[op].dimension != 0 ? table[op].dimension : 2 + static_cast<int>(i % 2);
      const Shape a = oracle::random_primitive_of(random, dimension);
      const Shape b = oracle::random_primitive_of(random, dimension);
      drawn.push_back({seed, oracle::random_operator(random, static_cast<int>(op), a, b)});
    }
  }
  return drawn;
}

}  // namespace thalweg::property
