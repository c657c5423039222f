// The mayaux technique: what its clipping leaves exact, its mirror and its peak, its bands against truth. The
// clipping itself: tests/glsl/fake_clip_test.cpp.
#include <gtest/gtest.h>

#include <array>

#include "tests/compare/technique_laws.h"

#include "glsl/dual_begin.h"
#include "glsl/specular_albedo.glsl"
#include "glsl/dual_end.h"

namespace arealab::mayaux_technique_test {
namespace {

class MayauxTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;
};
std::unique_ptr<TechniquePoints> MayauxTechnique::points_;

constexpr const char* kPublished = "mayaux@published";
constexpr LightShape kRectangle = LightShape::kRectangle;

bool WhollyAbove(const PointCase& c) {
  const double reach = std::abs(glm::dot(c.normal, c.axis_x)) * c.half_size.x +
                       std::abs(glm::dot(c.normal, c.axis_y)) * c.half_size.y;
  return glm::dot(c.normal, c.center) > reach;
}

// With the mean direction the diffuse lobe is exact where nothing is clipped, and where the horizon runs
// along a side but for the clipping's inset of 1e-3; towards the centre it is not.
TEST_F(MayauxTechnique, MeanDirectionIsExactButForTheClipping) {
  std::vector<PointCase> above, along;
  for (const PointCase& c : RandomPoints(1, kRectangle, 1500)) {
    if (WhollyAbove(c)) above.push_back(c);
  }
  for (int i = 1; i < 20; ++i) {
    PointCase c;
    c.center = {2.0, 0.0, -0.5 + 0.05 * i};
    c.light_normal = {-1.0, 0.0, 0.0};
    c.axis_x = {0.0, 0.0, 1.0};
    c.axis_y = {0.0, 1.0, 0.0};
    along.push_back(c);
  }
  const std::vector<Shaded> truth = TruthOf(above);
  EXPECT_LT(RelativeRmse(points_->Shade("mayaux", above), truth, &Shaded::diffuse), 1e-5);
  EXPECT_NEAR(RelativeRmse(points_->Shade(kPublished, above), truth, &Shaded::diffuse), 0.115, 0.01);
  EXPECT_LT(RelativeRmse(points_->Shade("mayaux", along), TruthOf(along), &Shaded::diffuse), 5e-3);
}

TEST_F(MayauxTechnique, ShrinkingLightTendsToThePointInDiffuse) {
  std::vector<PointCase> cases = RandomPoints(2, kRectangle, 200);
  for (PointCase& c : cases) c.half_size *= 1e-3;
  const std::vector<Shaded> point = points_->Shade("point", cases, Precision::kDouble);
  for (const char* name : {"mayaux", kPublished}) {
    EXPECT_LT(RelativeRmse(points_->Shade(name, cases, Precision::kDouble), point, &Shaded::diffuse), 1e-4)
        << name;
  }
}

// The specular is a plateau over the cone: a small light at the mirror direction is as bright as the lobe's
// peak makes it, and stays so until the cone's rim.
TEST_F(MayauxTechnique, SmallLightAtTheMirrorDirectionMeetsThePeak) {
  std::vector<PointCase> cases;
  for (const double roughness : {0.2, 0.35, 0.5}) {
    PointCase c;
    c.roughness = roughness;
    c.half_size = glm::dvec2(1e-3);
    cases.push_back(c);
  }
  const std::vector<Shaded> point = points_->Shade("point", cases), shaded = points_->Shade("mayaux", cases);
  for (std::size_t i = 0; i < cases.size(); ++i)
    EXPECT_NEAR(shaded[i].specular / point[i].specular, 1.0, 0.1) << i;
}

// A smooth surface is a mirror: the light's radiance where the mirror ray meets it, nothing elsewhere.
TEST_F(MayauxTechnique, SmoothSurfaceMirrors) {
  std::vector<PointCase> hit, missed;
  for (const double n_dot_v : {1.0, 0.7, 0.4}) {
    PointCase c;
    c.roughness = 0.02;
    c.to_view = {std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v};
    c.center = glm::dvec3(-c.to_view.x, 0.0, c.to_view.z) / n_dot_v;
    hit.push_back(c);
    c.center.y = 0.51;
    missed.push_back(c);
  }
  for (const char* name : {"mayaux", kPublished}) {
    for (const Shaded& shaded : points_->Shade(name, hit)) EXPECT_NEAR(shaded.specular, 1.0, 1e-2) << name;
    for (const Shaded& shaded : points_->Shade(name, missed)) EXPECT_EQ(shaded.specular, 0.0) << name;
  }
}

// Outside the light the trace fades by his smoothstep over its radius and a thousandth of the light's side; on the border half of the
// square of its area is covered. At normal incidence the trace's radius over a height of 1 is 2 alpha.
TEST_F(MayauxTechnique, FadesAsHisListing) {
  std::vector<PointCase> cases;
  constexpr double kRadius = 2.0 * 0.3 * 0.3, kHalf = 0.5;
  for (int i = 0; i <= 24; ++i) {
    PointCase c;
    c.roughness = 0.3;
    c.half_size = glm::dvec2(kHalf);
    c.center.x = kHalf + kRadius * i / 20.0;
    cases.push_back(c);
  }
  const std::vector<Shaded> shaded = points_->Shade("mayaux@published", cases, Precision::kDouble);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double x = std::min((cases[i].center.x - kHalf) / (kRadius + 2e-3 * kHalf), 1.0);
    EXPECT_NEAR(shaded[i].specular / shaded[0].specular, 1.0 - x * x * (3.0 - 2.0 * x), 1e-6) << i;
  }
  EXPECT_NEAR(shaded[0].specular, 0.5 * dual::SpecularAlbedo(1.0, 0.3).x, 1e-6);
}

