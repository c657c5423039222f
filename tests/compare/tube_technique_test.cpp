// Tubes: the truth against closed forms and its own finest level, and what the techniques make of them.
#include <gtest/gtest.h>

#include "compare/truth_levels.h"
#include "tests/compare/hard_configurations.h"
#include "tests/compare/technique_laws.h"

namespace arealab::tube_technique_test {
namespace {

constexpr double kPi = glm::pi<double>();
constexpr LightShape kTube = LightShape::kTube;

// A tube about `center` along `axis` over a point at the origin, seen from 53° beside the normal.
PointCase Tube(const glm::dvec3& center, const glm::dvec3& axis, double half_length, double radius, const glm::dvec3& normal = {0.0, 0.0, 1.0}) {
  Light light;
  LayAlong(light, axis);
  PointCase c;
  c.shape = kTube;
  c.center = center;
  c.axis_x = light.axis_x;
  c.axis_y = light.axis_y;
  c.light_normal = light.normal;
  c.half_size = {half_length, radius};
  c.normal = normal;
  c.to_view = glm::normalize(normal + 0.75 * light.axis_y);
  if (glm::dot(c.to_view, normal) <= 0.0) c.to_view = normal;
  c.roughness = 0.5;
  return c;
}

double FormFactor(const PointCase& c) { return c.Truth(1e-4).form_factor; }

// Of what an infinite cylinder of radius R at a distance h fills, half its angle is asin R/h; with the normal at the angle t to the axis'
// plane F = ½ (sin(t + a) − sin(t − a)), the greater angle cut at the horizon.
TEST(TubeTruth, AnEndlessTubeIsAWedge) {
  for (const double ratio : {1e-3, 0.1, 0.5, 0.95}) {
    for (const double t : {0.0, 0.5, 1.2, 1.5, 1.7, 2.2}) {
      const double half = std::asin(ratio);
      const double expected = t - half > kPi / 2 ? 0.0 : 0.5 * (std::sin(std::min(t + half, kPi / 2)) - std::sin(t - half));
      const PointCase c = Tube({0.0, 0.0, 2.0}, {1.0, 0.0, 0.0}, 1e6, 2.0 * ratio, {0.0, std::sin(t), std::cos(t)});
      EXPECT_NEAR(FormFactor(c), expected, 1e-9) << ratio << " " << t;
    }
  }
}

// The thin limit: R/π Δ[l/(h² + l²) + atan(l/h)/h] of a line parallel to the surface at the height h over it, R/π (1/d − d/(d² + l²)) of one
// that stands on its horizon, to the height l, also where it goes on below.
TEST(TubeTruth, AThinTubeIsALine) {
  const double radius = 1e-5;
  for (const auto& [from, to] : {std::pair(-1.0, 1.0), std::pair(-0.2, 3.0), std::pair(0.7, 0.9)}) {
    const double h = 1.3;
    const auto integral = [&](double l) { return l / (h * h + l * l) + std::atan(l / h) / h; };
    const PointCase c = Tube({0.5 * (from + to), 0.0, h}, {1.0, 0.0, 0.0}, 0.5 * (to - from), radius);
    EXPECT_NEAR(FormFactor(c) / radius, (integral(to) - integral(from)) / kPi, 1e-4);
  }
  for (const double top : {0.5, 2.0, 50.0}) {
    const double d = 0.8, expected = (1.0 / d - d / (d * d + top * top)) / kPi;
    for (const double bottom : {0.0, -0.3, -4.0}) {
      const PointCase c = Tube({d, 0.0, 0.5 * (top + bottom)}, {0.0, 0.0, 1.0}, 0.5 * (top - bottom), radius);
      EXPECT_NEAR(FormFactor(c) / radius, expected, 1e-4) << top << " " << bottom;
    }
  }
}

// Nothing of the outside is seen from within the cylinder, prolonged, and nothing of the inside.
TEST(TubeTruth, OpenEndsAreDark) {
  EXPECT_EQ(FormFactor(Tube({0.0, 0.0, 2.0}, {0.0, 0.0, 1.0}, 0.5, 0.1)), 0.0);
  EXPECT_EQ(FormFactor(Tube({0.09, 0.0, 2.0}, {0.0, 0.0, 1.0}, 0.5, 0.1)), 0.0);
  EXPECT_GT(FormFactor(Tube({0.11, 0.0, 2.0}, {0.0, 0.0, 1.0}, 0.5, 0.1)), 0.0);
  EXPECT_EQ(FormFactor(Tube({0.05, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.5, 0.1)), 0.0);
}

// As Truth.StatedErrorsAreHonest asks of the other shapes.
TEST(TubeTruth, StatedErrorsAreHonest) {
  constexpr int kCount = 1000;
  for (const double tolerance : {1e-3, 1e-4}) {
    std::mt19937_64 engine(23);
    int lit = 0, exceeded = 0, understated = 0;
    for (int i = 0; i < kCount; ++i) {
      HardConfiguration c = MakeHardConfiguration(engine, i);
      c.light.shape = kTube;
      c.light.half_size.y *= 0.02 + 0.2 * (i % 5);
      if (i % 3 == 0) LayAlong(c.light, c.light.axis_x + c.light.normal * (1.0 + i % 7));
      const LightIntegrals truth = IntegrateLight(c.point, c.light, tolerance);
      const LightIntegrals fine = IntegrateLightAtLevel(c.point, c.light, kTruthLevelCount - 2);
      ASSERT_TRUE(std::isfinite(truth.specular) && std::isfinite(truth.specular_grazing) && std::isfinite(truth.form_factor)) << i;
      if (fine.specular < 1e-12) continue;
      ++lit;
      exceeded += std::abs(truth.specular - fine.specular) > tolerance * fine.specular ||
                  std::abs(truth.specular_grazing - fine.specular_grazing) > tolerance * (fine.specular_grazing + 0.04 * fine.specular);
      understated += std::abs(truth.specular - fine.specular) > truth.specular_error;
    }
    EXPECT_GT(lit, kCount * 7 / 10);
    EXPECT_LE(exceeded, kCount / 1000) << tolerance;
    EXPECT_LE(understated, kCount / 200) << tolerance;
  }
}

class TubeTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;

  static double Error(const std::string& variant, const std::vector<PointCase>& cases, const std::vector<Shaded>& truth, double Shaded::*lobe) {
    return RelativeRmse(points_->Shade(variant, cases), truth, lobe);
  }
};
std::unique_ptr<TechniquePoints> TubeTechnique::points_;

std::vector<PointCase> Thin(std::vector<PointCase> cases, double radius) {
  for (PointCase& c : cases) {
    c.half_size.y = radius;
    c = c.Rounded();
  }
  return cases;
}

// Lambert, relative RMSE by radius: the line is the thin limit, in closed form, wherever the horizon is, and leaves it with the radius over
// the distance; so does the strip, which has no rims; the outline stays.
TEST_F(TubeTechnique, LambertByRadius) {
  struct Expected {
    double radius, line, strip, outline;
  };
  const std::vector<PointCase> cases = RandomPoints(61, kTube, 3000);
  for (const Expected& e : {Expected{1e-3, 6.6e-4, 6.6e-4, 5.0e-5}, Expected{0.02, 0.0134, 0.0127, 5.3e-5}, Expected{0.1, 0.077, 0.058, 9.7e-4}}) {
    const std::vector<PointCase> tubes = Thin(cases, e.radius);
    const std::vector<Shaded> truth = TruthOf(tubes);
    const auto error = [&](const char* name) { return Error(name, tubes, truth, &Shaded::diffuse); };
    const double line = error("ltc+tube=line"), strip = error("ltc+tube=strip"), outline = error("ltc");
    EXPECT_NEAR(line, e.line, 0.2 * e.line) << e.radius;
    EXPECT_NEAR(strip, e.strip, 0.2 * e.strip) << e.radius;
    EXPECT_LT(outline, 1.2 * e.outline) << e.radius;
  }
}

// Cut by the horizon: lengths are taken to the fourth power there, and lights are 1e-5 to 1e5 m large.
TEST_F(TubeTechnique, AsLargeToTheEyeIsTheSame) {
  for (const LightShape shape : {kTube, LightShape::kRectangle, LightShape::kPolygon}) {
    for (const std::string variant : {"ltc", "ltc+clip=stream", "ltc+horizon=true"}) {
      if (shape != LightShape::kRectangle && variant != "ltc") continue;
      std::vector<PointCase> cases;
      for (const double scale : {1.0, 1e-5, 1e5}) {
        PointCase c = Tube(scale * glm::dvec3(-1.2, 0.3, 0.1), {0.6, 0.0, 0.8}, scale, 0.2 * scale);
        c.shape = shape;
        if (shape != kTube && glm::dot(c.light_normal, c.center) > 0.0) {
          c.light_normal = -c.light_normal;
          c.axis_y = -c.axis_y;
        }
        if (shape == LightShape::kPolygon) c.corners = {{-scale, -0.2 * scale}, {scale, -0.2 * scale}, {0.5 * scale, 0.2 * scale}};
        cases.push_back(c.Rounded());
      }
      const std::vector<Shaded> shaded = points_->Shade(variant, cases);
      EXPECT_GT(shaded[0].diffuse, 1e-3) << variant << " " << Name(shape);
      for (const Shaded& s : shaded) {
        EXPECT_NEAR(s.diffuse, shaded[0].diffuse, 1e-6) << variant << " " << Name(shape);
        EXPECT_NEAR(s.specular, shaded[0].specular, 1e-6) << variant << " " << Name(shape);
      }
    }
  }
}

TEST_F(TubeTechnique, TheReferenceIsTheTruth) {
  const std::vector<PointCase> cases = RandomPoints(62, kTube, 1000);
  const std::vector<Shaded> truth = TruthOf(cases, 1e-4);
  EXPECT_LT(Error("reference", cases, truth, &Shaded::diffuse), 1e-4);
  EXPECT_LT(Error("reference+level=dense", cases, truth, &Shaded::specular), 1e-3);
}

TEST_F(TubeTechnique, MonteCarloTendsToTheTruth) {
  const std::vector<PointCase> cases = RandomPoints(63, kTube, 200);
  const std::vector<Shaded> mean = points_->MeanOverSeeds("monte_carlo+samples=64", cases, 200);
  const std::vector<Shaded> truth = TruthOf(cases);
  EXPECT_LT(RelativeRmse(mean, truth, &Shaded::diffuse), 0.01);
  EXPECT_LT(RelativeRmse(mean, truth, &Shaded::specular), 0.02);
}

// The specular lobe by roughness, relative RMSE: the fit's error, and what outline, strip and line add to it.
TEST_F(TubeTechnique, SpecularByRoughness) {
  struct Expected {
    double radius, roughness, outline, strip, line;
  };
  for (const Expected& e : {Expected{0.02, 0.1, 0.033, 0.033, 0.15}, Expected{0.02, 0.5, 0.104, 0.105, 0.105}, Expected{0.1, 0.1, 0.0063, 0.060, 0.57},
                            Expected{0.1, 0.25, 0.039, 0.084, 0.17}, Expected{0.1, 0.5, 0.1, 0.113, 0.117}, Expected{0.1, 1.0, 0.076, 0.098, 0.115}}) {
    std::vector<PointCase> cases = Thin(RandomPoints(64, kTube, 3000), e.radius);
    for (PointCase& c : cases) {
      c.roughness = e.roughness;
      c = c.Rounded();
    }
    const std::vector<Shaded> truth = TruthOf(cases);
    const auto error = [&](const char* name) { return Error(name, cases, truth, &Shaded::specular); };
    EXPECT_NEAR(error("ltc"), e.outline, 0.15 * e.outline) << e.radius << " " << e.roughness;
    EXPECT_NEAR(error("ltc+tube=strip"), e.strip, 0.15 * e.strip) << e.radius << " " << e.roughness;
    EXPECT_NEAR(error("ltc+tube=line"), e.line, 0.15 * e.line) << e.radius << " " << e.roughness;
  }
}

// The line's reflection has no width: in a mirror it is up to the whole radiance wherever the lobe reaches, cut off at 1 as the paper does.
TEST_F(TubeTechnique, TheLineNeverExceedsTheRadiance) {
  std::vector<PointCase> cases = Thin(RandomPoints(65, kTube, 2000), 0.5);
  for (const Shaded& shaded : points_->Shade("ltc+tube=line", cases)) {
    ASSERT_LE(shaded.diffuse, 1.0);
    ASSERT_GE(shaded.diffuse, 0.0);
  }
}

}  // namespace
}  // namespace arealab::tube_technique_test
