// Polygonal Area Light Sources on DX11-Class Hardware, 2013.
#include <algorithm>
#include <cmath>

#include "compare/claims.h"

namespace arealab {
namespace {

std::vector<PointCase> Receding(const std::vector<double>& distances) {
  std::vector<PointCase> cases;
  for (const double d : distances) {
    PointCase c;
    c.center = {0.0, 0.0, d};
    cases.push_back(c);
  }
  return cases;
}

// Lights of all sizes and places in the upper half and across the horizon, from a fixed low-discrepancy sequence.
std::vector<PointCase> ManyLights() {
  std::vector<PointCase> cases;
  for (int i = 1; i <= 500; ++i) {
    const auto halton = [i](int base) {
      double f = 1.0, r = 0.0;
      for (int n = i; n > 0; n /= base) r += (f /= base) * (n % base);
      return r;
    };
    PointCase c;
    const double z = 1.2 * halton(2) - 0.2, phi = 6.283185307179586 * halton(3), s = std::sqrt(std::max(1.0 - z * z, 0.0));
    c.center = {s * std::cos(phi), s * std::sin(phi), z};
    c.light_normal = -glm::normalize(c.center + 0.5 * glm::dvec3(halton(5) - 0.5, halton(7) - 0.5, halton(11) - 0.5));
    c.axis_x = glm::normalize(glm::cross(c.light_normal, std::abs(c.light_normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
    c.axis_y = glm::cross(c.light_normal, c.axis_x);
    c.half_size = {0.1 + 0.4 * halton(13), 0.1 + 0.4 * halton(17)};
    cases.push_back(c);
  }
  return cases;
}

Finding UnitLosesFallOff(ClaimBench& bench) {
  const auto distances = Steps(0.5, 10.0, 96);
  const auto cases = Receding(distances);
  const auto unit = bench.Shade("light_field@published", cases), irradiance = bench.Shade("light_field", cases);
  ClaimCurve first{"vector=unit", {}}, second{"vector=irradiance", {}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    first.points.emplace_back(distances[i], unit[i].diffuse / unit[0].diffuse);
    second.points.emplace_back(distances[i], irradiance[i].diffuse / irradiance[0].diffuse);
  }
  Finding found;
  const double kept = unit.back().diffuse / unit[0].diffuse, exact = cases.back().Truth().form_factor / cases[0].Truth().form_factor;
  found.figures = {{"left at 10 m of the light at 0.5 m, normalised", 100.0 * kept, "%"}, {"exact", 100.0 * exact, "%"}};
  found.verdict = std::abs(kept / exact - 1.0) < 0.01 ? Verdict::kHolds : Verdict::kFails;
  found.note = "What normalising takes away is the form factor, not a uniform scale: a light is as bright from afar as from near.";
  found.plot = {"distance, m", "diffuse over that at 0.5 m", {first, second}};
  return found;
}

Finding ArvoIsExact(ClaimBench& bench) {
  const auto cases = ManyLights();
  const auto shaded = bench.Shade("light_field", cases);
  double largest = 0.0, peak = 0.0;
  std::vector<double> errors;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double exact = cases[i].Rounded().Truth(1e-8).form_factor;
    peak = std::max(peak, exact);
    errors.push_back(std::abs(shaded[i].diffuse - exact));
    largest = std::max(largest, errors.back());
  }
  Finding found;
  found.figures = {{"largest error of 500 lights, vector=irradiance, float", largest, "of π L"}, {"median", Percentile(errors, 0.5), "of π L"}};
  found.verdict = largest < 1e-5 ? Verdict::kHolds : largest < 1e-3 ? Verdict::kPartly : Verdict::kFails;
  return found;
}

Finding EarlyTestSaves(ClaimBench& bench) {
  Finding found;
  const GpuCost cost = bench.Cost("light_field@published");
  if (!cost.paths.contains("above") || !cost.paths.contains("crossing") || !cost.paths.contains("below")) {
    found.note = "The text has no early test.";
    return found;
  }
  const double above = cost.paths.at("above").cycles, crossing = cost.paths.at("crossing").cycles, below = cost.paths.at("below").cycles;
  found.figures = {{"light wholly above the horizon", above, "cycles"}, {"crossing it", crossing, "cycles"}, {"wholly below", below, "cycles"}};
  found.verdict = above < 0.9 * crossing && below < 0.5 * crossing ? Verdict::kHolds : above < crossing ? Verdict::kPartly : Verdict::kFails;
  return found;
}

Finding MustClip(ClaimBench& bench) {
  // A light that straddles the horizon: what its lower part would take away.
  PointCase c;
  c.center = {0.0, 1.0, 0.0};
  c.light_normal = {0.0, -1.0, 0.0};
  c.axis_y = glm::cross(c.light_normal, c.axis_x);
  Finding found;
  const double clipped = bench.Shade("light_field", {c})[0].diffuse, unclipped = bench.Shade("ltc+clip=none", {c})[0].diffuse, exact = c.Truth().form_factor;
  found.figures = {{"half below the horizon: clipped, of the exact value", 100.0 * clipped / exact, "%"}, {"unclipped (ltc+clip=none)", 100.0 * unclipped / exact, "%"}};
  found.verdict = std::abs(clipped / exact - 1.0) < 1e-3 && unclipped < 0.9 * exact ? Verdict::kHolds : Verdict::kFails;
  return found;
}

}  // namespace

ClaimSource LightFieldClaims() {
  return {"light_field", "Light field 2013", "Polygonal Area Light Sources on DX11-Class Hardware",
          {{"Introduction", "Arvo's weighted sum of edge normals over 2π is all that area lighting needs.", "the diffuse lobe is exact to 1e-5, clipped", "arealab stress --technique light_field", ArvoIsExact},
           {"Basic HLSL code", "The factor 1/2π may go, since normalising the vector makes it a mere uniform scale.", "fall-off with distance stays within 1 %", "arealab sweep distance --technique light_field@published --technique light_field", UnitLosesFallOff},
           {"Introduction", "The polygon must be clipped against the plane of the shaded point: a valid light may straddle it.", "the clipped value is exact and the unclipped one is not", "arealab compare sinking --technique light_field --technique ltc+clip=none", MustClip},
           {"Clipping", "An early test of wholly above and wholly below spares most pixels the clipping.", "a light above costs less than 90 %, one below less than half of one that crosses", "arealab cost --gpu bonaire --technique light_field@published", EarlyTestSaves, true}}};
}

}  // namespace arealab
