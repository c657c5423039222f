// Truth with visibility against closed forms, its own stated error, one thread against two, and its cache.
#include "compare/shadowed_truth.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <set>

#include "compare/closed_forms.h"
#include "compare/light_sampling.h"
#include "compare/truth_cache.h"
#include "scenes/shapes.h"

namespace arealab::shadowed_truth_test {
namespace {

using glm::dvec3;
constexpr double kPi = std::numbers::pi;

Light MakeLight(LightShape shape, const dvec3& center, const dvec3& normal, glm::dvec2 half_size) {
  Light light;
  light.shape = shape;
  light.center = center;
  light.normal = glm::normalize(normal);
  light.axis_x = glm::normalize(
      glm::cross(std::abs(light.normal.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), light.normal));
  light.axis_y = glm::cross(light.normal, light.axis_x);
  light.half_size = half_size;
  return light;
}

struct Picture {
  Scene scene;
  SurfacePixels pixels;
  RadianceImage unshadowed;
  TruthOptions truth_options;

  ShadowedTruth Shadowed(double tolerance = ShadowOptions().tolerance) const {
    ShadowOptions options;
    options.tolerance = tolerance;
    return ComputeShadowedTruth(scene, pixels, unshadowed, truth_options, options);
  }
};

// A floor of 20 m at z = 0 seen from above; pixel (x, y) lies at `position(x, y)`, roughness rises to the
// right.
template <typename Position>
Picture MakePicture(int width, int height, std::vector<Light> lights, std::vector<Mesh> occluders,
                    Position position, float roughness = 0.9f) {
  Picture p;
  p.scene.lights = std::move(lights);
  p.scene.meshes = std::move(occluders);
  p.scene.meshes.push_back(MakePlane({20.0, 20.0}, {}));
  p.pixels.width = width;
  p.pixels.height = height;
  p.pixels.view_position = {0.5f, -3.0f, 1.2f};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 at = position(x, y);
      p.pixels.position.emplace_back(static_cast<float>(at.x), static_cast<float>(at.y), 0.0f, 1.0f);
      p.pixels.normal.emplace_back(0.0f, 0.0f, 1.0f, roughness);
      p.pixels.base_color.emplace_back(0.8f, 0.6f, 0.4f, 0.0f);
    }
  }
  p.unshadowed = ComputeTruth(p.scene, p.pixels, p.truth_options).radiance;
  return p;
}

glm::dvec2 Grid(int x, int y, int size) {
  return {2.0 * (x + 0.5) / size - 1.0, 2.0 * (y + 0.5) / size - 1.0};
}

double Sum(const glm::vec3& v) {
  return static_cast<double>(v.x) + static_cast<double>(v.y) + static_cast<double>(v.z);
}

// How far the diffuse lobe is from `form_factor(position)`, in stated standard errors of the pixel.
struct Deviation {
  double rms = 0.0, beyond_three = 0.0, mean = 0.0;
  int count = 0, partly = 0;  // pixels; those that lose some light and keep some
};
template <typename FormFactor>
Deviation CompareDiffuse(const Picture& p, const ShadowedTruth& shadowed, FormFactor form_factor) {
  Deviation d;
  for (std::size_t i = 0; i < p.pixels.size(); ++i) {
    const double expected = Sum(glm::vec3(p.pixels.base_color[i])) * form_factor(dvec3(p.pixels.position[i]));
    const double got = Sum(shadowed.radiance.diffuse[i]), before = Sum(p.unshadowed.diffuse[i]);
    const double sigma = static_cast<double>(shadowed.relative_error[i]) * Sum(p.unshadowed.Total(i));
    if (sigma == 0.0) {
      EXPECT_NEAR(got, expected, 1e-5 * before);
      continue;
    }
    const double z = (got - expected) / sigma;
    d.rms += z * z;
    d.mean += z;
    d.beyond_three += std::abs(z) > 3.0 ? 1.0 : 0.0;
    d.partly += got > 1e-3 * before && got < 0.999 * before ? 1 : 0;
    ++d.count;
  }
  d.rms = std::sqrt(d.rms / d.count);
  d.mean /= d.count;
  d.beyond_three /= d.count;
  return d;
}

