// ltc and hill on disks and spheres: exact for Lambert against the truth's closed forms, the same text in
// float, the point's limit, the published form beside ours, and what degenerate lights leave.
#include <gtest/gtest.h>

#include <array>

#include "tests/compare/technique_laws.h"

namespace arealab::disk_technique_test {
namespace {

constexpr std::array kShapes{LightShape::kDisk, LightShape::kSphere};

class DiskTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;
};
std::unique_ptr<TechniquePoints> DiskTechnique::points_;

double LargestDifference(const std::vector<Shaded>& a, const std::vector<Shaded>& b, double Shaded::*lobe) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i].*lobe - b[i].*lobe));
  return largest;
}

// Lights of every size, near, far and in their own plane, mostly crossing the horizon.
std::vector<PointCase> RandomLights(unsigned seed, LightShape shape, int count) {
  PointRandom random(seed);
  std::vector<PointCase> cases;
  for (int i = 0; i < count; ++i) {
    PointCase c = RandomPoint(random, shape);
    c.center *= random.Log(0.2, 5.0);
    c.half_size = glm::dvec2(random.Log(0.01, 3.0));
    if (shape == LightShape::kSphere)
      c.half_size = glm::min(c.half_size, glm::dvec2(0.95 * glm::length(c.center)));
    c.roughness = random(0.05, 1.0);
    cases.push_back(c.Rounded());
  }
  return cases;
}

TEST_F(DiskTechnique, ExactForLambert) {
  for (const LightShape shape : kShapes) {
    SCOPED_TRACE(Name(shape));
    const std::vector<PointCase> cases = RandomLights(11, shape, 4000);
    const std::vector<Shaded> truth = TruthOf(cases);
    const std::vector<Shaded> in_double = points_->Shade("ltc", cases, Precision::kDouble);
    EXPECT_LT(RelativeRmse(in_double, truth, &Shaded::diffuse), 1e-5);       // measured 2.8e-6, 7.2e-8
    EXPECT_LT(LargestDifference(in_double, truth, &Shaded::diffuse), 2e-5);  // 5.5e-6, 3.0e-7
    const std::vector<Shaded> in_float = points_->Shade("ltc", cases);
    EXPECT_LT(RelativeRmse(in_float, truth, &Shaded::diffuse), 1e-4);       // 3.0e-6, 3.4e-5
    EXPECT_LT(LargestDifference(in_float, truth, &Shaded::diffuse), 1e-4);  // 5.5e-6, 3.2e-5
  }
}

// Relative RMSE against truth, from both sides: what the tables, the proxy sphere and Fresnel leave.
TEST_F(DiskTechnique, StandsInItsBandsAgainstTruth) {
  struct Band {
    const char* variant;
    LightShape shape;
    double diffuse, specular;  // measured
  };
  for (const Band& band :
       {Band{"ltc", LightShape::kDisk, 3.0e-6, 0.0208}, Band{"ltc", LightShape::kSphere, 3.4e-5, 0.0194},
        Band{"hill", LightShape::kDisk, 0.0133, 0.0269}, Band{"hill", LightShape::kSphere, 0.0041, 0.0260},
        Band{"ltc@published", LightShape::kDisk, 0.0167, 0.1018},
        Band{"ltc@published", LightShape::kSphere, 0.0002, 0.0959},
        Band{"hill@published", LightShape::kDisk, 0.0167, 0.1018}}) {
    SCOPED_TRACE(std::string(band.variant) + " " + Name(band.shape));
    const std::vector<PointCase> cases = RandomLights(11, band.shape, 4000);
    const std::vector<Shaded> shaded = points_->Shade(band.variant, cases), truth = TruthOf(cases);
    EXPECT_NEAR(RelativeRmse(shaded, truth, &Shaded::diffuse), band.diffuse, 0.1 * band.diffuse + 1e-4);
    EXPECT_NEAR(RelativeRmse(shaded, truth, &Shaded::specular), band.specular, 0.1 * band.specular);
  }
}

TEST_F(DiskTechnique, FloatAgainstTheSameTextInDouble) {
  for (const LightShape shape : kShapes) {
    const std::vector<PointCase> cases = RandomLights(12, shape, 8192);
    for (const char* name : {"ltc", "hill"}) {
      SCOPED_TRACE(std::string(name) + " " + Name(shape));
      const auto in_float = points_->Shade(name, cases),
                 in_double = points_->Shade(name, cases, Precision::kDouble);
      EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::diffuse), 1e-4);        // measured at most 3.5e-5
      EXPECT_LT(LargestDifference(in_float, in_double, &Shaded::diffuse), 1e-4);   // 3.2e-5
      EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::specular), 1e-5);       // 1.3e-6
      EXPECT_LT(LargestDifference(in_float, in_double, &Shaded::specular), 1e-4);  // 1.1e-5
    }
  }
}

TEST_F(DiskTechnique, ShrinkingLightTendsToThePoint) {
  for (const LightShape shape : kShapes) {
    std::vector<PointCase> cases = RandomPoints(13, shape, 200);
    for (PointCase& c : cases) c.half_size *= 1e-3;
    const std::vector<Shaded> point = points_->Shade("point", cases, Precision::kDouble);
    for (const char* name : {"ltc", "hill"}) {
      EXPECT_LT(RelativeRmse(points_->Shade(name, cases, Precision::kDouble), point, &Shaded::diffuse), 1e-4)
          << name;
    }
  }
}

TEST_F(DiskTechnique, DegenerateLightsStayFinite) {
  std::vector<PointCase> cases;
  for (const PointCase& c : HardPoints()) {
    if (c.shape != LightShape::kRectangle) cases.push_back(c);
  }
  for (const char* name : {"ltc", "hill", "ltc+fit=l3", "hill+sphere=table"}) {
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      const std::vector<Shaded> shaded = points_->Shade(name, cases, precision);
      for (std::size_t i = 0; i < cases.size(); ++i) {
        ASSERT_TRUE(std::isfinite(shaded[i].diffuse) && shaded[i].diffuse >= 0.0) << name << " " << i;
        ASSERT_TRUE(std::isfinite(shaded[i].specular) && shaded[i].specular >= 0.0) << name << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace arealab::disk_technique_test
