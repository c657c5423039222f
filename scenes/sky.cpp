#include "scenes/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/error.h"
#include "scenes/light_texture.h"

namespace arealab {

std::shared_ptr<const Image> LoadSkyTexture(const std::filesystem::path& file) {
  std::shared_ptr<const Image> texture = LoadLightTexture(file);
  if (texture->width != 2 * texture->height) {
    throw InputError(fmt::format("'{}' is {} × {} pixels; expected a sky in latitude and longitude, twice as wide as high", file.filename().string(),
                                 texture->width, texture->height));
  }
  return texture;
}

glm::dvec2 SkyCoordinates(const glm::dvec3& direction, double turn) {
  const double u = 0.5 + (std::atan2(direction.x, direction.y) + turn) / (2.0 * glm::pi<double>());
  return {u - std::floor(u), std::acos(std::clamp(direction.z, -1.0, 1.0)) / glm::pi<double>()};
}

glm::dvec3 SkyDirection(const glm::dvec2& uv, double turn) {
  const double azimuth = (uv.x - 0.5) * 2.0 * glm::pi<double>() - turn, polar = uv.y * glm::pi<double>();
  return {std::sin(polar) * std::sin(azimuth), std::sin(polar) * std::cos(azimuth), std::cos(polar)};
}

glm::dvec3 SkyTexel(const Image& texture, const glm::dvec2& uv) {
  const double x = uv.x * texture.width - 0.5, y = std::clamp(uv.y * texture.height - 0.5, 0.0, texture.height - 1.0);
  const double left = std::floor(x);
  const int x0 = (static_cast<int>(left) + texture.width) % texture.width, x1 = (x0 + 1) % texture.width;
  const int y0 = static_cast<int>(y), y1 = std::min(y0 + 1, texture.height - 1);
  const auto texel = [&](int column, int row) {
    return glm::dvec3(texture.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.width) + static_cast<std::size_t>(column)]);
  };
  const double f = x - left;
  return glm::mix(glm::mix(texel(x0, y0), texel(x1, y0), f), glm::mix(texel(x0, y1), texel(x1, y1), f), y - y0);
}

glm::dvec3 MeanSkyTexel(const Image& texture) {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < texture.height; ++y) {
    const auto row = texture.pixels.begin() + static_cast<std::ptrdiff_t>(y) * texture.width;
    glm::dvec3 texels(0.0);
    for (int x = 0; x < texture.width; ++x) texels += glm::dvec3(row[x]);
    // The share of the sphere between the row's latitudes.
    sum += texels * (0.5 * (std::cos(glm::pi<double>() * y / texture.height) - std::cos(glm::pi<double>() * (y + 1) / texture.height)));
  }
  return sum / static_cast<double>(texture.width);
}

glm::dvec3 SkyRadiance(const Sky& sky, const glm::dvec3& direction) {
  return sky.texture ? sky.radiance * SkyTexel(*sky.texture, SkyCoordinates(direction, sky.turn)) : sky.radiance;
}

}  // namespace arealab
