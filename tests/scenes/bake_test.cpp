// Apertures against what can be worked out by hand.
#include "scenes/bake.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "scenes/shapes.h"

namespace arealab::bake_test {
namespace {

Scene SceneOf(std::vector<Mesh> meshes, int rays) {
  Scene scene;
  scene.meshes = std::move(meshes);
  scene.aperture = ApertureSettings{.rays = rays};
  return scene;
}

// The aperture at the vertex of mesh 0 that is nearest to a place.
Aperture ApertureAt(const Scene& scene, const glm::vec3& place) {
  const Mesh& mesh = scene.meshes[0];
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (glm::distance(mesh.vertices[i].position, place) < glm::distance(mesh.vertices[nearest].position, place)) nearest = i;
  }
  return mesh.apertures[nearest];
}

TEST(Bake, AnOpenPlaneSeesAllOfItsHemisphere) {
  Scene scene = SceneOf({MakePlane({4.0, 4.0}, {}, 0.5)}, 64);
  BakeApertures(scene);
  ASSERT_EQ(scene.meshes[0].apertures.size(), 81u);
  for (const Aperture& aperture : scene.meshes[0].apertures) EXPECT_EQ(aperture.open, glm::vec4(0.0f, 0.0f, 1.0f, 1.0f));
}

// At the foot of a wall without end half of the hemisphere is left: versine 1/2, and ∫ ω dω over it is (π/2)(x + z).
TEST(Bake, TheFootOfAWallSeesAQuarterSphere) {
  Placement wall;
  wall.rotation = RotationFromDegrees({0.0, 90.0, 0.0});
  Scene scene = SceneOf({MakePlane({2.0, 2.0}, {{1.0, 0.0, 0.0}, glm::dmat3(1.0)}, 1.0), MakePlane({2e4, 2e4}, wall)}, 4096);
  BakeApertures(scene);
  const glm::vec4 aperture = ApertureAt(scene, {0.0f, 0.0f, 0.0f}).open;
  EXPECT_NEAR(aperture.w, 0.5, 0.01);
  EXPECT_NEAR(aperture.x, std::sqrt(0.5), 0.01);
  EXPECT_NEAR(aperture.y, 0.0, 0.01);
  EXPECT_NEAR(aperture.z, std::sqrt(0.5), 0.01);
}

// A ball of radius 1 whose centre is 2 overhead hides the cap of sin r = 1/2: of the plane's hemisphere √3/2 is left, and by
// symmetry the mean direction is still up: where it fails, since up is what is hidden.
TEST(Bake, ABallOverAPlaneLeavesARingThatACapCannotHold) {
  Placement ball;
  ball.position = {0.0, 0.0, 2.0};
  Scene scene = SceneOf({MakePlane({2.0, 2.0}, {}, 1.0), MakeSphere(1.0, ball)}, 512);
  BakeApertures(scene);
  const glm::vec4 aperture = ApertureAt(scene, {0.0f, 0.0f, 0.0f}).open;
  EXPECT_NEAR(aperture.w, std::sqrt(0.75), 5e-3);
  EXPECT_NEAR(aperture.z, 1.0, 2e-3);
}

// The same ball as an anti-aperture is the cap that it hides, and beside it what is open is one region.
TEST(Bake, ABallOverAPlaneIsWhatABlockedCapHolds) {
  Placement ball;
  ball.position = {0.0, 0.0, 2.0};
  Scene scene = SceneOf({MakePlane({2.0, 2.0}, {}, 1.0), MakeSphere(1.0, ball)}, 512);
  BakeApertures(scene);
  const Aperture aperture = ApertureAt(scene, {0.0f, 0.0f, 0.0f});
  EXPECT_NEAR(aperture.blocked.w, 1.0 - std::sqrt(0.75), 5e-3);
  EXPECT_NEAR(aperture.blocked.z, 1.0, 1e-2);
  EXPECT_EQ(aperture.region[0], aperture.open);
  EXPECT_EQ(aperture.region[1].w, 0.0f);
}

// Under a roof between two walls there is an opening on either side. His one cap looks up, at the roof; the two regions look out, mirror
// images in the middle, and their order is the same all along the floor.
TEST(Bake, TwoOpeningsAreTwoRegions) {
  Placement roof, end, other_end;
  roof.position = {0.0, 0.0, 1.0};
  end.position = {0.0, 0.9, 0.0};
  other_end.position = {0.0, -0.9, 0.0};
  end.rotation = other_end.rotation = RotationFromDegrees({90.0, 0.0, 0.0});
  Scene scene = SceneOf({MakePlane({0.4, 1.6}, {}, 0.2), MakePlane({2.0, 4.0}, roof), MakePlane({2.0, 4.0}, end), MakePlane({2.0, 4.0}, other_end)}, 2048);
  BakeApertures(scene);
  const Aperture middle = ApertureAt(scene, {0.0f, 0.0f, 0.0f});
  EXPECT_NEAR(middle.open.z, 1.0, 0.02);
  EXPECT_NEAR(middle.region[0].w, middle.region[1].w, 0.01);
  EXPECT_NEAR(middle.region[0].x, -middle.region[1].x, 0.01);
  EXPECT_NEAR(middle.region[0].z, middle.region[1].z, 0.01);
  const float side = middle.region[0].x > 0.0f ? 1.0f : -1.0f;
  for (const Aperture& aperture : scene.meshes[0].apertures) {
    EXPECT_GT(side * aperture.region[0].x, 0.7f);
    EXPECT_LT(side * aperture.region[1].x, -0.7f);
    EXPECT_NEAR(aperture.region[0].w + aperture.region[1].w, aperture.open.w, 1e-6);
    EXPECT_NEAR(aperture.open.w + aperture.blocked.w, 1.0, 1e-6);
  }
}

TEST(Bake, WhatIsShutInSeesNothing) {
  Scene scene = SceneOf({MakePlane({0.5, 0.5}, {}), MakeBox({2.0, 2.0, 2.0}, {})}, 64);
  BakeApertures(scene);
  EXPECT_EQ(ApertureAt(scene, {0.25f, 0.25f, 0.0f}).open, glm::vec4(0.0f, 0.0f, 1.0f, 0.0f));
}

TEST(Bake, SameBitsOnAnyNumberOfThreads) {
  const auto bake = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Placement ball;
    ball.position = {0.1, 0.2, 0.6};
    Scene scene = SceneOf({MakePlane({2.0, 2.0}, {}, 0.1), MakeSphere(0.4, ball)}, 64);
    BakeApertures(scene);
    return scene.meshes[0].apertures;
  };
  EXPECT_EQ(bake(1), bake(4));
}

}  // namespace
}  // namespace arealab::bake_test
