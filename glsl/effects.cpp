#include "glsl/effects.h"

#include <algorithm>

#include "glsl/light_block.h"

namespace arealab {
namespace {

bool IsPureMetal(const Material& material) {
  return material.metalness >= 1.0f && !material.metallic_roughness_texture;
}

// F0 = mix(0.04, base colour, metalness) is 1 in every channel, everywhere.
bool ReflectsAll(const Material& material) {
  return IsPureMetal(material) && !material.base_color_texture &&
         glm::all(glm::greaterThanEqual(material.base_color, glm::vec3(1.0f)));
}

}  // namespace

std::vector<std::pair<std::string, int>> SceneEffects(const Scene& scene) {
  const std::vector<Light> lights = EmittingLights(scene);
  const auto any_shape = [&](LightShape shape) {
    return std::any_of(lights.begin(), lights.end(),
                       [&](const Light& light) { return light.shape == shape; });
  };
  const bool two_sided = std::any_of(lights.begin(), lights.end(), [](const Light& light) {
    return light.two_sided && light.shape != LightShape::kSphere;
  });
  const auto& materials = scene.materials;
  return {
      {"EFFECT_RECTANGLE", any_shape(LightShape::kRectangle)},
      {"EFFECT_DISK", any_shape(LightShape::kDisk)},
      {"EFFECT_SPHERE", any_shape(LightShape::kSphere)},
      {"EFFECT_TWO_SIDED", two_sided},
      {"EFFECT_DIFFUSE", !std::all_of(materials.begin(), materials.end(), IsPureMetal)},
      {"EFFECT_SPECULAR", 1},
      {"EFFECT_FRESNEL", !std::all_of(materials.begin(), materials.end(), ReflectsAll)},
      {"EFFECT_MANY_LIGHTS", lights.size() > 1},
  };
}

}  // namespace arealab
