// Hill & Heitz 2016, Real-Time Area Lighting: a Journey from Research to Production.
#include <algorithm>
#include <cmath>

#include "compare/claims.h"

namespace arealab {
namespace {

// A smooth floor from below a bright panel outwards.
std::vector<PointCase> SmoothFloor() {
  std::vector<PointCase> cases;
  for (const double x : Steps(-2.0, 2.0, 401)) {
    PointCase c;
    c.position = {x, 0.0, 0.0};
    c.to_view = glm::normalize(glm::dvec3(-0.3, -0.6, 0.7));
    c.roughness = 0.15;
    c.center = {0.0, 1.5, 1.0};
    c.light_normal = glm::normalize(glm::dvec3(0.0, -1.0, -0.4));
    c.axis_x = {1.0, 0.0, 0.0};
    c.axis_y = glm::cross(c.light_normal, c.axis_x);
    c.half_size = {0.6, 0.4};
    cases.push_back(c);
  }
  return cases;
}

// A floor that runs up to a panel that stands half below it.
std::vector<PointCase> SunkenPanel() {
  std::vector<PointCase> cases;
  for (const double distance : Steps(0.05, 2.0, 200)) {
    PointCase c;
    c.position = {0.0, -distance, 0.0};
    c.to_view = glm::normalize(glm::dvec3(0.0, -1.0, 1.0));
    c.roughness = 0.5;
    c.center = {0.0, 0.0, 0.1};
    c.light_normal = {0.0, -1.0, 0.0};
    c.axis_x = {1.0, 0.0, 0.0};
    c.axis_y = glm::cross(c.light_normal, c.axis_x);
    c.half_size = {0.5, 0.5};
    cases.push_back(c);
  }
  return cases;
}

// A sharp highlight that sinks towards the horizon.
std::vector<PointCase> SinkingView(std::vector<double>* angles) {
  std::vector<PointCase> cases;
  for (const double degrees : Steps(75.0, 88.0, 400)) {
    const double a = degrees * 3.14159265358979323846 / 180.0;
    PointCase c;
    c.to_view = {std::sin(a), 0.0, std::cos(a)};
    c.roughness = 0.08;
    const glm::dvec3 mirror{-std::sin(a), 0.0, std::cos(a)};
    c.center = 2.0 * mirror;
    c.light_normal = -mirror;
    c.axis_x = {0.0, 1.0, 0.0};
    c.axis_y = glm::cross(c.light_normal, c.axis_x);
    c.half_size = {0.05, 0.02};
    cases.push_back(c);
    angles->push_back(degrees);
  }
  return cases;
}

std::vector<double> Lobe(const std::vector<Shaded>& shaded, bool specular) {
  std::vector<double> values;
  for (const Shaded& s : shaded) values.push_back(specular ? s.specular : s.diffuse);
  return values;
}

// |a/b − 1| where b is above a thousandth of its largest, and the curve of a/b − 1 in percent.
double LargestRatioError(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& x, ClaimCurve* curve) {
  const double least = 1e-3 * *std::max_element(b.begin(), b.end());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(b[i] > least)) continue;
    largest = std::max(largest, std::abs(a[i] / b[i] - 1.0));
    if (curve) curve->points.emplace_back(x[i], 100.0 * (a[i] / b[i] - 1.0));
  }
  return largest;
}

Finding ArcCosineRings(ClaimBench& bench) {
  const auto cases = SmoothFloor();
  const auto x = Steps(-2.0, 2.0, 401);
  const auto exact = Lobe(bench.Shade("ltc+edge=acos", cases, Precision::kDouble), true);
  Finding found;
  ClaimCurve fast{"edge=fast_acos", {}}, rational{"edge=rational", {}};
  const double of_fast = LargestRatioError(Lobe(bench.Shade("ltc+edge=fast_acos", cases, Precision::kDouble), true), exact, x, &fast);
  const double of_rational = LargestRatioError(Lobe(bench.Shade("ltc+edge=rational", cases, Precision::kDouble), true), exact, x, &rational);
  found.figures = {{"largest error of the highlight, four-term arc cosine", 100.0 * of_fast, "%"}, {"the same, rational fit of θ/sin θ", 100.0 * of_rational, "%"}};
  found.verdict = of_fast > 10.0 * of_rational ? Verdict::kHolds : of_fast > of_rational ? Verdict::kPartly : Verdict::kFails;
  found.plot = {"place on the floor, m", "error, %", {fast, rational}};
  return found;
}

