// Form factors with closed forms, in double: the reference for every diffuse technique.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "scenes/scene.h"

namespace arealab {

// The part of a convex polygon above the horizon z = 0, in order; points on the horizon have z exactly 0.
// Fewer than three corners where nothing is left.
struct HorizonPolygon {
  std::array<glm::dvec3, kMostCorners + 1> corners;
  int count = 0;
};
HorizonPolygon ClipToHorizon(std::span<const glm::dvec3> corners);

// ∫ cosθ/π dω over a convex polygon at or above the horizon, seen from the origin, normal z; its corners
// counter-clockwise from outside give a positive value [Lambert 1760; Arvo 1995].
double PolygonFormFactor(const HorizonPolygon& polygon);

// An elliptic cone of directions with apex at the origin: axis_3 + axis_1·tan_1·cosψ + axis_2·tan_2·sinψ is
// its surface, tan_1 ≥ tan_2, tan_i = sin_i / cos_i; the axes are orthonormal and right-handed. It is what a
// disk or a sphere covers.
struct LightCone {
  glm::dvec3 axis_1{1.0, 0.0, 0.0}, axis_2{0.0, 1.0, 0.0}, axis_3{0.0, 0.0, 1.0};
  double sin_1 = 0.0, cos_1 = 1.0, sin_2 = 0.0, cos_2 = 1.0;
};

// The cone of a disk seen from the origin: centre c, unit normal with c·normal < 0, radius. The disk's cone
// needs no cubic: the tangent across the plane through centre and normal is one axis, a 2×2 problem gives the
// others.
LightCone DiskCone(const glm::dvec3& center, const glm::dvec3& normal, double radius);

// The cone of an ellipse seen from the origin: centre c, half axes a and b, perpendicular to each other and to the unit normal,
// c·normal < 0.
LightCone EllipseCone(const glm::dvec3& center, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& normal);

// The cone of a sphere whose centre is farther than its radius.
LightCone SphereCone(const glm::dvec3& center, double radius);

// The part of a cone's outline above the horizon z = 0.
struct ConeHorizon {
  enum class Kind { kAbove, kCrossing, kBelow } kind = Kind::kAbove;
  double psi_begin = 0.0,
         psi_end = 0.0;  // crossing: the visible interval of ψ, counter-clockwise, begin < end
};
ConeHorizon ClipToHorizon(const LightCone& cone);

// ∫ cosθ/π dω over the part of the cone above the horizon, normal z.
double ConeFormFactor(const LightCone& cone, const ConeHorizon& horizon);

// What the cone's outline from ψ = begin to end, in either turn, adds to 2π times the form factor of a region that it bounds.
double ConeContour(const LightCone& cone, double begin, double end);

}  // namespace arealab
