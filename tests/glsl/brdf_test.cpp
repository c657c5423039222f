// The shader's BRDF text in double against its definitions and the identities that any masking function must
// keep.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "glsl/dual_begin.h"
#include "glsl/polar_rule.glsl"
#include "glsl/dual_end.h"

namespace arealab::brdf_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

// ∫ over slopes of half vectors, s = α tan χ (cos φ, sin φ): f(n·h, h_x) · dω_h, by midpoints.
double OverHalfVectors(double alpha, const std::function<double(double, double)>& f) {
  constexpr int kRings = 2000, kSteps = 400;
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    double chi = 0.5 * kPi * (i + 0.5) / kRings, slope = alpha * std::tan(chi);
    double cos_h = 1.0 / std::sqrt(1.0 + slope * slope), sin_h = slope * cos_h;
    double d_slope = alpha / (std::cos(chi) * std::cos(chi)) * 0.5 * kPi / kRings;
    for (int k = 0; k < kSteps; ++k) {
      double phi = 2.0 * kPi * (k + 0.5) / kSteps;
      sum += f(cos_h, sin_h * std::cos(phi)) * sin_h * cos_h * cos_h * d_slope * 2.0 * kPi / kSteps;
    }
  }
  return sum;
}

TEST(Brdf, DensityProjectsToOne) {
  for (double alpha : {1e-4, 0.01, 0.25, 1.0}) {
    double projected =
        OverHalfVectors(alpha, [&](double c, double) { return dual::GgxDensity(c, alpha) * c; });
    EXPECT_NEAR(projected, 1.0, alpha < 1e-3 ? 1e-4 : 1e-6)
        << alpha;  // 1 − (n·h)² has lost 8 digits at alpha = 1e-4
  }
}

TEST(Brdf, DensityIsThePublishedForm) {
  for (double alpha : {0.01, 0.3, 1.0}) {
    for (double cos_h : {0.05, 0.5, 0.99, 1.0}) {
      double tan2 = 1.0 / (cos_h * cos_h) - 1.0, x = alpha * alpha + tan2;  // [Walter 2007, eq. 33]
      double expected = alpha * alpha / (kPi * std::pow(cos_h, 4) * x * x);
      EXPECT_NEAR(dual::GgxDensity(cos_h, alpha), expected, 1e-10 * expected);
    }
  }
}

// The weak white furnace: with masking alone the BRDF D G1 / (4 n·v) sends everything somewhere, be it below
// the horizon: ∫ D G1 / (4 n·v) dω_l = 1, dω_l = 4 (v·h) dω_h, over v·h > 0 [Heitz 2014, section 5.4].
TEST(Brdf, WeakWhiteFurnace) {
  for (double alpha : {0.01, 0.0625, 0.25, 0.5625, 1.0}) {
    for (double cos_v : {1.0, 0.7, 0.3, 0.05}) {
      double sin_v = std::sqrt(1.0 - cos_v * cos_v);
      double furnace = OverHalfVectors(alpha, [&](double cos_h, double h_x) {
        double v_dot_h = std::max(sin_v * h_x + cos_v * cos_h, 0.0);
        return dual::GgxDensity(cos_h, alpha) * dual::SmithG1(cos_v, alpha) * v_dot_h / cos_v;
      });
      EXPECT_NEAR(furnace, 1.0, 1e-4) << alpha << " " << cos_v;
    }
  }
}

// G2 = 1 / (1 + Λ(v) + Λ(l)) [Heitz 2014, eq. 99], Λ = (−1 + √(1 + α² tan²θ)) / 2 [eq. 72], G1 = 1 / (1 + Λ)
// [eq. 43].
TEST(Brdf, MaskingIsThePublishedForm) {
  auto lambda = [](double c, double alpha) {
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 / (c * c) - 1.0)) - 1.0);
  };
  for (double alpha : {1e-4, 0.1, 1.0}) {
    for (double v : {0.01, 0.4, 1.0}) {
      EXPECT_NEAR(dual::SmithG1(v, alpha), 1.0 / (1.0 + lambda(v, alpha)), 1e-12);
      for (double l : {0.02, 0.6, 1.0}) {
        double expected = 1.0 / ((1.0 + lambda(v, alpha) + lambda(l, alpha)) * 4.0 * v * l);
        EXPECT_NEAR(dual::SmithVisibility(v, l, alpha), expected, 1e-12 * expected);
        EXPECT_EQ(dual::SmithVisibility(v, l, alpha), dual::SmithVisibility(l, v, alpha));
      }
    }
  }
  EXPECT_EQ(dual::SmithVisibility(1.0, 1.0, 0.5), 0.25);
}

