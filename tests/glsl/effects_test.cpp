// What a scene calls for, each effect against a scene made for it.
#include "glsl/effects.h"

#include <gmock/gmock.h>

#include "scenes/error.h"
#include "scenes/shapes.h"

namespace arealab::effects_test {
namespace {

using testing::HasSubstr;

// A grey matte wall in z = 0, seen from above, under one distant lamp that faces it.
Scene MatteWall() {
  Scene scene;
  scene.camera.position = {0.0, -3.0, 3.0};
  scene.materials.emplace_back();
  scene.materials[0].name = "wall";
  scene.materials[0].specular = 0.0f;
  scene.meshes.push_back(MakePlane({4.0, 4.0}, {}));
  Light light;
  light.name = "lamp";
  light.center = {0.0, 0.0, 9.0};
  light.axis_y = {0.0, -1.0, 0.0};
  light.normal = {0.0, 0.0, -1.0};
  scene.lights.push_back(light);
  return scene;
}

std::vector<std::string> On(const Scene& scene) {
  std::vector<std::string> on;
  for (const Effect& effect : SceneEffects(scene)) {
    EXPECT_FALSE(effect.reason.empty());
    if (effect.on) on.push_back(effect.name);
  }
  return on;
}

using testing::ElementsAre;

TEST(Effects, ADistantLampOverAMatteWallCallsForLittle) {
  EXPECT_THAT(On(MatteWall()), ElementsAre("rectangle", "diffuse"));
  EXPECT_EQ(SceneEffect(MatteWall(), "specular").reason, "every material is matte: a non-metal of specular = 0");
}

TEST(Effects, ATextureIsSeenAndItsColours) {
  Scene scene = MatteWall();
  scene.lights[0].texture = std::make_shared<Image>(Image{2, 1, {glm::vec4(1.0f), glm::vec4(0.5f)}});
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "diffuse", "textured"));
  EXPECT_EQ(SceneEffect(scene, "textured").reason, "light \"lamp\" shows a texture");
  scene.lights[0].texture = std::make_shared<Image>(Image{1, 1, {glm::vec4(1.0f, 0.5f, 1.0f, 1.0f)}});
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "diffuse", "light_color", "textured"));
  EXPECT_EQ(SceneEffect(scene, "light_color").reason, "light \"lamp\" has a coloured texture");
}

TEST(Effects, FollowTheMaterials) {
  Scene scene = MatteWall();
  Material& wall = scene.materials[0];
  wall.specular = 0.5f;
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "diffuse", "specular", "specular_weight", "fresnel"));
  wall.specular = 1.0f;
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "diffuse", "specular", "fresnel"));
  wall.metalness = 1.0f;
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "specular", "fresnel", "metal"));
  wall.base_color = glm::vec3(1.0f);
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "specular", "metal"));
  wall.metallic_roughness_texture = std::make_shared<Image>(Image{1, 1, {glm::vec4(0.5f)}});
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "diffuse", "specular", "fresnel", "metal"));
  wall.base_color = {1.0f, 0.5f, 1.0f};
  EXPECT_TRUE(SceneEffect(scene, "material_color").on);
  scene.materials.insert(scene.materials.begin(), MatteWall().materials[0]);  // what no surface is made of costs nothing
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "diffuse"));
}

TEST(Effects, FollowTheLights) {
  Scene scene = MatteWall();
  scene.lights.push_back(scene.lights[0]);
  scene.lights[1].shape = LightShape::kDisk;
  scene.lights.push_back(scene.lights[0]);
  scene.lights[2].shape = LightShape::kSphere;
  scene.lights[2].two_sided = true;  // a sphere has one side
  scene.lights[2].radiance.x = 3.0;
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "disk", "sphere", "diffuse", "light_color", "many_lights"));
  scene.lights[1].radiance = scene.lights[2].radiance = glm::dvec3(0.0);  // what does not emit costs nothing
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "diffuse"));
}

TEST(Effects, BehindAndTwoSidedFollowTheSurfaces) {
  Scene scene = MatteWall();
  Light& light = scene.lights[0];
  light.two_sided = true;
  EXPECT_FALSE(SceneEffect(scene, "two_sided").on);  // nothing is behind it
  EXPECT_FALSE(SceneEffect(scene, "behind").on);
  light.normal = {1.0, 0.0, 0.0};  // its plane cuts the wall
  light.axis_x = {0.0, 0.0, 1.0};
  EXPECT_TRUE(SceneEffect(scene, "two_sided").on);
  EXPECT_THAT(SceneEffect(scene, "behind").reason, HasSubstr("\"wall\" lies behind light \"lamp\""));
  light.two_sided = false;
  EXPECT_FALSE(SceneEffect(scene, "two_sided").on);
  EXPECT_TRUE(SceneEffect(scene, "behind").on);
}

