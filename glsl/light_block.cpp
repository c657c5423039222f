#include "glsl/light_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numbers>

#include "scenes/error.h"

namespace arealab {
namespace {

float ShapeNumber(LightShape shape) {  // SHAPE_* of glsl/surface.glsl
  switch (shape) {
    case LightShape::kRectangle:
      return 0.0f;
    case LightShape::kDisk:
      return 1.0f;
    case LightShape::kSphere:
      return 2.0f;
    case LightShape::kPolygon:
      return 3.0f;
    case LightShape::kEllipse:
      return 1.0f;  // the shading text asks EFFECT_ELLIPSE where it matters
    case LightShape::kTube:
      return 4.0f;
  }
  return 0.0f;
}

}  // namespace

std::vector<Light> EmittingLights(const Scene& scene) {
  std::vector<Light> emitting;
  std::copy_if(scene.lights.begin(), scene.lights.end(), std::back_inserter(emitting),
               [](const Light& light) { return light.radiance != glm::dvec3(0.0); });
  return emitting;
}

std::vector<ShownTexture> ShownTextures(const std::vector<Light>& lights) {
  std::vector<ShownTexture> shown;
  for (const Light& light : lights) {
    if (!light.texture) continue;
    const ShownTexture texture{light.texture, light.half_size.x / light.half_size.y};
    if (std::ranges::find(shown, texture) == shown.end()) shown.push_back(texture);
  }
  return shown;
}

std::vector<glm::vec4> LightBlockRows(const std::vector<Light>& lights) {
  if (lights.size() > kMaxLights) {
    throw InputError(fmt::format("{} lights in the scene; expected at most {}", lights.size(), kMaxLights));
  }
  const std::vector<ShownTexture> shown = ShownTextures(lights);
  std::vector<glm::vec4> rows;
  rows.reserve(lights.size() * kLightRows);
  for (const Light& light : lights) {
    const glm::dvec2 half = light.half_size;
    const double area = light.shape == LightShape::kSphere ? std::numbers::pi * half.x * half.x
                        : light.shape == LightShape::kTube ? 4.0 * half.x * half.y
                                                           : light.Area() / (light.two_sided ? 2.0 : 1.0);
    rows.emplace_back(light.center, ShapeNumber(light.shape));
    rows.emplace_back(light.normal, light.two_sided ? 1.0f : 0.0f);
    rows.emplace_back(light.axis_x, half.x);
    rows.emplace_back(light.axis_y, half.y);
    rows.emplace_back(light.axis_x * half.x, area);
    const auto layer = light.texture ? std::ranges::find(shown, ShownTexture{light.texture, half.x / half.y}) - shown.begin() + 1 : 0;
    const glm::ivec2 texels = light.texture ? glm::ivec2(light.texture->width, light.texture->height) : glm::ivec2(0);
    // Polygons have no texture: the two share a place.
    rows.emplace_back(light.axis_y * half.y, light.texture ? texels.x : static_cast<int>(light.corners.size()));
    rows.emplace_back(light.radiance, layer);
    rows.emplace_back(half.x * half.x, half.y * half.y, 2.0 * half.x * half.y, texels.y);
  }
  return rows;
}

std::vector<glm::vec4> CornerBlockRows(const std::vector<Light>& lights) {
  std::vector<glm::vec4> rows(lights.size() * kCornerRows, glm::vec4(0.0f));
  for (std::size_t l = 0; l < lights.size(); ++l) {
    for (std::size_t i = 0; i < lights[l].corners.size(); ++i) {
      glm::vec4& row = rows[l * kCornerRows + i / 2];
      (i % 2 == 0 ? row.x : row.z) = static_cast<float>(lights[l].corners[i].x);
      (i % 2 == 0 ? row.y : row.w) = static_cast<float>(lights[l].corners[i].y);
    }
  }
  return rows;
}

}  // namespace arealab
