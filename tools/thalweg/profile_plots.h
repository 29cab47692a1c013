// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The plots of `thalweg profile`.
#pragma once

#include <string>
#include <vector>

#include "profile_descents.h"
#include "profile_strategies.h"

namespace thalweg::cli {

struct ProfileReport {
  std::vector<StrategyProfile> strategies;
  std::vector<OffsetSweep> sweeps;
  std::vector<DescentProfile> descents;
};

/// Draws into the folder and returns the pictures' paths.
std::vector<std::string> draw_profile(const ProfileReport& report, const std::string& folder, const std::string& scene);

}  // namespace thalweg::cli
