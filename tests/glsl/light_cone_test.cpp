// The form factors of disks, ellipses and spheres transformed by a lobe's matrix, in double, against the
// contour integral over their rims by quadrature.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "glsl/dual_begin.h"
#include "glsl/light_cone.glsl"
namespace closed {
#include "glsl/sphere/exact.glsl"
namespace cone {
#include "glsl/disk/cone.glsl"
}
namespace eigen {
#include "glsl/disk/eigen.glsl"
}
}  // namespace closed
namespace clipped {
#include "glsl/disk/exact.glsl"
}
#include "glsl/dual_end.h"

namespace arealab {
namespace {

using dual::DiskView;
using dual::SphereView;
using glm::dvec3;
using glm::dvec4;

constexpr double kPi = glm::pi<double>();
const dvec4 kIdentity(1.0, 0.0, 0.0, 1.0);

class Random {
 public:
  double operator()(double from, double to) { return from + (to - from) * uniform_(engine_); }
  double Log(double from, double to) { return from * std::pow(to / from, uniform_(engine_)); }
  dvec3 Direction() {
    const double z = (*this)(-1.0, 1.0), phi = (*this)(0.0, 2.0 * kPi), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  // M⁻¹ of a lobe, from round to fifty times as long as wide.
  dvec4 Lobe() {
    dvec4 m(Log(1.0, 50.0), (*this)(-5.0, 5.0), (*this)(-5.0, 5.0), Log(0.5, 20.0));
    if (m.x * m.w - m.y * m.z <= 0.1) m.y = 0.0;
    return m;
  }

 private:
  std::mt19937_64 engine_{2017};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

using Integrand = std::function<dvec3(double)>;

// Adaptive Simpson, to `tolerance` absolute.
dvec3 Refine(const Integrand& f, double a, double b, const dvec3& fa, const dvec3& fm, const dvec3& fb,
             double tolerance, int depth) {
  const double m = 0.5 * (a + b);
  const dvec3 f1 = f(0.5 * (a + m)), f2 = f(0.5 * (m + b));
  const dvec3 whole = (b - a) / 6.0 * (fa + 4.0 * fm + fb), left = (m - a) / 6.0 * (fa + 4.0 * f1 + fm),
              right = (b - m) / 6.0 * (fm + 4.0 * f2 + fb), change = left + right - whole;
  if (depth == 0 || glm::length(change) < 15.0 * tolerance) return left + right + change / 15.0;
  return Refine(f, a, m, fa, f1, fm, 0.5 * tolerance, depth - 1) +
         Refine(f, m, b, fm, f2, fb, 0.5 * tolerance, depth - 1);
}

// (2π)⁻¹ ∮ p × dp / |p|² over the rim center + a cos t + b sin t above the horizon and the side in it.
dvec3 ContourVector(const dvec3& center, const dvec3& a, const dvec3& b) {
  const double rise = std::hypot(a.z, b.z);
  if (center.z <= -rise) return dvec3(0.0);
  double from = 0.0, to = 2.0 * kPi;
  const bool crosses = center.z < rise;
  if (crosses) {
    const double top = std::atan2(b.z, a.z), half = std::acos(-center.z / rise);
    from = top - half;
    to = top + half;
  }
  const Integrand integrand = [&](double t) {
    const dvec3 p = center + a * std::cos(t) + b * std::sin(t);
    return glm::cross(p, b * std::cos(t) - a * std::sin(t)) / glm::dot(p, p);
  };
  constexpr int kPieces = 16;
  dvec3 sum(0.0);
  for (int i = 0; i < kPieces; ++i) {
    const double t0 = from + (to - from) * i / kPieces, t1 = from + (to - from) * (i + 1) / kPieces;
    sum += Refine(integrand, t0, t1, integrand(t0), integrand(0.5 * (t0 + t1)), integrand(t1), 1e-8, 30);
  }
  if (crosses) {
    const dvec3 p = center + a * std::cos(to) + b * std::sin(to),
                q = center + a * std::cos(from) + b * std::sin(from);
    sum.z += std::atan2(p.x * q.y - p.y * q.x, p.x * q.x + p.y * q.y);
  }
  return sum * ((glm::dot(glm::cross(a, b), center) < 0.0 ? -0.5 : 0.5) / kPi);
}

dvec3 TransformedContour(const dvec4& m, const dvec3& center, const dvec3& a, const dvec3& b) {
  return ContourVector(dual::LtcTransform(m, center), dual::LtcTransform(m, a), dual::LtcTransform(m, b));
}

// Facing the origin.
DiskView MakeDisk(const dvec3& center, const dvec3& axis_x, const dvec3& normal, double a, double b) {
  const dvec3 axis_y = glm::cross(normal, axis_x);
  const dvec3 place(glm::dot(center, axis_x) / a, glm::dot(center, axis_y) / b, glm::dot(center, normal));
  return {center, a * axis_x, b * axis_y, normal, place, {axis_x.z, axis_y.z, normal.z}, {a, b}};
}

const std::array<std::string, 10> kPlaces{"ordinary", "near", "far",  "grazing", "edge-on",
                                          "below",    "tiny", "huge", "1:10",    "above the rim"};

DiskView RandomDisk(Random& random, const std::string& place) {
  double distance = random.Log(0.5, 5.0), a = random.Log(0.2, 2.0), b = a;
  dvec3 direction = random.Direction(), normal = random.Direction();
  if (place == "near") distance = random.Log(0.01, 0.3) * a;
  if (place == "far") distance = random.Log(10.0, 1000.0);
  if (place == "grazing") direction = glm::normalize(dvec3(direction.x, direction.y, random(-0.05, 0.05)));
  if (place == "edge-on")
    normal = glm::normalize(glm::cross(direction, normal) + 1e-2 * random(-1.0, 1.0) * direction);
  if (place == "below") direction.z = -std::abs(direction.z);
  if (place == "tiny") a = b = random.Log(1e-5, 1e-3);
  if (place == "huge") a = b = random.Log(10.0, 1e4);
  if (place == "1:10") b = 0.1 * a;
  if (glm::dot(normal, direction) > 0.0) normal = -normal;
  const dvec3 axis_x = glm::normalize(glm::cross(normal, random.Direction()));
  dvec3 center = distance * direction;
  if (place == "above the rim")
    center = -a * ((1.0 + 0.1 * random(-1.0, 1.0)) * axis_x + random.Log(1e-4, 0.1) * normal);
  return MakeDisk(center, axis_x, normal, a, b);
}

TEST(LightCone, ClippedDiskIsTheContourIntegral) {
  Random random;
  for (const bool lambert : {true, false}) {
    for (const std::string& place : kPlaces) {
      double worst = 0.0, worst_vector = 0.0;
      for (int i = 0; i < 300; ++i) {
        const DiskView disk = RandomDisk(random, place);
        const dvec4 m = lambert ? kIdentity : random.Lobe();
        const dvec3 f = dual::clipped::LobeOfDisk(m, disk);
        const dvec3 expected = TransformedContour(m, disk.center, disk.half_a, disk.half_b);
        worst = std::max(worst, std::abs(f.z - std::max(expected.z, 0.0)));
        worst_vector = std::max(worst_vector, glm::length(f - expected));
      }
      // The root's polynomial: measured at most 1.9e-5 and 2.0e-5 over 10 000 each.
      EXPECT_LT(worst, 4e-5) << place << (lambert ? ", Lambert" : "");
      EXPECT_LT(worst_vector, 4e-5) << place << (lambert ? ", Lambert" : "");
    }
  }
}

TEST(LightCone, ClippedSphereIsTheContourIntegralOfItsRim) {
  Random random;
  double worst = 0.0, worst_vector = 0.0, worst_lambert = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const SphereView sphere{random.Direction(), random.Log(1e-8, 0.9999)};
    const dvec4 m = i % 4 == 0 ? kIdentity : random.Lobe();
    const dvec3 axis_x = glm::normalize(glm::cross(sphere.direction, random.Direction()));
    const double tangent = std::sqrt(sphere.sin2 / (1.0 - sphere.sin2));
    const dvec3 expected = TransformedContour(m, sphere.direction, tangent * axis_x,
                                              tangent * glm::cross(sphere.direction, axis_x));
    const dvec3 f = dual::clipped::LobeOfSphere(m, sphere);
    worst = std::max(worst, std::abs(f.z - expected.z));
    worst_vector = std::max(worst_vector, glm::length(f - expected));
    if (i % 4 == 0)
      worst_lambert = std::max(worst_lambert, std::abs(dual::clipped::LambertSphere(sphere) - expected.z));
  }
  EXPECT_LT(worst, 4e-5);
  EXPECT_LT(worst_vector, 4e-5);
  EXPECT_LT(worst_lambert, 1e-7);
}

// The light's own axes change nothing.
TEST(LightCone, LambertIsTheRoundLobe) {
  Random random;
  for (const std::string& place : kPlaces) {
    for (int i = 0; i < 300; ++i) {
      const DiskView disk = RandomDisk(random, place);
      ASSERT_NEAR(dual::closed::cone::LambertDisk(disk), dual::closed::cone::LobeOfDisk(kIdentity, disk).z,
                  1e-9)
          << place;
      ASSERT_EQ(dual::clipped::LambertDisk(disk), dual::clipped::LobeOfDisk(kIdentity, disk).z) << place;
    }
  }
}

// Both forms have the same proxy sphere, since both have the exact |F| and direction; ours without a number
// that is none.
TEST(LightCone, CubicOfThePublishedFormGivesTheSameCone) {
  Random random;
  for (const std::string& place : kPlaces) {
    int lost = 0;
    double worst = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const DiskView disk = RandomDisk(random, place);
      const dvec4 m = random.Lobe();
      const dvec3 ours = dual::closed::cone::LobeOfDisk(m, disk),
                  published = dual::closed::eigen::LobeOfDisk(m, disk);
      ASSERT_TRUE(std::isfinite(ours.x + ours.y + ours.z)) << place;
      if (!std::isfinite(published.x + published.y + published.z)) {
        ++lost;
      } else {
        worst = std::max(worst, glm::length(ours - published));
      }
    }
    EXPECT_LT(worst, 4e-5) << place;  // measured at most 1.1e-5
    EXPECT_EQ(lost, 0) << place;  // in double; in float its discriminant is rounding where eigenvalues meet
  }
}

// The middle of the disk's axis, its plane, its centre, the inside of a sphere, no size at all.
TEST(LightCone, DegenerateLightsStayFinite) {
  const auto expect_sound = [](const dvec3& f, const std::string& what) {
    EXPECT_TRUE(std::isfinite(f.x + f.y + f.z)) << what;
    EXPECT_GE(f.z, 0.0) << what;
    EXPECT_LE(f.z, 1.0) << what;
  };
  for (const double tilt : {0.0, 0.7, 0.5 * kPi, kPi}) {
    const dvec3 normal(std::sin(tilt), 0.0, -std::cos(tilt));
    for (const dvec4& m : {kIdentity, dvec4(1e4, 0.3, -20.0, 1e3)}) {
      for (const double size : {1e-12, 1.0, 1e12}) {
        for (const double aside : {0.0, 1.0, 3.0}) {
          for (const double height : {0.0, 1e-9, 1.0, 1e9}) {
            const dvec3 center = aside * size * dvec3(0.0, 1.0, 0.0) - height * normal;
            const DiskView disk = MakeDisk(center, {0.0, 1.0, 0.0}, normal, size, size);
            expect_sound(dual::clipped::LobeOfDisk(m, disk), "disk");
            expect_sound(dual::closed::cone::LobeOfDisk(m, disk), "disk by proxy");
          }
        }
      }
      for (const double sin2 : {0.0, 1e-20, 0.5, 1.0 - 1e-6}) {
        expect_sound(dual::clipped::LobeOfSphere(m, {normal, sin2}), "sphere");
        expect_sound(dual::closed::cone::LobeOfSphere(m, {normal, sin2}), "sphere by proxy");
      }
    }
  }
}

}  // namespace
}  // namespace arealab
