// Mayaux, Adding Area Lights.
#include <algorithm>
#include <cmath>

#include "compare/claims.h"
#include "compare/source_experiments.h"

namespace arealab {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

// A square light 1 m ahead; the surface's plane turns from facing it to facing away, about an axis at `spin` degrees.
std::vector<PointCase> TiltedPlane(double spin, const std::vector<double>& tilts) {
  std::vector<PointCase> cases;
  for (const double tilt : tilts) {
    PointCase c;
    c.center = {0.0, 0.0, 1.0};
    c.half_size = {0.8, 0.8};
    c.normal = {std::sin(tilt * kDegree) * std::cos(spin * kDegree), std::sin(tilt * kDegree) * std::sin(spin * kDegree), std::cos(tilt * kDegree)};
    c.to_view = c.normal;
    cases.push_back(c);
  }
  return cases;
}

std::vector<double> Diffuse(ClaimBench& bench, const char* variant, const std::vector<PointCase>& cases) {
  std::vector<double> values;
  for (const Shaded& s : bench.Shade(variant, cases, Precision::kDouble)) values.push_back(s.diffuse);
  return values;
}

Finding AreaIsContinuous(ClaimBench& bench) {
  const auto jump = [&](int count) {
    double largest = 0.0;
    for (const double spin : {0.0, 15.0, 30.0, 45.0}) {
      const auto values = Diffuse(bench, "mayaux@published", TiltedPlane(spin, Steps(20.0, 135.0, count)));
      for (std::size_t i = 1; i < values.size(); ++i) largest = std::max(largest, std::abs(values[i] - values[i - 1]) / values[0]);
    }
    return largest;
  };
  const double coarse = jump(461), fine = jump(4601);
  Finding found;
  found.figures = {{"largest change in a quarter of a degree", 100.0 * coarse, "%"}, {"in a fortieth", 100.0 * fine, "%"}};
  found.verdict = fine < 0.2 * coarse ? Verdict::kHolds : fine < 0.5 * coarse ? Verdict::kPartly : Verdict::kFails;
  return found;
}

// The surface's plane upright through the square's middle, turning about the square's axis: half of the light is above it at any turn.
Finding AreaBounces(ClaimBench&) {
  Finding found;
  found.plot = {"turn of an upright plane, degrees", "share of the light's area that is kept", {{"his rectangle", {}}, {"exact", {}}}};
  double least = 1.0, most = 0.0, least_exact = 1.0, most_exact = 0.0;
  for (const double turn : Steps(0.0, 180.0, 181)) {
    const ClippedArea cut = MayauxAreaCurve(2, turn).at(1);
    found.plot.curves[0].points.emplace_back(turn, cut.documented);
    found.plot.curves[1].points.emplace_back(turn, cut.exact);
    least = std::min(least, cut.documented), most = std::max(most, cut.documented);
    least_exact = std::min(least_exact, cut.exact), most_exact = std::max(most_exact, cut.exact);
  }
  found.figures = {{"the kept area swings by", 100.0 * (most - least), "% of the light's"}, {"the exact one by", 100.0 * (most_exact - least_exact), "%"}};
  found.verdict = most - least > 0.1 && most_exact - least_exact < 1e-6 ? Verdict::kHolds : Verdict::kFails;
  found.note = "It grows until the plane passes through two corners, where it turns back at once.";
  return found;
}

Finding AreaIsGoodEnough(ClaimBench&) {
  Finding found;
  found.plot = {"tilt of the plane, degrees", "share of the light's area that is kept", {{"his rectangle, about the diagonal", {}}, {"exact", {}}}};
  double mean = 0.0, largest = 0.0;
  int count = 0;
  for (const double azimuth : Steps(0.0, 45.0, 10)) {
    for (const ClippedArea& cut : MayauxAreaCurve(180, azimuth)) {
      mean += std::abs(cut.documented - cut.exact);
      largest = std::max(largest, std::abs(cut.documented - cut.exact));
      ++count;
      if (azimuth < 45.0) continue;
      found.plot.curves[0].points.emplace_back(cut.degrees, cut.documented);
      found.plot.curves[1].points.emplace_back(cut.degrees, cut.exact);
    }
  }
  mean /= count;
  found.figures = {{"mean difference from the exact share, over tilts and turns", 100.0 * mean, "% of the light's area"}, {"largest, a diagonal cut", 100.0 * largest, "%"}};
  found.verdict = largest < 0.1 ? Verdict::kHolds : mean < 0.1 ? Verdict::kPartly : Verdict::kFails;
  return found;
}

Finding NoConditionsAreCheaper(ClaimBench& bench) {
  Finding found;
  const double fake = bench.Cost("mayaux@published").core.cycles, exact = bench.Cost("light_field+clip=stream").core.cycles,
               branchless = bench.Cost("light_field").core.cycles;
  found.figures = {{"mayaux@published", fake, "cycles"}, {"light_field+clip=stream, clipped with conditions", exact, "cycles"}, {"light_field, clipped exactly without", branchless, "cycles"}};
  found.verdict = fake < exact ? Verdict::kHolds : Verdict::kFails;
  found.note = "Whole techniques on bonaire, estimated: their specular parts differ too.";
  return found;
}

}  // namespace

ClaimSource MayauxClaims() {
  return {"mayaux", "Mayaux 2017", "Adding Area Lights",
          {{"Fake Clipping", "The area returned is continuous: nothing jumps as the plane turns.", "the largest change shrinks to a fifth as steps shrink to a tenth",
            "arealab stress --technique mayaux@published", AreaIsContinuous},
           {"Fake Clipping", "The area bounces: it stops growing and shrinks again, as the plane turns.", "the kept area swings by more than a tenth where the exact one stays",
            "arealab claims --source mayaux", AreaBounces},
           {"Fake Clipping", "A rectangle approximates the cut well enough.", "the share that is kept is off by less than a tenth at any tilt; partly where it is in the mean",
            "arealab claims --source mayaux", AreaIsGoodEnough},
           {"Fake Clipping", "Clipping without conditions avoids an expensive routine.", "it takes fewer cycles than a technique that clips side by side",
            "arealab cost --gpu bonaire --technique mayaux@published --technique light_field+clip=stream", NoConditionsAreCheaper, true}}};
}

}  // namespace arealab
