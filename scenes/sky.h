// The image that a sky shows, in latitude and longitude: its radiance in a direction is the sky's radiance × the texel there.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>

#include "scenes/scene.h"

namespace arealab {

// As LoadLightTexture; throws InputError without a place also where the image is not twice as wide as high.
std::shared_ptr<const Image> LoadSkyTexture(const std::filesystem::path& file);

// Where a direction (world, unit) is on an image that is turned by `turn`: (0, 0) is the upper left corner. The image's middle is
// towards +y, its right half towards +x, its top towards +z.
glm::dvec2 SkyCoordinates(const glm::dvec3& direction, double turn);
// The direction that is there.
glm::dvec3 SkyDirection(const glm::dvec2& uv, double turn);

// Bilinear between the texels' centres, which go on around; held beyond the outermost rows.
glm::dvec3 SkyTexel(const Image& texture, const glm::dvec2& uv);

// The mean over all directions, of a texel as if it were even.
glm::dvec3 MeanSkyTexel(const Image& texture);

glm::dvec3 SkyRadiance(const Sky& sky, const glm::dvec3& direction);

}  // namespace arealab
