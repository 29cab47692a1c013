// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// OKLab and sRGB.
#include "colour.h"

#include <algorithm>
#include <cmath>

namespace thalweg::cli {

namespace {

struct Lab {
  float lightness = 0, a = 0, b = 0;
};

float cube(float x) { return x * x * x; }

Colour from_oklab(Lab lab) {
  const float l = cube(lab.lightness + 0.3963377774F * lab.a + 0.2158037573F * lab.b);
  const float m = cube(lab.lightness - 0.1055613458F * lab.a - 0.0638541728F * lab.b);
  const float s = cube(lab.lightness - 0.0894841775F * lab.a - 1.2914855480F * lab.b);
  return {4.0767416621F * l - 3.3077115913F * m + 0.2309699292F * s,
          -1.2684380046F * l + 2.6097574011F * m - 0.3413193965F * s,
          -0.0041960863F * l - 0.7034186147F * m + 1.7076147010F * s};
}

Lab to_lab(float lightness, float chroma, float hue) {
  return {lightness, chroma * std::cos(hue), chroma * std::sin(hue)};
}

float decode_srgb(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

std::uint8_t encode_srgb(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  const float encoded = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

}  // namespace

Colour mix(Colour a, Colour b, float share) { return a * (1 - share) + b * share; }

Colour from_oklch(float lightness, float chroma, float hue) { return from_oklab(to_lab(lightness, chroma, hue)); }

Colour from_hex(std::uint32_t rgb) {
  const auto channel = [rgb](int shift) { return decode_srgb(static_cast<float>(rgb >> shift & 0xff) / 255); };
  return {channel(16), channel(8), channel(0)};
}

Colour ink() { return from_hex(0x10182b); }

Colour paper() { return {1, 1, 1}; }

std::array<std::uint8_t, 3> to_srgb8(Colour colour) {
  return {encode_srgb(colour.r), encode_srgb(colour.g), encode_srgb(colour.b)};
}

Ramp::Ramp(Stop first, Stop last) {
  const Lab a = to_lab(first.lightness, first.chroma, first.hue);
  const Lab b = to_lab(last.lightness, last.chroma, last.hue);
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(colours_.size() - 1);
    colours_[i] = from_oklab({std::lerp(a.lightness, b.lightness, t), std::lerp(a.a, b.a, t), std::lerp(a.b, b.b, t)});
  }
}

Colour Ramp::operator()(float share) const {
  const float at = std::clamp(share, 0.0F, 1.0F) * static_cast<float>(colours_.size() - 1);
  const auto index = std::min(static_cast<std::size_t>(at), colours_.size() - 2);
  return mix(colours_[index], colours_[index + 1], at - static_cast<float>(index));
}

}  // namespace thalweg::cli
