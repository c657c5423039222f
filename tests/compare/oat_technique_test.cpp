// The oat technique: exactness over spheres, what is known of its published form, its bands against truth,
// and that it stays finite.
#include <gmock/gmock.h>

#include <array>

#include "tests/compare/technique_laws.h"

#define EFFECT_FRESNEL 1
#include "glsl/dual_begin.h"
#include "glsl/specular_albedo.glsl"
#include "glsl/dual_end.h"

namespace arealab::oat_technique_test {
namespace {

class OatTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;
};
std::unique_ptr<TechniquePoints> OatTechnique::points_;

constexpr const char* kPublished = "oat@published";

// Over the hemisphere the moment of the shared part is the irradiance itself, wherever the sphere stands.
TEST_F(OatTechnique, SphereDiffuseIsExact) {
  PointRandom random(1);
  std::vector<PointCase> cases;
  std::vector<Shaded> truth;
  for (int i = 0; i < 500; ++i) {
    cases.push_back(RandomPoint(random, LightShape::kSphere));
    truth.push_back({cases.back().Truth().form_factor, 0.0});
  }
  const std::vector<Shaded> shaded = points_->Shade("oat", cases, Precision::kDouble);
  for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_NEAR(shaded[i].diffuse, truth[i].diffuse, 2e-7) << i;
  // Float: the driver's arc tangent, 2e-5, tells at the horizon.
  EXPECT_LT(RelativeRmse(points_->Shade("oat", cases), truth, &Shaded::diffuse), 5e-5);
}

// Lambert's cosine halfway to an open hemisphere's axis is cos(θ/2): 1.73 times the true one at 60°, 4.4
// times at 80°.
TEST_F(OatTechnique, AveragedCentroidIsTooBright) {
  std::vector<PointCase> cases;
  const std::array<double, 3> degrees{0.0, 60.0, 80.0};
  for (const double angle : degrees) {
    PointCase c;
    c.shape = LightShape::kSphere;
    c.center = 10.0 * glm::dvec3(std::sin(glm::radians(angle)), 0.0, std::cos(glm::radians(angle)));
    c.half_size = glm::dvec2(0.1);
    cases.push_back(c);
  }
  const std::vector<Shaded> his = points_->Shade(kPublished, cases), ours = points_->Shade("oat", cases);
  EXPECT_NEAR(his[0].diffuse / ours[0].diffuse, 1.0, 1e-3);
  EXPECT_NEAR(his[1].diffuse / ours[1].diffuse, 1.732, 2e-3);
  EXPECT_NEAR(his[2].diffuse / ours[2].diffuse, 4.411, 5e-3);
}

// Diffuse from a small light of any shape tends to the point technique's.
TEST_F(OatTechnique, ShrinkingLightTendsToThePoint) {
  PointRandom random(2);
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    std::vector<PointCase> cases;
    for (int i = 0; i < 200; ++i) {
      cases.push_back(RandomPoint(random, shape));
      cases.back().half_size *= 1e-3;
    }
    const std::vector<Shaded> point = points_->Shade("point", cases, Precision::kDouble);
    for (const char* name : {"oat", "oat+overlap=smoothstep"}) {
      EXPECT_LT(RelativeRmse(points_->Shade(name, cases, Precision::kDouble), point, &Shaded::diffuse), 1e-5)
          << name << " " << Name(shape);
    }
  }
}

// A light that fills the lobe's cone gives back the lobe's energy.
TEST_F(OatTechnique, WideLightReturnsTheLobesEnergy) {
  std::vector<PointCase> cases;
  for (const double n_dot_v : {1.0, 0.7, 0.4}) {
    for (const double roughness : {0.0, 0.2, 0.4}) {
      PointCase c;
      c.shape = LightShape::kSphere;
      c.roughness = roughness;
      c.to_view = {std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v};
      c.center = 3.0 * glm::dvec3(-c.to_view.x, 0.0, c.to_view.z);
      c.half_size = glm::dvec2(1.15);  // wholly above the horizon at n·v = 0.4
      cases.push_back(c);
    }
  }
  for (const char* name : {"oat", kPublished}) {
    const std::vector<Shaded> shaded = points_->Shade(name, cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const double energy = dual::SpecularAlbedo(cases[i].to_view.z, cases[i].roughness).x;
      EXPECT_NEAR(shaded[i].specular, energy, 1e-3) << name << " " << i;
      EXPECT_GT(energy, 0.8);
    }
  }
}

TEST_F(OatTechnique, StaysFinite) {
  const std::vector<PointCase> cases = HardPoints();
  for (const Variant& variant : points_->Variants("oat")) {
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      if (precision == Precision::kDouble && variant.Name() != "oat")
        continue;  // it costs ten times float's time
      const std::vector<Shaded> shaded = points_->Shade(variant.Name(), cases, precision);
      for (std::size_t i = 0; i < cases.size(); ++i) {
        ASSERT_TRUE(shaded[i].diffuse >= 0.0 && shaded[i].diffuse <= 2.0 + 1e-6)
            << variant.Name() << " " << i;
        ASSERT_TRUE(shaded[i].specular >= 0.0 && shaded[i].specular <= 1.0 + 1e-6)
            << variant.Name() << " " << i;
      }
    }
  }
}

TEST_F(OatTechnique, FloatAgreesWithDouble) {
  PointRandom random(3);
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    std::vector<PointCase> cases;
    for (int i = 0; i < 5000; ++i) cases.push_back(RandomPoint(random, shape));
    for (const Variant& variant : points_->Variants("oat")) {
      const auto in_float = points_->Shade(variant.Name(), cases);
      const auto in_double = points_->Shade(variant.Name(), cases, Precision::kDouble);
      EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::diffuse), 1e-4)
          << variant.Name() << " " << Name(shape);
      EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::specular), 2e-4)
          << variant.Name() << " " << Name(shape);
    }
  }
}

// Relative RMSE against truth over random lights: the technique's own error, from both sides.
TEST_F(OatTechnique, StandsInItsBandsAgainstTruth) {
  struct Band {
    const char* variant;
    LightShape shape;
    double diffuse, specular;  // measured
  };
  constexpr std::array<Band, 6> kBands{{
      {"oat", LightShape::kRectangle, 0.278, 0.759},
      {"oat", LightShape::kDisk, 0.196, 0.709},
      {"oat", LightShape::kSphere, 0.0, 0.476},
      {kPublished, LightShape::kRectangle, 0.835, 0.821},
      {kPublished, LightShape::kDisk, 0.707, 0.734},
      {kPublished, LightShape::kSphere, 0.583, 0.52},
  }};
  std::array<std::vector<PointCase>, 3> cases;
  std::array<std::vector<Shaded>, 3> truth;
  PointRandom random(4);
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    const auto s = static_cast<std::size_t>(shape);
    for (int i = 0; i < 1500; ++i) {
      cases[s].push_back(RandomPoint(random, shape));
      const LightIntegrals integrals = cases[s].back().Truth(1e-3);
      truth[s].push_back({integrals.form_factor, integrals.specular});
    }
  }
  for (const Band& band : kBands) {
    const auto s = static_cast<std::size_t>(band.shape);
    SCOPED_TRACE(Name(band.shape));
    ExpectInBand(*points_, band.variant, cases[s], truth[s], band.diffuse, band.specular);
  }
}

}  // namespace
}  // namespace arealab::oat_technique_test
