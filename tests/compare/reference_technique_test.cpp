// The reference technique against the CPU's truth: the same rule at a fixed number of nodes, in float and in double.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/compare/technique_points.h"

namespace arealab::reference_technique_test {
namespace {

class ReferenceTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;
};
std::unique_ptr<TechniquePoints> ReferenceTechnique::points_;

constexpr double kF0 = 0.3;  // between metal and glass, so that both specular integrals count

struct Case {
  LightShape shape;
  const char* variant;
  Precision precision;
  // Share of points whose specular may be further than 1e-3 from the truth, and relative RMSE over all.
  double outliers, rmse;
};

// A diffuse lobe by the rule that else has the specular one.
TEST_F(ReferenceTechnique, DisneysDiffuseLobeIsTheTruths) {
  const Brdfs brdfs(Brdf::kGgx, Brdf::kDisney);
  PointRandom random(12);
  std::vector<PointCase> cases;
  std::vector<Shaded> truth;
  for (int i = 0; i < 600; ++i) {
    cases.push_back(RandomPoint(random, i % 2 == 0 ? LightShape::kRectangle : LightShape::kSphere));
    truth.push_back({cases.back().Truth(1e-6, brdfs).form_factor, 0.0});
  }
  PointOptions options;
  options.brdfs = brdfs;
  const std::vector<Shaded> shaded = points_->Shade(points_->Variants("reference").front(), cases, options);
  EXPECT_LT(RelativeRmse(shaded, truth, &Shaded::diffuse), 1e-4);
  // It is no Lambertian form factor.
  EXPECT_GT(RelativeRmse(points_->Shade("reference", cases), truth, &Shaded::diffuse), 0.02);
}

class ReferenceAgainstTruth : public ReferenceTechnique, public testing::WithParamInterface<Case> {};

TEST_P(ReferenceAgainstTruth, AgreesWithinItsStatedError) {
  PointRandom random(11);
  std::vector<PointCase> cases;
  std::vector<Shaded> truth;
  for (int i = 0; i < 1500; ++i) {
    PointCase c = RandomPoint(random, GetParam().shape);
    c.f0 = static_cast<float>(kF0);
    cases.push_back(c);
    const LightIntegrals light = c.Truth(1e-6);
    truth.push_back({light.form_factor, c.f0 * (light.specular - light.specular_grazing) + light.specular_grazing});
  }
  const std::vector<Shaded> shaded = points_->Shade(GetParam().variant, cases, GetParam().precision);
  int lit = 0, far = 0;
  double worst_diffuse = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    worst_diffuse = std::max(worst_diffuse, std::abs(shaded[i].diffuse - truth[i].diffuse));
    if (truth[i].specular > 1e-6) {
      ++lit;
      far += !(std::abs(shaded[i].specular - truth[i].specular) <= 1e-3 * truth[i].specular);
    }
  }
  EXPECT_LE(far, GetParam().outliers * lit) << lit;
  EXPECT_LT(RelativeRmse(shaded, truth, &Shaded::specular), GetParam().rmse);
  EXPECT_LT(worst_diffuse, GetParam().precision == Precision::kDouble ? 1e-7 : 2e-6);
}

INSTANTIATE_TEST_SUITE_P(
    All, ReferenceAgainstTruth,
    testing::Values(Case{LightShape::kRectangle, "reference", Precision::kFloat, 0.03, 1e-3},
                    Case{LightShape::kDisk, "reference", Precision::kFloat, 0.03, 1e-3},
                    Case{LightShape::kSphere, "reference", Precision::kFloat, 0.03, 1e-3},
                    Case{LightShape::kRectangle, "reference+level=dense", Precision::kFloat, 0.003, 1e-4},
                    Case{LightShape::kDisk, "reference+level=dense", Precision::kFloat, 0.003, 1e-4},
                    Case{LightShape::kSphere, "reference+level=dense", Precision::kFloat, 0.003, 1e-4},
                    Case{LightShape::kRectangle, "reference+level=dense", Precision::kDouble, 0.003, 1e-4},
                    Case{LightShape::kDisk, "reference+level=dense", Precision::kDouble, 0.003, 1e-4},
                    Case{LightShape::kSphere, "reference+level=dense", Precision::kDouble, 0.003, 1e-4}));

TEST_F(ReferenceTechnique, HardPointsAreFinite) {
  const std::vector<PointCase> cases = HardPoints();
  const std::vector<Shaded> shaded = points_->Shade("reference", cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_TRUE(std::isfinite(shaded[i].diffuse) && shaded[i].diffuse >= 0.0) << i << " " << shaded[i].diffuse;
    EXPECT_TRUE(std::isfinite(shaded[i].specular) && shaded[i].specular >= 0.0) << i << " " << shaded[i].specular;
  }
}

// Shrinking lights tend to the point technique's, diffuse and specular.
TEST_F(ReferenceTechnique, ShrinkingLightTendsToThePoint) {
  PointRandom random(12);
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    std::vector<PointCase> cases;
    for (int i = 0; i < 200; ++i) {
      cases.push_back(RandomPoint(random, shape));
      cases.back().half_size *= 1e-3;
    }
    const std::vector<Shaded> point = points_->Shade("point", cases, Precision::kDouble);
    const std::vector<Shaded> shaded = points_->Shade("reference", cases, Precision::kDouble);
    EXPECT_LT(RelativeRmse(shaded, point, &Shaded::diffuse), 1e-5) << Name(shape);
    EXPECT_LT(RelativeRmse(shaded, point, &Shaded::specular), 1e-3) << Name(shape);
  }
}

}  // namespace
}  // namespace arealab::reference_technique_test
