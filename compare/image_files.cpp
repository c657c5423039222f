#include "compare/image_files.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "scenes/error.h"
#include "scenes/write_image.h"

namespace arealab {
namespace {

constexpr float kLargestFloat = std::numeric_limits<float>::max();
constexpr float kLargestHalf = 65504.0f;  // (2 − 2⁻¹⁰) · 2¹⁵
constexpr float kSmallestPeak =
    0.0625f;  // 10 stops above the smallest normal half, 2⁻¹⁴: full precision down to 1/1024 of it
const char* const kLayers[2] = {"diffuse", "specular"};

// IEEE 754 binary16: sign, 5 bits of exponent biased by 15, 10 of fraction. Without branches: whole pictures pass here.
[[gnu::always_inline]] inline float HalfToFloat(std::uint16_t bits) {
  const std::uint32_t size = bits & 0x7fffu, sign = static_cast<std::uint32_t>(bits & 0x8000u) << 16;
  const std::uint32_t bias = size >= 0x7c00u ? 224u << 23 : 112u << 23;  // infinity stays itself
  const float denormal = static_cast<float>(static_cast<int>(size)) * 0x1p-24f;
  const std::uint32_t v = size < 0x400u ? std::bit_cast<std::uint32_t>(denormal) : (size << 13) + bias;
  return std::bit_cast<float>(v | sign);
}

// sRGB's transfer curve [IEC 61966-2-1], in and out in [0, 1].
float EncodeSrgb(float v) {
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

// 8-bit codes by a table over [0, 1]: 4096 steps are finer than the codes except near black, where the curve
// is a line.
std::uint8_t SrgbCode(float v) {
  constexpr int kSteps = 4096;
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> codes;
    for (int i = 0; i <= kSteps; ++i) {
      codes.push_back(
          static_cast<std::uint8_t>(std::lround(255.0f * EncodeSrgb(static_cast<float>(i) / kSteps))));
    }
    return codes;
  }();
  if (v < 0.02f) return static_cast<std::uint8_t>(std::lround(255.0f * EncodeSrgb(std::max(v, 0.0f))));
  return table[static_cast<std::size_t>(std::lround(std::min(v, 1.0f) * kSteps))];
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

void WriteExr(const std::filesystem::path& file, const HalfImage& image, ExrLoss loss) {
  std::vector<int> planes;
  std::vector<std::string> names;
  for (int lobe = 0; lobe < 2; ++lobe) {
    const bool gray = image.IsGray(lobe);
    for (int channel = 0; channel < (gray ? 1 : 3); ++channel) {
      planes.push_back(3 * lobe + channel);
      names.push_back(fmt::format("{}.{}", kLayers[lobe], gray ? 'Y' : "RGB"[channel]));
    }
  }
  const bool as_half = image.exponent == 0;
  const int count = static_cast<int>(planes.size());
  OIIO::ImageSpec spec(image.width, image.height, count,
                       as_half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
  spec.channelnames = names;
  // Measured on `gloss`, `relief` and `scan`: PXR24, lossless for halves, 13.6 MB; DWA 7.7 MB at its usual level, which
  // moves values by 0.1 to 0.5 % in the mean, single dark ones beside edges by up to a quarter. It smears what is not finite.
  spec.attribute("compression", !as_half ? "zip" : loss == ExrLoss::kForTheEye && image.IsFinite() ? "dwab:45" : "pxr24");
  const std::size_t size = image.planes[0].size();
  if (as_half) {
    std::vector<std::uint16_t> pixels(size * planes.size());
    for (std::size_t p = 0; p < planes.size(); ++p) {
      const auto& plane = image.planes[static_cast<std::size_t>(planes[p])];
      for (std::size_t i = 0; i < size; ++i) pixels[i * planes.size() + p] = plane[i];
    }
    WriteImageFile(file, spec, pixels.data());
  } else {
    std::vector<float> pixels(size * planes.size());
    for (std::size_t p = 0; p < planes.size(); ++p) {
      for (std::size_t i = 0; i < size; ++i) pixels[i * planes.size() + p] = image.Value(planes[p], i);
    }
    WriteImageFile(file, spec, pixels.data());
  }
}

void WriteExr(const std::filesystem::path& file, const RadianceImage& image) {
  OIIO::ImageSpec spec(image.width, image.height, 6, OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const char* lobe : kLayers) {
    for (char channel : {'R', 'G', 'B'}) spec.channelnames.push_back(fmt::format("{}.{}", lobe, channel));
  }
  spec.attribute("compression", "zip");
  std::vector<float> pixels;
  pixels.reserve(6 * image.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (const auto* lobe : {&image.diffuse, &image.specular}) {
      for (int c = 0; c < 3; ++c) pixels.push_back((*lobe)[i][c]);
    }
  }
  WriteImageFile(file, spec, pixels.data());
}

RadianceImage ReadExr(const std::filesystem::path& file) {
  auto input = OIIO::ImageInput::open(file.string());
  if (!input) {
    throw InputError(
        fmt::format("{}: {}; expected an EXR that AreaLab wrote", file.string(), OIIO::geterror()));
  }
  const OIIO::ImageSpec spec = input->spec();
  std::vector<float> pixels(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                            static_cast<std::size_t>(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data())) {
    throw InputError(fmt::format("{}: {}; expected a whole EXR", file.string(), input->geterror()));
  }
  RadianceImage image;
  image.width = spec.width;
  image.height = spec.height;
  for (int lobe = 0; lobe < 2; ++lobe) {
    const int gray = spec.channelindex(fmt::format("{}.Y", kLayers[lobe]));
    auto& target = lobe == 0 ? image.diffuse : image.specular;
    target.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
    for (int c = 0; c < 3; ++c) {
      const int index = gray >= 0 ? gray : spec.channelindex(fmt::format("{}.{}", kLayers[lobe], "RGB"[c]));
      if (index < 0) {
        throw InputError(
            fmt::format("{}: no layer {}; expected diffuse and specular", file.string(), kLayers[lobe]));
      }
      for (std::size_t i = 0; i < target.size(); ++i) {
        target[i][c] = pixels[i * static_cast<std::size_t>(spec.nchannels) + static_cast<std::size_t>(index)];
      }
    }
  }
  return image;
}

void WritePng(const std::filesystem::path& file, std::span<const glm::vec3> radiance, int width,
              double exposure) {
  const float scale = static_cast<float>(std::exp2(exposure));
  std::vector<std::uint8_t> pixels;
  pixels.reserve(3 * radiance.size());
  for (const glm::vec3& v : radiance) {
    if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) {
      for (int c = 0; c < 3; ++c) pixels.push_back(SrgbCode(v[c] * scale));
    } else {
      pixels.insert(pixels.end(), {255, 0, 255});
    }
  }
  WritePngCodes(file, pixels, width);
}

void WritePngCodes(const std::filesystem::path& file, std::span<const std::uint8_t> codes, int width) {
  const int height = static_cast<int>(codes.size() / (3 * static_cast<std::size_t>(width)));
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("png:compressionLevel", 6);
  WriteImageFile(file, spec, codes.data());
}

std::vector<glm::vec3> Picture(const RadianceImage& image, std::span<const glm::vec3> emission) {
  std::vector<glm::vec3> picture(image.size());
  for (std::size_t i = 0; i < picture.size(); ++i) {
    picture[i] = image.Total(i);
    if (!emission.empty()) picture[i] += emission[i];
  }
  return picture;
}

}  // namespace arealab
