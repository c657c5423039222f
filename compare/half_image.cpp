#include "compare/half_image.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

namespace arealab {
namespace {

constexpr float kLargestFloat = std::numeric_limits<float>::max();
constexpr float kLargestHalf = 65504.0f;  // (2 − 2⁻¹⁰) · 2¹⁵
constexpr float kSmallestPeak =
    0.0625f;  // 10 stops above the smallest normal half, 2⁻¹⁴: full precision down to 1/1024 of it

// IEEE 754 binary16: sign, 5 bits of exponent biased by 15, 10 of fraction. Without branches: whole pictures pass here.
[[gnu::always_inline]] inline float HalfToFloat(std::uint16_t bits) {
  const std::uint32_t size = bits & 0x7fffu, sign = static_cast<std::uint32_t>(bits & 0x8000u) << 16;
  const std::uint32_t bias = size >= 0x7c00u ? 224u << 23 : 112u << 23;  // infinity stays itself
  const float denormal = static_cast<float>(static_cast<int>(size)) * 0x1p-24f;
  const std::uint32_t v = size < 0x400u ? std::bit_cast<std::uint32_t>(denormal) : (size << 13) + bias;
  return std::bit_cast<float>(v | sign);
}

}  // namespace

bool HalfImage::IsGray(int lobe) const {
  const std::size_t first = 3 * static_cast<std::size_t>(lobe);
  return planes[first] == planes[first + 1] && planes[first] == planes[first + 2];
}

bool HalfImage::IsFinite() const {
  constexpr unsigned kExponent = 0x7c00;  // all ones: infinite or no number
  return std::all_of(planes.begin(), planes.end(), [](const std::vector<std::uint16_t>& plane) {
    return std::all_of(plane.begin(), plane.end(), [](unsigned bits) { return (bits & kExponent) != kExponent; });
  });
}

float HalfImage::Value(int plane, std::size_t i) const {
  return std::ldexp(HalfToFloat(planes[static_cast<std::size_t>(plane)][i]), exponent);
}

namespace {

int ChooseExponent(const RadianceImage& image) {
  float largest = 0.0f;
  for (const auto* lobe : {&image.diffuse, &image.specular}) {
    for (const glm::vec3& v : *lobe) {
      for (int c = 0; c < 3; ++c) {
        if (std::isfinite(v[c])) largest = std::max(largest, std::abs(v[c]));
      }
    }
  }
  const bool fits = largest == 0.0f || (largest >= kSmallestPeak && largest <= kLargestHalf);
  return fits ? 0 : std::ilogb(largest) - 14;
}

// The distance between neighbouring halves at v: 2^(e − 10), e the exponent of v but not below −14.
float Step(float v) {
  const std::uint32_t exponent = (std::bit_cast<std::uint32_t>(v) >> 23) & 255;  // biased by 127
  return std::bit_cast<float>((std::max(exponent, 127u - 14u) - 10u) << 23);
}

// v to the nearest multiple of a power of two, for |v| < 2²² steps: the sum with 1.5 · 2²³ steps has no finer
// digits.
float ToMultiple(float v, float step) {
  const float shift = 12582912.0f * step;
  return (v + shift) - shift;
}

// To the nearest half, ties to even; beyond the largest infinity. A −0 would cost the coder a jump of 32768 for nothing.
[[gnu::always_inline]] inline std::uint16_t HalfBits(float v) {
  const std::uint32_t sign = std::bit_cast<std::uint32_t>(v) >> 16 & 0x8000u;
  const float size = std::abs(v);
  // Half's own step at 0 is that of floats at ½.
  const std::uint32_t denormal = std::bit_cast<std::uint32_t>(size + 0.5f) - 0x3f000000u;
  const std::uint32_t rounded = std::bit_cast<std::uint32_t>(ToMultiple(size, Step(size)));
  const std::uint32_t normal = std::min((rounded - (112u << 23)) >> 13, 0x7c00u);
  const std::uint32_t finite = size < 0x1p-14f ? denormal : normal;
  const std::uint32_t bits = size >= 65536.0f ? 0x7c00u : size == size ? finite : 0x7e00u;
  return static_cast<std::uint16_t>(bits == 0u ? 0u : bits | sign);
}

// `truth` and `stored` are both given or neither; all values are already divided by 2^exponent.
template <bool beside_truth>
[[gnu::always_inline]] inline std::uint16_t Round(float v, float coarsest, float truth, float stored) {
  float step = std::max(Step(v), coarsest), rounded = ToMultiple(v, step);
  if constexpr (beside_truth) {
    // Where the two lie within two powers of two the difference is what is kept; farther off it is the value itself.
    const float its_step = std::max(Step(truth), coarsest), larger = std::max(step, its_step);
    const bool near = its_step <= 4.0f * step && step <= 4.0f * its_step && std::abs(truth) <= kLargestFloat;
    rounded = near ? stored + ToMultiple(v - truth, larger) : rounded;
  }
  rounded = std::clamp(rounded, -kLargestHalf, kLargestHalf);
  return HalfBits(v == 0.0f || !(std::abs(v) <= kLargestFloat) ? v : rounded);
}

// Compiled for wider vectors too, twice as fast.
#if defined(__x86_64__) && !defined(__clang__)
#define AREALAB_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define AREALAB_CLONES
#endif
// One channel; `truth` and `stored` may be null.
AREALAB_CLONES void RoundPlane(std::uint16_t* bits, std::size_t count, const float* values, float scale, float coarsest,
                               const float* truth, const std::uint16_t* stored) {
  if (stored == nullptr) {
    for (std::size_t i = 0; i < count; ++i) bits[i] = Round<false>(values[3 * i] * scale, coarsest, 0.0f, 0.0f);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    bits[i] = Round<true>(values[3 * i] * scale, coarsest, truth[3 * i] * scale, HalfToFloat(stored[i]));
  }
}

HalfImage RoundImage(const RadianceImage& image, float coarse_below, const RadianceImage* truth,
                     const HalfImage* stored) {
  HalfImage result;
  result.width = image.width;
  result.height = image.height;
  result.exponent = ChooseExponent(image);
  if (stored != nullptr && (stored->exponent != result.exponent || truth->size() != image.size()))
    stored = nullptr;
  const float scale = std::ldexp(1.0f, -result.exponent);
  const float coarsest = coarse_below > 0.0f ? Step(coarse_below * scale) : 0.0f;
  for (std::size_t plane = 0; plane < 6; ++plane) {
    auto& bits = result.planes[plane];
    bits.resize(image.size());
    const auto channel = [plane](const RadianceImage& picture) {
      const auto& lobe = plane < 3 ? picture.diffuse : picture.specular;
      return lobe.empty() ? nullptr : glm::value_ptr(lobe[0]) + plane % 3;
    };
    RoundPlane(bits.data(), bits.size(), channel(image), scale, coarsest, stored == nullptr ? nullptr : channel(*truth),
               stored == nullptr ? nullptr : stored->planes[plane].data());
  }
  return result;
}

}  // namespace

HalfImage ToHalf(const RadianceImage& image) {
  return RoundImage(image, 0.0f, nullptr, nullptr);
}

HalfImage ToHalf(const RadianceImage& image, float coarse_below) {
  return RoundImage(image, coarse_below, nullptr, nullptr);
}

HalfImage ToHalf(const RadianceImage& image, float coarse_below, const RadianceImage& truth,
                 const HalfImage& stored) {
  return RoundImage(image, coarse_below, &truth, &stored);
}

RadianceImage FromHalf(const HalfImage& image) {
  RadianceImage result;
  result.width = image.width;
  result.height = image.height;
  result.diffuse.resize(image.planes[0].size());
  result.specular.resize(image.planes[0].size());
  const float scale = std::ldexp(1.0f, image.exponent);
  for (std::size_t plane = 0; plane < 6 && !result.diffuse.empty(); ++plane) {
    float* values = glm::value_ptr((plane < 3 ? result.diffuse : result.specular)[0]) + plane % 3;
    const std::uint16_t* bits = image.planes[plane].data();
    for (std::size_t i = 0; i < result.diffuse.size(); ++i) values[3 * i] = HalfToFloat(bits[i]) * scale;
  }
  return result;
}

void DropBits(HalfImage& image, int bits) {
  constexpr unsigned kSign = 0x8000, kLargest = 0x7bff, kInfinity = 0x7c00, kNan = 0x7e00;
  const unsigned step = 1u << bits;
  for (auto& plane : image.planes) {
    for (std::uint16_t& value : plane) {
      const unsigned size = value & ~kSign & 0xffffu;
      unsigned kept = std::min((size + step / 2) / step, kLargest / step) * step;
      if (size >= kInfinity) kept = size == kInfinity ? kInfinity : kNan;
      value = static_cast<std::uint16_t>(kept == 0 ? 0u : (value & kSign) | kept);
    }
  }
}

}  // namespace arealab