// A rectangle above the floor, half hidden by a large sheet whose edge runs along y: what is seen is the
// rectangle cut by the plane through the point and the edge, a polygon.
TEST(ShadowedTruth, HalfPlaneOverLambertFloor) {
  const double light_z = 2.0, sheet_z = 1.1, edge = 0.15, half = 0.7;
  const Picture p =
      MakePicture(32, 32, {MakeLight(LightShape::kRectangle, {0, 0, light_z}, {0, 0, -1}, {half, half})},
                  {MakePlane({10.0, 40.0}, {{edge + 5.0, 0.0, sheet_z}, glm::dmat3(1.0)})},
                  [](int x, int y) { return Grid(x, y, 32); });
  const ShadowedTruth shadowed = p.Shadowed();
  const Deviation d = CompareDiffuse(p, shadowed, [&](const dvec3& at) {
    const double cut = std::min(at.x + (edge - at.x) * light_z / sheet_z, half);
    if (cut <= -half) return 0.0;
    const std::array<dvec3, 4> corners = {dvec3(-half, -half, light_z) - at, dvec3(cut, -half, light_z) - at,
                                          dvec3(cut, half, light_z) - at, dvec3(-half, half, light_z) - at};
    return std::abs(PolygonFormFactor(ClipToHorizon(corners)));
  });
  EXPECT_GT(d.partly, 300);
  EXPECT_LE(d.beyond_three, 0.02);
  EXPECT_LT(d.rms, 1.0);
  EXPECT_GT(d.rms, 0.1);  // an edge along the light's side suits nets, so that the error is well overstated
  EXPECT_LT(std::abs(d.mean), 0.15);
  EXPECT_LE(shadowed.p99_error, 0.0201);
}

// A ball that hides a part of the middle of a large disk: the disk's form factor less the ball's.
TEST(ShadowedTruth, BallBeforeADisk) {
  const double radius = 0.3;
  const dvec3 center(0.1, 0.0, 1.0);
  const Picture p = MakePicture(
      24, 24, {MakeLight(LightShape::kDisk, {0, 0, 2.5}, {0, 0, -1}, glm::dvec2(3.0))},
      {MakeSphere(radius, {center, glm::dmat3(1.0)})}, [](int x, int y) { return 0.5 * Grid(x, y, 24); });
  const Light ball = MakeLight(LightShape::kSphere, center, {0, 0, 1}, glm::dvec2(radius));
  const ShadowedTruth shadowed = p.Shadowed();
  const Deviation d = CompareDiffuse(p, shadowed, [&](const dvec3& at) {
    const ShadingPoint point{at, {0, 0, 1}, glm::normalize(dvec3(0, -1, 1)), 0.8};
    return IntegrateLight(point, p.scene.lights[0], 1e-4).form_factor -
           IntegrateLight(point, ball, 1e-4).form_factor;
  });
  EXPECT_GT(d.partly, 500);
  EXPECT_LE(d.beyond_three, 0.02);
  EXPECT_LT(d.rms, 1.0);
  EXPECT_GT(d.rms, 0.2);
}

TEST(ShadowedTruth, WhollyVisibleIsTheUnshadowedTruthBitForBit) {
  const Picture p = MakePicture(16, 16,
                                {MakeLight(LightShape::kRectangle, {0, 1.5, 0.5}, {0, -1, -0.2},
                                           {0.5, 0.5}),  // reaches below the floor
                                 MakeLight(LightShape::kDisk, {1, 0, 1}, {0, 0, -1}, glm::dvec2(0.2)),
                                 MakeLight(LightShape::kSphere, {-1, 0, 0.5}, {0, 0, 1}, glm::dvec2(0.2))},
                                {MakeBox({1, 1, 1}, {{0, 3.0, 0.5}, glm::dmat3(1.0)})},
                                [](int x, int y) { return Grid(x, y, 16); });
  const ShadowedTruth shadowed = p.Shadowed();
  EXPECT_EQ(shadowed.radiance.diffuse, p.unshadowed.diffuse);
  EXPECT_EQ(shadowed.radiance.specular, p.unshadowed.specular);
  EXPECT_EQ(shadowed.sampled_pixels, 0);
  EXPECT_EQ(shadowed.p99_error, 0.0);
}

TEST(ShadowedTruth, WhollyHiddenIsBlack) {
  const Picture p = MakePicture(16, 16,
                                {MakeLight(LightShape::kRectangle, {0, 0, 2}, {0, 0, -1}, {0.5, 0.5}),
                                 MakeLight(LightShape::kSphere, {0.2, 0.1, 1.5}, {0, 0, 1}, glm::dvec2(0.2))},
                                {MakePlane({30.0, 30.0}, {{0.0, 0.0, 1.0}, glm::dmat3(1.0)})},
                                [](int x, int y) { return Grid(x, y, 16); });
  const ShadowedTruth shadowed = p.Shadowed();
  EXPECT_EQ(shadowed.sampled_pixels, 256);
  for (std::size_t i = 0; i < p.pixels.size(); ++i) {
    EXPECT_GT(Sum(p.unshadowed.Total(i)), 0.0);
    EXPECT_EQ(shadowed.radiance.Total(i), glm::vec3(0.0f));
    EXPECT_GT(shadowed.relative_error[i], 0.0f);  // a gap between the rays is never excluded
  }
}

