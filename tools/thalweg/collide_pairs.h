// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// `thalweg collide SCENE --with SCENE2 --poses Q`: a second shape at many poses against the scene's.
#pragma once

#include <cstdint>
#include <string>

#include "command.h"
#include "thalweg/pairs.h"

namespace thalweg::cli {

struct PairRequest {
  std::string scene, with, poses, output;
  PairOptions options;
  bool wants_contacts = false;  ///< --contacts, or goal deepest
  std::uint64_t contacts = 16;  ///< K
  bool wants_paths = false;
};

ExitCode run_collide_pairs(const PairRequest& request, const Globals& globals);

}  // namespace thalweg::cli
