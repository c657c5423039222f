// The drobot technique: its limits, its bands against truth, what its author says of its points, and that it
// stays finite.
#include <gmock/gmock.h>

#include <array>
#include <limits>

#include "compare/closed_forms.h"
#include "tests/compare/technique_laws.h"

#include "glsl/dual_begin.h"
#include "glsl/representative_point.glsl"
#include "glsl/solid_angle.glsl"
#include "glsl/dual_end.h"

namespace arealab::drobot_technique_test {
namespace {

class DrobotTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }
  static std::unique_ptr<TechniquePoints> points_;
};
std::unique_ptr<TechniquePoints> DrobotTechnique::points_;

constexpr const char* kPublished = "drobot@published";
constexpr const char* kByTheWord = "drobot+point=halfway+extent=area+cone=threshold";  // eq. 1.16

TEST_F(DrobotTechnique, SphereDiffuseIsTheClosedForm) {
  PointRandom random(1);
  std::vector<PointCase> cases;
  std::vector<Shaded> truth;
  for (int i = 0; i < 500; ++i) {
    cases.push_back(RandomPoint(random, LightShape::kSphere));
    truth.push_back({cases.back().Truth().form_factor, 0.0});
  }
  for (const char* name : {"drobot", kPublished}) {
    const std::vector<Shaded> shaded = points_->Shade(name, cases, Precision::kDouble);
    for (std::size_t i = 0; i < cases.size(); ++i)
      EXPECT_NEAR(shaded[i].diffuse, truth[i].diffuse, 2e-7) << i;
  }
  // Float: the driver's arc tangent, 2e-5, tells at the horizon.
  EXPECT_LT(RelativeRmse(points_->Shade("drobot", cases), truth, &Shaded::diffuse), 5e-5);
}

// A shrinking light tends to the point technique: diffuse everywhere, specular where its cone holds the
// light.
TEST_F(DrobotTechnique, ShrinkingLightTendsToThePoint) {
  PointRandom random(2);
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    std::vector<PointCase> cases;
    while (cases.size() < 200) {
      PointCase c = RandomPoint(random, shape);
      c.half_size *= 1e-3;
      const glm::dvec3 to_light = glm::normalize(c.center);
      c.normal = glm::normalize(to_light + c.to_view);  // the mirror direction hits it
      if (glm::dot(c.normal, to_light) < 0.3 || glm::dot(c.light_normal, -to_light) < 0.3) continue;
      c.roughness = random(0.3, 0.8);
      cases.push_back(c);
    }
    const std::vector<Shaded> point = points_->Shade("point", cases, Precision::kDouble);
    for (const Variant& variant : points_->Variants("drobot")) {
      const std::vector<Shaded> shaded = points_->Shade(variant.Name(), cases, Precision::kDouble);
      if (variant.options.at("point") != "plane" || shape == LightShape::kSphere) {  // by the word the light's place does not matter
        EXPECT_LT(RelativeRmse(shaded, point, &Shaded::diffuse), 5e-3) << variant.Name() << Name(shape);
      }
      EXPECT_LT(RelativeRmse(shaded, point, &Shaded::specular), 5e-3) << variant.Name() << Name(shape);
    }
  }
}

// A smooth surface is a mirror: the radiance of a light that fills the lobe comes back as it is, at every
// view angle and tilt of the light. The published cone returns 0.65/(n·v) of it, and less where the light is
// seen aslant.
TEST_F(DrobotTechnique, WideLightOverASmoothSurface) {
  std::vector<PointCase> cases;
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    for (const double n_dot_v : {1.0, 0.8, 0.5, 0.3}) {
      PointCase c;
      c.shape = shape;
      c.roughness = 0.1;
      c.to_view = {std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v};
      c.center = glm::dvec3(-c.to_view.x, 0.0, c.to_view.z) * 2.0;
      c.half_size = glm::dvec2(1.0);
      cases.push_back(c);  // the light stays level, so it is seen at the angle of the view
    }
  }
  const std::vector<Shaded> ours = points_->Shade("drobot", cases), his = points_->Shade(kPublished, cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double n_dot_v = cases[i].to_view.z;
    EXPECT_NEAR(ours[i].specular, 1.0, 0.01) << i;
    // A sphere's cone has no slant to lose.
    const double expected = 0.6487 / n_dot_v * (cases[i].shape == LightShape::kSphere ? 1.0 : n_dot_v);
    EXPECT_NEAR(his[i].specular, expected, 0.02 * expected) << i;
  }
}

