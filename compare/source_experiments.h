// The sources' own experiments rerun, in double, from the shading text itself.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace arealab {

// Drobot's choice of a representative point [2014, §1.3.3]: random rectangles and disks, wholly above the horizon, of 0.2 to 1 m half
// size, 1 to 4 m away. The best point is that of the segment between the light's points closest to both maxima whose cosine times the
// light's solid angle (eq. 1.15) comes nearest to the integral. Means over the lights.
struct RepresentativePointErrors {
  std::string form;      // "closest", "halfway", "plane": choices of drobot's option `point`; "sum": plane+bisector=sum
  bool facing = true;    // lights that face the surface (n · n' < 0), or those that do not
  int lights = 0;
  double distance = 0.0;       // from the best point, over the square root of the light's area
  double from_best = 0.0;      // of the irradiance, relative, from the best point's
  double from_integral = 0.0;  // and from the integral
};
std::vector<RepresentativePointErrors> RerunDrobotPoints(int lights = 600, unsigned seed = 5);

// The area that Mayaux's clipping keeps [2017]: of a square of half size 1 in the plane z = 0, seen from `point` of a surface that turns,
// its normal within the plane through the square's axis and the direction at `azimuth` degrees from its x axis (45: a diagonal).
// Shares of the square's area.
struct ClippedArea {
  double degrees = 0.0;                                  // of the surface's normal from the light's, 0: facing
  double documented = 0.0, printed = 0.0, exact = 0.0;  // segment=documented, segment=printed, what is above the horizon
};
std::vector<ClippedArea> MayauxAreaCurve(int steps = 180, double azimuth = 45.0, const glm::dvec3& point = {0.0, 0.0, 1.0});

}  // namespace arealab
