// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Numerals of five by seven dots: enough for a scale, and no font to look for on a machine that may have none.
#include "legend.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "measures.h"

namespace thalweg::cli {

namespace {

constexpr std::size_t kDotsWide = 5, kDotsHigh = 7;
constexpr std::size_t kStripWidth = 12, kPadding = 6;

struct Glyph {
  char letter;
  std::array<std::uint8_t, kDotsHigh> rows;  ///< five bits each, the first dot in the highest
};
constexpr Glyph kGlyphs[] = {
    {'-', {0x00, 0x00, 0x00, 0x0e, 0x00, 0x00, 0x00}}, {'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}},
    {'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}}, {'2', {0x0e, 0x11, 0x01, 0x06, 0x08, 0x10, 0x1f}},
    {'3', {0x0e, 0x11, 0x01, 0x06, 0x01, 0x11, 0x0e}}, {'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}},
    {'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}}, {'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}},
    {'7', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}}, {'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}},
    {'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}}, {'a', {0x00, 0x00, 0x0e, 0x01, 0x0f, 0x11, 0x0f}},
    {'d', {0x01, 0x01, 0x0d, 0x13, 0x11, 0x13, 0x0d}}, {'e', {0x00, 0x00, 0x0e, 0x11, 0x1f, 0x10, 0x0e}},
    {'p', {0x00, 0x00, 0x1e, 0x11, 0x1e, 0x10, 0x10}}, {'r', {0x00, 0x00, 0x16, 0x19, 0x10, 0x10, 0x10}},
    {'s', {0x00, 0x00, 0x0f, 0x10, 0x0e, 0x01, 0x1e}}, {'t', {0x08, 0x08, 0x1e, 0x08, 0x08, 0x09, 0x06}}};

struct Corner {
  std::size_t column, row;
};

void draw_text(Canvas& canvas, Corner at, const std::string& text, std::size_t scale) {
  for (const char letter : text) {
    for (const Glyph& glyph : kGlyphs) {
      if (glyph.letter != letter) continue;
      for (std::size_t y = 0; y < kDotsHigh * scale; ++y) {
        for (std::size_t x = 0; x < kDotsWide * scale; ++x) {
          const bool dot = (glyph.rows[y / scale] >> (kDotsWide - 1 - x / scale) & 1) != 0;
          if (dot) canvas.at(at.column + x, at.row + y) = ink();
        }
      }
    }
    at.column += (kDotsWide + 1) * scale;
  }
}

std::size_t text_width(const std::string& text, std::size_t scale) { return text.size() * (kDotsWide + 1) * scale; }

}  // namespace

void draw_legend(Canvas& canvas, const Legend& legend) {
  const std::size_t scale = canvas.height() >= 720 ? 2 : 1;
  std::size_t words = text_width(legend.unit, scale);
  for (const Legend::Tick& tick : legend.ticks) words = std::max(words, text_width(tick.text, scale));
  const std::size_t line = (kDotsHigh + 4) * scale;
  const std::size_t strip = 2 * line * legend.ticks.size();
  const std::size_t width = 3 * kPadding + kStripWidth * scale + words;
  const std::size_t height = 2 * kPadding + strip + 2 * line;
  if (canvas.width() < width + kPadding || canvas.height() < height + kPadding) return;
  const Corner corner{canvas.width() - width - kPadding, canvas.height() - height - kPadding};
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      Colour& pixel = canvas.at(corner.column + x, corner.row + y);
      pixel = mix(pixel, paper(), 0.88F);
    }
  }
  const Corner words_at{corner.column + 2 * kPadding + kStripWidth * scale, corner.row + kPadding};
  draw_text(canvas, words_at, legend.unit, scale);
  const std::size_t top = corner.row + kPadding + line + line / 2;
  const Ramp ramp = measure_ramp();
  for (std::size_t y = 0; y < strip; ++y) {
    const Colour colour = ramp(1 - static_cast<float>(y) / static_cast<float>(strip - 1));
    for (std::size_t x = 0; x < kStripWidth * scale; ++x) canvas.at(corner.column + kPadding + x, top + y) = colour;
  }
  for (const Legend::Tick& tick : legend.ticks) {
    const auto y = static_cast<std::size_t>((1 - tick.share) * static_cast<float>(strip - 1));
    for (std::size_t x = 0; x < 4 * scale; ++x) {
      canvas.at(corner.column + kPadding + kStripWidth * scale - x, top + y) = ink();
    }
    draw_text(canvas, {words_at.column, top + y - kDotsHigh * scale / 2}, tick.text, scale);
  }
}

}  // namespace thalweg::cli
