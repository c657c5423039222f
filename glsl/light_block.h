// The lights of a scene as the shader gets them: computed once per light, in double, then rounded.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "scenes/scene.h"

namespace arealab {

// As in glsl/platform_inputs.glsl; together 32 KiB, which every driver of a GPU has for a uniform block.
constexpr int kMaxLights = 256;
constexpr int kLightRows = 8;
constexpr int kCornerRows = 4;  // of a light in the block of corners, 16 KiB, which is there where a light is a polygon

// The lights that emit anything, in the scene's order: all that a technique ever sees.
std::vector<Light> EmittingLights(const Scene& scene);

// A texture as a rectangle of given proportions shows it: what filters depend on.
struct ShownTexture {
  std::shared_ptr<const Image> image;
  double aspect = 1.0;  // width / height
  bool operator==(const ShownTexture&) const = default;
};

// Those of the lights, each once; the layers of the texture arrays of glsl/light_textures.h from 1 on.
std::vector<ShownTexture> ShownTextures(const std::vector<Light>& lights);

// kLightRows rows per light, as glsl/lights.glsl reads them:
//   0 centre (m, world), shape (0 rectangle, 1 disk or ellipse, 2 sphere, 3 polygon, 4 tube)   4 half axis A = axis_x · half_size.x (m),
//   area (m²) 1 normal, 1 if two-sided                                      5 half axis B = axis_y ·
//   half_size.y (m), corners of a polygon or texels across 2 axis_x, half_size.x (m)             6 radiance, layer of the texture
//   3 axis_y, half_size.y (m)                           7 half_size.x², half_size.y², 2 · x · y (m²), texels down
// Without a texture its three are 0.
// The area is one side's; of a sphere its cross-section πR², of a tube 2R · length, as it is seen from the side.
// Throws InputError where there are more than kMaxLights.
std::vector<glm::vec4> LightBlockRows(const std::vector<Light>& lights);

// kCornerRows rows per light: two corners of a polygon each, m along its axes from its centre, 0 where there are none.
std::vector<glm::vec4> CornerBlockRows(const std::vector<Light>& lights);

}  // namespace arealab
