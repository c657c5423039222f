// The LTC techniques on the GL, each pixel a random shaded point with a random light of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <random>

#include "glsl/fit.h"
#include "tests/compare/technique_points.h"

namespace arealab::ltc_technique_test {
namespace {

class LtcTechnique : public testing::Test {
 protected:
  static void SetUpTestSuite() { points_ = std::make_unique<TechniquePoints>(); }
  static void TearDownTestSuite() { points_.reset(); }

  static std::vector<Shaded> Shade(const std::string& variant, const std::vector<PointCase>& cases,
                                   Precision precision = Precision::kFloat) {
    return points_->Shade(variant, cases, precision);
  }

  inline static std::unique_ptr<TechniquePoints> points_;
};

class Random {
 public:
  double operator()(double from, double to) { return from + (to - from) * uniform_(engine_); }
  double Log(double from, double to) { return from * std::pow(to / from, uniform_(engine_)); }
  glm::dvec3 Direction() {
    const double z = (*this)(-1.0, 1.0), phi = (*this)(0.0, glm::two_pi<double>()),
                 r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937_64 engine_{20262};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

std::vector<PointCase> RandomCases(int count) {
  Random random;
  std::vector<PointCase> cases;
  while (static_cast<int>(cases.size()) < count) {
    PointCase c;
    c.position = 3.0 * random.Direction();
    c.normal = random.Direction();
    c.to_view = random.Direction();
    if (glm::dot(c.normal, c.to_view) < 0.0) c.to_view = -c.to_view;
    c.roughness = random(0.05, 1.0);
    const glm::dvec3 to_center = random.Direction();
    c.center = c.position + random.Log(0.3, 10.0) * to_center;
    c.light_normal = random.Direction();
    if (glm::dot(c.light_normal, c.position - c.center) < 0.0) c.light_normal = -c.light_normal;
    c.axis_x = glm::normalize(glm::cross(random.Direction(), c.light_normal));
    c.axis_y = glm::cross(c.light_normal, c.axis_x);
    c.half_size = {random.Log(0.05, 3.0), random.Log(0.05, 3.0)};
    cases.push_back(c);
  }
  return cases;
}

struct Difference {
  double rmse = 0.0, max = 0.0;
  double p999 = 0.0;  // the difference that one case in a thousand exceeds
};
template <class Member>
Difference Compare(const std::vector<Shaded>& a, const std::vector<Shaded>& b, Member member) {
  double squares = 0.0, reference = 0.0;
  Difference result;
  std::vector<double> all;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = a[i].*member - b[i].*member;
    squares += d * d;
    reference += b[i].*member * b[i].*member;
    result.max = std::max(result.max, std::abs(d));
    all.push_back(std::abs(d));
  }
  const auto rank = all.begin() + static_cast<std::ptrdiff_t>(all.size() - 1 - all.size() / 1000);
  std::nth_element(all.begin(), rank, all.end());
  result.p999 = *rank;
  result.rmse = std::sqrt(squares / reference);
  return result;
}

bool IsSound(const std::vector<Shaded>& shaded) {
  return std::all_of(shaded.begin(), shaded.end(), [](const Shaded& s) {
    return std::isfinite(s.diffuse) && std::isfinite(s.specular) && s.diffuse >= 0.0 && s.specular >= 0.0;
  });
}

// Rounding: float on the GL against the same text in double, which reads the same floats. Roughness down to
// 0.05, where the edges seen from the lobe come close to π.
TEST_F(LtcTechnique, FloatAgainstTheSameTextInDouble) {
  std::vector<PointCase> cases = RandomCases(1 << 15);
  for (std::size_t i = 0; i < cases.size(); i += 2) cases[i].roughness = 0.05;
  struct Limit {
    const char* variant;
    double diffuse_rmse, diffuse_max, specular_rmse, specular_max;
  };
  for (const Limit& limit : {
           Limit{"ltc", 2e-6, 1e-4, 4e-6, 1e-4},                 // measured 8.0e-7, 2.0e-5, 1.4e-6, 3.9e-5
           Limit{"ltc+clip=switch", 2e-6, 1e-4, 4e-6, 1e-4},     // measured 1.8e-7, 1.6e-6, 9.1e-7, 1.1e-5
           Limit{"ltc+edge=half_angle", 1e-5, 5e-4, 1e-2, 0.5},  // measured 1.3e-6, 2.5e-5, 2.7e-3, 0.10
           Limit{"hill", 1e-4, 3e-3, 1e-4, 3e-3},                // measured 1.7e-5, 4.0e-4, 1.6e-6, 2.9e-5
       }) {
    SCOPED_TRACE(limit.variant);
    const auto in_float = Shade(limit.variant, cases),
               in_double = Shade(limit.variant, cases, Precision::kDouble);
    EXPECT_TRUE(IsSound(in_float));
    EXPECT_TRUE(IsSound(in_double));
    const Difference diffuse = Compare(in_float, in_double, &Shaded::diffuse);
    const Difference specular = Compare(in_float, in_double, &Shaded::specular);
    // Of the most that a light of radiance 1 can give, 1. Measured 6e-7 and 2.4e-6, 1.2e-5 and 3.6e-6.
    const bool is_default = std::string(limit.variant).find('+') == std::string::npos;
    if (is_default) {
      EXPECT_LT(diffuse.p999, 2e-5);
      EXPECT_LT(specular.p999, 2e-5);
    }
    EXPECT_LT(diffuse.rmse, limit.diffuse_rmse);
    EXPECT_LT(diffuse.max, limit.diffuse_max);
    EXPECT_LT(specular.rmse, limit.specular_rmse);
    EXPECT_LT(specular.max, limit.specular_max);
  }
}

// Where digits get lost: a corner in the horizon, sometimes a side with it, the point next to the light's
// plane and to its corner, grazing viewers, lights of a tenth of a millimetre and of ten kilometres.
std::vector<PointCase> TrapCases() {
  Random random;
  std::vector<PointCase> cases;
  for (const double scale : {1e-4, 1.0, 1e4}) {
    for (const double height : {1e-3, 1e-2, 1.0}) {
      for (const double along : {0.0, 0.99, 1.0, 1.01, 3.0}) {
        for (const double turn : {0.0, 0.3, 0.7853981633974483}) {
          for (const double view : {0.01, 0.3, 0.7, 1.1, 1.5, 1.57}) {
            for (const double roughness : {0.1, 0.3, 1.0}) {
              PointCase c;
              c.roughness = roughness;
              c.half_size = scale * glm::dvec2(1.0, 0.5);
              c.axis_x = {std::cos(turn), std::sin(turn), 0.0};
              c.axis_y = glm::cross(c.light_normal, c.axis_x);
              c.center = along * (c.half_size.x * c.axis_x + c.half_size.y * c.axis_y);
              c.center.z = height * scale;
              const glm::dvec3 corner = c.center - c.half_size.x * c.axis_x + c.half_size.y * c.axis_y;
              const glm::dvec3 through = cases.size() % 3 == 0 ? c.axis_x : random.Direction();
              c.normal = glm::normalize(glm::cross(corner, through));
              if (glm::dot(c.normal, c.center) < 0.0) c.normal = -c.normal;
              const glm::dvec3 side = glm::normalize(glm::cross(c.normal, random.Direction()));
              c.to_view = std::cos(view) * c.normal + std::sin(view) * side;
              cases.push_back(c);
            }
          }
        }
      }
    }
  }
  return cases;
}

// A corner at 1e-3 of the light's size keeps four digits of its direction in float, and a lobe of roughness
// 0.1 is 1e-2 wide. Measured at most 1.6e-5, 8.3e-5, 3.4e-4, 4.7e-3.
TEST_F(LtcTechnique, FloatAgainstDoubleWhereDigitsGetLost) {
  const std::vector<PointCase> cases = TrapCases();
  for (const char* name : {"ltc", "hill"}) {
    SCOPED_TRACE(name);
    const auto in_float = Shade(name, cases), in_double = Shade(name, cases, Precision::kDouble);
    EXPECT_TRUE(IsSound(in_float));
    const Difference diffuse = Compare(in_float, in_double, &Shaded::diffuse);
    const Difference specular = Compare(in_float, in_double, &Shaded::specular);
    EXPECT_LT(diffuse.rmse, 6e-5);
    EXPECT_LT(diffuse.max, 4e-4);
    EXPECT_LT(specular.rmse, 1.5e-3);
    EXPECT_LT(specular.max, 2e-2);
  }
}

// The tangent is any at all within 1e-4 rad of the normal; nobody may see where that begins. Measured 6.7e-4,
// 3.7e-3: the lobe's own move by 1e-3 rad.
TEST_F(LtcTechnique, NoStepAsTheViewerPassesTheNormal) {
  Random random;
  std::vector<PointCase> at, beside;
  for (const PointCase& random_case : RandomCases(4096)) {
    PointCase c = random_case;
    const glm::dvec3 side = glm::normalize(glm::cross(c.normal, random.Direction()));
    c.to_view = c.normal;
    at.push_back(c);
    const double angle = random.Log(1e-6, 1e-3);
    c.to_view = std::cos(angle) * c.normal + std::sin(angle) * side;
    beside.push_back(c);
  }
  for (const char* name : {"ltc", "ltc@published", "hill", "hill@published"}) {
    const Difference specular = Compare(Shade(name, at), Shade(name, beside), &Shaded::specular);
    EXPECT_LT(specular.rmse, 3e-3) << name;
    EXPECT_LT(specular.max, 1.5e-2) << name;
  }
}

// Two ways to the same integral, in double. The diffuse arc works in the light's own axes, which as floats
// are perpendicular to 1e-7 only, and takes the light's sides by another polynomial; the specular one differs
// by rounding alone: measured 4e-16.
TEST_F(LtcTechnique, TheExactClipsAgree) {
  const auto cases = RandomCases(1 << 14);
  const auto arc = Shade("ltc", cases, Precision::kDouble),
             switched = Shade("ltc+clip=switch", cases, Precision::kDouble);
  EXPECT_LT(Compare(arc, switched, &Shaded::diffuse).max, 3e-6);
  EXPECT_LT(Compare(arc, switched, &Shaded::specular).max, 1e-6);
  const auto streamed = Shade("ltc+clip=stream", cases, Precision::kDouble);
  EXPECT_LT(Compare(streamed, switched, &Shaded::diffuse).max, 1e-12);
  EXPECT_LT(Compare(streamed, switched, &Shaded::specular).max, 1e-12);
}

// Wholly above the horizon nothing is clipped, and the proxy sphere must not be felt where it is above, too.
TEST_F(LtcTechnique, ProxyAgreesWithTheClipAboveTheHorizon) {
  std::vector<PointCase> cases = RandomCases(1 << 13);
  Random random;
  for (PointCase& c : cases) {  // small lights at least 45° above the horizon
    c.center = c.position + glm::normalize(c.normal + 0.5 * random.Direction());
    c.half_size = {random(0.01, 0.2), random(0.01, 0.2)};
    if (glm::dot(c.light_normal, c.position - c.center) < 0.0) {
      c.light_normal = -c.light_normal;
      c.axis_x = -c.axis_x;
    }
  }
  const auto ltc = Shade("ltc", cases, Precision::kDouble),
             hill = Shade("hill+sphere=exact", cases, Precision::kDouble);
  EXPECT_LT(Compare(hill, ltc, &Shaded::diffuse).max, 1e-6);  // measured 0
  EXPECT_GT(hill[0].diffuse, 0.0f);
}

// The clipped integral against the proxy sphere's: close, not equal, else one of them is not what it says.
TEST_F(LtcTechnique, ProxyDiffersFromTheClipAtTheHorizon) {
  const auto cases = RandomCases(1 << 14);
  const auto ltc = Shade("ltc", cases);
  for (const char* name : {"hill", "hill+sphere=table", "hill+sphere=exact"}) {
    SCOPED_TRACE(name);
    const Difference diffuse = Compare(Shade(name, cases), ltc, &Shaded::diffuse);
    EXPECT_GT(diffuse.rmse, 0.02);  // measured 0.055, 0.053, 0.052
    EXPECT_LT(diffuse.rmse, 0.08);
  }
  EXPECT_LT(
      Compare(Shade("hill+sphere=table", cases), Shade("hill+sphere=exact", cases), &Shaded::diffuse).max,
      0.03);  // measured 0.0198: the table has 64 × 64 nodes over a kink
}

// The talk's banding: as the viewer sinks, a sharp highlight steps from row to row of the table. 4096 view
// angles from 75° to 88°, the reflection of a light's end at roughness 0.08; the same lobes stored about the
// mirrored view stand for the exact ones.
TEST_F(LtcTechnique, DividedMatricesBandWhereTheTalkSaysSo) {
  std::vector<PointCase> cases;
  for (int i = 0; i < 4096; ++i) {
    const double angle = glm::radians(75.0 + 13.0 * i / 4095.0);
    PointCase c;
    c.roughness = 0.08;
    c.to_view = {-std::sin(angle), 0.0, std::cos(angle)};
    c.center = {4.0, 0.0, 0.5};
    c.light_normal = {-1.0, 0.0, 0.0};
    c.axis_x = {0.0, 1.0, 0.0};
    c.axis_y = {0.0, 0.0, -1.0};
    c.half_size = {0.5, 0.3};
    cases.push_back(c);
  }
  struct Banding {
    double rmse, jump;  // jump: largest second difference over 0.05°, a small part of a row
  };
  const auto measure = [&](const std::string& norm) {
    const auto mirror = Shade("hill@published+frame=mirror", cases, Precision::kDouble);
    const auto shaded = Shade("hill@published+norm=" + norm, cases, Precision::kDouble);
    Banding banding{Compare(shaded, mirror, &Shaded::specular).rmse, 0.0};
    constexpr std::size_t kStep = 16;
    for (std::size_t i = kStep; i + kStep < shaded.size(); ++i)
      banding.jump = std::max(banding.jump,
                              std::abs(shaded[i - kStep].specular - 2.0 * shaded[i].specular +
                                       shaded[i + kStep].specular));
    return banding;
  };
  // Measured: none 0.0016, 0.0023 (the mirror frame's own jump 0.0022, the highlight's curvature); middle
  // 0.058, 0.0093; last 0.050, 0.0147.
  const Banding none = measure("none"), middle = measure("middle"), last = measure("last");
  EXPECT_LT(none.rmse, 0.004);
  EXPECT_LT(none.jump, 0.004);
  EXPECT_GT(last.rmse, 10.0 * none.rmse);
  EXPECT_GT(last.jump, 4.0 * none.jump);
  EXPECT_GT(middle.rmse, 10.0 * none.rmse);
  EXPECT_GT(last.jump, middle.jump);
}

// Shaded points on the light's plane, edges and corners, the viewer along the normal and at grazing angles,
// tiny and huge lights: every choice of clip, sphere and edge leaves finite radiance that is at least 0.
TEST_F(LtcTechnique, DegenerateInputsStayFiniteForEveryOption) {
  std::vector<PointCase> cases;
  for (const double scale : {1e-6, 1.0, 1e5}) {
    for (const double height : {0.0, 1e-7, 1e-3, 1.0}) {
      for (const double along : {0.0, 0.5, 1.0, 3.0}) {
        for (const double tilt : {0.0, 0.8, 1.5707963267948966, 3.0}) {
          for (const double view : {0.0, 1e-5, 0.7, 1.57}) {
            for (const double roughness : {0.0, 0.03, 0.5, 1.0}) {
              PointCase c;
              c.roughness = roughness;
              c.normal = {std::sin(tilt), 0.0, std::cos(tilt)};
              c.to_view = std::cos(view) * c.normal + std::sin(view) * glm::dvec3(0.0, 1.0, 0.0);
              c.half_size = scale * glm::dvec2(1.0, 0.5);
              c.center = {along * c.half_size.x, along * c.half_size.y, height * scale};
              cases.push_back(c);
            }
          }
        }
      }
    }
  }
  int variants = 0;
  std::vector<Variant> both = points_->Variants("ltc");
  for (const Variant& variant : points_->Variants("hill")) both.push_back(variant);
  for (const Variant& variant : both) {
    // Where the tables' rows lie and where Fresnel is taken changes nothing here, and takes long to compile.
    const auto like = [&](const Variant& form, const std::string& option) {
      return variant.options.at(option) == form.options.at(option);
    };
    const Variant own = DefaultVariant(*variant.technique), published = PublishedVariant(*variant.technique);
    bool same = true;
    for (const std::string option : {"axis", "frame", "fresnel", "fit"})
      same = same && (like(own, option) || like(published, option));
    if (!same || like(own, "fresnel") != like(own, "fit") || like(own, "frame") != like(own, "fit")) continue;
    EXPECT_TRUE(IsSound(Shade(variant.Name(), cases))) << variant.Name();
    ++variants;
  }
  EXPECT_GT(variants, 30);
}

// Two lobes are what the fit says they are: each lobe's density over the light by mid-points on its area, with Fresnel's term averaged
// over each lobe.
TEST_F(LtcTechnique, TwoLobesAreTheQuadratureOfTheirDensities) {
  const LtcTables tables = ReadLtcTables(AREALAB_SOURCE_DIR "/glsl/tables", Brdf::kGgx, FitKind::kTwo);
  PointRandom random(41);
  std::vector<PointCase> cases;
  while (cases.size() < 60) {
    PointCase c = RandomPoint(random, LightShape::kRectangle);
    c.roughness = static_cast<float>(random(0.35, 1.0));
    c.f0 = 0.25;
    cases.push_back(c);
  }
  const std::vector<Shaded> shaded = Shade("ltc+lobes=two+fresnel=lobe", cases, Precision::kDouble);
  double largest = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const PointCase& c = cases[i];
    const double cosine = glm::dot(c.normal, c.to_view);
    const glm::dvec3 tangent = glm::normalize(c.to_view - c.normal * cosine), bitangent = glm::cross(c.normal, tangent);
    const LtcLookup look = Look(tables, c.roughness, cosine);
    const auto density = [](const glm::dvec4& m, const glm::dvec3& v) {  // [Heitz et al. 2016, eq. 1]
      const glm::dvec3 w(m.x * v.x + m.z * v.z, v.y, m.y * v.x + m.w * v.z);
      return std::max(w.z, 0.0) * (m.x * m.w - m.y * m.z) / (glm::pi<double>() * std::pow(glm::dot(w, w), 2.0));
    };
    const auto reflectance = [&](double magnitude, double schlick) { return c.f0 * (magnitude - schlick) + schlick; };
    constexpr int kSteps = 300;
    double first = 0.0, second = 0.0;
    for (int row = 0; row < kSteps; ++row) {
      for (int column = 0; column < kSteps; ++column) {
        const glm::dvec2 at = c.half_size * (2.0 * (glm::dvec2(column, row) + 0.5) / double(kSteps) - 1.0);
        const glm::dvec3 to_light = c.center + at.x * c.axis_x + at.y * c.axis_y - c.position;
        const double length = glm::length(to_light);
        const glm::dvec3 v(glm::dot(to_light, tangent), glm::dot(to_light, bitangent), glm::dot(to_light, c.normal));
        const double solid_angle = -glm::dot(to_light, c.light_normal) / (length * length * length);
        first += solid_angle * density(look.m, v / length);
        second += solid_angle * density(look.second, v / length);
      }
    }
    const double area = 4.0 * c.half_size.x * c.half_size.y / (kSteps * kSteps);
    const double expected = area * (first * reflectance(look.terms.x, look.terms.y) + second * reflectance(look.terms.x * look.terms.z, look.terms.w));
    EXPECT_NEAR(shaded[i].specular, expected, 1e-4 * (1.0 + expected)) << i;
    largest = std::max(largest, shaded[i].specular);
  }
  EXPECT_GT(largest, 0.01);
}

}  // namespace
}  // namespace arealab::ltc_technique_test
