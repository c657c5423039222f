// What must hold of every mesh that a scene brings.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace arealab {

struct Corners {
  const Vertex& a;
  const Vertex& b;
  const Vertex& c;
  glm::dvec3 Facing() const {  // twice the area, m²
    return glm::cross(glm::dvec3(b.position) - glm::dvec3(a.position),
                      glm::dvec3(c.position) - glm::dvec3(a.position));
  }
};

inline Corners Triangle(const Mesh& mesh, std::size_t i) {
  return {mesh.vertices[mesh.indices[3 * i]], mesh.vertices[mesh.indices[3 * i + 1]],
          mesh.vertices[mesh.indices[3 * i + 2]]};
}

inline std::size_t TriangleCount(const Mesh& mesh) {
  return mesh.indices.size() / 3;
}

// Finite, unit and orthogonal frames within single precision; triangles with an area, wound to face along
// their normals.
inline void ExpectSound(const Mesh& mesh) {
  constexpr double kRounding = 1e-5;  // a few steps of single precision at 1
  ASSERT_FALSE(mesh.vertices.empty());
  ASSERT_EQ(mesh.indices.size() % 3, 0u);
  std::size_t bad_frames = 0;
  for (const Vertex& vertex : mesh.vertices) {
    const glm::dvec3 normal(vertex.normal);
    const glm::dvec3 tangent(vertex.tangent);
    const bool good = std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z) &&
                      std::isfinite(vertex.uv.x + vertex.uv.y) &&
                      std::abs(glm::length(normal) - 1.0) < kRounding &&
                      std::abs(glm::length(tangent) - 1.0) < kRounding &&
                      std::abs(glm::dot(normal, tangent)) < kRounding && std::abs(vertex.tangent.w) == 1.0f;
    bad_frames += good ? 0 : 1;
  }
  EXPECT_EQ(bad_frames, 0u);
  std::size_t bad_triangles = 0;
  for (std::size_t i = 0; i < TriangleCount(mesh); ++i) {
    ASSERT_LT(*std::max_element(&mesh.indices[3 * i], &mesh.indices[3 * i] + 3), mesh.vertices.size());
    const Corners corner = Triangle(mesh, i);
    const glm::dvec3 normals(corner.a.normal + corner.b.normal + corner.c.normal);
    bad_triangles += glm::dot(corner.Facing(), normals) > 0.0 ? 0 : 1;
  }
  EXPECT_EQ(bad_triangles, 0u) << "of " << TriangleCount(mesh);
}

// Along the tangent u grows, along the bitangent v falls (glTF: images hang from their top).
inline void ExpectTangentsFollowTexture(const Mesh& mesh) {
  std::size_t bad = 0;
  for (std::size_t i = 0; i < TriangleCount(mesh); ++i) {
    const Corners corner = Triangle(mesh, i);
    const glm::dvec3 ab = corner.b.position - corner.a.position;
    const glm::dvec3 ac = corner.c.position - corner.a.position;
    const glm::dmat2 uv(glm::dvec2(corner.b.uv - corner.a.uv), glm::dvec2(corner.c.uv - corner.a.uv));
    if (std::abs(glm::determinant(uv)) < 1e-12) continue;  // no direction of growth
    const glm::dmat2 inverse = glm::inverse(uv);
    const glm::dvec3 along_u = ab * inverse[0][0] + ac * inverse[0][1];
    const glm::dvec3 along_v = ab * inverse[1][0] + ac * inverse[1][1];
    const glm::dvec3 tangent(corner.a.tangent);
    const glm::dvec3 bitangent =
        glm::cross(glm::dvec3(corner.a.normal), tangent) * static_cast<double>(corner.a.tangent.w);
    if (!(glm::dot(along_u, tangent) > 0.0) || !(glm::dot(along_v, bitangent) < 0.0)) ++bad;
  }
  EXPECT_EQ(bad, 0u) << "of " << TriangleCount(mesh);
}

}  // namespace arealab
