// Oat, Ambient Aperture Lighting.
#include <algorithm>
#include <cmath>

#include "compare/claims.h"

namespace arealab {
namespace {

// A sun of radius 20 degrees that sets; nothing is baked, so the aperture is the hemisphere.
std::vector<PointCase> SettingSun(const std::vector<double>& elevations) {
  std::vector<PointCase> cases;
  for (const double degrees : elevations) {
    const double a = degrees * 3.14159265358979323846 / 180.0;
    PointCase c;
    c.shape = LightShape::kSphere;
    c.center = 10.0 * glm::dvec3(std::cos(a), 0.0, std::sin(a));
    c.half_size = glm::dvec2(10.0 * std::sin(20.0 * 3.14159265358979323846 / 180.0));
    c.light_normal = -glm::normalize(c.center);
    c.axis_x = {0.0, 1.0, 0.0};
    c.axis_y = glm::cross(c.light_normal, c.axis_x);
    cases.push_back(c);
  }
  return cases;
}

Finding SmoothstepSuffices(ClaimBench& bench) {
  const auto elevations = Steps(-25.0, 90.0, 231);
  const auto cases = SettingSun(elevations);
  const auto exact = bench.Shade("oat+centroid=average", cases), smooth = bench.Shade("oat+overlap=smoothstep+centroid=average", cases);
  double peak = 0.0, largest = 0.0;
  for (const Shaded& s : exact) peak = std::max(peak, s.diffuse);
  ClaimCurve first{"overlap=exact", {}}, second{"overlap=smoothstep", {}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    largest = std::max(largest, std::abs(smooth[i].diffuse - exact[i].diffuse));
    first.points.emplace_back(elevations[i], exact[i].diffuse);
    second.points.emplace_back(elevations[i], smooth[i].diffuse);
  }
  Finding found;
  found.figures = {{"largest difference", 100.0 * largest / peak, "% of the peak"}};
  found.verdict = largest < 0.05 * peak ? Verdict::kHolds : largest < 0.15 * peak ? Verdict::kPartly : Verdict::kFails;
  found.plot = {"elevation of the sun, degrees", "diffuse, of the light's radiance", {first, second}};
  return found;
}

Finding AveragedCentroid(ClaimBench& bench) {
  const auto elevations = Steps(-25.0, 90.0, 116);
  const auto cases = SettingSun(elevations);
  const auto average = bench.Shade("oat+centroid=average", cases), overlap = bench.Shade("oat", cases);
  ClaimCurve first{"centroid=average", {}}, second{"centroid=overlap", {}}, third{"exact", {}};
  double largest = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double exact = cases[i].Truth().form_factor;
    first.points.emplace_back(elevations[i], average[i].diffuse);
    second.points.emplace_back(elevations[i], overlap[i].diffuse);
    third.points.emplace_back(elevations[i], exact);
    if (elevations[i] == 30.0 && exact > 0.0) largest = average[i].diffuse / exact;
  }
  Finding found;
  found.figures = {{"over the exact value, sun at 60° from the normal", largest, ""}};
  found.verdict = std::abs(largest - 1.0) < 0.1 ? Verdict::kHolds : std::abs(largest - 1.0) < 0.3 ? Verdict::kPartly : Verdict::kFails;
  found.note = "Over an open hemisphere the average of the two axes stands twice as high as the sun.";
  found.plot = {"elevation of the sun, degrees", "diffuse, of the light's radiance", {first, second, third}};
  return found;
}

Finding SmoothstepIsCheaper(ClaimBench& bench) {
  Finding found;
  const double smooth = bench.Cost("oat+overlap=smoothstep+centroid=average", "sphere").core.cycles, exact = bench.Cost("oat+centroid=average", "sphere").core.cycles;
  found.figures = {{"by smoothstep", smooth, "cycles"}, {"exact, without the cancelling form that he shows", exact, "cycles"}};
  found.verdict = smooth < 0.8 * exact ? Verdict::kHolds : smooth < exact ? Verdict::kPartly : Verdict::kFails;
  return found;
}

}  // namespace

ClaimSource OatClaims() {
  return {"oat", "Oat 2006", "Ambient Aperture Lighting",
          {{"Quality comparison", "A smoothstep between touching and containing looks like the exact intersection of two caps.", "the diffuse lobe differs by less than 5 % of its peak",
            "arealab compare bulbs --technique oat+overlap=smoothstep+centroid=average --technique oat+centroid=average", SmoothstepSuffices},
           {"Smoothstep saves the day", "The exact intersection is too dear; the smoothstep is cheap.", "it takes less than 80 % of the cycles",
            "arealab cost --gpu bonaire --effects sphere,diffuse,specular,fresnel --technique oat+overlap=smoothstep+centroid=average --technique oat+centroid=average", SmoothstepIsCheaper, true},
           {"Don't forget Lambert", "Averaging the aperture's and the light's axes is a fair estimate of the centroid: errors above and below cancel.", "the sun 60° from the normal is within 10 %",
            "arealab compare bulbs --technique oat+centroid=average --technique oat", AveragedCentroid}}};
}

}  // namespace arealab
