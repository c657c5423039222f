// Textures from files and from memory, through OpenImageIO.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "scenes/scene.h"

namespace arealab {

// kColor: sRGB-encoded integer pixels become linear, floating-point pixels are linear already. kData: as
// stored, integers scaled to [0, 1].
enum class ImageUse { kColor, kData };

// Throws InputError without a place ("what; expected what") where the bytes are not an image, its sides
// exceed 8192 pixels or a pixel is not finite. A grey image fills red, green and blue; alpha is 1 where there
// is none.
std::shared_ptr<const Image> LoadImage(const std::filesystem::path& file, ImageUse use);

// The same for an encoded file in memory; `name` has the format's extension ("texture 0.png").
std::shared_ptr<const Image> DecodeImage(std::span<const std::byte> bytes, const std::string& name,
                                         ImageUse use);

}  // namespace arealab
