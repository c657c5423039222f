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

std::vector<glm::vec4> LightBlockRows(const std::vector<Light>& lights) {
  if (lights.size() > kMaxLights) {
    throw InputError(fmt::format("{} lights in the scene; expected at most {}", lights.size(), kMaxLights));
  }
  std::vector<glm::vec4> rows;
  rows.reserve(lights.size() * kLightRows);
  for (const Light& light : lights) {
    const glm::dvec2 half = light.half_size;
    const double area =
        light.shape == LightShape::kSphere ? std::numbers::pi * half.x * half.x : light.Area() / (light.two_sided ? 2.0 : 1.0);
    rows.emplace_back(light.center, ShapeNumber(light.shape));
    rows.emplace_back(light.normal, light.two_sided ? 1.0f : 0.0f);
    rows.emplace_back(light.axis_x, half.x);
    rows.emplace_back(light.axis_y, half.y);
    rows.emplace_back(light.axis_x * half.x, area);
    rows.emplace_back(light.axis_y * half.y, static_cast<float>(light.corners.size()));
    rows.emplace_back(light.radiance, 0.0);
    rows.emplace_back(half.x * half.x, half.y * half.y, 2.0 * half.x * half.y, 0.0);
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
