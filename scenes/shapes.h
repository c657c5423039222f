// Triangle meshes of the analytic surfaces, with texture coordinates and tangents.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <limits>

#include "scenes/scene.h"

namespace arealab {

// Where a surface stands: world = position + rotation * local.
struct Placement {
  glm::dvec3 position{0.0};  // m
  glm::dmat3 rotation{1.0};
};

// Turns about the world's x, then y, then z axis; degrees.
glm::dmat3 RotationFromDegrees(const glm::dvec3& degrees);

// size: m along local x and y; faces local +z. u runs along +x, v along -y. cell: m, the largest side of the
// rectangles that it is made of.
Mesh MakePlane(const glm::dvec2& size, const Placement& placement,
               double cell = std::numeric_limits<double>::infinity());

// size: m along the local axes. Each face has the whole texture.
Mesh MakeBox(const glm::dvec3& size, const Placement& placement,
             double cell = std::numeric_limits<double>::infinity());

// radius: m. u is the longitude from local +x through +y, v the angle from local +z. The normal at a point p
// of a triangle is the sphere's in the direction of p; the triangle lies at most 1.6e-4 radii inside the
// sphere.
Mesh MakeSphere(double radius, const Placement& placement);

// The height (x) and its slopes along local x and y (y, z) at a place of the field; m, m -> (m, 1, 1).
using HeightFunction = std::function<glm::dvec3(double x, double y)>;

// size: m along local x and y; cells: quads along them. Faces local +z; texture coordinates as a plane's.
Mesh MakeHeightField(const glm::dvec2& size, const glm::ivec2& cells, const HeightFunction& height,
                     const Placement& placement);

}  // namespace arealab
