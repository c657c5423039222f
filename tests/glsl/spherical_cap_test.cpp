// Spherical caps, their intersections, and the solid angles of shapes, in double, against quadrature and
// closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "glsl/dual_begin.h"
#include "glsl/solid_angle.glsl"
#include "glsl/spherical_cap.glsl"
#include "glsl/dual_end.h"

namespace arealab::spherical_cap_test {
namespace {

using dual::Cap;
using dual::CapOverlap;

constexpr double kPi = glm::pi<double>();

class Random {
 public:
  double operator()(double from, double to) { return from + (to - from) * uniform_(engine_); }
  glm::dvec3 Direction() {
    const double z = (*this)(-1.0, 1.0), phi = (*this)(0.0, 2.0 * kPi), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937_64 engine_{4};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

Cap CapOfRadius(const glm::dvec3& axis, double radius) {
  return {axis, 2.0 * std::sin(0.5 * radius) * std::sin(0.5 * radius)};
}

// Rings about a's axis, the part of each that lies in b known in closed form.
CapOverlap Quadrature(const Cap& a, const Cap& b) {
  const double cos_d = glm::dot(a.axis, b.axis);
  const glm::dvec3 across = b.axis - cos_d * a.axis;
  const double sin_d = glm::length(across);
  CapOverlap sum{0.0, glm::dvec3(0.0)};
  constexpr int kRings = 20000;
  for (int i = 0; i < kRings; ++i) {
    const double x = (i + 0.5) / kRings;  // crowded at both ends, where the part has square-root ends
    const double weight = 6.0 * x * (1.0 - x) / kRings * a.versine;
    const double z = 1.0 - a.versine * x * x * (3.0 - 2.0 * x);
    const double r = std::sqrt(std::max(1.0 - z * z, 0.0));
    const double phi = std::acos(glm::clamp((1.0 - b.versine - z * cos_d) / (r * sin_d), -1.0, 1.0));
    sum.area += 2.0 * phi * weight;
    sum.moment += (2.0 * phi * z * a.axis + 2.0 * std::sin(phi) * r * across / sin_d) * weight;
  }
  return sum;
}

double SmallerSolidAngle(const Cap& a, const Cap& b) {
  return 2.0 * kPi * std::min(a.versine, b.versine);
}

TEST(SphericalCap, IntersectionAgreesWithQuadrature) {
  Random random;
  constexpr double kMaxError = 1e-5;  // of the smaller cap; measured 2.3e-6, the rings' own error
  int partial = 0;
  for (int i = 0; i < 300; ++i) {
    Cap a{random.Direction(), random(0.0, 2.0)};
    Cap b{random.Direction(), random(0.0, 2.0)};
    if (i % 3 == 0) a.versine = 1.0;  // the hemisphere where nothing is baked
    if (i % 5 == 0) {
      a.versine *= 0.01;
      b.versine *= 0.01;
      b.axis = glm::normalize(a.axis + 0.1 * random.Direction());
    }
    const CapOverlap exact = dual::IntersectCaps(a, b);
    const CapOverlap expected = Quadrature(a, b);
    const double scale = SmallerSolidAngle(a, b);
    EXPECT_NEAR(exact.area, expected.area, kMaxError * scale) << i;
    EXPECT_LT(glm::length(exact.moment - expected.moment), kMaxError * scale) << i;
    partial += exact.area > 0.01 * scale && exact.area < 0.99 * scale;
  }
  EXPECT_GT(partial, 50);
}

TEST(SphericalCap, IntersectionHasNoOrder) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const Cap a{random.Direction(), random(0.0, 2.0)}, b{random.Direction(), random(0.0, 2.0)};
    const CapOverlap ab = dual::IntersectCaps(a, b), ba = dual::IntersectCaps(b, a);
    EXPECT_NEAR(ab.area, ba.area, 1e-12);
    EXPECT_LT(glm::length(ab.moment - ba.moment), 1e-12);
    EXPECT_LE(glm::length(ab.moment), ab.area * (1.0 + 1e-12));
  }
}

// The lune between two hemispheres at an angle d has the area 2(π − d); its moment lies between the axes.
TEST(SphericalCap, HemispheresShareALune) {
  for (double d : {0.01, 0.5, 1.0, 1.5707, 2.5, 3.1}) {
    const Cap a{{0.0, 0.0, 1.0}, 1.0}, b{{std::sin(d), 0.0, std::cos(d)}, 1.0};
    const CapOverlap overlap = dual::IntersectCaps(a, b);
    EXPECT_NEAR(overlap.area, 2.0 * (kPi - d), 1e-12) << d;
    EXPECT_NEAR(overlap.moment.z, 0.5 * kPi * (1.0 + std::cos(d)), 1e-12)
        << d;  // half-disk plus projected half-disk
  }
}

// The source's formula with its third term's sign corrected (as printed it gives -7 sr, not 0.46 sr, in the
// first case).
TEST(SphericalCap, EqualsOatsFormulaWithItsSignCorrected) {
  const auto oat = [](double r0, double r1, double d) {
    return 2.0 * std::cos(r1) *
               std::acos((-std::cos(r0) + std::cos(d) * std::cos(r1)) / (std::sin(d) * std::sin(r1))) -
           2.0 * std::cos(r0) *
               std::acos((std::cos(r1) - std::cos(d) * std::cos(r0)) / (std::sin(d) * std::sin(r0))) +
           2.0 * std::acos((-std::cos(d) + std::cos(r0) * std::cos(r1)) / (std::sin(r0) * std::sin(r1))) -
           2.0 * kPi * std::cos(r1);
  };
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const double r0 = random(0.1, 1.5), r1 = random(0.1, 1.5);
    const double d = random(std::abs(r0 - r1) + 0.01, r0 + r1 - 0.01);
    const CapOverlap overlap = dual::IntersectCaps(CapOfRadius({0.0, 0.0, 1.0}, r0),
                                                   CapOfRadius({std::sin(d), 0.0, std::cos(d)}, r1));
    EXPECT_NEAR(overlap.area, oat(r0, r1, d), 1e-11) << r0 << " " << r1 << " " << d;
  }
}

TEST(SphericalCap, LimitsAreContinuous) {
  const double r0 = 0.7, r1 = 0.3;
  const auto area = [&](double d) {
    return dual::IntersectCaps(CapOfRadius({0.0, 0.0, 1.0}, r0),
                               CapOfRadius({std::sin(d), 0.0, std::cos(d)}, r1))
        .area;
  };
  const double whole = 2.0 * kPi * (1.0 - std::cos(r1));
  EXPECT_EQ(area(0.0),
            dual::IntersectCaps(CapOfRadius({0.0, 0.0, 1.0}, r1), CapOfRadius({0.0, 0.0, 1.0}, r0)).area);
  EXPECT_NEAR(area(0.0), whole, 1e-14);
  EXPECT_NEAR(area(r0 - r1 - 1e-9), whole, 1e-12);
  EXPECT_NEAR(area(r0 - r1 + 1e-9), whole, 1e-9);
  EXPECT_NEAR(area(r0 + r1 - 1e-9), 0.0, 1e-9);
  EXPECT_EQ(area(r0 + r1 + 1e-9), 0.0);
  EXPECT_EQ(area(3.0), 0.0);
  // A cap with itself.
  const Cap cap = CapOfRadius(glm::normalize(glm::dvec3(1.0, 2.0, 3.0)), 0.4);
  EXPECT_NEAR(dual::IntersectCaps(cap, cap).area, 2.0 * kPi * cap.versine, 1e-14);
}

// A cap as small as a mirror-like lobe keeps its digits.
TEST(SphericalCap, TinyCapsScale) {
  const double d = 1.2;
  const auto ratio = [&](double scale) {
    const CapOverlap overlap =
        dual::IntersectCaps(CapOfRadius({0.0, 0.0, 1.0}, scale),
                            CapOfRadius({std::sin(d * scale), 0.0, std::cos(d * scale)}, scale));
    return overlap.area / (kPi * scale * scale);
  };
  const double plane =
      (2.0 * std::acos(d / 2.0) - d * std::sqrt(1.0 - d * d / 4.0)) / kPi;  // two equal disks
  EXPECT_NEAR(ratio(1e-3), plane, 1e-6);
  EXPECT_NEAR(ratio(1e-5), plane, 1e-7);
}

TEST(SphericalCap, SphereFormFactorIsTheMomentAboveTheHorizon) {
  Random random;
  const Cap horizon{{0.0, 0.0, 1.0}, 1.0};
  for (int i = 0; i < 1000; ++i) {
    const Cap cap{random.Direction(), random(0.0, 1.0)};
    EXPECT_NEAR(dual::SphereFormFactor(cap.axis.z, cap.versine),
                dual::IntersectCaps(horizon, cap).moment.z / kPi, 1e-12);
  }
  EXPECT_NEAR(dual::SphereFormFactor(0.8, 1.0 - std::sqrt(1.0 - 0.04)), 0.8 * 0.04,
              1e-15);  // whole: cosθ R²/d²
  for (double c : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    EXPECT_NEAR(dual::SphereFormFactor(c, 1.0), 0.5 * (1.0 + c), 1e-15);  // touching: half the sky
  }
}

TEST(SphericalCap, SphereSeenFromInsideIsHalfTheSky) {
  const glm::dvec3 up(0.0, 0.0, 1.0);
  EXPECT_EQ(dual::SphereCap({0.0, 0.0, 0.1}, 1.0, up).versine, 1.0);
  EXPECT_EQ(dual::SphereCap({0.0, 0.0, 0.0}, 1.0, up).axis, up);
  EXPECT_NEAR(dual::SphereCap({0.0, 0.0, 1e6}, 1.0, up).versine, 0.5e-12, 1e-24);
}

TEST(SphericalCap, SmoothstepOverlapMeetsItsLimits) {
  EXPECT_EQ(dual::SmoothstepOverlap(2.0, 0.5, 1.5), 1.0);
  EXPECT_EQ(dual::SmoothstepOverlap(0.5, 2.0, 0.0), 1.0);
  EXPECT_EQ(dual::SmoothstepOverlap(2.0, 0.5, 2.5), 0.0);
  EXPECT_DOUBLE_EQ(dual::SmoothstepOverlap(2.0, 0.5, 2.0), 0.5);
  EXPECT_EQ(dual::SmoothstepOverlap(0.0, 0.0, 0.0), 1.0);
  // The middle of the shared part of the segments [-2, 2] and [1.5, 2.5].
  EXPECT_DOUBLE_EQ(2.0 * dual::OverlapCenter(2.0, 0.5, 2.0), 1.75);
  EXPECT_EQ(dual::OverlapCenter(2.0, 0.5, 1.0), 1.0);
  EXPECT_EQ(dual::OverlapCenter(0.5, 2.0, 1.0), 0.0);
}

TEST(SphericalCap, AlongArcTurnsEvenly) {
  const glm::dvec3 a(0.0, 0.0, 1.0);
  for (double angle : {1e-9, 1e-3, 1.0, 3.0}) {
    const glm::dvec3 b(std::sin(angle), 0.0, std::cos(angle));
    const glm::dvec3 third = dual::AlongArc(a, b, dual::VersineBetween(a, b), 1.0 / 3.0);
    EXPECT_NEAR(third.x, std::sin(angle / 3.0), 1e-6) << angle;
    EXPECT_NEAR(glm::length(third), 1.0, 1e-6) << angle;
  }
  EXPECT_EQ(dual::AlongArc(a, -a, 2.0, 0.7), -a);
}

TEST(SolidAngle, RectangleIsExact) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 p(random(-3.0, 3.0), random(-3.0, 3.0), std::exp(random(-4.0, 3.0)));
    const glm::dvec2 half(random(0.05, 2.0), random(0.05, 2.0));
    const auto corner = [&](double x, double y) {
      return std::atan2(x * y, p.z * std::sqrt(x * x + y * y + p.z * p.z));
    };
    const double expected = corner(half.x - p.x, half.y - p.y) - corner(-half.x - p.x, half.y - p.y) -
                            corner(half.x - p.x, -half.y - p.y) + corner(-half.x - p.x, -half.y - p.y);
    EXPECT_NEAR(dual::RectangleSolidAngle(p, half), expected, 1e-12 * (1.0 + expected));
  }
  EXPECT_NEAR(dual::RectangleSolidAngle({0.0, 0.0, 1e-4}, {1.0, 1.0}), 2.0 * kPi, 1e-3);
  EXPECT_NEAR(dual::RectangleSolidAngle({0.0, 0.0, 1e3}, {0.5, 0.5}), 1e-6, 1e-12);
  EXPECT_LT(dual::RectangleSolidAngle({2.0, 0.0, 0.0}, {1.0, 1.0}), 1e-4);
}

