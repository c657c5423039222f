// The truth's closed forms, its honesty about its error, that threads do not change it, and its cache.
#include "compare/truth.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <iostream>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "compare/closed_forms.h"
#include "compare/truth_bands.h"
#include "compare/truth_cache.h"
#include "compare/truth_levels.h"
#include "tests/compare/hard_configurations.h"

namespace arealab::truth_test {
namespace {

constexpr double kPi = glm::pi<double>();
using glm::dvec3;

Light MakeLight(LightShape shape, const dvec3& center, const dvec3& normal, glm::dvec2 half_size) {
  Light light;
  light.shape = shape;
  light.center = center;
  light.normal = glm::normalize(normal);
  light.axis_x = glm::normalize(
      glm::cross(std::abs(light.normal.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), light.normal));
  light.axis_y = glm::cross(light.normal, light.axis_x);
  light.half_size = half_size;
  return light;
}

ShadingPoint AtOrigin(double cos_v = 0.8, double roughness = 0.5) {
  return {dvec3(0.0), dvec3(0, 0, 1), dvec3(std::sqrt(1.0 - cos_v * cos_v), 0.0, cos_v),
          roughness * roughness};
}

// A rectangle parallel to the surface whose corner is above the point [Howell 1982, element to
// parallel rectangle]: F = 1/(2π) [A/√(1+A²) atan(B/√(1+A²)) + B/√(1+B²) atan(A/√(1+B²))], A, B its sides over the
// distance.
TEST(Truth, FormFactorOfParallelRectangle) {
  for (double a : {1e-3, 0.1, 1.0, 30.0}) {
    for (double b : {2e-3, 0.5, 4.0}) {
      Light light =
          MakeLight(LightShape::kRectangle, {0.5 * a, 0.5 * b, 1.0}, {0, 0, -1}, {0.5 * a, 0.5 * b});
      if (std::abs(light.axis_x.y) > 0.5) std::swap(light.half_size.x, light.half_size.y);
      double ra = std::sqrt(1.0 + a * a), rb = std::sqrt(1.0 + b * b);
      double expected = (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2.0 * kPi);
      EXPECT_NEAR(IntegrateLight(AtOrigin(), light, 1e-4).form_factor, expected, 1e-10 * expected)
          << a << " " << b;
    }
  }
}

// A rectangle that stands on the horizon, its edge on the floor at distance d, width 2w, height h; the point
// faces up. Polar slices [Howell 1982, element to perpendicular rectangle]: F = 1/(2π) [atan(B) − A atan(B·A)…] doubled for the two halves.
TEST(Truth, FormFactorOfStandingRectangleWhoseLowerHalfIsCut) {
  for (double w : {0.05, 0.7, 20.0}) {
    for (double h : {0.1, 1.0, 5.0}) {
      double d = 1.3;
      Light light = MakeLight(LightShape::kRectangle, {d, 0.0, 0.0}, {-1, 0, 0}, {w, h});
      if (std::abs(light.axis_x.z) > 0.5) std::swap(light.half_size.x, light.half_size.y);
      double r = std::sqrt(h * h + d * d);
      double expected = (std::atan(w / d) - d / r * std::atan(w / r)) / kPi;
      EXPECT_NEAR(IntegrateLight(AtOrigin(), light, 1e-4).form_factor, expected, 1e-10 * expected)
          << w << " " << h;
    }
  }
}

TEST(Truth, FormFactorOfSphere) {
  for (double sine : {1e-4, 0.1, 0.7, 0.999}) {  // R / distance
    for (double elevation : {90.0, 60.0, 20.0, 3.0, 0.0, -3.0, -20.0}) {
      double e = glm::radians(elevation), omega = 0.5 * kPi - e;
      Light light = MakeLight(LightShape::kSphere, 2.0 * dvec3(std::cos(e), 0.0, std::sin(e)), {0, 0, 1},
                              glm::dvec2(2.0 * sine));
      double sigma = std::asin(sine), expected;
      if (omega <= 0.5 * kPi - sigma) {
        expected = std::cos(omega) * sine * sine;
      } else if (omega >= 0.5 * kPi + sigma) {
        expected = 0.0;
      } else {  // crosses the horizon [Lagarde & de Rousiers 2014, sphere lights with horizon handling]
        double x = std::sqrt(1.0 / (sine * sine) - 1.0), y = -x / std::tan(omega), z = std::sqrt(1.0 - y * y);
        expected = (sine * sine * (std::cos(omega) * std::acos(y) - x * std::sin(omega) * z) +
                    std::atan(std::sin(omega) * z / x)) /
                   kPi;
      }
      double got = IntegrateLight(AtOrigin(), light, 1e-4).form_factor;
      EXPECT_NEAR(got, expected, 1e-6 * expected + 1e-15) << sine << " " << elevation;
    }
  }
}

// A disk facing the point on its axis, and cut in half by the horizon edge-on to it by symmetry of a standing
// disk.
TEST(Truth, FormFactorOfDisk) {
  for (double r : {1e-4, 0.3, 2.0, 100.0}) {
    Light above = MakeLight(LightShape::kDisk, {0, 0, 1.5}, {0, 0, -1}, glm::dvec2(r));
    double expected = r * r / (r * r + 1.5 * 1.5);
    EXPECT_NEAR(IntegrateLight(AtOrigin(), above, 1e-4).form_factor, expected, 1e-10 * expected) << r;
    // A disk of radius r parallel to the surface, its axis at a distance a [Howell 1982, element to disk].
    double a = 0.8, h = 1.1;
    Light aside = MakeLight(LightShape::kDisk, {a, 0.3, h}, {0, 0, -1}, glm::dvec2(r));
    double a2 = a * a + 0.09, z = 1.0 + h * h / a2 + r * r / a2;
    expected = 0.5 * (1.0 - (z - 2.0 * r * r / a2) / std::sqrt(z * z - 4.0 * r * r / a2));
    EXPECT_NEAR(IntegrateLight(AtOrigin(), aside, 1e-4).form_factor, expected, 1e-7 * expected) << r;
  }
}

// A tilted disk cut by the horizon, against the contour integral by a fine polygon inscribed in it: error ~
// 1/sides².
TEST(Truth, FormFactorOfCutDiskIsTheLimitOfPolygons) {
  for (double height : {0.3, 0.0, -0.2}) {
    dvec3 center(1.0, 0.4, height), normal = glm::normalize(dvec3(-1.0, 0.2, -0.3));
    Light light = MakeLight(LightShape::kDisk, center, normal, glm::dvec2(0.7));
    auto polygon = [&](int sides) {
      // Fans from the centre, each clipped by itself: HorizonPolygon holds few corners.
      double sum = 0.0;
      for (int i = 0; i < sides; ++i) {
        auto at = [&](int k) {
          double t = 2.0 * kPi * k / sides;
          return center - light.axis_x * (0.7 * std::cos(t)) + light.axis_y * (0.7 * std::sin(t));
        };
        std::array<dvec3, 3> corners = {center, at(i), at(i + 1)};
        sum += PolygonFormFactor(ClipToHorizon(corners));
      }
      return sum;
    };
    double coarse = polygon(2000), fine = polygon(4000), limit = fine + (fine - coarse) / 3.0;
    EXPECT_NEAR(IntegrateLight(AtOrigin(), light, 1e-4).form_factor, limit, 1e-8 * limit) << height;
  }
}

TEST(Truth, LightsThatCannotBeSeenGiveExactlyNothing) {
  ShadingPoint point = AtOrigin();
  std::vector<Light> lights = {
      MakeLight(LightShape::kRectangle, {0, 0, 1}, {0, 0, 1}, {1, 1}),      // faces away
      MakeLight(LightShape::kRectangle, {0, 0, -1}, {0, 0, 1}, {1, 1}),     // below
      MakeLight(LightShape::kRectangle, {1, 0, 0}, {0, 0, 1}, {0.5, 0.5}),  // in its plane
      MakeLight(LightShape::kDisk, {0, 0, 1}, {0, 0, 1}, {1, 1}),
      MakeLight(LightShape::kDisk, {0.5, 0, -2}, {0, 0, 1}, {1, 1}),
      MakeLight(LightShape::kSphere, {0, 0, -2}, {0, 0, 1}, {1, 1}),
      MakeLight(LightShape::kSphere, {0, 0, 0.5}, {0, 0, 1}, {1, 1})};  // inside
  for (const Light& light : lights) {
    LightIntegrals result = IntegrateLight(point, light, 1e-4);
    EXPECT_EQ(result.form_factor, 0.0) << Name(light.shape);
    EXPECT_EQ(result.specular, 0.0) << Name(light.shape);
  }
  Light two_sided = lights[0];
  two_sided.two_sided = true;
  LightIntegrals back = IntegrateLight(point, two_sided, 1e-6);
  LightIntegrals front =
      IntegrateLight(point, MakeLight(LightShape::kRectangle, {0, 0, 1}, {0, 0, -1}, {1, 1}), 1e-6);
  EXPECT_NEAR(back.form_factor, front.form_factor, 1e-14);
  EXPECT_NEAR(back.specular, front.specular, 1e-6);
  point.to_view = {1.0, 0.0, -1e-3};
  EXPECT_EQ(IntegrateLight(point, two_sided, 1e-4).specular, 0.0);  // the viewer is below the surface
}

// A light of unit radiance all around gives the lobe's energy with masking and shadowing, at most 1, whatever
// its shape.
TEST(Truth, SurroundingLightsOfEveryShapeAgree) {
  for (double roughness : {0.05, 0.3, 1.0}) {
    for (double cos_v : {1.0, 0.6, 0.1}) {
      ShadingPoint point = AtOrigin(cos_v, roughness);
      // Each as good as a half space.
      double far = 1e6;
      double rectangle =
          IntegrateLight(point, MakeLight(LightShape::kRectangle, {0, 0, 1}, {0, 0, -1}, {far, far}), 1e-6)
              .specular;
      double disk =
          IntegrateLight(point, MakeLight(LightShape::kDisk, {0, 0, 1}, {0, 0, -1}, {far, far}), 1e-6)
              .specular;
      double sphere =
          IntegrateLight(point, MakeLight(LightShape::kSphere, {0, 0, 1.0 + 1e-13}, {0, 0, 1}, {1, 1}), 1e-6)
              .specular;
      EXPECT_NEAR(disk / rectangle, 1.0, 1e-4) << roughness << " " << cos_v;
      EXPECT_NEAR(sphere / rectangle, 1.0, 1e-4) << roughness << " " << cos_v;
      EXPECT_LE(rectangle, 1.0);
      EXPECT_GT(rectangle, roughness < 0.5 ? 0.8 : 0.3);
    }
  }
}

// A light cut in two gives the sum of its halves, wherever the cut runs.
TEST(Truth, LightsAddUp) {
  std::mt19937_64 engine(3);
  for (int i = 0; i < 400; ++i) {
    HardConfiguration c = MakeHardConfiguration(engine, i);
    if (c.light.shape != LightShape::kRectangle) continue;
    LightIntegrals whole = IntegrateLight(c.point, c.light, 1e-6);
    Light left = c.light, right = c.light;
    left.half_size.x *= 0.3;
    right.half_size.x *= 0.7;
    left.center -= c.light.axis_x * (0.7 * c.light.half_size.x);
    right.center += c.light.axis_x * (0.3 * c.light.half_size.x);
    LightIntegrals l = IntegrateLight(c.point, left, 1e-6), r = IntegrateLight(c.point, right, 1e-6);
    EXPECT_NEAR(l.form_factor + r.form_factor, whole.form_factor, 1e-9 * whole.form_factor + 1e-14) << i;
    EXPECT_NEAR(l.specular + r.specular, whole.specular, 1e-4 * whole.specular + 1e-12) << i;
    EXPECT_NEAR(l.specular_grazing + r.specular_grazing, whole.specular_grazing,
                1e-4 * (whole.specular_grazing + 0.04 * whole.specular) + 1e-12)
        << i;
  }
}

// The tolerance is exceeded, against the finest level but one, in at most 1 of 1000 hard configurations by GGX. Of a steep lobe it is in the
// far tail, where there is nothing to see; Phong's converges slowest, and its stated error says so. AREALAB_HARD=20000: as many.
TEST(Truth, StatedErrorsAreHonest) {
  struct Bound {
    Brdf brdf;
    int count;
    double exceeded, understated;  // shares; measured: README, How true the truth is
  };
  const char* many = std::getenv("AREALAB_HARD");
  for (const Bound& bound : {Bound{Brdf::kGgx, 2000, 0.001, 0.005}, Bound{Brdf::kGgxSeparable, 1000, 0.001, 0.005}, Bound{Brdf::kBeckmann, 1000, 0.01, 0.005},
                             Bound{Brdf::kBlinnPhong, 1000, 0.015, 0.005}, Bound{Brdf::kWard, 1000, 0.01, 0.005}, Bound{Brdf::kPhong, 1000, 0.08, 0.015}}) {
    const int count = many ? std::atoi(many) : bound.count;
    for (double tolerance : {1e-3, 1e-4}) {
      std::mt19937_64 engine(17);
      int lit = 0, exceeded = 0, seen = 0, understated = 0;
      for (int i = 0; i < count; ++i) {
        HardConfiguration c = MakeHardConfiguration(engine, i);
        c.point.brdf = bound.brdf;
        LightIntegrals truth = IntegrateLight(c.point, c.light, tolerance);
        LightIntegrals fine = IntegrateLightAtLevel(c.point, c.light, kTruthLevelCount - 2);
        EXPECT_TRUE(std::isfinite(truth.specular) && std::isfinite(truth.specular_grazing) &&
                    std::isfinite(truth.form_factor));
        if (fine.specular < 1e-12) continue;
        ++lit;
        const bool is_exceeded = std::abs(truth.specular - fine.specular) > tolerance * fine.specular ||
                                 std::abs(truth.specular_grazing - fine.specular_grazing) >
                                     tolerance * (fine.specular_grazing + 0.04 * fine.specular);
        exceeded += is_exceeded;
        seen += is_exceeded && fine.specular > 1e-6;
        understated += std::abs(truth.specular - fine.specular) > truth.specular_error;
      }
      const auto share = [&](int part) { return static_cast<double>(part) / lit; };
      if (many) {
        std::cout << Name(bound.brdf) << " " << tolerance << ": of " << lit << " lit " << 100.0 * share(exceeded) << " % exceed, " << 100.0 * share(seen)
                  << " % above 1e-6; " << 100.0 * share(understated) << " % by more than stated\n";
      }
      EXPECT_GT(lit, count / 2);
      EXPECT_LE(share(exceeded), bound.exceeded + 0.5 / lit) << Name(bound.brdf) << " " << tolerance;
      EXPECT_LE(share(understated), bound.understated) << Name(bound.brdf) << " " << tolerance;
    }
  }
}

// GGX is summed in a form of its own, and as a check in float: the one is what the shaders' text gives, the other near enough to be
// held against a level, but where much cancels, where it cannot agree by chance more often than two levels do.
TEST(Truth, OwnFormOfGgxIsTheText) {
  constexpr int kCount = 2000;
  constexpr double kMaxText = 1e-11;  // measured 1e-12: rounding, where terms cancel
  constexpr double kCheck = 1e-5;     // for 98 of 100; measured for 99
  std::mt19937_64 engine(29);
  int lit = 0, near = 0;
  for (int i = 0; i < kCount; ++i) {
    const HardConfiguration c = MakeHardConfiguration(engine, i);
    const LightIntegrals kept = IntegrateLightAtLevel(c.point, c.light, 1);
    if (kept.specular < 1e-12) continue;
    ++lit;
    const auto difference = [&](TruthForm form) {
      const LightIntegrals other = IntegrateLightAtLevel(c.point, c.light, 1, form);
      return std::max(std::abs(other.specular - kept.specular) / kept.specular,
                      std::abs(other.specular_grazing - kept.specular_grazing) / (kept.specular_grazing + 0.04 * kept.specular));
    };
    EXPECT_LE(difference(TruthForm::kText), kMaxText) << i;
    const double check = difference(TruthForm::kCheck);
    near += check <= kCheck;
    EXPECT_GT(check, 0.0) << i;  // it is in float
  }
  EXPECT_GT(lit, kCount * 9 / 10);
  EXPECT_GE(near, lit * 98 / 100);
}

// A floor whose roughness rises, with a metal half, before a few lights of every shape.
struct Picture {
  Scene scene;
  SurfacePixels pixels;
};
Picture MakePicture(int width = 48, int height = 40) {
  Picture p;
  p.scene.lights = {MakeLight(LightShape::kRectangle, {0, 2, 1}, {0, -1, -0.3}, {0.8, 0.4}),
                    MakeLight(LightShape::kDisk, {-1, 1.5, 0.2}, {0.5, -1, 0}, glm::dvec2(0.5)),
                    MakeLight(LightShape::kSphere, {1.2, 1, 0.4}, {0, 0, 1}, glm::dvec2(0.3))};
  p.scene.lights[1].two_sided = true;
  p.scene.lights[2].radiance = {2.0, 1.0, 0.5};
  p.pixels.width = width;
  p.pixels.height = height;
  p.pixels.view_position = {0.0f, -3.0f, 1.0f};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float u = static_cast<float>(x) / static_cast<float>(width),
            v = static_cast<float>(y) / static_cast<float>(height);
      p.pixels.position.emplace_back(3.0f * u - 1.5f, 1.5f - 3.0f * v, 0.0f, y == 0 ? 0.0f : 1.0f);
      p.pixels.normal.emplace_back(0.0f, 0.0f, 1.0f, 0.02f + 0.9f * u);
      p.pixels.base_color.emplace_back(0.8f, 0.6f, 0.4f, v > 0.5f ? 1.0f : 0.0f);
    }
  }
  return p;
}

