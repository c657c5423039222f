// Every choice of a scene's BRDF: the shader's text in double against each source's own form, its symmetry,
// its sign and its stated normalisation.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "scenes/scene.h"
// clang-format off: the order matters
#include "glsl/dual_begin.h"
#include "glsl/brdf.glsl"
#include "glsl/brdf_choices.h"
#include "glsl/dual_end.h"
// clang-format on

namespace arealab::brdf_choices_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
using glm::dvec3;

// 1/sr, Fresnel 1.
double Value(Brdf brdf, const dvec3& v, const dvec3& l, double alpha) {
  const dvec3 h = glm::normalize(v + l);
  const double tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
  return dual::GgxDensity(h.z, alpha) * dual::BrdfOverGgx(brdf, v.z, l.z, glm::dot(v, h), tan2, alpha);
}

// ∫ f n·l dω over the hemisphere: midpoints over half vectors of slope α tan χ.
double Albedo(Brdf brdf, double cos_v, double alpha) {
  constexpr int kRings = 1500, kSteps = 300;
  const dvec3 v(std::sqrt(1.0 - cos_v * cos_v), 0.0, cos_v);
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double chi = 0.5 * kPi * (i + 0.5) / kRings, slope = alpha * std::tan(chi);
    const double cos_h = 1.0 / std::sqrt(1.0 + slope * slope), sin_h = slope * cos_h;
    const double d_slope = alpha / (std::cos(chi) * std::cos(chi)) * 0.5 * kPi / kRings;
    for (int k = 0; k < kSteps; ++k) {
      const double phi = 2.0 * kPi * (k + 0.5) / kSteps;
      const dvec3 h(sin_h * std::cos(phi), sin_h * std::sin(phi), cos_h);
      const double v_dot_h = glm::dot(v, h);
      const dvec3 l = 2.0 * v_dot_h * h - v;
      if (v_dot_h <= 0.0 || l.z <= 0.0) continue;
      const double f =
          dual::GgxDensity(cos_h, alpha) * dual::BrdfOverGgx(brdf, cos_v, l.z, v_dot_h, slope * slope, alpha);
      sum += f * l.z * 4.0 * v_dot_h * sin_h * cos_h * cos_h * d_slope * 2.0 * kPi / kSteps;
    }
  }
  return sum;
}

class EachBrdf : public testing::TestWithParam<Brdf> {};

TEST_P(EachBrdf, IsReciprocalAndNeitherNegativeNorInfinite) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    const auto direction = [&] {
      const double z = i % 3 == 0 ? 1e-6 + 1e-3 * uniform(engine) : 1e-6 + (1.0 - 1e-6) * uniform(engine);
      const double s = std::sqrt(1.0 - z * z), phi = 2.0 * kPi * uniform(engine);
      return dvec3(s * std::cos(phi), s * std::sin(phi), z);
    };
    const dvec3 v = direction(), l = direction();
    const double roughness = uniform(engine), alpha = std::max(roughness * roughness, 1e-4);
    const double f = Value(GetParam(), v, l, alpha);
    ASSERT_TRUE(std::isfinite(f)) << alpha;
    ASSERT_GE(f, 0.0);
    ASSERT_NEAR(f, Value(GetParam(), l, v, alpha), 1e-9 * f);
  }
}

// What is reflected of an even sky is at most all, but for Blinn-Phong, whose factor is a fit (checked
// below).
TEST_P(EachBrdf, ReflectsAtMostAll) {
  for (const double alpha : {0.05, 0.25, 1.0})
    for (const double cos_v : {1.0, 0.5, 0.1}) {
      const double albedo = Albedo(GetParam(), cos_v, alpha);
      EXPECT_LE(albedo, GetParam() == Brdf::kBlinnPhong ? 1.07 : 1.0 + 1e-4) << alpha << " " << cos_v;
      EXPECT_GT(albedo, 0.0);
    }
}

INSTANTIATE_TEST_SUITE_P(All, EachBrdf, testing::ValuesIn(kBrdfs),
                         [](const auto& brdf) { return std::string(Name(brdf.param)); });