// One free light and one that is hidden: what is left is the free one's.
TEST(ShadowedTruth, FreeLightsStayWhole) {
  std::vector<Light> lights = {MakeLight(LightShape::kRectangle, {0, 0, 2}, {0, 0, -1}, {0.2, 0.2}),
                               MakeLight(LightShape::kRectangle, {0, -2, 0.6}, {0, 1, 0}, {0.5, 0.4})};
  const auto sheet = MakePlane({3.0, 3.0}, {{0.0, 0.0, 1.5}, glm::dmat3(1.0)});
  const auto grid = [](int x, int y) { return 0.5 * Grid(x, y, 16); };
  const Picture both = MakePicture(16, 16, lights, {sheet}, grid);
  lights.erase(lights.begin());
  const Picture one = MakePicture(16, 16, lights, {sheet}, grid);
  const ShadowedTruth shadowed = both.Shadowed();
  for (std::size_t i = 0; i < both.pixels.size(); ++i) {
    const double expected = Sum(one.unshadowed.Total(i));
    EXPECT_GT(Sum(both.unshadowed.Total(i)), 1.2 * expected);
    EXPECT_NEAR(Sum(shadowed.radiance.Total(i)), expected, 2e-3 * Sum(both.unshadowed.Total(i)));
  }
}

// Every row is one place under three lights and two obstacles, every column another scrambling of it. The
// mean of many dense estimates is right to far less than one sparse estimate, whose stated error it judges.
TEST(ShadowedTruth, StatedErrorsAreHonest) {
  constexpr int kColumns = 32, kRows = 20;
  double squares = 0.0;
  int beyond = 0, count = 0;
  for (float roughness : {0.12f, 0.4f, 0.9f}) {
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<glm::dvec2> places;
    for (int y = 0; y < kRows; ++y) places.emplace_back(unit(engine), unit(engine));
    Picture p = MakePicture(
        kColumns, kRows,
        {MakeLight(LightShape::kRectangle, {0, 1.6, 0.7}, {0, -1, -0.2}, {0.9, 0.4}),
         MakeLight(LightShape::kDisk, {-1.2, 0.5, 1.2}, {1, -0.3, -0.8}, glm::dvec2(0.5)),
         MakeLight(LightShape::kSphere, {1.2, 0.8, 0.6}, {0, 0, 1}, glm::dvec2(0.3))},
        {MakeSphere(0.3, {{0.1, 0.6, 0.3}, glm::dmat3(1.0)}),
         MakeBox({0.3, 0.2, 0.9}, {{-0.6, 0.5, 0.45}, glm::dmat3(1.0)})},
        [&](int, int y) { return places[static_cast<std::size_t>(y)]; }, roughness);
    const ShadowedTruth sparse = p.Shadowed(0.02), dense = p.Shadowed(1e-9);
    EXPECT_LT(dense.mean_error, 0.4 * sparse.mean_error);
    for (int y = 0; y < kRows; ++y) {
      double reference = 0.0;
      for (int x = 0; x < kColumns; ++x) {
        reference += Sum(dense.radiance.Total(static_cast<std::size_t>(y * kColumns + x))) / kColumns;
      }
      for (int x = 0; x < kColumns; ++x) {
        const auto i = static_cast<std::size_t>(y * kColumns + x);
        const double sigma = static_cast<double>(sparse.relative_error[i]) * Sum(p.unshadowed.Total(i));
        if (sigma == 0.0) continue;
        const double z = (Sum(sparse.radiance.Total(i)) - reference) / sigma;
        squares += z * z;
        beyond += std::abs(z) > 3.0 ? 1 : 0;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 1500);
  EXPECT_LE(beyond, count / 100);  // measured 3 of 1920, and a root mean square of 0.56
  EXPECT_LT(std::sqrt(squares / count), 0.9);
  EXPECT_GT(std::sqrt(squares / count), 0.3);
}

Picture SmallScene() {
  return MakePicture(
      24, 20, {MakeLight(LightShape::kRectangle, {0, 1.5, 0.7}, {0, -1, -0.2}, {0.9, 0.4})},
      {MakeSphere(0.3, {{0.1, 0.6, 0.3}, glm::dmat3(1.0)})}, [](int x, int y) { return Grid(x, y, 24); },
      0.3f);
}

bool SameBits(const ShadowedTruth& a, const ShadowedTruth& b) {
  return a.radiance.diffuse == b.radiance.diffuse && a.radiance.specular == b.radiance.specular &&
         a.relative_error == b.relative_error;
}

TEST(ShadowedTruth, ThreadsDoNotChangeIt) {
  const Picture p = SmallScene();
  ShadowedTruth one, two;
  {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
    one = p.Shadowed();
  }
  {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, 2);
    two = p.Shadowed();
  }
  EXPECT_TRUE(SameBits(one, two));
  EXPECT_GT(one.sampled_pixels, 100);
  EXPECT_NE(one.radiance.diffuse, p.unshadowed.diffuse);
}

class ShadowCache : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("arealab_shadow_cache_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  ShadowedTruth Get() const {
    return CachedShadowedTruth(p_.scene, p_.pixels, p_.unshadowed, p_.truth_options, options_, folder_);
  }
  std::string Key() const { return ShadowKey(p_.scene, p_.pixels, p_.truth_options, options_); }
  Picture p_ = SmallScene();
  ShadowOptions options_;
  std::filesystem::path folder_;
};

