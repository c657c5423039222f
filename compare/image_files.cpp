#include "compare/image_files.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scenes/error.h"
#include "scenes/write_image.h"

namespace arealab {
namespace {

const char* const kLayers[2] = {"diffuse", "specular"};

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
