// How a hand moves the camera, and where things of the world are in the picture.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "scenes/scene.h"

namespace arealab {

// A camera's axes, as the rasteriser takes them, and its projection to a picture of `size` pixels, origin top left.
struct Projection {
  Projection(const Camera& camera, glm::dvec2 size);

  glm::dvec3 position, right, up, forward;  // unit axes
  double focal;                             // px: of one metre at a distance of one
  glm::dvec2 size;

  // Nothing where the point is not in front of the camera.
  std::optional<glm::dvec2> Pixel(const glm::dvec3& world) const;
  glm::dvec3 Direction(glm::dvec2 pixel) const;                // unit, world
  double PixelSize(const glm::dvec3& world) const;             // m: of a pixel at that depth
};

// Turns about the target; angles in radians. Stays half a degree off the poles of `up`.
void Orbit(Camera& camera, double azimuth, double elevation);
// Moves camera and target across the picture by pixels of a picture of `size`.
void Pan(Camera& camera, glm::dvec2 pixels, glm::dvec2 size);
// Distance to the target × factor.
void Dolly(Camera& camera, double factor);
// Makes `point` what the camera turns about and looks at, from where it stands.
void Focus(Camera& camera, const glm::dvec3& point);

}  // namespace arealab