TEST_F(ShadowCache, HitsAndMendsWhatIsDamaged) {
  const ShadowedTruth first = Get(), second = Get();
  EXPECT_FALSE(first.cached);
  EXPECT_TRUE(second.cached);
  EXPECT_TRUE(SameBits(first, second));
  EXPECT_TRUE(SameBits(first, p_.Shadowed()));
  EXPECT_EQ(first.mean_error, second.mean_error);
  EXPECT_EQ(first.sampled_pixels, second.sampled_pixels);
  const std::filesystem::path entry = folder_ / (Key() + ".truth");
  const auto size = std::filesystem::file_size(entry);
  {
    std::fstream file(entry, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(size / 2));
    file.put('\x7f');
  }
  const ShadowedTruth mended = Get();
  EXPECT_FALSE(mended.cached);
  EXPECT_TRUE(SameBits(first, mended));
  EXPECT_TRUE(Get().cached);
  // Beside the unshadowed truth in one folder, each its own.
  EXPECT_FALSE(CachedTruth(p_.scene, p_.pixels, p_.truth_options, folder_).cached);
  EXPECT_TRUE(Get().cached);
}

TEST_F(ShadowCache, EverythingThatMattersIsInTheKey) {
  const std::string key = Key();
  EXPECT_NE(key, TruthKey(p_.scene, p_.pixels, p_.truth_options));
  p_.scene.meshes[0].vertices[100].position.x += 1e-6f;
  EXPECT_NE(Key(), key);
  p_ = SmallScene();
  p_.scene.meshes[0].vertices[100].normal.x += 1e-6f;  // rays begin elsewhere
  EXPECT_NE(Key(), key);
  p_ = SmallScene();
  p_.scene.meshes[0].indices.resize(p_.scene.meshes[0].indices.size() - 3);
  EXPECT_NE(Key(), key);
  p_ = SmallScene();
  p_.scene.lights[0].center.z += 1e-9;
  EXPECT_NE(Key(), key);
  p_ = SmallScene();
  p_.truth_options.tolerance *= 2.0;
  EXPECT_NE(Key(), key);
  p_ = SmallScene();
  EXPECT_EQ(Key(), key);
  options_.tolerance *= 2.0;
  EXPECT_NE(Key(), key);
}

