#include "scenes/light_texture.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/error.h"
#include "scenes/image.h"

namespace arealab {

std::shared_ptr<const Image> LoadLightTexture(const std::filesystem::path& file) {
  auto texture = std::make_shared<Image>(*LoadImage(file, ImageUse::kColor));
  const std::string name = file.filename().string();
  const auto width = static_cast<std::size_t>(texture->width);
  bool black = true;
  for (std::size_t i = 0; i < texture->pixels.size(); ++i) {
    glm::vec4& texel = texture->pixels[i];
    if (std::min({texel.r, texel.g, texel.b, texel.a}) < 0.0f) {
      throw InputError(fmt::format("'{}' has a negative pixel at ({}, {}); expected a light's texels to be 0 or more", name,
                                   i % width, i / width));
    }
    texel = glm::vec4(glm::vec3(texel) * texel.a, texel.a);
    black = black && glm::vec3(texel) == glm::vec3(0.0f);
  }
  if (black) throw InputError(fmt::format("'{}' is black; expected a light's texture to emit something", name));
  return texture;
}

glm::dvec3 TextureAt(const Image& texture, const glm::dvec2& uv) {
  const glm::ivec2 last(texture.width - 1, texture.height - 1);
  const glm::dvec2 p = glm::clamp(uv * glm::dvec2(last + 1) - 0.5, glm::dvec2(0.0), glm::dvec2(last));
  const glm::ivec2 low(p), high = glm::min(low + 1, last);
  const glm::dvec2 f = p - glm::dvec2(low);
  const auto texel = [&](int x, int y) {
    return glm::dvec3(texture.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) + static_cast<std::size_t>(x)]);
  };
  return glm::mix(glm::mix(texel(low.x, low.y), texel(high.x, low.y), f.x), glm::mix(texel(low.x, high.y), texel(high.x, high.y), f.x), f.y);
}

glm::dvec3 MeanTexel(const Image& texture) {
  glm::dvec3 sum(0.0);
  for (const glm::vec4& texel : texture.pixels) sum += glm::dvec3(texel);
  return sum / static_cast<double>(texture.pixels.size());
}

glm::dvec2 TextureCoordinates(const Light& light, const glm::dvec3& point, bool back_side) {
  const glm::dvec3 offset = point - light.center;
  const double x = glm::dot(offset, light.axis_x) / light.half_size.x, y = glm::dot(offset, light.axis_y) / light.half_size.y;
  return {0.5 + 0.5 * (back_side ? -x : x), 0.5 - 0.5 * y};
}

}  // namespace arealab
