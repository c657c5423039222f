// A light's edge as the eye sees it.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scenes/scene.h"

namespace arealab {

// 128 points of a circle, the first again at the end.
std::vector<glm::dvec3> Circle(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v);

// What a drawing of the light shows, closed: of a tube both rims, joined along one line. Empty from inside a sphere.
std::vector<glm::dvec3> Outline(const Light& light, const glm::dvec3& eye);

// The edge of the region that the light covers, convex: of a tube the hull of its rims. Empty from inside.
std::vector<glm::dvec3> Silhouette(const Light& light, const glm::dvec3& eye);

}  // namespace arealab