bool SameBits(const Truth& a, const Truth& b) {
  auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
  };
  return same(a.radiance.diffuse, b.radiance.diffuse) && same(a.radiance.specular, b.radiance.specular) &&
         same(a.relative_error, b.relative_error);
}

TEST(Truth, ThreadsDoNotChangeIt) {
  Picture p = MakePicture();
  Truth one, two;
  {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
    one = ComputeTruth(p.scene, p.pixels);
  }
  {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, 2);
    two = ComputeTruth(p.scene, p.pixels);
  }
  EXPECT_TRUE(SameBits(one, two));
  EXPECT_GT(one.worst_relative_error, 0.0);
  EXPECT_LT(one.worst_relative_error, 2e-4);
  EXPECT_EQ(one.radiance.Total(0), glm::vec3(0.0f));  // background
  EXPECT_EQ(one.relative_error[0], 0.0f);
}

// Radiance is albedo·E·L and L·(F0·(I0 − I1) + I1), summed over lights; metals have no diffuse.
TEST(Truth, PixelsAreTheSumOfTheirLights) {
  Picture p = MakePicture();
  Truth truth = ComputeTruth(p.scene, p.pixels);
  for (std::size_t i : {std::size_t{5 * 48 + 7}, std::size_t{30 * 48 + 40}}) {
    dvec3 position(p.pixels.position[i]);
    double roughness = static_cast<double>(p.pixels.normal[i].w);
    ShadingPoint point{position, dvec3(0, 0, 1), glm::normalize(dvec3(p.pixels.view_position) - position),
                       std::max(roughness * roughness, 1e-4)};
    dvec3 base(p.pixels.base_color[i]), f0 = p.pixels.base_color[i].w > 0.0f ? base : dvec3(0.04);
    dvec3 diffuse(0.0), specular(0.0);
    for (const Light& light : p.scene.lights) {
      LightIntegrals s = IntegrateLight(point, light, 1e-7);
      if (p.pixels.base_color[i].w == 0.0f) diffuse += base * light.radiance * s.form_factor;
      specular += light.radiance * (f0 * (s.specular - s.specular_grazing) + s.specular_grazing);
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(truth.radiance.diffuse[i][k], diffuse[k], 1e-6 * diffuse[k]);
      EXPECT_NEAR(truth.radiance.specular[i][k], specular[k], 1e-4 * specular[k]);
    }
  }
}

