// What a sound scene file becomes, and the scenes that come with AreaLab.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <set>

#include "scenes/mesh_file.h"
#include "tests/scenes/mesh_checks.h"
#include "tests/scenes/scene_folder.h"

namespace arealab::scene_test {
namespace {

using ::testing::HasSubstr;

class SceneTest : public SceneFolder {};

TEST_F(SceneTest, EveryFieldArrives) {
  const Scene scene = Load(R"(# Does it arrive?
units = "photometric"
exposure = -7.5
[camera]
position = [1, -4.0, 1.5]
target = [0.0, 0.5, 0.25]
up = [0.0, 0.0, 2.0]
vertical_fov = 90.0
[[material]]
name = "ramp"
base_color = [0.1, 0.2, 0.3]
roughness = [0.25, 0.75]
metalness = 1
normal_scale = 0.5
[[material]]
name = "plain"
base_color = 0.5
roughness = 0.125
[[surface]]
type = "box"
size = [1, 2, 3]
position = [0, 0, 1.5]
rotation = [0, 0, 45]
material = "plain"
[[light]]
name = "key"
shape = "disk"
position = [0, 0, 2]
target = [0, 0, 0]
radius = 0.5
two_sided = true
luminance = 1000.0
)");
  EXPECT_EQ(scene.name, "test");
  EXPECT_EQ(scene.question, "Does it arrive?");
  EXPECT_EQ(scene.file, folder_ / "test.toml");
  EXPECT_EQ(scene.units, Units::kPhotometric);
  EXPECT_EQ(scene.exposure, -7.5);
  EXPECT_EQ(scene.camera.position, glm::dvec3(1.0, -4.0, 1.5));
  EXPECT_EQ(scene.camera.target, glm::dvec3(0.0, 0.5, 0.25));
  EXPECT_EQ(scene.camera.up, glm::dvec3(0.0, 0.0, 1.0));
  EXPECT_DOUBLE_EQ(scene.camera.vertical_fov, glm::half_pi<double>());
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].base_color, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(scene.materials[0].roughness, glm::vec2(0.25f, 0.75f));
  EXPECT_EQ(scene.materials[0].metalness, 1.0f);
  EXPECT_EQ(scene.materials[0].normal_scale, 0.5f);
  EXPECT_EQ(scene.materials[1].base_color, glm::vec3(0.5f));
  EXPECT_EQ(scene.materials[1].roughness, glm::vec2(0.125f));
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].material, 1);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "key");
  EXPECT_EQ(scene.lights[0].shape, LightShape::kDisk);
  EXPECT_TRUE(scene.lights[0].two_sided);
  EXPECT_EQ(scene.lights[0].radiance, glm::dvec3(1000.0));
}

TEST_F(SceneTest, WithoutACommentThereIsNoQuestion) {
  EXPECT_EQ(Load(kCamera + kMaterial + kSurface + kLight).question, "");
  EXPECT_EQ(Load("#\n" + kCamera + kMaterial + kSurface + kLight).question, "");
  EXPECT_EQ(Load("##  Is <b>this</b> it?  \r\n" + kCamera + kMaterial + kSurface + kLight).question,
            "Is <b>this</b> it?");
}

TEST_F(SceneTest, HeightFieldsFollowTheirFormulas) {
  const std::string field =
      "[[surface]]\ntype = \"height_field\"\nsize = [4, 4]\nheight = 0.05\nwavelength = 1.5\n"
      "cells = [200, 200]\nmaterial = \"grey\"\n";
  for (const std::string formula : {"waves", "ripples", "dunes"}) {
    SCOPED_TRACE(formula);
    const Scene scene = Load(kCamera + kMaterial + kLight + field + "formula = \"" + formula + "\"\n");
    const Mesh& mesh = scene.meshes.at(0);
    ExpectSound(mesh);
    ExpectTangentsFollowTexture(mesh);
    float low = 0.0f, high = 0.0f;
    double worst = 0.0;  // of the analytic normal against the triangle's: a wrong slope shows
    for (const Vertex& vertex : mesh.vertices) {
      low = std::min(low, vertex.position.z);
      high = std::max(high, vertex.position.z);
    }
    for (std::size_t i = 0; i < TriangleCount(mesh); ++i) {
      const Corners corner = Triangle(mesh, i);
      const glm::dvec3 mean(corner.a.normal + corner.b.normal + corner.c.normal);
      worst = std::max(worst, glm::length(glm::normalize(mean) - glm::normalize(corner.Facing())));
    }
    EXPECT_GE(low, -0.05f);
    EXPECT_LE(high, 0.05f);
    EXPECT_GT(high - low, 0.06f);
    EXPECT_LT(worst, 0.015);  // measured 0.006 … 0.0103, the bend within a cell; slopes reach 0.2
  }
}