// ∮ (1 − h/√(h² + s²)) dφ about the foot of the perpendicular.
double DiskContour(const glm::dvec3& p, double radius) {
  const double rho = std::hypot(p.x, p.y);
  constexpr int kNodes = 20000;
  double sum = 0.0;
  for (int i = 0; i < kNodes; ++i) {
    const double t = 2.0 * kPi * (i + 0.5) / kNodes;
    const double x = radius * std::cos(t) - rho, y = radius * std::sin(t), s2 = x * x + y * y;
    const double l = std::sqrt(p.z * p.z + s2);
    sum += (radius * radius - radius * rho * std::cos(t)) / (l * (l + p.z));
  }
  return sum * 2.0 * kPi / kNodes;
}

TEST(SolidAngle, DiskIsWithinItsStatedError) {
  Random random;
  double worst = 0.0, worst_near_rim = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 p(random(-3.0, 3.0), random(-3.0, 3.0), std::exp(random(-4.0, 3.0)));
    const double radius = random(0.1, 2.0);
    const double error = std::abs(dual::DiskSolidAngle(p, radius) / DiskContour(p, radius) - 1.0);
    const double to_rim = std::hypot(std::hypot(p.x, p.y) - radius, p.z) / radius;
    (to_rim > 0.2 ? worst : worst_near_rim) = std::max(to_rim > 0.2 ? worst : worst_near_rim, error);
  }
  EXPECT_LT(worst, 5e-5);           // measured 2.5e-5
  EXPECT_LT(worst_near_rim, 5e-2);  // measured 2.0e-2
  EXPECT_NEAR(dual::DiskSolidAngle({0.0, 0.0, 2.0}, 1.5), 2.0 * kPi * (1.0 - 2.0 / 2.5), 1e-14);
}

}  // namespace
}  // namespace arealab::spherical_cap_test
