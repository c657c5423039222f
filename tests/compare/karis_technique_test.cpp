// The karis technique: diffuse as from a point, what its representative point and its normalisation keep of a
// mirror, the windowed fall-off, its bands against truth.
#include <gtest/gtest.h>

#include <array>

#include "tests/compare/technique_laws.h"

namespace arealab::karis_technique_test {
namespace {

class KarisTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;
};
std::unique_ptr<TechniquePoints> KarisTechnique::points_;

constexpr const char* kPublished = "karis@published";
constexpr LightShape kSphere = LightShape::kSphere;

// "The irradiance from a sphere light is identical to that of a point light if the sphere is above the
// horizon."
TEST_F(KarisTechnique, DiffuseIsExactAboveTheHorizon) {
  std::vector<PointCase> above, crossing;
  for (const PointCase& c : RandomPoints(1, kSphere, 1500)) {
    const double height = glm::dot(c.normal, c.center) - c.half_size.x;
    if (height > 0.0) above.push_back(c);
    if (height < 0.0 && height > -2.0 * c.half_size.x) crossing.push_back(c);
  }
  EXPECT_LT(RelativeRmse(points_->Shade("karis", above), TruthOf(above), &Shaded::diffuse), 1e-6);
  // And he accepts what that costs below: measured 0.25.
  EXPECT_NEAR(RelativeRmse(points_->Shade("karis", crossing), TruthOf(crossing), &Shaded::diffuse), 0.25,
              0.02);
}

TEST_F(KarisTechnique, ShrinkingLightTendsToThePoint) {
  std::vector<PointCase> cases = RandomPoints(2, kSphere, 200);
  for (PointCase& c : cases) c.half_size *= 1e-4;
  const std::vector<Shaded> point = points_->Shade("point", cases, Precision::kDouble);
  for (const char* name : {"karis", "karis+widening=third"}) {
    const std::vector<Shaded> shaded = points_->Shade(name, cases, Precision::kDouble);
    EXPECT_LT(RelativeRmse(shaded, point, &Shaded::diffuse), 1e-6) << name;
    EXPECT_LT(RelativeRmse(shaded, point, &Shaded::specular), 2e-3) << name;
  }
}

// A mirror shows the sphere with sharp edges, as it should, but its radiance over n·v: widening by half the
// angle keeps it at normal incidence only; by a third, as eq. 10 has it, it is (3/2)² as bright.
TEST_F(KarisTechnique, MirrorKeepsRadianceAtNormalIncidenceOnly) {
  std::vector<PointCase> cases, outside;
  for (const double n_dot_v : {1.0, 0.7, 0.4}) {
    PointCase c;
    c.shape = kSphere;
    c.roughness = 0.02;
    c.to_view = {std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v};
    c.center = 3.0 * glm::dvec3(-c.to_view.x, 0.0, c.to_view.z);
    c.half_size = glm::dvec2(0.6);
    cases.push_back(c);
    c.center.y += 0.75;  // the mirror ray passes by
    outside.push_back(c);
  }
  const std::vector<Shaded> half = points_->Shade("karis", cases),
                            third = points_->Shade("karis+widening=third", cases);
  const std::vector<Shaded> truth = TruthOf(cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_NEAR(truth[i].specular, 1.0, 1e-3);
    EXPECT_NEAR(half[i].specular * cases[i].to_view.z, 1.0, 0.02) << i;
    EXPECT_NEAR(third[i].specular * cases[i].to_view.z, 2.25, 0.05) << i;
  }
  for (const Shaded& shaded : points_->Shade("karis", outside)) EXPECT_LT(shaded.specular, 0.01);
}

// Eq. 9, with its 1 a square centimetre.
TEST_F(KarisTechnique, WindowedFallOff) {
  std::vector<PointCase> cases;
  for (const double distance : {0.05, 2.0, 3.9, 4.0, 5.0}) {
    PointCase c;
    c.shape = kSphere;
    c.center = {0.0, 0.0, distance};
    c.half_size = glm::dvec2(0.01);
    cases.push_back(c);
  }
  const std::vector<Shaded> physical = points_->Shade("karis", cases);
  const std::vector<Shaded> windowed =
      points_->Shade(kPublished, cases, Precision::kFloat, {{"influence", 4.0}});
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double d2 = cases[i].center.z * cases[i].center.z;
    const double window = std::pow(std::max(1.0 - d2 * d2 / 256.0, 0.0), 2.0) * d2 / (d2 + 1e-4);
    EXPECT_NEAR(windowed[i].diffuse, physical[i].diffuse * window, 1e-4 * physical[i].diffuse) << i;
    EXPECT_NEAR(windowed[i].specular, physical[i].specular * window, 1e-4 * physical[i].specular) << i;
  }
}

TEST_F(KarisTechnique, Laws) {
  ExpectFinite(*points_, "karis");
  const std::vector<PointCase> cases = RandomPoints(3, kSphere, 500);
  ExpectFreeOfScale(*points_, "karis", cases);  // a window and a centimetre are not
  for (const char* name : {"karis", kPublished}) {
    ExpectLinearInRadiance(*points_, name, cases);
    const auto in_float = points_->Shade(name, cases),
               in_double = points_->Shade(name, cases, Precision::kDouble);
    EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::diffuse), 1e-5) << name;
    EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::specular), 1e-3) << name;
  }
}

// Relative RMSE against truth over random lights: the technique's own error, from both sides.
TEST_F(KarisTechnique, StandsInItsBandsAgainstTruth) {
  struct Band {
    const char* variant;
    double diffuse, specular;  // measured
  };
  constexpr std::array<Band, 3> kBands{
      {{"karis", 0.122, 1.1}, {"karis+widening=third", 0.122, 2.36}, {kPublished, 0.122, 1.1}}};
  const std::vector<PointCase> cases = RandomPoints(4, kSphere, 1500);
  const std::vector<Shaded> truth = TruthOf(cases);
  for (const Band& band : kBands) ExpectInBand(*points_, band.variant, cases, truth, band.diffuse, band.specular);
}

}  // namespace
}  // namespace arealab::karis_technique_test
