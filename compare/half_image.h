// Radiance rounded to half floats, as the report stores it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "glsl/pixels.h"

namespace arealab {

// Radiance rounded to half floats times a power of two: value = half × 2^exponent. The exponent is 0 where
// halves hold the image well (its largest value between 1/16 and 65504); else it brings the largest value to
// [16384, 32768), so that neither 1e6 cd/m² nor 1e-6 W/(m² sr) is lost.
struct HalfImage {
  int width = 0, height = 0;
  int exponent = 0;
  std::array<std::vector<std::uint16_t>, 6>
      planes;  // half bits: diffuse R G B, specular R G B; row 0 is the top

  bool IsGray(int lobe) const;  // R = G = B, bit for bit; lobe 0 diffuse, 1 specular
  bool IsFinite() const;
  float Value(int plane, std::size_t i) const;
};

HalfImage ToHalf(const RadianceImage& image);

// For files that are to stay small: values below `coarse_below` (in the images' unit) are kept to the step
// that halves have there, not to a finer one; and each value is rounded by its difference from the truth, of
// which `truth` is exact and `stored` as it was stored, so that a − b on a page is right to half a step and
// an exact technique differs nowhere. Hence |stored − exact| is at most one step beyond the truth's own. Values
// more than two powers of two away from the truth's are rounded by themselves.
HalfImage ToHalf(const RadianceImage& image, float coarse_below);
HalfImage ToHalf(const RadianceImage& image, float coarse_below, const RadianceImage& truth,
                 const HalfImage& stored);
RadianceImage FromHalf(const HalfImage& image);

// Keeps every value to a multiple of 2^bits units in its last place (of ten bits), bits from 0 to 9: a relative
// step of at most 2^(bits − 10). NaN and infinity stay what they are.
void DropBits(HalfImage& image, int bits);

}  // namespace arealab
