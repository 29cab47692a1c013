// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The scale of a picture of numbers, in its lower right corner: a strip of the ramp with ticks and numerals.
#pragma once

#include <string>
#include <vector>

#include "canvas.h"

namespace thalweg::cli {

struct Legend {
  struct Tick {
    float share;  ///< of the scale
    std::string text;
  };
  std::vector<Tick> ticks;
  std::string unit;
};

/// Leaves a picture alone that is too small for it.
void draw_legend(Canvas& canvas, const Legend& legend);

}  // namespace thalweg::cli
