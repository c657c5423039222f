// What techniques make of baked apertures, through the G-buffer and the lighting pass.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "compare/aperture_cache.h"
#include "compare/context.h"
#include "compare/metrics.h"
#include "glsl/renderer.h"
#include "scenes/bake.h"
#include "scenes/shapes.h"

namespace arealab::aperture_test {
namespace {

// A floor at the foot of a wall, seen from above, and a sphere light overhead on the wall's open or shut side.
Scene Foot(double light_x) {
  Scene scene;
  scene.camera.position = {2.0, 0.0, 6.0};
  scene.camera.target = {2.0, 0.0, 0.0};
  scene.camera.up = {0.0, 1.0, 0.0};
  scene.camera.vertical_fov = 0.5;
  scene.materials.push_back({});
  Placement wall;
  wall.position = {0.0, 0.0, 0.0};
  wall.rotation = RotationFromDegrees({0.0, 90.0, 0.0});
  scene.meshes = {MakePlane({8.0, 8.0}, {{4.0, 0.0, 0.0}, glm::dmat3(1.0)}, 0.5), MakePlane({100.0, 100.0}, wall)};
  Light light;
  light.shape = LightShape::kSphere;
  light.center = {light_x, 0.0, 60.0};
  light.half_size = {5.0, 5.0};
  scene.lights.push_back(light);
  scene.aperture = ApertureSettings{};
  return scene;
}

class Aperture : public ::testing::Test {
 protected:
  RadianceImage Shade(const Scene& scene, const std::string& variant) {
    renderer_.DrawScene(scene, {24, 24});
    return renderer_.Shade(ParseVariant(techniques_, variant));
  }

  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
  ShaderLibrary library_;
  std::vector<Technique> techniques_ = LoadTechniques(library_);
  Renderer renderer_{context_->gl(), library_};
};

// Before the bake, and where the light is wholly in the aperture, every technique gives what it gives without one.
TEST_F(Aperture, LightInTheOpenIsUntouched) {
  Scene scene = Foot(80.0);
  for (const std::string variant : {"oat", "ltc", "point"}) {
    const RadianceImage unbaked = Shade(scene, variant);
    Scene without = scene;
    without.aperture.reset();
    const RadianceImage plain = Shade(without, variant);
    EXPECT_LT(RelativeRmse(unbaked.diffuse, plain.diffuse), 1e-6) << variant;
    Scene baked = scene;
    BakeApertures(baked);
    const RadianceImage open = Shade(baked, variant);
    EXPECT_LT(RelativeRmse(open.diffuse, plain.diffuse), 1e-6) << variant;
    EXPECT_GT(plain.diffuse[300].x, 0.0f);
  }
}

// Behind the wall, seen over the floor's horizon but not through the wall: dark for all of them.
TEST_F(Aperture, LightBehindTheWallIsShutOut) {
  Scene scene = Foot(-80.0);
  BakeApertures(scene);
  for (const std::string variant : {"oat", "oat@published", "ltc", "reference"}) {
    const RadianceImage image = Shade(scene, variant);
    Scene without = scene;
    without.aperture.reset();
    const RadianceImage plain = Shade(without, variant);
    double sum = 0.0, plain_sum = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
      sum += static_cast<double>(image.diffuse[i].x);
      plain_sum += static_cast<double>(plain.diffuse[i].x);
    }
    EXPECT_GT(plain_sum, 0.1) << variant;
    EXPECT_LT(sum, 0.01 * plain_sum) << variant;
  }
}

TEST_F(Aperture, CacheGivesTheSameBitsAndHealsWhatIsDamaged) {
  const auto folder = std::filesystem::temp_directory_path() / ("arealab_apertures_" + std::to_string(getpid()));
  Scene baked = Foot(80.0), read = baked, healed = baked;
  EXPECT_FALSE(CachedApertures(baked, folder));
  EXPECT_TRUE(CachedApertures(read, folder));
  EXPECT_EQ(read.meshes[0].apertures, baked.meshes[0].apertures);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::fstream(entry.path(), std::ios::in | std::ios::out | std::ios::binary).write("damage", 6);
  }
  EXPECT_FALSE(CachedApertures(healed, folder));
  EXPECT_EQ(healed.meshes[0].apertures, baked.meshes[0].apertures);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace arealab::aperture_test
