// The light_field technique: Arvo's vector is exact for Lambert, the published one is not and by what; the
// specular is a point's.
#include <gtest/gtest.h>

#include <array>

#include "tests/compare/technique_laws.h"

namespace arealab::light_field_technique_test {
namespace {

class LightFieldTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;
};
std::unique_ptr<TechniquePoints> LightFieldTechnique::points_;

constexpr const char* kPublished = "light_field@published";
constexpr LightShape kRectangle = LightShape::kRectangle;

TEST_F(LightFieldTechnique, VectorIrradianceIsExactForLambert) {
  const std::vector<PointCase> cases = RandomPoints(1, kRectangle, 2000);
  const std::vector<Shaded> truth = TruthOf(cases);
  for (const Variant& variant : points_->Variants("light_field")) {
    if (variant.options.at("vector") == "unit") continue;
    // The language's arc cosine is the driver's: 7e-5 here.
    const double bound = variant.options.at("edge") == "acos" ? 5e-4 : 2e-5;
    EXPECT_LT(RelativeRmse(points_->Shade(variant.Name(), cases), truth, &Shaded::diffuse), bound)
        << variant.Name();
  }
  for (const char* name : {"light_field", "light_field+clip=stream+edge=acos"}) {
    EXPECT_LT(RelativeRmse(points_->Shade(name, cases, Precision::kDouble), truth, &Shaded::diffuse), 1e-5)
        << name;
  }
}

// What the normalisation loses: neither distance nor size changes anything but the direction's cosine, and a
// light that covers a hundredth of the sky is a hundred times too bright.
TEST_F(LightFieldTechnique, UnitVectorHasNoFallOff) {
  std::vector<PointCase> cases;
  for (const double distance : {2.0, 20.0, 200.0}) {
    PointCase c;
    c.center = {0.0, 0.6 * distance, 0.8 * distance};
    c.light_normal = {0.0, -0.6, -0.8};
    c.axis_y = {0.0, -0.8, 0.6};
    c.half_size = glm::dvec2(0.1);
    cases.push_back(c);
  }
  const std::vector<Shaded> unit = points_->Shade(kPublished, cases),
                            arvo = points_->Shade("light_field", cases);
  for (const Shaded& shaded : unit) EXPECT_NEAR(shaded.diffuse, 0.8, 1e-3);
  EXPECT_NEAR(arvo[0].diffuse / arvo[2].diffuse, 1e4, 0.01e4);
  for (std::size_t i = 0; i < cases.size(); ++i) {  // the specular by the same factor
    EXPECT_NEAR(unit[i].specular / arvo[i].specular / (unit[i].diffuse / arvo[i].diffuse), 1.0, 1e-5);
  }
}

TEST_F(LightFieldTechnique, ShrinkingLightTendsToThePoint) {
  std::vector<PointCase> cases = RandomPoints(2, kRectangle, 200);
  for (PointCase& c : cases) c.half_size *= 1e-3;
  const std::vector<Shaded> point = points_->Shade("point", cases, Precision::kDouble);
  const std::vector<Shaded> shaded = points_->Shade("light_field", cases, Precision::kDouble);
  EXPECT_LT(RelativeRmse(shaded, point, &Shaded::diffuse), 1e-5);
  EXPECT_LT(RelativeRmse(shaded, point, &Shaded::specular), 1e-4);
}

// Its mirror has no limit: where the truth tends to the light's radiance, the highlight is F/(4α²), F the
// form factor, at the mirror of the vector, and dark elsewhere.
TEST_F(LightFieldTechnique, HighlightGrowsWithoutBound) {
  std::vector<PointCase> cases;
  for (const double roughness : {0.5, 0.2, 0.05}) {
    PointCase c;  // seen along the normal
    c.roughness = roughness;
    cases.push_back(c);
  }
  const std::vector<Shaded> shaded = points_->Shade("light_field", cases), truth = TruthOf(cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double alpha2 = std::pow(cases[i].roughness, 4.0);
    EXPECT_NEAR(shaded[i].specular, shaded[i].diffuse / (4.0 * alpha2), 1e-3 * shaded[i].specular);
  }
  EXPECT_NEAR(truth[2].specular, 1.0, 1e-3);
  EXPECT_NEAR(shaded[2].specular, 9573.0, 100.0);
}

TEST_F(LightFieldTechnique, Laws) {
  ExpectFinite(*points_, "light_field");
  const std::vector<PointCase> cases = RandomPoints(3, kRectangle, 500);
  for (const char* name : {"light_field", kPublished}) {
    ExpectLinearInRadiance(*points_, name, cases);
    ExpectFreeOfScale(*points_, name, cases);
    const auto in_float = points_->Shade(name, cases),
               in_double = points_->Shade(name, cases, Precision::kDouble);
    // The published form has the driver's arc cosine, and where little of a light is left the direction of
    // little.
    EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::diffuse), name == kPublished ? 5e-3 : 2e-5) << name;
    EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::specular), 5e-3) << name;
  }
}

// Relative RMSE against truth over random lights: the technique's own error, from both sides.
TEST_F(LightFieldTechnique, StandsInItsBandsAgainstTruth) {
  struct Band {
    const char* variant;
    double diffuse, specular;  // measured
  };
  constexpr std::array<Band, 2> kBands{{{"light_field", 0.0, 6.1}, {kPublished, 10.5, 42.6}}};
  const std::vector<PointCase> cases = RandomPoints(4, kRectangle, 1500);
  const std::vector<Shaded> truth = TruthOf(cases);
  for (const Band& band : kBands) ExpectInBand(*points_, band.variant, cases, truth, band.diffuse, band.specular);
}

}  // namespace
}  // namespace arealab::light_field_technique_test