TEST_F(DrobotTechnique, StaysFinite) {
  const std::vector<PointCase> cases = HardPoints();
  for (const Variant& variant : points_->Variants("drobot")) {
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      if (precision == Precision::kDouble && variant.Name() != "drobot")
        continue;  // it costs ten times float's time
      const std::vector<Shaded> shaded = points_->Shade(variant.Name(), cases, precision);
      const bool cut = variant.options.at("excess") == "cut";
      for (std::size_t i = 0; i < cases.size(); ++i) {
        ASSERT_TRUE(shaded[i].diffuse >= 0.0 && shaded[i].diffuse <= (cut ? 1.0 + 1e-6 : std::numeric_limits<float>::max()))
            << variant.Name() << " " << i;
        ASSERT_TRUE(shaded[i].specular >= 0.0 && std::isfinite(shaded[i].specular))
            << variant.Name() << " " << i;
        // 1/(n·v) too much at worst (the published cone), and n·v is at least 1e-3 here.
        if (cut) {
          ASSERT_LT(shaded[i].specular, 1.1e3) << variant.Name() << " " << i;
        }
      }
    }
  }
}

TEST_F(DrobotTechnique, FloatAgreesWithDouble) {
  PointRandom random(3);
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    std::vector<PointCase> cases;
    for (int i = 0; i < 5000; ++i) cases.push_back(RandomPoint(random, shape));
    for (const Variant& variant : points_->Variants("drobot")) {
      const auto in_float = points_->Shade(variant.Name(), cases);
      const auto in_double = points_->Shade(variant.Name(), cases, Precision::kDouble);
      EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::diffuse), 1e-4)
          << variant.Name() << " " << Name(shape);
      EXPECT_LT(RelativeRmse(in_float, in_double, &Shaded::specular), 5e-4)
          << variant.Name() << " " << Name(shape);
    }
  }
}

