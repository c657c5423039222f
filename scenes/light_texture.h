// The image that a rectangle light shows: its radiance at a point is the light's radiance × the texel there.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>

#include "scenes/scene.h"

namespace arealab {

// Linear colours, multiplied by alpha. Throws InputError without a place where LoadImage does, where a texel is negative and
// where all are black.
std::shared_ptr<const Image> LoadLightTexture(const std::filesystem::path& file);

// Bilinear between the texels' centres, held beyond the outermost; uv (0, 0) is the upper left corner, (1, 1) the lower right.
glm::dvec3 TextureAt(const Image& texture, const glm::dvec2& uv);

// The mean of TextureAt over the light, which is that of its texels.
glm::dvec3 MeanTexel(const Image& texture);

// Where `point` (m, world, in the light's plane) is on the texture. Each lit side shows the image upright to who looks at it.
glm::dvec2 TextureCoordinates(const Light& light, const glm::dvec3& point, bool back_side);

}  // namespace arealab