TEST(BrdfChoices, BeckmannsDensityProjectsToOne) {
  for (const double alpha : {0.01, 0.3, 1.0}) {
    double sum = 0.0;
    constexpr int kSteps = 4000;
    for (int i = 0; i < kSteps; ++i) {
      const double chi = 0.5 * kPi * (i + 0.5) / kSteps, slope = alpha * std::tan(chi);
      const double cos_h = 1.0 / std::sqrt(1.0 + slope * slope);
      const double density = dual::GgxDensity(cos_h, alpha) * dual::GaussOverGgx(slope * slope, alpha);
      // cosθ dω = cos⁴θ · slope d(slope) dφ.
      sum += density * std::pow(cos_h, 4) * slope * 2.0 * kPi * alpha / (std::cos(chi) * std::cos(chi)) *
             0.5 * kPi / kSteps;
    }
    EXPECT_NEAR(sum, 1.0, 1e-6) << alpha;
  }
}

// The ratio of the highest to GGX's of the same alpha at the mirror direction, straight on: D(0) is the same
// for GGX, Beckmann and Ward, and all have masking 1 there.
TEST(BrdfChoices, PeaksStraightOn) {
  for (const double alpha : {1e-4, 0.01, 0.25}) {
    const double ggx = dual::BrdfOverGgx(Brdf::kGgx, 1.0, 1.0, 1.0, 0.0, alpha);
    EXPECT_EQ(ggx, 0.25);
    for (const Brdf brdf : {Brdf::kGgxSeparable, Brdf::kBeckmann, Brdf::kWard})
      EXPECT_NEAR(dual::BrdfOverGgx(brdf, 1.0, 1.0, 1.0, 0.0, alpha), 0.25, 1e-15) << Name(brdf);
    EXPECT_NEAR(dual::BrdfOverGgx(Brdf::kBlinnPhong, 1.0, 1.0, 1.0, 0.0, alpha), 0.25 + 0.75 * alpha * alpha,
                1e-15);
    EXPECT_NEAR(dual::BrdfOverGgx(Brdf::kPhong, 1.0, 1.0, 1.0, 0.0, alpha), 0.25 + alpha * alpha, 1e-15);
  }
}

// Λ by the library's erfc; the shader's is a polynomial with an error of 1.2e-8 in ierfc.
TEST(BrdfChoices, BeckmannsMaskingIsThePublishedForm) {
  const auto lambda = [](double c, double alpha) {
    const double a = c / (alpha * std::sqrt(1.0 - c * c));
    return 0.5 * (std::exp(-a * a) / (a * std::sqrt(kPi)) - std::erfc(a));
  };
  for (const double alpha : {0.01, 0.25, 1.0})
    for (const double v : {0.001, 0.05, 0.4, 0.999})
      for (const double l : {0.002, 0.1, 0.7}) {
        const double expected = 0.25 / (v * l * (1.0 + lambda(v, alpha) + lambda(l, alpha)));
        EXPECT_NEAR(dual::BrdfOverGgx(Brdf::kBeckmann, v, l, 0.5, 0.0, alpha), expected, 1e-6 * expected)
            << alpha << " " << v << " " << l;
      }
}

TEST(BrdfChoices, SeparableMaskingIsTheProduct) {
  for (const double alpha : {1e-4, 0.25, 1.0})
    for (const double v : {0.01, 0.4, 1.0})
      for (const double l : {0.02, 0.7}) {
        const double expected = dual::SmithG1(v, alpha) * dual::SmithG1(l, alpha) / (4.0 * v * l);
        EXPECT_NEAR(dual::BrdfOverGgx(Brdf::kGgxSeparable, v, l, 0.5, 0.0, alpha), expected,
                    1e-12 * expected);
      }
}

// (n + 8)/(8π) (n·h)ⁿ, and straight on its albedo (n + 8)(n + 2^(−n/2)) / ((n + 2)(n + 4)) by integration.
TEST(BrdfChoices, BlinnPhongIsTheNormalisedForm) {
  for (const double alpha : {0.02, 0.25, 0.7}) {
    const double n = 2.0 / (alpha * alpha) - 2.0;
    const dvec3 v = glm::normalize(dvec3(0.5, 0.1, 0.8)), l = glm::normalize(dvec3(-0.52, -0.09, 0.79));
    const double expected = (n + 8.0) / (8.0 * kPi) * std::pow(glm::normalize(v + l).z, n);
    EXPECT_NEAR(Value(Brdf::kBlinnPhong, v, l, alpha), expected, 1e-8 * expected);
    const double albedo = (n + 8.0) * (n + std::exp2(-0.5 * n)) / ((n + 2.0) * (n + 4.0));
    EXPECT_NEAR(Albedo(Brdf::kBlinnPhong, 1.0, alpha), albedo, 1e-4);
  }
}