TEST(Brdf, SchlickRunsFromNothingToAll) {
  EXPECT_EQ(dual::SchlickWeight(1.0), 0.0);
  EXPECT_EQ(dual::SchlickWeight(0.0), 1.0);
  EXPECT_NEAR(dual::SchlickWeight(0.5), 1.0 / 32.0, 1e-16);
  EXPECT_EQ(dual::SchlickWeight(1.0 + 1e-7), 0.0);  // rounding does not make it negative
}

// The slope plane's parts: n·l from the slope of the half vector, and the lobe as D · V · n·l with its
// Jacobian.
TEST(PolarRule, LobeIsTheBrdfInSlopes) {
  for (double cos_v : {0.9, 0.2}) {
    double alpha = 0.3, sin_v = std::sqrt(1.0 - cos_v * cos_v);
    dual::LobeView view{sin_v, cos_v, alpha, -1.0};
    for (glm::dvec3 l :
         {glm::dvec3(0.1, 0.2, 0.9), glm::dvec3(-0.9, 0.1, 0.2), glm::dvec3(0.5, -0.7, 0.02)}) {
      l = glm::normalize(l);
      glm::dvec3 v(sin_v, 0.0, cos_v), h = glm::normalize(l + v);
      double slope_x = h.x / h.z, slope2 = (h.x * h.x + h.y * h.y) / (h.z * h.z), v_dot_h = glm::dot(v, h);
      EXPECT_NEAR(dual::CosineFromSlope(view, slope_x, slope2), l.z, 1e-14);
      // dω_l = 4 (v·h) dω_h, dω_h = (n·h)³ d²s.
      double expected = dual::GgxDensity(h.z, alpha) * dual::SmithVisibility(cos_v, l.z, alpha) * l.z * 4.0 *
                        v_dot_h * std::pow(h.z, 3);
      double tail = alpha * alpha + slope2, p22 = alpha * alpha / (kPi * tail * tail);
      dual::vec2 lobe = dual::LobeWeights(dual::LightAtSlope(view, slope_x, slope2),
                                          dual::SmithVisibility(cos_v, l.z, alpha));
      EXPECT_NEAR(lobe.x * p22, expected, 1e-12 * expected);
      EXPECT_NEAR(lobe.y / lobe.x, std::pow(1.0 - v_dot_h, 5), 1e-12);
    }
  }
}

TEST(PolarRule, RayMapAndItsInverse) {
  for (double x : {1e-9, 1e-3, 0.3, 1.0, 40.0, 1e5}) {
    double y = dual::RayMapInverse(x), p, slope, ahead, behind, unused;
    dual::RayMap(y, p, slope);
    EXPECT_NEAR(p, x, 1e-9 * x);
    double step = 1e-6 * y;
    dual::RayMap(y + step, ahead, unused);
    dual::RayMap(y - step, behind, unused);
    EXPECT_NEAR((ahead - behind) / (2.0 * step), slope, 1e-5 * slope);
  }
}

TEST(PolarRule, ArcDerivatives) {
  dual::LobeView view{0.6, 0.8, 0.3, -1.0};
  dual::Arc arc{{0.0, 0.8, 0.6}, {1.0, 0.0, 0.0}, {0.0, -0.6, 0.8}, 0.8, 0.6, 0.6, 0.8, -0.9, 0.7};
  for (double t : {-0.9, -0.2, 0.0, 0.5}) {
    constexpr double kStep = 1e-6;
    dual::vec2 slope, derivative, ahead, behind, unused;
    dual::ArcSlope(arc, view, t, slope, derivative);
    dual::ArcSlope(arc, view, t + kStep, ahead, unused);
    dual::ArcSlope(arc, view, t - kStep, behind, unused);
    EXPECT_NEAR((ahead.x - behind.x) / (2.0 * kStep), derivative.x, 1e-8);
    EXPECT_NEAR((ahead.y - behind.y) / (2.0 * kStep), derivative.y, 1e-8);
    double height, rise, high, low, rest;
    dual::ArcHeight(arc, t, height, rise);
    dual::ArcHeight(arc, t + kStep, high, rest);
    dual::ArcHeight(arc, t - kStep, low, rest);
    EXPECT_NEAR((high - low) / (2.0 * kStep), rise, 1e-8);
    // The slope's light has that height.
    EXPECT_NEAR(dual::CosineFromSlope(view, slope.x, slope.x * slope.x + slope.y * slope.y), height, 1e-12);
  }
}

}  // namespace
}  // namespace arealab::brdf_test
