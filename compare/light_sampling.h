// Directions towards a light and around a BRDF's lobe, for the integrals that have no closed form: those with
// visibility.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "compare/closed_forms.h"
#include "scenes/scene.h"

namespace arealab {

// The i-th point of the two-dimensional Sobol' sequence in [0, 1)², Owen-scrambled by `seed`, by the text of
// glsl/low_discrepancy.glsl with 32 bits kept: its first 2^k points are a (0, k, 2)-net for every k.
glm::dvec2 ScrambledSobol(std::uint32_t i, std::uint64_t seed);

// A well mixed function of its arguments [Steele et al. 2014, splitmix64].
std::uint64_t Mix(std::uint64_t a, std::uint64_t b);

// What one light covers, seen from a point that it lights.
class LightDirections {
 public:
  // Nothing where the light faces away, contains the point, or lies below the horizon of `normal`.
  static std::optional<LightDirections> From(const glm::dvec3& position, const glm::dvec3& normal,
                                             const Light& light);

  // All directions above the horizon, as dense as their cosine; nothing is beyond them.
  static LightDirections Sky(const glm::dvec3& normal);

  struct Sample {
    glm::dvec3 direction;  // unit, world
    double distance;       // m, to the light's surface
    double density;        // 1/sr
  };
  // Rectangles by solid angle [Ureña et al. 2013], by area where they are tiny; polygons and the wall of a tube by area; disks, ellipses and spheres evenly over
  // the projection of their cone along its axis. `u` in [0, 1)². Directions below the horizon are given too.
  Sample At(const glm::dvec2& u) const;

  // The sample that has this direction; nothing where it misses the light.
  std::optional<Sample> Towards(const glm::dvec3& direction) const;

  // Directions to four places, in turn, between which the light lies; world, not unit.
  std::array<glm::dvec3, 4> Corners() const;

  // A plane behind which nothing hides the light: its unit normal towards the point, and how far below the
  // point it lies along that normal, in metres.
  glm::dvec3 back_normal() const { return axis_[2]; }
  double back_distance() const { return back_; }

  double solid_angle() const { return solid_angle_; }  // sr, horizon ignored; of the projection for cones

 private:
  glm::dvec3 World(const glm::dvec3& local) const {
    return axis_[0] * local.x + axis_[1] * local.y + axis_[2] * local.z;
  }

  // The sample at a place of a tube's wall, from the point; the wall's unit normal there.
  Sample OnTube(const glm::dvec3& to, const glm::dvec3& outwards) const;

  LightShape shape_ = LightShape::kRectangle;
  // Right-handed and unit. Flat lights: their own, the third towards the point.
  std::array<glm::dvec3, 3> axis_;
  glm::dvec3 center_{0.0};     // m, from the point, world
  glm::dvec2 half_size_{0.0};  // m
  double back_ = 0.0;
  double solid_angle_ = 0.0;
  LightCone cone_;  // disks and spheres; world
  // Rectangles: in the axes, from the point: x0 ≤ x ≤ x1, y0 ≤ y ≤ y1, z = −back_.
  double x0_ = 0.0, x1_ = 0.0, y0_ = 0.0, y1_ = 0.0, b0_ = 0.0, b1_ = 0.0, k_ = 0.0;
  bool by_area_ = false;
  std::vector<glm::dvec2> corners_;     // of a polygon, in the axes about the centre, counter-clockwise
  std::vector<double> shares_;          // of its area, up to and with each triangle about the first corner
  double area_ = 0.0;                   // m², of a polygon or of the wall of a tube that is seen
  double widest_ = 0.0;                 // rad, of that wall, to either side; half_size_: half length, radius
  bool sky_ = false;
};

// Half vectors that the viewer sees, hence reflected directions, of a GGX lobe [Heitz 2018, by the spherical
// caps of Dupuy & Benyoub 2023]. Frame: z the normal.
// `to_view` unit, above the surface; the direction may point below it.
glm::dvec3 SampleVisibleGgx(const glm::dvec3& to_view, double alpha, const glm::dvec2& u);

}  // namespace arealab
