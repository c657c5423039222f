// Representative points, importance cones and their footprints on lights, in double.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "scenes/scene.h"

#define EFFECT_FRESNEL 1
#include "glsl/dual_begin.h"
#include "glsl/brdf.glsl"
#include "glsl/brdf_choices.h"
#include "glsl/brdf/ggx.glsl"
#include "glsl/spherical_cap.glsl"
#include "glsl/importance_cone/ggx.glsl"
#include "glsl/importance_cone.glsl"
#include "glsl/elongated_footprint.glsl"
#include "glsl/representative_point.glsl"
#include "glsl/specular_albedo.glsl"
namespace ward {
#include "glsl/specular_albedo/ward.glsl"
}
namespace unit {
#include "glsl/bisector/unit.glsl"
}
namespace sum {
#include "glsl/bisector/sum.glsl"
}
namespace cone_beckmann {
#include "glsl/importance_cone/beckmann.glsl"
}
namespace cone_blinn_phong {
#include "glsl/importance_cone/blinn_phong.glsl"
}
namespace cone_phong {
#include "glsl/importance_cone/phong.glsl"
}
#include "glsl/dual_end.h"

namespace arealab {
namespace {

constexpr double kPi = glm::pi<double>();

glm::dvec3 OnPlane(const glm::dvec3& point, const glm::dvec2& hit) {
  return {hit, -point.z};
}

TEST(RepresentativePoint, NormalHitIsOnTheNormalWhereItMeetsThePlane) {
  const glm::dvec3 point(0.3, -0.2, 1.5), normal = glm::normalize(glm::dvec3(0.4, 0.5, -0.6));
  const glm::dvec3 to_hit = OnPlane(point, dual::NormalHit(point, normal));
  EXPECT_LT(glm::length(glm::cross(normal, to_hit)), 1e-14);
}

// The skew changes directions near the plane's own only, and nothing jumps where the normal turns away.
TEST(RepresentativePoint, SkewIsContinuousAndFinite) {
  const glm::dvec3 point(0.3, -0.2, 1.5);
  glm::dvec2 before = dual::NormalHit(point, {0.0, 0.0, -1.0});
  for (int i = 1; i <= 20000; ++i) {
    const double angle = kPi * i / 20000;
    const glm::dvec3 normal(std::sin(angle), 0.0, -std::cos(angle));
    const glm::dvec2 hit = dual::NormalHit(point, normal);
    EXPECT_LT(glm::length(hit - before), 0.03 * point.z);  // one step of 1.6e-4 rad, slope at most 1/kSkew²
    EXPECT_LE(glm::length(hit), point.z / dual::kSkew + 1e-12);
    before = hit;
  }
}

TEST(RepresentativePoint, NearestHitIsTheFootOrOnTheHorizon) {
  const glm::dvec3 point(0.3, -0.2, 1.5);
  EXPECT_EQ(dual::NearestHit(point, glm::normalize(glm::dvec3(0.4, 0.5, -0.6))), glm::dvec2(0.0));
  const glm::dvec3 away = glm::normalize(glm::dvec3(0.4, 0.5, 0.6));
  const glm::dvec3 to_hit = OnPlane(point, dual::NearestHit(point, away));
  EXPECT_NEAR(glm::dot(to_hit, away), 0.0, 1e-14);
  // Nearest of the horizon's line: along the normal's own trace.
  EXPECT_NEAR(to_hit.x * away.y - to_hit.y * away.x, 0.0, 1e-14);
}

TEST(RepresentativePoint, HalfwayHitBisects) {
  const glm::dvec3 point(0.3, -0.2, 1.5);
  const glm::dvec2 a(2.0, 1.0), b(-0.5, 0.25);
  const glm::dvec3 to_hit = OnPlane(point, dual::unit::HalfwayHit(point, a, b));
  const glm::dvec3 direction = glm::normalize(to_hit);
  EXPECT_NEAR(glm::dot(direction, glm::normalize(OnPlane(point, a))),
              glm::dot(direction, glm::normalize(OnPlane(point, b))), 1e-14);
  EXPECT_NEAR(glm::determinant(glm::dmat3(OnPlane(point, a), OnPlane(point, b), to_hit)), 0.0, 1e-13);
}

// The pseudo code's sum of vectors as they come, by its word: the ray along it meets the plane in the middle between both points.
TEST(RepresentativePoint, HalfwayHitOfTheSumIsTheMiddle) {
  const glm::dvec3 point(0.3, -0.2, 1.5);
  const glm::dvec2 a(2.0, 1.0), b(-0.5, 0.25);
  const glm::dvec3 along = OnPlane(point, a) + OnPlane(point, b);
  const glm::dvec2 hit = glm::dvec2(along) * (point.z / -along.z);
  EXPECT_NEAR(glm::length(dual::sum::HalfwayHit(point, a, b) - hit), 0.0, 1e-15);
}

TEST(RepresentativePoint, ClosestPointsOfShapes) {
  const glm::dvec2 foot(0.5, 0.0);
  EXPECT_EQ(dual::ClosestOnRectangle(foot, {2.5, 0.1}, {1.0, 0.5}), glm::dvec2(0.5, 0.1));
  EXPECT_NEAR(glm::length(foot + dual::ClosestOnDisk(foot, {2.5, 4.0}, 2.0) - glm::dvec2(1.2, 1.6)), 0.0, 1e-15);
  EXPECT_EQ(dual::ClosestOnDisk(foot, {-0.2, 0.4}, 2.0), glm::dvec2(-0.2, 0.4));
}

// At the cone's edge the half vector's density has fallen to 1/e of its peak.
TEST(ImportanceCone, ThresholdIsOneOverE) {
  for (double alpha : {1e-4, 0.01, 0.1, 0.3, 0.5}) {
    const double half_angle = 0.5 * dual::AngleFromVersine(dual::ThresholdConeVersine(alpha));
    EXPECT_NEAR(dual::GgxDensity(std::cos(half_angle), alpha) / dual::GgxDensity(1.0, alpha), std::exp(-1.0),
                alpha < 1e-3 ? 1e-6 : 1e-9)
        << alpha;
  }
}

// Peak times solid angle: what a wide light of radiance 1 reflects from a smooth surface. 1 for the energy's
// cone at every view angle; at normal incidence σ = 1/e keeps 0.65 of it, and gives back more than all at
// grazing view.
TEST(ImportanceCone, EnergyOfTheCones) {
  const double alpha = 0.02;
  for (double n_dot_v : {1.0, 0.7, 0.4, 0.2}) {
    const double peak =
        dual::GgxDensity(1.0, alpha) * dual::SmithVisibility(n_dot_v, n_dot_v, alpha) * n_dot_v;
    const double masking = 4.0 * n_dot_v * n_dot_v * dual::SmithVisibility(n_dot_v, n_dot_v, alpha);
    EXPECT_NEAR(peak * 2.0 * kPi * dual::EnergyConeVersine(alpha, n_dot_v), masking, 1e-12);
    EXPECT_NEAR(masking, 1.0, 0.01);
    EXPECT_NEAR(peak * 2.0 * kPi * dual::ThresholdConeVersine(alpha) * n_dot_v, 0.6487 * masking, 1e-3);
  }
}

// The same for every BRDF: the peak times the whole cone is what the BRDF's mirror tends to, at every view angle; and Drobot's half angle √(2/(m + 2)),
// which makes Phong's peak times its cone 1.
TEST(ImportanceCone, WholeConesOfTheOtherBrdfs) {
  const double alpha = 0.02;
  for (double n_dot_v : {1.0, 0.7, 0.4}) {
    const auto peak = [&](Brdf brdf) {
      return dual::GgxDensity(1.0, alpha) * dual::BrdfOverGgx(brdf, n_dot_v, n_dot_v, n_dot_v, 0.0, alpha) * n_dot_v;
    };
    const double facets = 2.0 * kPi * dual::cone_beckmann::WholeConeVersine(alpha) * dual::cone_beckmann::ConeAcross(n_dot_v);
    EXPECT_NEAR(peak(Brdf::kBeckmann) * facets, 1.0, 0.01);
    EXPECT_NEAR(peak(Brdf::kWard) * facets, 1.0, 1e-9);
    EXPECT_NEAR(peak(Brdf::kGgxSeparable) * 2.0 * kPi * dual::EnergyConeVersine(alpha, n_dot_v), 1.0, 0.01);
    EXPECT_NEAR(peak(Brdf::kBlinnPhong) * 2.0 * kPi * dual::cone_blinn_phong::WholeConeVersine(alpha) * dual::cone_blinn_phong::ConeAcross(n_dot_v),
                n_dot_v * n_dot_v, 1e-9);
    EXPECT_NEAR(peak(Brdf::kPhong) * 2.0 * kPi * dual::cone_phong::WholeConeVersine(alpha), n_dot_v, 1e-9);
    EXPECT_NEAR(peak(Brdf::kPhong) * 2.0 * kPi * dual::cone_phong::ThresholdConeVersine(alpha), n_dot_v, 1e-3);
  }
}

// Where the thresholds lie: the lobes have fallen to 1/e but for what their comments leave out, an alpha squared.
TEST(ImportanceCone, ThresholdsOfTheOtherBrdfs) {
  for (double alpha : {1e-3, 0.01, 0.05}) {
    const auto half = [&](double versine) { return 0.5 * dual::AngleFromVersine(versine); };
    const double phong = 2.0 * half(dual::cone_phong::ThresholdConeVersine(alpha));
    EXPECT_NEAR(std::pow(std::cos(phong), 0.5 / (alpha * alpha)), std::exp(-1.0), 4.0 * alpha * alpha);
    EXPECT_NEAR(phong, std::sqrt(2.0 / (0.5 / (alpha * alpha) + 2.0)), 1e-9);
    const double blinn = half(dual::cone_blinn_phong::ThresholdConeVersine(alpha));
    EXPECT_NEAR(std::pow(std::cos(blinn), 2.0 / (alpha * alpha) - 2.0), std::exp(-1.0), 4.0 * alpha * alpha);
    const double slope = std::tan(half(dual::cone_beckmann::ThresholdConeVersine(alpha)));
    EXPECT_NEAR(slope, alpha, 1e-9);
  }
}

struct Outlined {
  double area = 0.0;
  glm::dvec2 center{0.0};
};

// Of a convex polygon clipped side by side against a rectangle about the origin [Sutherland & Hodgman 1974].
Outlined ClippedBySides(std::vector<glm::dvec2> polygon, const glm::dvec2& half) {
  for (const auto& [normal, offset] : {std::pair(glm::dvec2(1, 0), half.x), std::pair(glm::dvec2(-1, 0), half.x),
                                       std::pair(glm::dvec2(0, 1), half.y), std::pair(glm::dvec2(0, -1), half.y)}) {
    std::vector<glm::dvec2> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double hp = offset - glm::dot(normal, p), hq = offset - glm::dot(normal, q);
      if (hp >= 0.0) kept.push_back(p);
      if (hp * hq < 0.0) kept.push_back(p + (q - p) * (hp / (hp - hq)));
    }
    polygon = kept;
  }
  Outlined result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double cross = p.x * q.y - p.y * q.x;
    result.area += 0.5 * cross;
    result.center += (p + q) * (cross / 6.0);
  }
  if (result.area != 0.0) result.center /= result.area;
  result.area = std::abs(result.area);
  return result;
}