TEST(Effects, HorizonsAreThoseOfTheSurfacesPlane) {
  Scene scene = MatteWall();
  Light& light = scene.lights[0];
  light.normal = {0.0, -1.0, 0.0};
  light.axis_x = {1.0, 0.0, 0.0};
  light.axis_y = {0.0, 0.0, 1.0};
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    light.shape = shape;
    light.half_size = {0.5, 0.5};
    const double radius = shape == LightShape::kRectangle ? std::sqrt(0.5) : 0.5;
    light.center.z = 0.51;  // stands 1 cm clear of the wall
    EXPECT_FALSE(SceneEffect(scene, "horizon").on) << Name(shape);
    EXPECT_TRUE(SceneEffect(scene, "proxy_horizon").on) << Name(shape);
    light.center.z = 0.49;
    EXPECT_TRUE(SceneEffect(scene, "horizon").on) << Name(shape);
    light.center.z = -0.51;  // wholly below
    EXPECT_FALSE(SceneEffect(scene, "horizon").on) << Name(shape);
    light.center.z = 2.42 * radius;
    EXPECT_FALSE(SceneEffect(scene, "proxy_horizon").on) << Name(shape);
    light.center.z = 2.41 * radius;
    EXPECT_TRUE(SceneEffect(scene, "proxy_horizon").on) << Name(shape);
  }
}

TEST(Effects, ABentNormalCallsForEveryHorizon) {
  Scene scene = MatteWall();
  scene.materials[0].normal_texture = std::make_shared<Image>(Image{1, 1, {glm::vec4(0.5f, 0.5f, 1.0f, 1.0f)}});
  EXPECT_THAT(SceneEffect(scene, "horizon").reason, HasSubstr("normal map"));
  EXPECT_TRUE(SceneEffect(scene, "proxy_horizon").on);
  EXPECT_TRUE(SceneEffect(scene, "turned_away").on);
}

// Corner normals that lean apart: between them lies one whose horizon is higher than at any corner's own place.
TEST(Effects, CurvedSurfacesAreBoundedBetweenTheirCorners) {
  Scene scene = MatteWall();
  scene.meshes[0].vertices[0].normal = glm::normalize(glm::vec3(0.0f, -1.0f, 0.2f));
  scene.lights[0].center = {0.0, 2.5, 1.2};
  EXPECT_TRUE(SceneEffect(scene, "horizon").on);
}

// Surfaces turned from the camera are black and call for nothing.
TEST(Effects, WhatIsTurnedAwayCallsForNothing) {
  Scene scene = MatteWall();
  scene.lights[0].center.z = 0.1;
  scene.lights[0].normal = {1.0, 0.0, 0.0};
  scene.lights[0].axis_x = {0.0, 0.0, 1.0};
  EXPECT_TRUE(SceneEffect(scene, "horizon").on);
  scene.camera.position.z = -3.0;
  EXPECT_FALSE(SceneEffect(scene, "horizon").on);
  EXPECT_TRUE(SceneEffect(scene, "turned_away").on);
}

TEST(Effects, FollowMetalAndArea) {
  Scene scene = MatteWall();
  EXPECT_FALSE(SceneEffect(scene, "metal").on);
  EXPECT_FALSE(SceneEffect(scene, "thin").on);
  scene.materials[0].metalness = 0.25f;
  EXPECT_TRUE(SceneEffect(scene, "metal").on);
  scene.lights[0].half_size = {1.0, 2e-8};
  EXPECT_TRUE(SceneEffect(scene, "thin").on);
  scene.lights[0].half_size = {1.0, 1e-6};
  EXPECT_FALSE(SceneEffect(scene, "thin").on);
}

TEST(Effects, FollowTheSky) {
  Scene scene = MatteWall();
  EXPECT_EQ(SceneEffect(scene, "sky").reason, "the scene has no sky");
  scene.sky = glm::dvec3(0.5);
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "diffuse", "sky"));
  scene.sky = glm::dvec3(0.4, 0.5, 0.6);
  EXPECT_THAT(On(scene), ElementsAre("rectangle", "diffuse", "light_color", "sky"));
  EXPECT_EQ(SceneEffect(scene, "light_color").reason, "the sky is coloured");
}

TEST(Effects, AnUnknownNameListsWhatThereIs) {
  try {
    SceneEffect(MatteWall(), "horizom");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected one of rectangle, disk"));
  }
}

TEST(Effects, ForcedOnesHaveTheLastWord) {
  const std::vector<Effect> effects{{"horizon", true, ""}, {"disk", false, ""}};
  EXPECT_THAT(Defines(effects, {{"horizon", false}}), ElementsAre(testing::Pair("EFFECT_HORIZON", 0), testing::Pair("EFFECT_DISK", 0)));
}

}  // namespace
}  // namespace arealab::effects_test
