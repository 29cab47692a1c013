// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What `thalweg profile` asks of a scene: points with the gradient in double precision as the reference, sorted by
// how near a kink of the field is and by the distance from the surface; and triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "thalweg/tape.h"

namespace thalweg::cli {

/// Bounds of |f| in diagonals of the scene; the last band has no end.
inline constexpr std::array<double, 5> kBandStarts = {0, 1e-4, 1e-3, 1e-2, 1e-1};
inline constexpr std::array<std::string_view, 5> kBandNames = {"below 1e-4", "1e-4 to 1e-3", "1e-3 to 1e-2",
                                                               "1e-2 to 1e-1", "1e-1 and more"};

struct ProfileSample {
  std::size_t dimension = 2;
  double diagonal = 1;                  ///< of the scene's bounds
  std::vector<float> points;            ///< (N,d)
  std::vector<double> reference;        ///< (N,d): grad f in double, as long as it is
  std::vector<std::uint8_t> near_kink;  ///< (N): the gradient turns by 5 degrees within 1e-3 diagonals
  std::vector<std::uint8_t> band;       ///< (N): of |f|, as in kBandStarts

  [[nodiscard]] std::size_t count() const { return band.size(); }
  /// The first `most` points.
  [[nodiscard]] ProfileSample head(std::size_t most) const;
};

/// Half of the points uniform over the bounds grown by half a diagonal, half of them at distances from the surface
/// that are even on a logarithmic scale from 1e-6 diagonals up. The bounds must be finite.
[[nodiscard]] ProfileSample make_profile_sample(const Tape& tape, std::size_t count, std::uint64_t seed);

/// Triangles (N,3,d) centred uniformly over the bounds grown by an eighth; corners lie off it by up to 1/36 of the
/// diagonal along each axis, as in the thesis' scene.
[[nodiscard]] std::vector<float> profile_triangles(const Tape& tape, std::size_t count, std::uint64_t seed);

/// The angle between two vectors in radians; NaN where one of them is zero or not a number.
[[nodiscard]] double angle_between(const float* a, const double* b, std::size_t dimension);

}  // namespace thalweg::cli