TEST(BuiltInScenes, EachLoadsAndAsksOneQuestion) {
  std::set<std::string> names;
  for (const std::filesystem::path& file : BuiltInScenes()) {
    SCOPED_TRACE(file);
    const Scene scene = LoadScene(file);
    names.insert(scene.name);
    EXPECT_FALSE(scene.question.empty());
    EXPECT_EQ(scene.question.find('?'), scene.question.size() - 1);
    EXPECT_EQ(scene.question.find(". "), std::string::npos);
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(scene.question.at(0))));
    for (const Mesh& mesh : scene.meshes) ExpectSound(mesh);
    for (const Light& light : scene.lights) EXPECT_GT(light.Flux(), 0.0);
  }
  EXPECT_THAT(names, ::testing::IsSupersetOf({"gloss", "beckmann", "sinking", "grazing", "mirror", "strip", "shapes",
                                              "bulbs", "spheres", "relief", "scan", "sixteen"}));
  EXPECT_EQ(BuiltInScenes().front().stem(), "gloss");
}

TEST(BuiltInScenes, AreWhatTheirNamesSay) {
  const auto load = [](const char* name) { return LoadScene(FindScene(name)); };
  EXPECT_EQ(load("gloss").materials.at(0).roughness, glm::vec2(0.05f, 1.0f));
  EXPECT_EQ(load("gloss").brdf, Brdf::kGgx);
  EXPECT_EQ(load("beckmann").brdf, Brdf::kBeckmann);
  EXPECT_EQ(load("sixteen").lights.size(), 16u);
  const glm::dvec2 strip = load("strip").lights.at(0).half_size;
  EXPECT_NEAR(strip.x / strip.y, 100.0, 1e-9);
  const Scene shapes = load("shapes");
  std::set<LightShape> kinds;
  for (const Light& light : shapes.lights) {
    kinds.insert(light.shape);
    EXPECT_NEAR(light.Flux(), shapes.lights[0].Flux(), 1e-9);
  }
  EXPECT_EQ(kinds.size(), 3u);
  int crossing = 0;
  for (const Light& light : load("sinking").lights) {
    const double foot = light.center.z - light.half_size.y * std::abs(light.axis_y.z);
    const double top = light.center.z + light.half_size.y * std::abs(light.axis_y.z);
    crossing += foot < 0.0 && top > 0.0 ? 1 : 0;
  }
  EXPECT_GE(crossing, 3);
  const Scene scan = load("scan");
  EXPECT_EQ(scan.units, Units::kPhotometric);
  EXPECT_EQ(scan.lights.size(), 3u);
  const std::size_t largest = TriangleCount(
      *std::max_element(scan.meshes.begin(), scan.meshes.end(),
                        [](const Mesh& a, const Mesh& b) { return a.indices.size() < b.indices.size(); }));
  EXPECT_EQ(largest, 69666u);
}

TEST(BuiltInScenes, AreFoundByNameAndOthersByPath) {
  const std::filesystem::path gloss = FindScene("gloss");
  EXPECT_EQ(gloss.filename(), "gloss.toml");
  EXPECT_EQ(FindScene(gloss.string()), gloss);
  try {
    FindScene("glos");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("no scene 'glos'; expected a scene file's path or one of: gloss, beckmann, sinking, "));
  }
}

TEST_F(SceneTest, AnotherFolderOfScenesCanBeNamed) {
  for (const char* name : {"zebra.toml", "ant.toml", "scan.toml", "gloss.toml", "notes.txt"}) Write(name, "");
  setenv("AREALAB_SCENES", folder_.c_str(), 1);
  std::vector<std::string> names;
  for (const std::filesystem::path& file : BuiltInScenes()) names.push_back(file.filename().string());
  unsetenv("AREALAB_SCENES");
  EXPECT_THAT(names, ::testing::ElementsAre("gloss.toml", "scan.toml", "ant.toml", "zebra.toml"));
}

}  // namespace
}  // namespace arealab::scene_test
