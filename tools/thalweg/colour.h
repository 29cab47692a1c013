// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Colours in linear light, made in OKLab so that equal steps look equal (B. Ottosson, "A perceptual color space for
// image processing", 2020).
#pragma once

#include <array>
#include <cstdint>

namespace thalweg::cli {

/// Linear red, green, blue of the sRGB primaries; 0 to 1.
struct Colour {
  float r = 0, g = 0, b = 0;

  friend Colour operator+(Colour x, Colour y) { return {x.r + y.r, x.g + y.g, x.b + y.b}; }
  friend Colour operator*(Colour x, float s) { return {x.r * s, x.g * s, x.b * s}; }
};

/// `a` at 0, `b` at 1.
[[nodiscard]] Colour mix(Colour a, Colour b, float share);

/// Lightness 0 to 1, chroma (0 is grey), hue in radians.
[[nodiscard]] Colour from_oklch(float lightness, float chroma, float hue);

/// 0xRRGGBB, gamma-encoded as in a style sheet.
[[nodiscard]] Colour from_hex(std::uint32_t rgb);

/// The near-black of lines and the white of what lies below them.
[[nodiscard]] Colour ink();
[[nodiscard]] Colour paper();

/// Gamma-encoded bytes for a file.
[[nodiscard]] std::array<std::uint8_t, 3> to_srgb8(Colour colour);

/// A straight ramp in OKLab between two colours, tabulated.
class Ramp {
 public:
  struct Stop {
    float lightness = 0, chroma = 0, hue = 0;
  };
  Ramp(Stop first, Stop last);
  [[nodiscard]] Colour operator()(float share) const;  ///< share is clamped to 0 to 1

 private:
  std::array<Colour, 256> colours_;
};

}  // namespace thalweg::cli
