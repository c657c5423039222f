// The effects: 0/1 defines by which the shading text leaves out what a scene does not call for.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace arealab {

// All EFFECT_* with 0 or 1, as the scene calls for them:
//   EFFECT_RECTANGLE, EFFECT_DISK, EFFECT_SPHERE: some light that emits has this shape;
//   EFFECT_TWO_SIDED: some light is lit on both sides;
//   EFFECT_DIFFUSE: some material is not pure metal;
//   EFFECT_SPECULAR: always;
//   EFFECT_FRESNEL: some reflectance at normal incidence is below 1;
//   EFFECT_MANY_LIGHTS: more than one light emits.
std::vector<std::pair<std::string, int>> SceneEffects(const Scene& scene);

}  // namespace arealab
