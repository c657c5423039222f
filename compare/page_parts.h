// What pages that stand alone are made of: the report's palettes, pictures inside the page, a file replaced
// in one step.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace arealab {

using Rgb = std::array<std::uint8_t, 3>;

// The report's palettes (signedColor and magnitudeColor of report.js) at eighths of their range.
constexpr std::array<Rgb, 17> kSigned{{{169, 234, 255},
                                       {105, 207, 246},
                                       {77, 176, 221},
                                       {55, 146, 194},
                                       {41, 116, 164},
                                       {31, 87, 132},
                                       {24, 61, 98},
                                       {18, 37, 62},
                                       {15, 15, 15},
                                       {56, 28, 7},
                                       {88, 48, 7},
                                       {118, 71, 12},
                                       {147, 97, 27},
                                       {175, 125, 48},
                                       {201, 156, 74},
                                       {225, 187, 106},
                                       {248, 220, 142}}};
constexpr std::array<Rgb, 9> kMagnitude{{{9, 3, 33},
                                         {49, 2, 73},
                                         {99, 0, 93},
                                         {155, 0, 94},
                                         {207, 32, 75},
                                         {241, 88, 41},
                                         {255, 147, 40},
                                         {255, 201, 106},
                                         {255, 248, 189}}};

// t in [0, 1] along the palette.
template <std::size_t kCount>
Rgb Color(const std::array<Rgb, kCount>& palette, double t) {
  const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(kCount - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), kCount - 2);
  const double part = place - static_cast<double>(below);
  Rgb color;
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] = static_cast<std::uint8_t>(
        std::lround((1.0 - part) * palette[below][c] + part * palette[below + 1][c]));
  }
  return color;
}

// The bytes of a PNG file; row 0 is the top.
std::string PngBytes(const std::vector<Rgb>& pixels, int width);

// The figure of a picture, as PNG inside the page.
std::string FigureHtml(const std::vector<Rgb>& pixels, int width, const std::string& caption);

// Text that stands in HTML.
std::string Escaped(const std::string& text);

}  // namespace arealab