// The densities are those of the directions: each way of sampling gives the light's own integrals.
TEST(LightSampling, IntegratesWhatHasAClosedForm) {
  std::vector<Light> lights = {
      MakeLight(LightShape::kRectangle, {0.3, 1.2, 0.8}, {0.1, -1, -0.4}, {0.9, 0.3}),
      MakeLight(LightShape::kRectangle, {0.0, 0.2, 0.05}, {0.0, -1.0, -3.0}, {2.0, 0.5}),
      MakeLight(LightShape::kRectangle, {40, 300, 250}, {0, -1, -1}, {0.02, 0.03}),
      MakeLight(LightShape::kRectangle, {0, 1, 0.7}, {0, 1, 0.2}, {0.4, 0.6}),
      MakeLight(LightShape::kDisk, {-1, 0.3, 0.4}, {1, 0.2, -0.6}, glm::dvec2(0.7)),
      MakeLight(LightShape::kSphere, {1, 0.3, 0.3}, {0, 0, 1}, glm::dvec2(0.6)),
      MakeLight(LightShape::kEllipse, {-0.6, 0.5, 0.5}, {0.7, -0.2, -0.6}, {0.8, 0.3}),
      MakeLight(LightShape::kPolygon, {0.4, 1.2, 0.9}, {0.1, -1, -0.4}, {}),
      MakeLight(LightShape::kPolygon, {0, 1, 0.8}, {0.1, 1, 0.2}, {}),
      MakeLight(LightShape::kTube, {0.4, 1, 0.6}, {0.1, -1, -0.4}, {0.8, 0.1}),
      MakeLight(LightShape::kTube, {0.6, 0.2, 0.3}, {0.4, 0.5, -1}, {0.4, 0.1})};
  lights[3].two_sided = lights[8].two_sided = true;  // their backs
  SetCorners(lights[7], {{-0.5, -0.4}, {0.6, -0.3}, {0.3, 0.7}});
  SetCorners(lights[8], {{0.5, 0.0}, {0.3, 0.5}, {-0.2, 0.6}, {-0.5, 0.1}, {-0.3, -0.4}, {0.1, -0.5}});
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const ShadingPoint point{dvec3(0.0), {0, 0, 1}, glm::normalize(dvec3(0.1, -0.8, 0.6)), 0.5};
    const auto directions = LightDirections::From(point.position, point.normal, lights[l]);
    ASSERT_TRUE(directions) << l;
    const LightIntegrals expected = IntegrateLight(point, lights[l], 1e-6);
    double form_factor = 0.0;
    constexpr std::uint32_t kCount = 1024, kScramblings = 64;
    for (std::uint32_t s = 0; s < kScramblings; ++s) {
      for (std::uint32_t i = 0; i < kCount; ++i) {
        const auto sample = directions->At(ScrambledSobol(i, Mix(l, s)));
        EXPECT_NEAR(glm::length(sample.direction), 1.0, 1e-9);
        form_factor += std::max(sample.direction.z, 0.0) / (kPi * sample.density);
        if (i % 64 != 0) continue;
        const auto same = directions->Towards(sample.direction);
        if (!same) continue;  // rounding at the rim
        EXPECT_NEAR(same->distance, sample.distance, 1e-6 * sample.distance) << l;
        EXPECT_NEAR(same->density, sample.density, 1e-6 * sample.density) << l;
      }
    }
    EXPECT_NEAR(form_factor / (kCount * kScramblings), expected.form_factor, 2e-4 * expected.form_factor)
        << l;
    EXPECT_FALSE(directions->Towards(glm::normalize(-lights[l].center))) << l;
  }
  EXPECT_FALSE(LightDirections::From(dvec3(0.0), {0, 0, 1},
                                     MakeLight(LightShape::kDisk, {0, 0, 1}, {0, 0, 1}, {1, 1})));
  EXPECT_FALSE(LightDirections::From(dvec3(0.0), {0, 0, 1},
                                     MakeLight(LightShape::kSphere, {0, 0, 1}, {0, 0, 1}, {2, 2})));
  EXPECT_FALSE(LightDirections::From(dvec3(0.0), {0, 0, 1},
                                     MakeLight(LightShape::kRectangle, {1, 0, -1}, {-1, 0, 0}, {1, 1})));
}

// A net: each of the 2^k first points has an interval of each elementary shape to itself, whatever the seed.
TEST(LightSampling, ScrambledPointsAreNets) {
  for (std::uint64_t seed : {1u, 99u, 12345u}) {
    for (int k : {1, 4, 6}) {
      for (int a = 0; a <= k; ++a) {
        std::set<std::pair<int, int>> cells;
        for (std::uint32_t i = 0; i < (1u << k); ++i) {
          const glm::dvec2 u = ScrambledSobol(i, Mix(seed, 3));
          ASSERT_TRUE(u.x >= 0.0 && u.x < 1.0 && u.y >= 0.0 && u.y < 1.0);
          cells.emplace(static_cast<int>(u.x * (1 << a)), static_cast<int>(u.y * (1 << (k - a))));
        }
        EXPECT_EQ(cells.size(), std::size_t{1} << k) << k << " " << a;
      }
    }
  }
}

}  // namespace
}  // namespace arealab::shadowed_truth_test