Finding QuadraticSuffices(ClaimBench& bench) {
  const auto cases = SunkenPanel();
  const auto x = Steps(0.05, 2.0, 200);
  Finding found;
  ClaimCurve curve{"edge=quadratic, diffuse", {}};
  const auto exact = Lobe(bench.Shade("ltc+edge=acos", cases, Precision::kDouble), false), quadratic = Lobe(bench.Shade("ltc+edge=quadratic", cases, Precision::kDouble), false);
  const double peak = *std::max_element(exact.begin(), exact.end());
  double error = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    error = std::max(error, std::abs(quadratic[i] - exact[i]) / peak);
    curve.points.emplace_back(x[i], 100.0 * (quadratic[i] - exact[i]) / peak);
  }
  found.figures = {{"largest error of the diffuse lobe", 100.0 * error, "% of the peak"}};
  found.verdict = error < 0.01 ? Verdict::kHolds : error < 0.03 ? Verdict::kPartly : Verdict::kFails;
  found.plot = {"distance from the panel, m", "error, % of the peak", {curve}};
  return found;
}

Finding DividingBands(ClaimBench& bench) {
  std::vector<double> angles;
  const auto cases = SinkingView(&angles);
  Finding found;
  const auto values = [&](const char* norm) { return Lobe(bench.Shade(std::string("ltc@published+norm=") + norm, cases, Precision::kDouble), true); };
  const std::vector<double> last = values("last"), none = values("none");
  const double of_last = LargestKink(last), of_none = LargestKink(none);
  ClaimCurve first{"norm=last", {}}, second{"norm=none", {}};
  for (std::size_t i = 0; i < angles.size(); ++i) {
    first.points.emplace_back(angles[i], last[i]);
    second.points.emplace_back(angles[i], none[i]);
  }
  found.figures = {{"sharpest kink, divided by the last element", 100.0 * of_last, "% of the peak"}, {"the same, five terms undivided", 100.0 * of_none, "% of the peak"}};
  found.verdict = of_last > 3.0 * of_none ? Verdict::kHolds : of_last > of_none ? Verdict::kPartly : Verdict::kFails;
  found.plot = {"view angle, degrees", "highlight, of the light's radiance", {first, second}};
  return found;
}

Finding CosineAxisSuffices(ClaimBench& bench) {
  std::vector<double> angles;
  const auto cases = SinkingView(&angles);
  double sum = 0.0;
  std::vector<double> truth;
  for (const PointCase& c : cases) truth.push_back(c.Truth().specular);
  for (const double t : truth) sum += t * t;
  const auto error = [&](const char* axis) {
    const auto shaded = bench.Shade(std::string("ltc@published+norm=none+axis=") + axis, cases);
    double square = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) square += std::pow(shaded[i].specular - truth[i], 2.0);
    return std::sqrt(square / sum);
  };
  Finding found;
  const double of_cos = error("cos"), of_theta = error("theta");
  found.figures = {{"relative RMSE against truth, table over cos θ", 100.0 * of_cos, "%"}, {"the same over θ", 100.0 * of_theta, "%"}};
  found.verdict = of_cos < 1.1 * of_theta ? Verdict::kHolds : of_cos < 1.5 * of_theta ? Verdict::kPartly : Verdict::kFails;
  return found;
}

Finding UnclippedDarkens(ClaimBench& bench) {
  const auto cases = SunkenPanel();
  const auto x = Steps(0.05, 2.0, 200);
  const auto clipped = Lobe(bench.Shade("ltc", cases), false), unclipped = Lobe(bench.Shade("ltc+clip=none", cases), false);
  Finding found;
  ClaimCurve with{"clipped", {}}, without{"clip=none", {}};
  double least = 1.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    with.points.emplace_back(x[i], clipped[i]);
    without.points.emplace_back(x[i], unclipped[i]);
    if (clipped[i] > 0.0) least = std::min(least, unclipped[i] / clipped[i]);
  }
  found.figures = {{"darkest, of the clipped value", 100.0 * least, "%"}, {"closest point, of the clipped value", 100.0 * unclipped[0] / clipped[0], "%"}};
  found.verdict = least < 0.9 ? Verdict::kHolds : least < 0.99 ? Verdict::kPartly : Verdict::kFails;
  found.plot = {"distance from the panel, m", "diffuse, of the light's radiance", {with, without}};
  return found;
}

Finding ProxyIs(ClaimBench& bench, const char* variant, double close) {
  const auto cases = SunkenPanel();
  const auto x = Steps(0.05, 2.0, 200);
  const auto exact = Lobe(bench.Shade("ltc", cases), false), proxy = Lobe(bench.Shade(variant, cases), false);
  const double peak = *std::max_element(exact.begin(), exact.end());
  Finding found;
  ClaimCurve first{"clipped exactly", {}}, second{variant, {}};
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    first.points.emplace_back(x[i], exact[i]);
    second.points.emplace_back(x[i], proxy[i]);
    largest = std::max(largest, std::abs(proxy[i] - exact[i]) / peak);
  }
  found.figures = {{"largest difference of the diffuse lobe", 100.0 * largest, "% of the peak"}};
  found.verdict = largest < close ? Verdict::kHolds : largest < 3.0 * close ? Verdict::kPartly : Verdict::kFails;
  found.plot = {"distance from the panel, m", "diffuse, of the light's radiance", {first, second}};
  return found;
}

