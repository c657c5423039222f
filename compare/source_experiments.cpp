#include "compare/source_experiments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "compare/closed_forms.h"

#include "glsl/dual_begin.h"
#include "glsl/representative_point.glsl"
#include "glsl/solid_angle.glsl"
namespace unit {
#include "glsl/bisector/unit.glsl"
}
namespace sum {
#include "glsl/bisector/sum.glsl"
}
namespace documented {
#include "glsl/segment/documented.glsl"
#include "glsl/fake_clip.glsl"
}  // namespace documented
namespace printed {
#include "glsl/segment/printed.glsl"
#include "glsl/fake_clip.glsl"
}  // namespace printed
#include "glsl/dual_end.h"

namespace arealab {
namespace {

class LightRandom {
 public:
  explicit LightRandom(unsigned seed) : engine_(seed) {}
  double Uniform(double low, double high) { return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0); }
  glm::dvec3 Direction() {
    const double z = Uniform(-1.0, 1.0), angle = Uniform(0.0, glm::two_pi<double>()), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937 engine_;
};

// A light and what it shades, in the light's frame.
struct FlatLight {
  bool disk = false;
  glm::dvec2 half{1.0};
  glm::dvec3 point{0.0}, normal{0.0};

  double Area() const { return disk ? glm::pi<double>() * half.x * half.x : 4.0 * half.x * half.y; }
  double SolidAngle() const { return disk ? dual::DiskSolidAngle(point, half.x) : dual::RectangleSolidAngle(point, half); }
  glm::dvec2 Closest(const glm::dvec2& p) const { return disk ? dual::ClosestOnDisk({}, p, half.x) : dual::ClosestOnRectangle({}, p, half); }
  // The form factor as eq. 1.15 takes it at a point of the light's plane.
  double At(const glm::dvec2& p) const {
    const glm::dvec3 to_light(p - glm::dvec2(point), -point.z);
    return std::max(glm::dot(normal, to_light), 0.0) / glm::length(to_light) * SolidAngle() / glm::pi<double>();
  }
  double FormFactor() const;
};

double FlatLight::FormFactor() const {
  // To a frame whose z is the surface's normal.
  const glm::dvec3 x = glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0)));
  const glm::dmat3 surface_from_light = glm::transpose(glm::dmat3(x, glm::cross(normal, x), normal));
  if (disk) {
    const LightCone cone = DiskCone(surface_from_light * -point, surface_from_light * glm::dvec3(0.0, 0.0, 1.0), half.x);
    return ConeFormFactor(cone, ClipToHorizon(cone));
  }
  std::array<glm::dvec3, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2 corner(i == 0 || i == 3 ? half.x : -half.x, i < 2 ? half.y : -half.y);
    corners[i] = surface_from_light * (glm::dvec3(corner, 0.0) - point);
  }
  return std::abs(PolygonFormFactor(ClipToHorizon(corners)));
}

FlatLight RandomLight(LightRandom& random, bool disk) {
  FlatLight light;
  light.disk = disk;
  light.half = {random.Uniform(0.2, 1.0), random.Uniform(0.2, 1.0)};
  if (disk) light.half.y = light.half.x;
  const glm::dvec3 to_point = random.Direction();  // first: compilers order operands as they like
  light.point = random.Uniform(1.0, 4.0) * to_point;
  light.point.z = std::abs(light.point.z);
  light.normal = random.Direction();
  return light;
}

double Share(const auto& clipped) { return (clipped.high.x - clipped.low.x) * (clipped.high.y - clipped.low.y) / 4.0; }

}  // namespace

std::vector<RepresentativePointErrors> RerunDrobotPoints(int lights, unsigned seed) {
  std::vector<RepresentativePointErrors> results;
  for (const bool facing : {true, false}) {
    for (const char* form : {"closest", "halfway", "plane", "sum"}) results.push_back({form, facing, lights});
  }
  LightRandom random(seed);
  for (std::size_t group = 0; group < results.size(); group += 4) {
    for (int done = 0; done < lights;) {
      const FlatLight light = RandomLight(random, done % 2 == 1);
      const bool faces = light.normal.z < 0.0;
      const bool above = glm::dot(light.normal, -light.point) > glm::length(light.half);
      if (!above || light.point.z < 0.05 || faces != results[group].facing) continue;
      ++done;
      const glm::dvec2 foot(light.point), normal_hit = dual::NormalHit(light.point, light.normal);
      const glm::dvec2 p_c = light.Closest(foot + normal_hit), p_r = light.Closest(foot + dual::NearestHit(light.point, light.normal));
      const double integral = light.FormFactor();
      glm::dvec2 best = p_c;
      for (int i = 1; i <= 400; ++i) {
        const glm::dvec2 p = glm::mix(p_c, p_r, i / 400.0);
        if (std::abs(light.At(p) - integral) < std::abs(light.At(best) - integral)) best = p;
      }
      const glm::dvec2 on_plane = foot + dual::unit::HalfwayHit(light.point, normal_hit, glm::dvec2(0.0));
      const std::array points{foot + dual::unit::HalfwayHit(light.point, p_c - foot, p_r - foot), light.Closest(on_plane), on_plane,
                              foot + dual::sum::HalfwayHit(light.point, normal_hit, glm::dvec2(0.0))};
      for (std::size_t form = 0; form < points.size(); ++form) {
        RepresentativePointErrors& r = results[group + form];
        r.distance += glm::length(points[form] - best) / std::sqrt(light.Area()) / lights;
        r.from_best += std::abs(light.At(points[form]) / light.At(best) - 1.0) / lights;
        r.from_integral += std::abs(light.At(points[form]) / integral - 1.0) / lights;
      }
    }
  }
  return results;
}

std::vector<ClippedArea> MayauxAreaCurve(int steps, double azimuth, const glm::dvec3& point) {
  const glm::dvec2 half(1.0);
  const std::array<glm::dvec2, 4> corners{{{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}}};
  std::vector<ClippedArea> curve;
  for (int step = 0; step <= steps; ++step) {
    const double tilt = glm::pi<double>() * step / steps;
    const double turn = glm::radians(azimuth);
    const glm::dvec3 normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt));
    // Exact: the corners' heights over the horizon as z make it the closed forms' polygon.
    double exact = 0.0;
    std::array<glm::dvec3, 4> raised;
    for (std::size_t i = 0; i < 4; ++i) raised[i] = {corners[i], glm::dot(glm::dvec3(corners[i], 0.0) - point, normal)};
    const HorizonPolygon kept = ClipToHorizon(raised);
    for (int i = 0; i < kept.count; ++i) {
      const glm::dvec3 p = kept.corners[static_cast<std::size_t>(i)], q = kept.corners[static_cast<std::size_t>((i + 1) % kept.count)];
      exact += 0.5 * (p.x * q.y - p.y * q.x) / 4.0;
    }
    curve.push_back({glm::degrees(tilt), Share(dual::documented::ClipToRectangle(point, normal, half)),
                     Share(dual::printed::ClipToRectangle(point, normal, half)), exact});
  }
  return curve;
}

}  // namespace arealab
