// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "pair_input.h"

#include <fmt/format.h>

#include "failure.h"
#include "input.h"
#include "queries.h"

namespace thalweg::cli {

PairInput::PairInput(const std::string& scene, const std::string& with, const std::string& poses_path) {
  const Scene first = read_scene(scene);
  const Scene second = read_scene(with);
  if (first.dimension != second.dimension) {
    refuse(input_name(with), "/dimension", fmt::format("{}, as in {}", first.dimension, scene),
           fmt::format("{}", second.dimension));
  }
  a = unwrap(compile(first.shape), input_name(scene), "/shape");
  b = unwrap(compile(second.shape), input_name(with), "/shape");
  poses = read_poses(poses_path, first.dimension);
}

PairQueries PairInput::queries() const {
  PairQueries queries;
  queries.shapes = shapes_.data();
  queries.shape_count = shapes_.size();
  queries.poses = poses.values.data();
  queries.count = poses.shape[0];
  return queries;
}

}  // namespace thalweg::cli