TEST(Truth, ProgressRisesToOne) {
  Picture p = MakePicture();
  TruthOptions options;
  std::vector<double> seen;
  options.progress = [&](double fraction) { seen.push_back(fraction); };
  ComputeTruth(p.scene, p.pixels, options);
  ASSERT_FALSE(seen.empty());
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.back(), 1.0);
}

class TruthCache : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("arealab_truth_cache_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
    key_ = TruthKey(picture_.scene, picture_.pixels, options_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  Truth Get() { return CachedTruth(picture_.scene, picture_.pixels, options_, folder_); }
  std::filesystem::path Entry() const { return folder_ / (key_ + ".truth"); }
  static std::string Bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void Write(const std::filesystem::path& file, const std::string& bytes) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
  }
  Picture picture_ = MakePicture();
  TruthOptions options_;
  std::filesystem::path folder_;
  std::string key_;
};

TEST_F(TruthCache, SecondCallReadsTheSameBits) {
  Truth first = Get(), second = Get();
  EXPECT_FALSE(first.cached);
  EXPECT_TRUE(second.cached);
  EXPECT_TRUE(SameBits(first, second));
  EXPECT_EQ(first.worst_relative_error, second.worst_relative_error);
  EXPECT_EQ(first.seconds, second.seconds);
  EXPECT_TRUE(SameBits(first, ComputeTruth(picture_.scene, picture_.pixels, options_)));
  // Nothing but the entry is left.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(TruthCache, DamagedShortLongAndForeignEntriesAreComputedAgain) {
  Truth first = Get();
  const std::string good = Bytes(Entry());
  std::string flipped = good;
  flipped[good.size() - 100] = static_cast<char>(flipped[good.size() - 100] ^ 1);
  for (const std::string& bad :
       {std::string(), std::string("not a truth"), good.substr(0, good.size() / 2), good + "x", flipped}) {
    Write(Entry(), bad);
    Truth again = Get();
    EXPECT_FALSE(again.cached);
    EXPECT_TRUE(SameBits(first, again));
    EXPECT_EQ(Bytes(Entry()).size(), good.size());
  }
  // An entry under another's name.
  options_.tolerance = 1e-3;
  key_ = TruthKey(picture_.scene, picture_.pixels, options_);
  Write(Entry(), good);
  EXPECT_FALSE(Get().cached);
}