// (m + 2)/(2π) (r·l)^m, and straight on it reflects all.
TEST(BrdfChoices, PhongIsTheNormalisedForm) {
  for (const double alpha : {0.02, 0.25, 0.7}) {
    const double m = 0.5 / (alpha * alpha);
    const dvec3 v = glm::normalize(dvec3(0.5, 0.1, 0.8)), l = glm::normalize(dvec3(-0.52, -0.09, 0.79));
    const double expected = (m + 2.0) / (2.0 * kPi) * std::pow(glm::dot(dvec3(-v.x, -v.y, v.z), l), m);
    EXPECT_NEAR(Value(Brdf::kPhong, v, l, alpha), expected, 1e-8 * expected);
    EXPECT_NEAR(Albedo(Brdf::kPhong, 1.0, alpha), 1.0, 1e-4);
  }
}

// The limit of a mirror: masked lobes and Ward's reflect all; Blinn-Phong without masking (n·v)², Phong's
// lobe, which has a solid angle of its own and is not divided by n·v, the cosine once.
TEST(BrdfChoices, AlbedoOfASharpLobe) {
  constexpr double kAlpha = 0.01;
  for (const double c : {1.0, 0.6}) {
    for (const Brdf brdf : {Brdf::kGgx, Brdf::kGgxSeparable, Brdf::kBeckmann, Brdf::kWard})
      EXPECT_NEAR(Albedo(brdf, c, kAlpha), 1.0, 2e-3) << Name(brdf) << c;
    EXPECT_NEAR(Albedo(Brdf::kBlinnPhong, c, kAlpha), c * c, 1e-3);
    EXPECT_NEAR(Albedo(Brdf::kPhong, c, kAlpha), c, 1e-3);
  }
}

// Burley's own form and what it says of it: symmetric, halved twice at grazing angles where smooth, up to 6.25 times Lambert's back towards
// a grazing light where rough, and at incidence along the normal Lambert's but for a light that grazes.
TEST(BrdfChoices, DisneysDiffuseIsThePublishedForm) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const auto direction = [&] {
      const double z = uniform(engine), phi = 2.0 * kPi * uniform(engine), s = std::sqrt(1.0 - z * z);
      return dvec3(s * std::cos(phi), s * std::sin(phi), z);
    };
    const dvec3 v = direction(), l = direction();
    const double roughness = uniform(engine), cos_d = glm::dot(l, glm::normalize(v + l)), f_d90 = 0.5 + 2.0 * roughness * cos_d * cos_d;
    const double expected = (1.0 + (f_d90 - 1.0) * std::pow(1.0 - l.z, 5)) * (1.0 + (f_d90 - 1.0) * std::pow(1.0 - v.z, 5));
    const auto over_lambert = [&](Brdf brdf, double cos_v, double cos_l) {
      return dual::GgxDensity(0.5, 1.0) * kPi * dual::BrdfOverGgx(brdf, cos_v, cos_l, cos_d, 1.0, 1.0, roughness);
    };
    EXPECT_NEAR(over_lambert(Brdf::kDisney, v.z, l.z), expected, 1e-13);
    EXPECT_NEAR(over_lambert(Brdf::kDisney, l.z, v.z), expected, 1e-13);
    EXPECT_NEAR(over_lambert(Brdf::kLambert, v.z, l.z), 1.0, 1e-14);
    dual::Surface surface;
    surface.normal = dvec3(0.0, 0.0, 1.0);
    surface.roughness = roughness;
    surface.diffuse_albedo = dvec3(0.5);
    EXPECT_NEAR(dual::disney::DiffuseAlbedo(surface, v, l).x, 0.5 * expected, 1e-13);
    EXPECT_EQ(dual::lambert::DiffuseAlbedo(surface, v, l).x, 0.5);
  }
  EXPECT_NEAR(dual::disney::DiffuseOverLambert(0.0, 0.0, 1.0, 0.0), 0.25, 1e-15);
  EXPECT_NEAR(dual::disney::DiffuseOverLambert(0.0, 0.0, 1.0, 1.0), 6.25, 1e-15);
  EXPECT_NEAR(dual::disney::DiffuseOverLambert(1.0, 1.0, 1.0, 1.0), 1.0, 1e-15);
}

TEST(BrdfChoices, Log1pKeepsItsDigits) {
  for (const double x : {-0.9, -0.3, -0.1, -1e-3, -1e-12, 1e-15, 1e-6, 0.01, 0.12, 0.13, 2.0, 1e9})
    EXPECT_NEAR(dual::Log1p(x), std::log1p(x), 3e-15 * std::abs(std::log1p(x)));
}

}  // namespace
}  // namespace arealab::brdf_choices_test
