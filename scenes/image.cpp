#include "scenes/image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "scenes/error.h"

namespace arealab {
namespace {

constexpr int kMaxSide = 8192;  // pixels: 1 GiB as four floats, the most that leaves room within 2 GiB

// The sRGB electro-optical transfer function [IEC 61966-2-1].
float LinearFromSrgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

// While one lives nothing reaches standard error: libpng writes there what it finds amiss, beside the line that we make of it.
class SilentErrors {
 public:
  SilentErrors() : lock_(Mutex()), kept_(dup(STDERR_FILENO)) {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
    if (nowhere >= 0) close(nowhere);
  }
  ~SilentErrors() {
    if (kept_ >= 0) dup2(kept_, STDERR_FILENO);
    if (kept_ >= 0) close(kept_);
  }
  SilentErrors(const SilentErrors&) = delete;
  SilentErrors& operator=(const SilentErrors&) = delete;

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  int kept_;
};

std::shared_ptr<const Image> Read(const std::string& file, const std::string& name, ImageUse use,
                                  OIIO::Filesystem::IOProxy* memory) {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // glTF and artists keep colour and alpha apart
  const SilentErrors silent;
  std::unique_ptr<OIIO::ImageInput> input;
  // The reader that the suffix names: the one-step open would offer a damaged file to those of every other format, and looks for
  // it on disk in spite of the memory that it is given (OpenImageIO 2.4).
  input = OIIO::ImageInput::create(file, false, nullptr, memory);
  OIIO::ImageSpec opened;
  if (input && ((memory && !input->set_ioproxy(memory)) || !input->open(file, opened, config))) {
    input->geterror();  // an unread message would be printed
    input.reset();
  }
  if (!input) {
    OIIO::geterror();  // clears the library's pending message
    throw InputError(fmt::format(
        "'{}' is not an image that can be read; expected a whole PNG, JPEG, EXR, HDR, TGA or TIFF file",
        name));
  }
  const OIIO::ImageSpec spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMaxSide || spec.height > kMaxSide) {
    throw InputError(fmt::format("'{}' is {} × {} pixels; expected 1 to {} a side", name, spec.width,
                                 spec.height, kMaxSide));
  }
  if (spec.depth > 1 || spec.deep || spec.nchannels < 1) {
    throw InputError(fmt::format("'{}' is a deep or volume image; expected a flat one", name));
  }
  const auto count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  const int channels = std::min(spec.nchannels, 4);
  // Not touched before it is read: a header's sides may be far larger than what follows it.
  const auto values = std::make_unique_for_overwrite<float[]>(count * static_cast<std::size_t>(channels));
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.get())) {
    input->geterror();
    throw InputError(fmt::format("'{}' is cut short or damaged; expected a whole image", name));
  }
  const bool encoded = use == ImageUse::kColor && !spec.format.is_floating_point();
  auto image = std::make_shared<Image>();
  image->width = spec.width;
  image->height = spec.height;
  image->pixels.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* value = &values[i * static_cast<std::size_t>(channels)];
    glm::vec4 pixel = channels >= 3 ? glm::vec4(value[0], value[1], value[2], 1.0f)
                                    : glm::vec4(value[0], value[0], value[0], 1.0f);
    if (channels == 2 || channels == 4) pixel.a = value[channels - 1];
    for (int c = 0; c < 4; ++c) {
      if (!std::isfinite(pixel[c])) {
        throw InputError(
            fmt::format("'{}' has a pixel that is not finite at ({}, {}); expected finite values", name,
                        i % static_cast<std::size_t>(spec.width), i / static_cast<std::size_t>(spec.width)));
      }
      if (encoded && c < 3) pixel[c] = LinearFromSrgb(pixel[c]);
    }
    image->pixels[i] = pixel;
  }
  return image;
}

}  // namespace

std::shared_ptr<const Image> LoadImage(const std::filesystem::path& file, ImageUse use) {
  return Read(file.string(), file.filename().string(), use, nullptr);
}

std::shared_ptr<const Image> DecodeImage(std::span<const std::byte> bytes, const std::string& name,
                                         ImageUse use) {
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  return Read(name, name, use, &memory);
}

}  // namespace arealab