TEST_F(TruthCache, EverythingThatMattersIsInTheKey) {
  std::set<std::string> keys = {key_};
  auto changed = [&](auto change) {
    Picture p = MakePicture();
    TruthOptions o;
    change(p, o);
    EXPECT_TRUE(keys.insert(TruthKey(p.scene, p.pixels, o)).second);
  };
  changed([](Picture&, TruthOptions& o) { o.tolerance = 1e-3; });
  changed([](Picture& p, TruthOptions&) { p.scene.lights[0].center.x += 1e-9; });
  changed([](Picture& p, TruthOptions&) { p.scene.lights[0].radiance.z = 0.5; });
  changed([](Picture& p, TruthOptions&) { p.scene.lights[0].two_sided = true; });
  changed([](Picture& p, TruthOptions&) { p.scene.lights[0].half_size.y *= 2.0; });
  changed([](Picture& p, TruthOptions&) { p.scene.lights[2].shape = LightShape::kDisk; });
  changed([](Picture& p, TruthOptions&) { p.scene.lights.pop_back(); });
  changed([](Picture& p, TruthOptions&) { p.pixels.view_position.z += 0.001f; });
  changed([](Picture& p, TruthOptions&) { p.pixels.normal.back().w = 0.5f; });
  changed([](Picture& p, TruthOptions&) { std::swap(p.pixels.width, p.pixels.height); });
}