Finding Milliseconds(ClaimBench& bench) {
  Finding found;
  const double ms = MillisecondsAt1080p("bonaire", bench.Cost("hill@published").core.cycles);
  constexpr double kTheirs = 0.9;  // ms, the talk's summary
  found.figures = {{"their figure", kTheirs, "ms"}, {"hill@published, estimated from bonaire ISA", ms, "ms"}, {"hill, estimated", MillisecondsAt1080p("bonaire", bench.Cost("hill").core.cycles), "ms"}};
  found.verdict = std::abs(ms / kTheirs - 1.0) < 0.25 ? Verdict::kHolds : ms < 2.0 * kTheirs ? Verdict::kPartly : Verdict::kFails;
  found.note = "Theirs was measured with the vendor's compiler, and the talk does not say how much of the picture the light reached; ours is an estimate for every pixel lit, Fresnel included.";
  return found;
}

Finding SwitchIsFastest(ClaimBench& bench) {
  Finding found;
  const double cases = bench.Cost("ltc@published").core.cycles, stream = bench.Cost("ltc@published+clip=stream").core.cycles,
               arc = bench.Cost("ltc@published+clip=arc").core.cycles;
  found.figures = {{"clip=switch", cases, "cycles"}, {"clip=stream, on the fly", stream, "cycles"}, {"clip=arc, ours, branchless", arc, "cycles"}};
  found.verdict = cases < stream ? Verdict::kHolds : Verdict::kFails;
  found.note = "Cycles per wave on bonaire, static; branches that not every pixel takes are discounted by the compiler.";
  return found;
}

}  // namespace

ClaimSource HillClaims() {
  return {"hill", "Hill & Heitz 2016", "Real-Time Area Lighting: a Journey from Research to Production",
          {{"acos: evil lurks within", "The shading languages' arc cosine is too inexact for the edge integral: smooth receivers ring under bright lights; a rational fit of θ/sin θ cures it.",
            "the four-term arc cosine's error is more than ten times the fit's", "arealab stress --technique ltc+edge=fast_acos --technique ltc+edge=rational", ArcCosineRings},
           {"bonus: cheaper diffuse", "The diffuse lobe needs less precision: a quadratic will do.", "the diffuse lobe stays within 1 % of its peak",
            "arealab compare sinking --technique ltc+edge=quadratic --technique ltc", QuadraticSuffices},
           {"normalise matrix: 4 terms", "Matrices divided by their last element interpolate badly and band at grazing angles; undivided ones are smooth.",
            "the sharpest kink along a sinking highlight is more than three times that of the undivided table", "arealab stress --technique ltc@published+norm=last --technique ltc@published+norm=none", DividingBands},
           {"bonus: cheaper lookup", "Once undivided, tables need not be indexed by θ: cos θ serves as well and costs no arc cosine.", "the error over cos θ is at most 1.1 times that over θ",
            "arealab sweep angle --technique ltc@published+norm=none+axis=cos --technique ltc@published+norm=none+axis=theta", CosineAxisSuffices},
           {"clipping", "Of the ways to clip that they tried, a switch over which corners are above the horizon was the fastest.", "the switch takes fewer cycles than clipping on the fly",
            "arealab cost --gpu bonaire --technique ltc@published --technique ltc@published+clip=stream", SwitchIsFastest, true},
           {"clipping", "Without clipping, surfaces near the light darken.", "somewhere less than 90 % of the clipped value is left", "arealab compare sinking --technique ltc+clip=none --technique ltc", UnclippedDarkens},
           {"proxy sphere", "A sphere with the polygon's vector form factor, clipped by a table, comes pretty close to clipping the polygon.", "the diffuse lobe differs by less than 5 % of its peak",
            "arealab compare sinking --technique hill+sphere=table --technique ltc", [](ClaimBench& bench) { return ProxyIs(bench, "hill+sphere=table", 0.05); }},
           {"without the table", "A rational function of the vector form factor replaces the table: crude, but effective.", "the diffuse lobe differs by less than 10 % of its peak",
            "arealab compare sinking --technique hill+sphere=cheap --technique ltc", [](ClaimBench& bench) { return ProxyIs(bench, "hill+sphere=cheap", 0.10); }},
           {"summary", "Diffuse and specular together take 0.9 ms on a PlayStation 4 at 1080p.", "our estimate lies within 25 % of it", "arealab cost --claims", Milliseconds, true}}};
}

}  // namespace arealab
