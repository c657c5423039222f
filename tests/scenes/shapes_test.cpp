#include "scenes/shapes.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "tests/scenes/mesh_checks.h"

namespace arealab::shapes_test {
namespace {

const Placement kTurned{{1.0, -2.0, 3.0}, RotationFromDegrees({20.0, -50.0, 110.0})};

// The vertex's place before `placement`.
glm::dvec3 Local(const Vertex& vertex, const Placement& placement) {
  return glm::transpose(placement.rotation) * (glm::dvec3(vertex.position) - placement.position);
}

double SurfaceArea(const Mesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < TriangleCount(mesh); ++i) area += 0.5 * glm::length(Triangle(mesh, i).Facing());
  return area;
}

TEST(Shapes, RotationTurnsAboutXThenYThenZ) {
  const auto near = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-15; };
  EXPECT_TRUE(near(RotationFromDegrees({90.0, 0.0, 0.0}) * glm::dvec3(0, 1, 0), {0, 0, 1}));
  EXPECT_TRUE(near(RotationFromDegrees({0.0, 90.0, 0.0}) * glm::dvec3(0, 0, 1), {1, 0, 0}));
  EXPECT_TRUE(near(RotationFromDegrees({0.0, 0.0, 90.0}) * glm::dvec3(1, 0, 0), {0, 1, 0}));
  // x first: y goes to z; then about z, which leaves it there.
  EXPECT_TRUE(near(RotationFromDegrees({90.0, 0.0, 90.0}) * glm::dvec3(0, 1, 0), {0, 0, 1}));
}

TEST(Shapes, PlaneLiesWhereItShouldAndFacesUp) {
  const Mesh mesh = MakePlane({4.0, 2.0}, {});
  ExpectSound(mesh);
  ExpectTangentsFollowTexture(mesh);
  EXPECT_DOUBLE_EQ(SurfaceArea(mesh), 8.0);
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(vertex.position, glm::vec3(4.0f * (vertex.uv.x - 0.5f), 2.0f * (0.5f - vertex.uv.y), 0.0f));
  }
}

TEST(Shapes, BoxIsClosedAndFacesOutward) {
  const glm::dvec3 size(1.0, 2.0, 3.0);
  const Mesh mesh = MakeBox(size, kTurned);
  ExpectSound(mesh);
  ExpectTangentsFollowTexture(mesh);
  EXPECT_EQ(TriangleCount(mesh), 12u);
  EXPECT_NEAR(SurfaceArea(mesh), 22.0, 1e-5);
  double volume = 0.0;  // by the divergence theorem: wrong where a face is missing or turned
  for (std::size_t i = 0; i < TriangleCount(mesh); ++i) {
    const Corners corner = Triangle(mesh, i);
    volume += glm::dot(glm::dvec3(corner.a.position) - kTurned.position, corner.Facing()) / 6.0;
  }
  EXPECT_NEAR(volume, 6.0, 1e-5);
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_LT(glm::length(glm::abs(Local(vertex, kTurned)) - 0.5 * size), 1e-6);
  }
}

TEST(Shapes, SphereIsRoundAndItsNormalsAreExact) {
  constexpr double kRadius = 0.7;
  const Mesh mesh = MakeSphere(kRadius, kTurned);
  ExpectSound(mesh);
  ExpectTangentsFollowTexture(mesh);
  double farthest = 0.0, deepest = 0.0, worst_normal = 0.0;
  for (const Vertex& vertex : mesh.vertices) {
    const glm::dvec3 p = glm::dvec3(vertex.position) - kTurned.position;
    farthest = std::max(farthest, std::abs(glm::length(p) / kRadius - 1.0));
  }
  for (std::size_t i = 0; i < TriangleCount(mesh); ++i) {
    const Corners corner = Triangle(mesh, i);
    // The middle of the longest side is the deepest point of these nearly right-angled triangles.
    for (const auto& [a, b] :
         {std::pair(&corner.a, &corner.b), {&corner.b, &corner.c}, {&corner.c, &corner.a}}) {
      const glm::dvec3 p = 0.5 * (glm::dvec3(a->position) + glm::dvec3(b->position)) - kTurned.position;
      const glm::dvec3 n = glm::normalize(0.5 * (glm::dvec3(a->normal) + glm::dvec3(b->normal)));
      deepest = std::max(deepest, 1.0 - glm::length(p) / kRadius);
      worst_normal = std::max(worst_normal, glm::length(n - glm::normalize(p)));
    }
  }
  EXPECT_LT(farthest, 1e-6);               // single precision
  EXPECT_LT(deepest, 1.6e-4);              // as scenes/shapes.h promises
  EXPECT_GT(deepest, 1e-4);                // and no finer than it must be: measured 1.51e-4
  EXPECT_LT(worst_normal, 1e-6);           // single precision
  EXPECT_LT(TriangleCount(mesh), 45000u);  // ten spheres in a picture must stay cheap to draw
  // A hole or an overlap of one triangle would be 2.4e-5 of the area; what the sphere loses by its flat faces
  // is 1.48e-4.
  EXPECT_NEAR(SurfaceArea(mesh) / (4.0 * glm::pi<double>() * kRadius * kRadius), 1.0 - 1.48e-4, 1e-5);
}

TEST(Shapes, HeightFieldFollowsItsFunction) {
  const HeightFunction function = [](double x, double y) {
    return glm::dvec3(0.3 * std::sin(x) + 0.1 * x * y, 0.3 * std::cos(x) + 0.1 * y, 0.1 * x);
  };
  const Mesh mesh = MakeHeightField({3.0, 5.0}, {30, 50}, function, kTurned);
  ExpectSound(mesh);
  ExpectTangentsFollowTexture(mesh);
  EXPECT_EQ(TriangleCount(mesh), 3000u);
  for (const Vertex& vertex : mesh.vertices) {
    const glm::dvec3 p = Local(vertex, kTurned);
    const glm::dvec3 h = function(p.x, p.y);
    EXPECT_NEAR(p.z, h.x, 1e-5);
    const glm::dvec3 normal = glm::transpose(kTurned.rotation) * glm::dvec3(vertex.normal);
    EXPECT_LT(glm::length(normal - glm::normalize(glm::dvec3(-h.y, -h.z, 1.0))), 1e-5);
    EXPECT_NEAR(p.x, 3.0 * (static_cast<double>(vertex.uv.x) - 0.5), 1e-5);
    EXPECT_NEAR(p.y, 5.0 * (0.5 - static_cast<double>(vertex.uv.y)), 1e-5);
  }
}

}  // namespace
}  // namespace arealab::shapes_test
