// Shadow rays against closed forms, the lift off facets, and the proof that nothing is in the way.
#include "scenes/ray_query.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "scenes/shapes.h"

namespace arealab::ray_query_test {
namespace {

using glm::dvec3;

dvec3 RandomDirection(std::mt19937_64& engine) {
  std::normal_distribution<double> normal;
  return glm::normalize(dvec3(normal(engine), normal(engine), normal(engine)));
}

Scene WithSphere(double radius, const dvec3& position) {
  Scene scene;
  scene.meshes.push_back(MakeSphere(radius, {position, glm::dmat3(1.0)}));
  return scene;
}

TEST(RayQuery, StopsRaysBetweenNearAndFar) {
  Scene scene;
  scene.meshes.push_back(MakePlane({2.0, 2.0}, {{0.0, 0.0, 1.0}, glm::dmat3(1.0)}));
  const RayQuery rays(scene);
  const dvec3 up(0.0, 0.0, 1.0), below(0.3, 0.2, 0.0), above(0.3, 0.2, 2.0);
  EXPECT_TRUE(rays.Occluded(below, up, 0.0, 2.0));
  EXPECT_TRUE(rays.Occluded(above, -up, 0.0, 2.0));  // from either side
  EXPECT_FALSE(rays.Occluded(below, up, 0.0, 0.99));
  EXPECT_FALSE(rays.Occluded(below, up, 1.01, 5.0));
  EXPECT_FALSE(rays.Occluded({1.2, 0.0, 0.0}, up, 0.0, 2.0));
  EXPECT_FALSE(RayQuery(Scene()).Occluded(below, up, 0.0, 2.0));
}

TEST(RayQuery, ManyRaysAtOnceAreTheSame) {
  const Scene scene = WithSphere(0.5, {1.0, 0.0, 0.0});
  const RayQuery rays(scene);
  std::mt19937_64 engine(1);
  for (std::size_t count : {0, 1, 7, 8, 9, 333}) {
    std::vector<RayQuery::ShadowRay> many(count);
    std::vector<std::uint8_t> occluded(count, 2);
    for (auto& ray : many) ray = {glm::vec3(RandomDirection(engine)), count % 2 == 0 ? 0.9f : 3.0f};
    rays.Occluded({0.1, 0.0, 0.0}, many, occluded);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(occluded[i] == 1, rays.Occluded({0.1, 0.0, 0.0}, dvec3(many[i].direction), 0.0,
                                                static_cast<double>(many[i].far)));
      EXPECT_LE(occluded[i], 1);
    }
  }
}

// From inside a closed surface every ray is stopped: at edges too, aimed at on purpose. At corners, hit to the
// last bit, Embree's robust mode lets one in 300 through; no direction of an integral is so unlucky.
// The bake's even directions over hills, the first of which lies in a plane of the axes: Embree's streams and coherent packets lose
// hits there, of the whole group.
TEST(RayQuery, ManyRaysAlongAxisPlanesAreTheSame) {
  const Scene scene = LoadScene(AREALAB_SOURCE_DIR "/scenes/terrain.toml");
  const RayQuery rays(scene);
  const Mesh& hills = scene.meshes.at(0);
  constexpr std::size_t kCount = 512;
  std::vector<std::uint8_t> occluded(kCount);
  std::size_t hits = 0;
  for (std::size_t v = 0; v < hills.vertices.size(); v += 7) {
    const dvec3 normal(hills.vertices[v].normal), x = glm::normalize(glm::cross(dvec3(1.0, 0.0, 0.0), normal)), y = glm::cross(normal, x);
    const dvec3 origin = dvec3(hills.vertices[v].position) + 5.7e-6 * normal;
    std::vector<RayQuery::ShadowRay> many;
    for (std::size_t i = 0; i < kCount; ++i) {
      const double z = (static_cast<double>(i) + 0.5) / kCount, r = std::sqrt(1.0 - z * z), phi = 2.399963229728653 * static_cast<double>(i);
      many.push_back({glm::vec3(x * (r * std::cos(phi)) + y * (r * std::sin(phi)) + normal * z), std::numeric_limits<float>::infinity()});
    }
    rays.Occluded(origin, many, occluded);
    for (std::size_t i = 0; i < kCount; ++i) {
      ASSERT_EQ(occluded[i] != 0, rays.Occluded(origin, dvec3(many[i].direction), 0.0, std::numeric_limits<double>::infinity())) << v << " " << i;
      hits += occluded[i];
    }
  }
  EXPECT_GT(hits, 100000u);
}

TEST(RayQuery, IsWatertight) {
  const Scene scene = WithSphere(1.0, {0.0, 0.0, 0.0});
  const RayQuery rays(scene);
  const dvec3 inside(0.3, -0.2, 0.1);
  const auto stopped = [&](const dvec3& at) {
    return rays.Occluded(inside, glm::normalize(at - inside), 0.0, 3.0);
  };
  const Mesh& mesh = scene.meshes[0];
  std::size_t missed = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const dvec3 a(mesh.vertices[mesh.indices[i]].position), b(mesh.vertices[mesh.indices[i + 1]].position);
    missed += stopped(a) ? 0 : 1;
    ASSERT_TRUE(stopped(0.5 * (a + b)) && stopped(0.9 * a + 0.1 * b)) << i;
  }
  EXPECT_LT(missed, mesh.indices.size() / 3 / 100);
  std::mt19937_64 engine(2);
  for (int i = 0; i < 20000; ++i) ASSERT_TRUE(stopped(inside + RandomDirection(engine)));
}