TEST(ElongatedFootprint, ClipsAsSidesOneByOneDo) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int crossing = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec2 half(0.5 + 0.4 * uniform(engine), 0.5 + 0.4 * uniform(engine));
    const glm::dvec2 center(uniform(engine) * 1.5, uniform(engine) * 1.5);
    glm::dvec2 a(uniform(engine), uniform(engine)), b(uniform(engine), uniform(engine));
    if (i % 5 == 0) a.y = b.x = 0.0;  // sides along the window's
    if (i % 7 == 0) a *= 0.05;
    const Outlined expected = ClippedBySides({center + a + b, center - a + b, center - a - b, center + a - b}, half);
    const dual::LitPart part = dual::ParallelogramOnRectangle(center, a, b, half);
    ASSERT_NEAR(part.area, expected.area, 1e-12) << i;
    const glm::dvec2 at = center + part.shift;
    ASSERT_LE(std::abs(at.x), half.x + 1e-12) << i;
    ASSERT_LE(std::abs(at.y), half.y + 1e-12) << i;
    if (expected.area < 1e-6) continue;
    ASSERT_LT(glm::length(at - expected.center), 1e-8) << i;
    if (expected.area < 0.99 * 4.0 * std::abs(a.x * b.y - a.y * b.x)) ++crossing;
  }
  EXPECT_GT(crossing, 5000);
}