// A killed run leaves bands of rows; the next one takes them, whole ones only.
TEST_F(TruthCache, FinishedRowsOfAKilledRunAreUsed) {
  struct Killed {};
  options_.progress = [](double) { throw Killed(); };  // stops the run after its first bands
  {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_THROW(Get(), Killed);
  }
  options_.progress = {};
  std::filesystem::path parts = folder_ / (key_ + ".parts");
  std::vector<std::filesystem::path> left(std::filesystem::directory_iterator(parts), {});
  ASSERT_FALSE(left.empty());
  EXPECT_FALSE(std::filesystem::exists(Entry()));
  const std::string band = Bytes(left.front());
  Write(parts / "8.rows.1-1.tmp", "half-written");
  Write(parts / "16.rows", band.substr(0, band.size() - 4));
  int computed = 0;
  options_.progress = [&](double) { ++computed; };
  {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
    Truth resumed = Get();
    EXPECT_FALSE(resumed.cached);
    EXPECT_TRUE(SameBits(resumed, ComputeTruth(picture_.scene, picture_.pixels)));
  }
  int bands = (picture_.pixels.height + kTruthBandRows - 1) / kTruthBandRows;
  EXPECT_EQ(computed, bands - static_cast<int>(left.size()) + 1);  // and the last call, with 1
  EXPECT_FALSE(std::filesystem::exists(parts));
}

TEST_F(TruthCache, AFolderThatCannotBeWrittenCostsOnlyTheStoring) {
  Write(folder_, "a file where the folder should be");
  Truth truth = Get();
  EXPECT_FALSE(truth.cached);
  EXPECT_TRUE(SameBits(truth, ComputeTruth(picture_.scene, picture_.pixels)));
}

}  // namespace
}  // namespace arealab::truth_test