// Points of a tessellated sphere lie up to 1.5e-4 radii deep; lifted, they lie on the sphere, and light just
// above their horizon reaches them, which the facets would keep from a third of them.
TEST(RayQuery, OriginsOfASphereSeeDownToTheirHorizon) {
  const double radius = 0.4;
  const dvec3 center(0.2, 0.3, 0.4);
  const Scene scene = WithSphere(radius, center);
  const RayQuery rays(scene);
  std::mt19937_64 engine(5);
  int blocked_unlifted = 0;
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount; ++i) {
    const Mesh& mesh = scene.meshes[0];
    const std::size_t t = 3 * (engine() % (mesh.indices.size() / 3));
    const dvec3 a(mesh.vertices[mesh.indices[t]].position), b(mesh.vertices[mesh.indices[t + 1]].position),
        c(mesh.vertices[mesh.indices[t + 2]].position);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    double u = unit(engine), v = unit(engine);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const dvec3 point(glm::vec3(a + u * (b - a) + v * (c - a)));
    const dvec3 normal = glm::normalize(point - center);
    const dvec3 origin = rays.Origin(point, point + normal + 0.5 * RandomDirection(engine));
    EXPECT_NEAR(glm::length(origin - center), radius, 4e-6);  // the offset against rounding included
    const dvec3 along = glm::normalize(glm::cross(normal, RandomDirection(engine)));
    const dvec3 grazing = glm::normalize(along + 1e-4 * normal);
    EXPECT_FALSE(rays.Occluded(origin, grazing, 0.0, 10.0)) << i;
    EXPECT_TRUE(rays.Occluded(origin, glm::normalize(along - 0.1 * normal), 0.0, 10.0)) << i;
    blocked_unlifted += rays.Occluded(point + 1e-6 * normal, grazing, 0.0, 10.0) ? 1 : 0;
  }
  EXPECT_GT(blocked_unlifted, kCount / 3);
}