// Its area is the round footprint's; over a large light it is centred where the mirror ray meets it; as long against its width as
// the lobe's, 1/(n·v), along the plane of incidence.
TEST(ElongatedFootprint, IsAsLongAsTheLobe) {
  const glm::dvec3 point(0.2, -0.1, 1.5);
  for (double n_dot_v : {1.0, 0.8, 0.5}) {
    // The mirror direction is the plane's normal, the surface's normal turned from it by the view's angle.
    const glm::dvec3 mirror(0.0, 0.0, -1.0), normal(std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, -n_dot_v);
    const dual::Footprint footprint = dual::ConeFootprint(point, mirror, 1e-4, true);
    const auto area = [&](const glm::dvec2& half) {
      return dual::ElongatedFootprintOnRectangle({glm::dvec2(0.0), footprint.offset, footprint.radius}, point, normal, mirror, n_dot_v, half).area;
    };
    const double whole = area({1.0, 1.0});
    EXPECT_NEAR(whole / (kPi * footprint.radius * footprint.radius), 1.0, 1e-12);
    // Strips through the middle: as long as the footprint, in whole times the strip's width.
    const double strip = 1e-6, length_x = area({1.0, strip}) / (2.0 * strip), length_y = area({strip, 1.0}) / (2.0 * strip);
    if (n_dot_v < 1.0) {
      EXPECT_NEAR(length_y / length_x, n_dot_v, 1e-9);
    }
  }
}