// Relative RMSE against truth over random lights: the technique's own error, from both sides.
TEST_F(DrobotTechnique, StandsInItsBandsAgainstTruth) {
  struct Band {
    const char* variant;
    LightShape shape;
    double diffuse, specular;  // measured
  };
  constexpr std::array<Band, 8> kBands{{
      {"drobot", LightShape::kRectangle, 0.594, 0.412},
      {"drobot", LightShape::kDisk, 0.524, 0.294},
      {"drobot", LightShape::kSphere, 0.0, 0.46},
      {kPublished, LightShape::kRectangle, 0.705, 0.855},
      {kPublished, LightShape::kDisk, 0.686, 3.01},
      {kByTheWord, LightShape::kRectangle, 3.25, 0.855},
      {kByTheWord, LightShape::kDisk, 2.81, 3.01},
      {kPublished, LightShape::kSphere, 0.0, 0.79},
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

// "A statistical error less than 0.05 against best-point", "more than 0.15" for the shipped form [§1.3.3],
// without a measure or the lights. Here: lights of ours that are wholly above the horizon and face it, as he
// assumes; the mean relative difference from the value at the best point of the segment between both maxima,
// the one whose value comes nearest to the integral, and how near that is. His first figure comes out with
// the light's solid angle and not with eq. 1.16 by the word, where even the best point is far off: hence
// the published form's extent.
TEST_F(DrobotTechnique, PointsAgainstTheBestPoint) {
  PointRandom random(5);
  enum Extent { kSolidAngle, kArea, kExtents };
  constexpr std::array<std::array<const char*, 2>, kExtents> kForms{
      {{"drobot", "drobot+point=halfway"},
       {"drobot+extent=area", "drobot+point=halfway+extent=area"}}};  // closest, halfway
  std::vector<PointCase> cases;
  std::vector<double> truth;
  std::array<std::vector<double>, kExtents> best;
  std::array<double, kExtents> best_error{};
  constexpr int kLights = 600;
  while (static_cast<int>(cases.size()) < kLights) {
    PointCase c = RandomPoint(random, cases.size() % 2 ? LightShape::kDisk : LightShape::kRectangle);
    const double extent = glm::length(c.half_size);
    if (glm::dot(c.normal, c.center) < extent || glm::dot(c.normal, c.light_normal) > 0.0) continue;
    cases.push_back(c);
    truth.push_back(c.Truth().form_factor);
    const glm::dvec3 point(glm::dot(-c.center, c.axis_x), glm::dot(-c.center, c.axis_y),
                           glm::dot(-c.center, c.light_normal));
    const glm::dvec3 normal(glm::dot(c.normal, c.axis_x), glm::dot(c.normal, c.axis_y),
                            glm::dot(c.normal, c.light_normal));
    const glm::dvec2 foot(point);
    const bool disk = c.shape == LightShape::kDisk;
    const auto closest = [&](const glm::dvec2& p) {
      return disk ? dual::ClosestOnDisk({}, p, c.half_size.x) : dual::ClosestOnRectangle({}, p, c.half_size);
    };
    const glm::dvec2 p_c = closest(foot + dual::NormalHit(point, normal)),
                     p_r = closest(foot + dual::NearestHit(point, normal));
    const double area =
        disk ? glm::pi<double>() * c.half_size.x * c.half_size.x : 4.0 * c.half_size.x * c.half_size.y;
    const double solid_angle =
        disk ? dual::DiskSolidAngle(point, c.half_size.x) : dual::RectangleSolidAngle(point, c.half_size);
    std::array<double, kExtents> nearest{INFINITY, INFINITY};
    for (int i = 0; i <= 200; ++i) {
      const glm::dvec3 to_light(glm::mix(p_c, p_r, i / 200.0) - foot, -point.z);
      const double r = glm::length(to_light);
      const double cosine = glm::dot(normal, to_light) / r / glm::pi<double>();
      const std::array<double, kExtents> value{cosine * solid_angle, cosine * area * point.z / (r * r * r)};
      for (std::size_t e = 0; e < kExtents; ++e) {
        if (std::abs(value[e] - truth.back()) < std::abs(nearest[e] - truth.back())) nearest[e] = value[e];
      }
    }
    for (std::size_t e = 0; e < kExtents; ++e) {
      best[e].push_back(nearest[e]);
      best_error[e] += std::abs(nearest[e] / truth.back() - 1.0) / kLights;
    }
  }
  // Mean relative errors, measured: of the best point, of each form against it, of each form against the
  // integral.
  struct Errors {
    double best;
    std::array<double, 2> from_best, from_truth;  // closest, halfway
  };
  constexpr std::array<Errors, kExtents> kMeasured{
      {{0.0699, {0.044, 0.0675}, {0.116, 0.139}}, {0.673, {0.127, 0.27}, {0.833, 0.995}}}};
  constexpr double kSlack = 0.05;  // relative
  for (std::size_t e = 0; e < kExtents; ++e) {
    EXPECT_NEAR(best_error[e], kMeasured[e].best, kMeasured[e].best * kSlack) << e;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::vector<Shaded> shaded = points_->Shade(kForms[e][k], cases);
      double from_best = 0.0, from_truth = 0.0;
      for (std::size_t i = 0; i < cases.size(); ++i) {
        from_best += std::abs(shaded[i].diffuse / best[e][i] - 1.0) / kLights;
        from_truth += std::abs(shaded[i].diffuse / truth[i] - 1.0) / kLights;
      }
      EXPECT_NEAR(from_best, kMeasured[e].from_best[k], kMeasured[e].from_best[k] * kSlack) << kForms[e][k];
      EXPECT_NEAR(from_truth, kMeasured[e].from_truth[k], kMeasured[e].from_truth[k] * kSlack)
          << kForms[e][k];
    }
  }
}

}  // namespace
}  // namespace arealab::drobot_technique_test
