// Drobot, Physically Based Area Lights, GPU Pro 5.
#include <fmt/format.h>

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
  found.figures.push_back({"with the halfway vector as the pseudo code prints it, of vectors that are not of length 1", Rerun("sum", true).from_best, ""});
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

// A floor seen aslant, and over it, upright, a rectangle that reflects in it, turned in its own plane: a strip of 1.6 × 0.2 m, or a
// square as large. Points of the floor, row by row from the viewer.
constexpr int kFloorColumns = 11, kFloorRows = 15;
std::vector<PointCase> OverTheFloor(bool strip, double turn) {
  const double a = turn * 3.14159265358979323846 / 180.0;
  std::vector<PointCase> cases;
  for (int row = 0; row < kFloorRows; ++row) {
    for (int column = 0; column < kFloorColumns; ++column) {
      PointCase c;
      c.position = {-1.0 + 2.0 * column / (kFloorColumns - 1), -1.8 + 3.2 * row / (kFloorRows - 1), 0.0};
      c.to_view = glm::normalize(glm::dvec3(0.0, -4.0, 1.2) - c.position);
      c.roughness = 0.35;
      c.center = {0.0, 1.5, 0.95};
      c.light_normal = {0.0, -1.0, 0.0};
      c.axis_x = {std::cos(a), 0.0, std::sin(a)};
      c.axis_y = glm::cross(c.light_normal, c.axis_x);
      c.half_size = strip ? glm::dvec2(0.8, 0.1) : glm::dvec2(std::sqrt(0.08));
      cases.push_back(c.Rounded());
    }
  }
  return cases;
}

// Of the specular lobe over that floor: his form and the truth.
struct OnTheFloor {
  std::vector<double> his, truth;
  double Error() const {  // relative RMSE
    double squares = 0.0, reference = 0.0;
    for (std::size_t i = 0; i < his.size(); ++i) {
      squares += (his[i] - truth[i]) * (his[i] - truth[i]);
      reference += truth[i] * truth[i];
    }
    return std::sqrt(squares / reference);
  }
};
OnTheFloor ShadeFloor(ClaimBench& bench, Brdf brdf, bool strip, double turn) {
  const std::vector<PointCase> cases = OverTheFloor(strip, turn);
  OnTheFloor floor;
  for (const Shaded& s : bench.Shade("drobot@published", cases, Precision::kFloat, brdf)) floor.his.push_back(s.specular);
  for (const PointCase& c : cases) floor.truth.push_back(c.Truth(1e-3, brdf).specular);
  return floor;
}

Finding PhongAloneForRectangles(ClaimBench& bench) {
  Finding found;
  found.plot = {"distance along the floor from below the strip, m", "specular of a strip across the view, of its radiance", {}};
  double worst[2] = {0.0, 0.0};
  for (const Brdf brdf : {Brdf::kPhong, Brdf::kBlinnPhong}) {
    const std::string name = brdf == Brdf::kPhong ? "Phong" : "Blinn-Phong";
    for (const double turn : {0.0, 45.0, 90.0}) {
      const OnTheFloor floor = ShadeFloor(bench, brdf, true, turn);
      found.figures.push_back({fmt::format("{}, the strip turned by {:g}°: relative RMSE", name, turn), 100.0 * floor.Error(), "%"});
      double& largest = worst[brdf == Brdf::kPhong ? 0 : 1];
      largest = std::max(largest, floor.Error());
      if (turn > 0.0) continue;
      ClaimCurve his{name + ", drobot@published", {}}, truth{name + ", truth", {}};
      for (int row = 0; row < kFloorRows; ++row) {
        const auto i = static_cast<std::size_t>(row * kFloorColumns + kFloorColumns / 2);
        const double distance = 1.5 - (-1.8 + 3.2 * row / (kFloorRows - 1));
        his.points.emplace_back(distance, floor.his[i]);
        truth.points.emplace_back(distance, floor.truth[i]);
      }
      found.plot.curves.push_back(his);
      found.plot.curves.push_back(truth);
    }
  }
  found.verdict = worst[1] > 1.5 * worst[0] ? Verdict::kHolds : worst[1] > 1.1 * worst[0] ? Verdict::kPartly : Verdict::kFails;
  found.note = "Across the view a Blinn-Phong lobe is drawn out over several strips: he takes one point and a round cone, so the streak is cut off short and as much brighter.";
  return found;
}

Finding SquaresAreBearable(ClaimBench& bench) {
  Finding found;
  double worst[2] = {0.0, 0.0};
  for (const bool strip : {true, false}) {
    for (const double turn : {0.0, 45.0, 90.0}) worst[strip] = std::max(worst[strip], ShadeFloor(bench, Brdf::kBlinnPhong, strip, turn).Error());
  }
  found.figures = {{"a strip of 1.6 × 0.2 m, at its worst turn: relative RMSE", 100.0 * worst[1], "%"}, {"a square as large", 100.0 * worst[0], "%"}};
  found.verdict = worst[0] < worst[1] / 1.5 ? Verdict::kHolds : worst[0] < worst[1] ? Verdict::kPartly : Verdict::kFails;
  return found;
}

}  // namespace

ClaimSource DrobotClaims() {
  return {"drobot", "Drobot 2014", "Physically Based Area Lights",
          {{"§ 1.3.3", "The half vector between the closest points p_c and p_r finds a point within 0.05 of the best one.", "the irradiance is within 0.05 of the best point's, whether the light faces the surface or not; partly where it does",
            "arealab claims --source drobot", ClosestPointsAreAccurate},
           {"§ 1.3.3", "Without the closest points, by p' and p'' alone, the error is more than 0.15, and good enough.", "the irradiance is off by 0.15 to 0.3; partly where by more",
            "arealab claims --source drobot", TheShortcutIsWorse},
           {"§ 1.5", "With a Blinn-Phong lobe a rectangle shows artefacts that it does not show with Phong's: he ships rectangles with Phong alone.", "a strip's reflection is off by half as much again, at its worst turn, as with Phong; partly by a tenth",
            "arealab claims --source drobot", PhongAloneForRectangles},
           {"§ 1.6", "They are bearable where the rectangle is close to a square.", "a square is off by less than two thirds of what the strip is, with Blinn-Phong",
            "arealab claims --source drobot", SquaresAreBearable},
           {"§ 1.3.3", "The disparity shows mostly where the light points away from the surface's normal.", "the error there is more than a quarter larger",
            "arealab claims --source drobot", WorseForLightsThatFaceAway},
           {"§ 1.4.2", "A sphere's diffuse integral has a closed form in its place and radius.", "it is exact to 1e-5", "arealab stress --technique drobot", SphereIsClosed},
           {"Table 1.1", "A sphere adds little to a point light's instructions, a disk more, a rectangle most: 30, 139 and 160.", "the order is his and the rectangle adds within 50 % of his", "arealab cost --claims", TableOfGrowth, true}}};
}

}  // namespace arealab