// By the lobe's own text, the peak in double; and the sine's form equals the cosine's.
TEST(ImportanceCone, DensityBetweenVectors) {
  const glm::dvec3 n(0.0, 0.0, 1.0);
  for (double angle : {0.0, 1e-3, 0.1, 1.0, 1.5}) {
    const glm::dvec3 h(std::sin(angle), 0.0, std::cos(angle));
    EXPECT_NEAR(dual::GgxDensityBetween(n, h, 0.2) / dual::GgxDensity(std::cos(angle), 0.2), 1.0, 1e-9);
  }
}

TEST(ImportanceCone, FootprintOfAStraightConeIsItsSection) {
  const glm::dvec3 point(0.5, 0.25, 2.0);
  const double half_angle = 0.3, versine = 1.0 - std::cos(half_angle);
  const dual::Footprint plain = dual::ConeFootprint(point, {0.0, 0.0, -1.0}, versine, false);
  EXPECT_NEAR(glm::length(plain.center - glm::dvec2(point)), 0.0, 1e-15);
  EXPECT_NEAR(plain.radius, 2.0 * std::tan(half_angle), 1e-14);
  const glm::dvec3 slanted = glm::normalize(glm::dvec3(1.0, 0.5, -1.0));
  const dual::Footprint kept = dual::ConeFootprint(point, slanted, versine, true);
  const double reach = point.z / -slanted.z;
  EXPECT_NEAR(kPi * kept.radius * kept.radius * -slanted.z / (reach * reach), 2.0 * kPi * versine, 1e-14);
}

// As the mirror direction turns away from the plane the lit part of a light nowhere jumps, and a narrow cone
// loses it.
TEST(ImportanceCone, FootprintIsContinuousWhereItMissesThePlane) {
  for (const bool keep : {false, true}) {
    for (double alpha : {0.05, 0.3, 0.7, 1.0}) {
      const double versine = dual::EnergyConeVersine(alpha, 0.8);
      double before = -1.0;
      constexpr int kSteps = 200000;
      for (int i = 0; i <= kSteps; ++i) {
        const double angle = kPi * i / kSteps;
        const dual::Footprint footprint =
            dual::ConeFootprint({0.4, 0.1, 1.0}, {std::sin(angle), 0.0, -std::cos(angle)}, versine, keep);
        const double area = dual::FootprintOnDisk(footprint, 0.8).area;
        ASSERT_TRUE(std::isfinite(area) && area >= 0.0) << angle;
        // One step is 1.6e-5 rad; measured 0.0203 where the last of a cone leaves the plane.
        if (before >= 0.0) {
          ASSERT_LT(std::abs(area - before), 0.04) << angle << " " << alpha;
        }
        before = area;
      }
      if (alpha < 0.5) {
        EXPECT_EQ(before, 0.0);
      }
    }
  }
}

TEST(ImportanceCone, PartsOfLights) {
  // Wholly inside, wholly covering, apart; square of equal area.
  dual::LitPart part = dual::FootprintOnDisk({{0.2, 0.0}, {0.0, 0.0}, 0.1}, 1.0);
  EXPECT_NEAR(part.area, kPi * 0.01, 1e-15);
  EXPECT_NEAR(part.shift.x, 0.0, 1e-15);
  part = dual::FootprintOnDisk({{0.2, 0.0}, {0.0, 0.0}, 10.0}, 1.0);
  EXPECT_NEAR(part.area, kPi, 1e-15);
  EXPECT_EQ(part.shift.x, -0.2);
  EXPECT_EQ(dual::FootprintOnDisk({{3.0, 0.0}, {0.0, 0.0}, 1.0}, 1.0).area, 0.0);
  part = dual::FootprintOnRectangle({{0.2, 0.1}, {0.0, 0.0}, 0.1}, {1.0, 0.5});
  EXPECT_NEAR(part.area, kPi * 0.01, 1e-15);
  EXPECT_EQ(part.shift.y, 0.0);
  part = dual::FootprintOnRectangle({{0.9, 0.0}, {0.0, 0.0}, 2.0 * 0.2 / std::sqrt(kPi)}, {1.0, 0.5});
  EXPECT_NEAR(part.area, 0.3 * 0.4, 1e-15);
  EXPECT_NEAR(part.shift.x, -0.05, 1e-15);
  part = dual::FootprintOnRectangle({{0.0, 0.0}, {0.0, 0.0}, 1e6}, {1.0, 0.5});
  EXPECT_EQ(part.area, 2.0);
  part = dual::FootprintOnRectangle({{5.0, 0.0}, {0.0, 0.0}, 1.0}, {1.0, 0.5});
  EXPECT_EQ(part.area, 0.0);
  EXPECT_EQ(part.shift.x, -4.0);  // the light's nearest side
}

