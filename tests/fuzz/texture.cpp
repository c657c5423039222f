// Texture import: the first byte chooses the file's suffix, the others are its bytes.
#include <cmath>

#include "scenes/image.h"
#include "scenes/light_texture.h"
#include "tests/fuzz/targets.h"

namespace arealab::fuzz {

void TextureFile(Bytes bytes) {
  constexpr const char* kSuffixes[] = {"png", "jpg", "exr", "hdr", "tga", "tif"};
  if (bytes.empty()) return;
  const std::filesystem::path file = File(std::string("texture.") + kSuffixes[bytes[0] % std::size(kSuffixes)], Text(bytes.subspan(1)));
  std::shared_ptr<const Image> image;
  if (!Reads([&] { image = LoadImage(file, ImageUse::kData); })) return;
  Require(image->width > 0 && image->height > 0, "no pixels");
  Require(image->pixels.size() == static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height), "pixels missing");
  for (const glm::vec4& pixel : image->pixels) {
    for (int c = 0; c < 4; ++c) Require(std::isfinite(pixel[c]), "a pixel that is not finite");
  }
  Reads([&] {
    const auto texture = LoadLightTexture(file);
    const glm::dvec3 mean = MeanTexel(*texture);
    Require(mean.x + mean.y + mean.z > 0.0, "a light without light");
  });
}

}  // namespace arealab::fuzz