// Nothing holds his form factor below 1: the cosine of one direction times a solid angle, near a wide light's middle 2π.
TEST_F(MayauxTechnique, PublishedFormFactorIsUpToTwo) {
  PointCase c;
  c.half_size = glm::dvec2(1000.0);
  EXPECT_NEAR(points_->Shade(kPublished, {c})[0].diffuse, 2.0, 0.01);
  EXPECT_NEAR(points_->Shade("mayaux", {c})[0].diffuse, 1.0, 1e-4);
}

// F' = 1 − F: a perfect mirror has no diffuse lobe, and at normal incidence F is F0.
TEST_F(MayauxTechnique, CouplingTakesFresnelFromTheDiffuse) {
  std::vector<PointCase> cases(2);
  cases[1].f0 = 0.25;
  const std::vector<Shaded> plain = points_->Shade("mayaux", cases);
  const std::vector<Shaded> coupled = points_->Shade("mayaux+coupling=fresnel", cases);
  EXPECT_EQ(coupled[0].diffuse, 0.0);
  EXPECT_NEAR(coupled[1].diffuse, 0.75 * plain[1].diffuse, 1e-6);
  EXPECT_EQ(coupled[1].specular, plain[1].specular);
}

TEST_F(MayauxTechnique, Laws) {
  ExpectFinite(*points_, "mayaux");
  const std::vector<PointCase> cases = RandomPoints(3, kRectangle, 500);
  for (const char* name : {"mayaux", kPublished}) {
    ExpectLinearInRadiance(*points_, name, cases);
    ExpectFreeOfScale(*points_, name, cases);
    const auto in_float = points_->Shade(name, cases),
               in_double = points_->Shade(name, cases, Precision::kDouble);
    EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::diffuse), 1e-4) << name;
    EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::specular), 1e-3) << name;
  }
}

// Relative RMSE against truth over random lights: the technique's own error, from both sides.
TEST_F(MayauxTechnique, StandsInItsBandsAgainstTruth) {
  struct Band {
    const char* variant;
    double diffuse, specular;  // measured
  };
  constexpr std::array<Band, 2> kBands{{{"mayaux", 0.0864, 0.642}, {kPublished, 0.326, 0.642}}};
  const std::vector<PointCase> cases = RandomPoints(4, kRectangle, 1500);
  const std::vector<Shaded> truth = TruthOf(cases);
  for (const Band& band : kBands) ExpectInBand(*points_, band.variant, cases, truth, band.diffuse, band.specular);
}

}  // namespace
}  // namespace arealab::mayaux_technique_test