// The fits against quadrature over facets, at nodes other than their own. `facet`(u): cos² of the facet at the share u of the
// density; `weight`(n_dot_v, n_dot_l, v_dot_h, n_dot_h): the lobe over that sampling's density.
void CheckAlbedo(const auto& fit, const auto& facet, const auto& lobe, const glm::dvec2& rms, const glm::dvec2& worst) {
  double squares_x = 0.0, squares_y = 0.0, worst_x = 0.0, worst_y = 0.0;
  int count = 0;
  for (double roughness = 0.03; roughness < 1.0; roughness += 0.097) {
    for (double n_dot_v = 0.05; n_dot_v < 1.0; n_dot_v += 0.093) {
      const double alpha = std::max(roughness * roughness, 1e-4);
      const glm::dvec3 v(std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
      glm::dvec2 expected(0.0);
      constexpr int kRings = 64, kSpokes = 128;
      for (int i = 0; i < kRings; ++i) {
        const double u = (i + 0.5) / kRings;
        const double cos2 = facet(u, alpha);
        for (int j = 0; j < kSpokes; ++j) {
          const double phi = 2.0 * kPi * (j + 0.5) / kSpokes, sine = std::sqrt(1.0 - cos2);
          const glm::dvec3 h(sine * std::cos(phi), sine * std::sin(phi), std::sqrt(cos2));
          const double v_dot_h = glm::dot(v, h);
          const double n_dot_l = 2.0 * v_dot_h * h.z - v.z;
          if (v_dot_h <= 0.0 || n_dot_l <= 0.0) continue;
          const double weight = lobe(n_dot_v, n_dot_l, v_dot_h, h.z, alpha);
          expected += glm::dvec2(1.0, dual::SchlickWeight(v_dot_h)) * weight / double{kRings * kSpokes};
        }
      }
      const glm::dvec2 error = fit(n_dot_v, roughness) - expected;
      squares_x += error.x * error.x;
      squares_y += error.y * error.y;
      worst_x = std::max(worst_x, std::abs(error.x));
      worst_y = std::max(worst_y, std::abs(error.y));
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(squares_x / count), rms.x);
  EXPECT_LT(std::sqrt(squares_y / count), rms.y);
  EXPECT_LT(worst_x, worst.x);
  EXPECT_LT(worst_y, worst.y);
}

TEST(SpecularAlbedo, FitIsWithinItsStatedError) {
  CheckAlbedo([](double n_dot_v, double roughness) { return dual::SpecularAlbedo(n_dot_v, roughness); },
              [](double u, double alpha) { return (1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u); },
              [](double n_dot_v, double n_dot_l, double v_dot_h, double n_dot_h, double alpha) {
                return dual::SmithVisibility(n_dot_v, n_dot_l, alpha) * 4.0 * n_dot_l * v_dot_h / n_dot_h;
              },
              {0.012, 0.012}, {0.045, 0.06});
}

// By Ward's own formula with H = l + v: |H|²/(n·H)⁴ · n·l over the density of facets is n·l/(v·h n·h).
TEST(SpecularAlbedo, WardsFitIsWithinItsStatedError) {
  CheckAlbedo([](double n_dot_v, double roughness) { return dual::ward::LobeAlbedo(n_dot_v, roughness); },
              [](double u, double alpha) { return 1.0 / (1.0 - alpha * alpha * std::log1p(-u)); },
              [](double, double n_dot_l, double v_dot_h, double n_dot_h, double) { return n_dot_l / (v_dot_h * n_dot_h); },
              {0.016, 0.014}, {0.06, 0.06});
}

}  // namespace
}  // namespace arealab
