// Drobot, Physically Based Area Lights, GPU Pro 5.
#include <algorithm>
#include <cmath>

#include "compare/claims.h"
#include "compare/source_experiments.h"

namespace arealab {
namespace {

// Several hundred disks and rectangles above the horizon that face the point (§ 1.3.3).
std::vector<PointCase> RandomLights() {
  std::vector<PointCase> cases;
  for (int i = 1; i <= 400; ++i) {
    const auto halton = [i](int base) {
      double f = 1.0, r = 0.0;
      for (int n = i; n > 0; n /= base) r += (f /= base) * (n % base);
      return r;
    };
    PointCase c;
    c.shape = i % 2 == 0 ? LightShape::kDisk : LightShape::kRectangle;
    const double z = 0.3 + 0.7 * halton(2), phi = 6.283185307179586 * halton(3), s = std::sqrt(1.0 - z * z);
    c.center = (0.8 + 1.2 * halton(5)) * glm::dvec3(s * std::cos(phi), s * std::sin(phi), z);
    c.light_normal = -glm::normalize(glm::normalize(c.center) + 0.8 * glm::dvec3(halton(7) - 0.5, halton(11) - 0.5, halton(13) - 0.5));
    c.axis_x = glm::normalize(glm::cross(c.light_normal, std::abs(c.light_normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
    c.axis_y = glm::cross(c.light_normal, c.axis_x);
    c.half_size = glm::dvec2(0.1 + 0.2 * halton(17));
    cases.push_back(c);
  }
  return cases;
}

Finding TableOfGrowth(ClaimBench& bench) {
  Finding found;
  const double point = bench.Cost("point").full.instructions;
  const auto added = [&](const char* shape) { return bench.Cost("drobot@published", shape).full.instructions - point; };
  const double sphere = added("sphere"), disk = added("disk"), rectangle = added("rectangle");
  // Table 1.1, less its point light.
  found.figures = {{"instructions added: his sphere", 252 - 222, ""}, {"ours", sphere, ""}, {"his disk", 361 - 222, ""}, {"ours", disk, ""}, {"his rectangle", 382 - 222, ""}, {"ours", rectangle, ""}};
  const bool order = sphere < disk && disk < rectangle;
  found.verdict = order && std::abs(rectangle / 160.0 - 1.0) < 0.5 ? Verdict::kHolds : order ? Verdict::kPartly : Verdict::kFails;
  found.note = "His are scalar ALU operations of a shadowed deferred shader with Blinn-Phong, ours all instructions of a pass with GGX and Fresnel.";
  return found;
}

Finding SphereIsClosed(ClaimBench& bench) {
  std::vector<PointCase> cases;
  for (PointCase c : RandomLights()) {
    c.shape = LightShape::kSphere;
    cases.push_back(c);
  }
  const auto shaded = bench.Shade("drobot", cases);
  double largest = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) largest = std::max(largest, std::abs(shaded[i].diffuse - cases[i].Truth(1e-8).form_factor));
  Finding found;
  found.figures = {{"largest error of 400 spheres, float", largest, "of π L"}};
  found.verdict = largest < 1e-5 ? Verdict::kHolds : largest < 1e-3 ? Verdict::kPartly : Verdict::kFails;
  return found;
}

// § 1.3.3 rerun, or nothing where the form is unknown.
RepresentativePointErrors Rerun(const std::string& form, bool facing) {
  static const std::vector<RepresentativePointErrors> experiment = RerunDrobotPoints();
  for (const RepresentativePointErrors& errors : experiment) {
    if (errors.form == form && errors.facing == facing) return errors;
  }
  return {};
}

Finding Experiment(const RepresentativePointErrors& facing, const RepresentativePointErrors& away) {
  Finding found;
  found.figures = {{"irradiance, from the best point's", facing.from_best, ""},
                   {"the same, lights that face away", away.from_best, ""},
                   {"irradiance, from the integral", facing.from_integral, ""},
                   {"the point, from the best one", facing.distance, "of the root of the light's area"}};
  found.note = "Means over 600 lights; his measure is not stated.";
  return found;
}

Finding ClosestPointsAreAccurate(ClaimBench&) {
  const RepresentativePointErrors facing = Rerun("closest", true), away = Rerun("closest", false);
  Finding found = Experiment(facing, away);
  found.verdict = facing.from_best < 0.05 && away.from_best < 0.05 ? Verdict::kHolds : facing.from_best < 0.05 ? Verdict::kPartly : Verdict::kFails;
  return found;
}

Finding TheShortcutIsWorse(ClaimBench&) {
  const RepresentativePointErrors facing = Rerun("plane", true), away = Rerun("plane", false);
  Finding found = Experiment(facing, away);
  found.figures.push_back({"with the point brought onto the light, from the best point's", Rerun("halfway", true).from_best, ""});
  found.verdict = facing.from_best > 0.15 && facing.from_best < 0.3 ? Verdict::kHolds : facing.from_best > 0.15 ? Verdict::kPartly : Verdict::kFails;
  return found;
}

Finding WorseForLightsThatFaceAway(ClaimBench&) {
  Finding found;
  const double facing = Rerun("halfway", true).from_best, away = Rerun("halfway", false).from_best;
  found.figures = {{"lights that face the surface", facing, ""}, {"lights that face away", away, ""}};
  found.verdict = away > 1.25 * facing ? Verdict::kHolds : away > facing ? Verdict::kPartly : Verdict::kFails;
  return found;
}

}  // namespace

ClaimSource DrobotClaims() {
  return {"drobot", "Drobot 2014", "Physically Based Area Lights",
          {{"§ 1.3.3", "The half vector between the closest points p_c and p_r finds a point within 0.05 of the best one.", "the irradiance is within 0.05 of the best point's, whether the light faces the surface or not; partly where it does",
            "arealab claims --source drobot", ClosestPointsAreAccurate},
           {"§ 1.3.3", "Without the closest points, by p' and p'' alone, the error is more than 0.15, and good enough.", "the irradiance is off by 0.15 to 0.3; partly where by more",
            "arealab claims --source drobot", TheShortcutIsWorse},
           {"§ 1.3.3", "The disparity shows mostly where the light points away from the surface's normal.", "the error there is more than a quarter larger",
            "arealab claims --source drobot", WorseForLightsThatFaceAway},
           {"§ 1.4.2", "A sphere's diffuse integral has a closed form in its place and radius.", "it is exact to 1e-5", "arealab stress --technique drobot", SphereIsClosed},
           {"Table 1.1", "A sphere adds little to a point light's instructions, a disk more, a rectangle most: 30, 139 and 160.", "the order is his and the rectangle adds within 50 % of his", "arealab cost --claims", TableOfGrowth, true}}};
}

}  // namespace arealab