// Far from the world's origin, where floats are coarse, a plane does not shade itself.
TEST(RayQuery, OriginsFarOutDoNotShadeThemselves) {
  for (double distance : {0.0, 10.0, 1e4, 1e6}) {
    const glm::dmat3 turned = RotationFromDegrees({31.0, -17.0, 5.0});
    const dvec3 at = distance * glm::normalize(dvec3(1.0, -2.0, 0.5));
    Scene scene;
    scene.meshes.push_back(MakePlane({8.0, 6.0}, {at, turned}));
    const RayQuery rays(scene);
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> side(-2.5, 2.5);
    for (int i = 0; i < 300; ++i) {
      const dvec3 point(glm::vec3(at + turned * dvec3(side(engine), side(engine), 0.0)));
      const dvec3 normal = turned * dvec3(0, 0, 1), origin = rays.Origin(point, point + 3.0 * normal);
      dvec3 direction = RandomDirection(engine);
      if (glm::dot(direction, normal) < 0.0) direction = -direction;
      EXPECT_FALSE(rays.Occluded(origin, glm::normalize(direction + 1e-3 * normal), 0.0, 100.0)) << distance;
    }
  }
}

// A square light of half width `half` at height 2 above the origin, floor z = 0.
Shaft UpTo(double half) {
  Shaft shaft;
  shaft.apex = dvec3(0.0);
  shaft.Add(glm::normalize(dvec3(-2.0, 0.0, half)), 0.0);
  shaft.Add(glm::normalize(dvec3(2.0, 0.0, half)), 0.0);
  shaft.Add(glm::normalize(dvec3(0.0, -2.0, half)), 0.0);
  shaft.Add(glm::normalize(dvec3(0.0, 2.0, half)), 0.0);
  shaft.Add({0.0, 0.0, -1.0}, -2.0);
  shaft.Add({0.0, 0.0, 1.0}, 0.0);
  return shaft;
}

TEST(RayQuery, ProvesThatNothingIsInTheWay) {
  Scene scene;
  scene.meshes.push_back(MakePlane({20.0, 20.0}, {}));                                // the floor itself
  scene.meshes.push_back(MakePlane({1.0, 1.0}, {{0.0, 0.0, 2.0}, glm::dmat3(1.0)}));  // touches the light
  scene.meshes.push_back(MakeBox({1.0, 1.0, 1.0}, {{0.0, 0.0, 4.0}, glm::dmat3(1.0)}));
  scene.meshes.push_back(MakeBox({0.5, 0.5, 0.5}, {{1.2, 0.0, 1.0}, glm::dmat3(1.0)}));
  EXPECT_FALSE(RayQuery(scene).MayBlock(UpTo(0.5)));
  scene.meshes.push_back(MakeSphere(0.1, {{0.3, 0.0, 1.0}, glm::dmat3(1.0)}));
  EXPECT_TRUE(RayQuery(scene).MayBlock(UpTo(0.5)));
  EXPECT_FALSE(RayQuery(Scene()).MayBlock(UpTo(0.5)));
}

// Where the proof holds no ray of the shaft may meet anything, however the scene lies.
TEST(RayQuery, TheProofAgreesWithRays) {
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  constexpr int kScenes = 1000;
  int proven = 0, blocked = 0;
  for (int i = 0; i < kScenes; ++i) {
    Scene scene;
    for (int k = 0; k < 3; ++k) {
      const dvec3 at{1.5 * unit(engine), 1.5 * unit(engine), 1.2 + unit(engine)};  // braces: drawn in this order by every compiler
      scene.meshes.push_back(MakeBox({0.5, 0.2, 0.9}, {at, RotationFromDegrees(180.0 * at)}));
    }
    const RayQuery rays(scene);
    const bool may_block = rays.MayBlock(UpTo(0.6));
    int hits = 0;
    for (int r = 0; r < 400; ++r) {
      const dvec3 target{0.6 * unit(engine), 0.6 * unit(engine), 2.0};
      const double far = glm::length(target);
      hits += rays.Occluded(dvec3(0.0), target / far, 0.0, far) ? 1 : 0;
    }
    if (!may_block) {
      EXPECT_EQ(hits, 0) << i;
    }
    proven += may_block ? 0 : 1;
    blocked += hits > 0 ? 1 : 0;
  }
  EXPECT_GT(proven, kScenes / 10);
  EXPECT_GT(blocked, kScenes / 10);
  EXPECT_GT(proven + blocked, kScenes * 87 / 100);  // the proof is seldom shy: 902 are decided, three deviations above
}

}  // namespace
}  // namespace arealab::ray_query_test
