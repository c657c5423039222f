#include "scenes/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace arealab {
namespace {

// Rings of latitude. Cells are about π/128 both ways, so that the middle of a cell is half a diagonal, 0.0174
// rad, from its corners and lies 1 − cos 0.0174 = 1.5e-4 radii deep.
constexpr int kSphereRings = 128;

constexpr double kMostCells = 2048.0;  // along a side of a rectangle

// Cells around a ring: as wide as they are high, hence fewer towards the poles. The poles themselves repeat
// their neighbour's, so that each cell there has a longitude.
int SphereSegments(int ring) {
  const int near = std::clamp(ring, 1, kSphereRings - 1);
  return static_cast<int>(std::ceil(2.0 * kSphereRings * std::sin(glm::pi<double>() * near / kSphereRings)));
}

void AddVertex(Mesh& mesh, const Placement& placement, const glm::dvec3& position, const glm::dvec3& normal,
               const glm::dvec3& tangent, const glm::dvec2& uv) {
  mesh.vertices.push_back({glm::vec3(placement.position + placement.rotation * position),
                           glm::vec3(placement.rotation * normal),
                           glm::vec4(glm::vec3(placement.rotation * tangent), 1.0f), glm::vec2(uv)});
}

// A rectangle about `center` that spans 2a × 2b and faces a × b, in cells of at most `cell` on a side.
void AddRectangle(Mesh& mesh, const Placement& placement, const glm::dvec3& center, const glm::dvec3& a,
                  const glm::dvec3& b, double cell) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const glm::dvec3 tangent = glm::normalize(a);
  const glm::dvec3 normal = glm::normalize(glm::cross(a, b));
  const auto cells = [&](const glm::dvec3& half) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(2.0 * glm::length(half) / cell), 1.0, kMostCells));
  };
  const std::uint32_t columns = cells(a), rows = cells(b);
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double x = static_cast<double>(i) / columns, y = static_cast<double>(j) / rows;
      AddVertex(mesh, placement, center + (2.0 * x - 1.0) * a + (2.0 * y - 1.0) * b, normal, tangent, {x, 1.0 - y});
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t near = first + j * (columns + 1) + i, far = near + columns + 1;
      mesh.indices.insert(mesh.indices.end(), {near, near + 1, far + 1, near, far + 1, far});
    }
  }
}

}  // namespace

glm::dmat3 RotationFromDegrees(const glm::dvec3& degrees) {
  const glm::dvec3 angle = glm::radians(degrees);
  const glm::dvec3 c = glm::cos(angle);
  const glm::dvec3 s = glm::sin(angle);
  // GLM's matrices are filled column by column.
  const glm::dmat3 about_x(1.0, 0.0, 0.0, 0.0, c.x, s.x, 0.0, -s.x, c.x);
  const glm::dmat3 about_y(c.y, 0.0, -s.y, 0.0, 1.0, 0.0, s.y, 0.0, c.y);
  const glm::dmat3 about_z(c.z, s.z, 0.0, -s.z, c.z, 0.0, 0.0, 0.0, 1.0);
  return about_z * about_y * about_x;
}

Mesh MakePlane(const glm::dvec2& size, const Placement& placement, double cell) {
  Mesh mesh;
  AddRectangle(mesh, placement, glm::dvec3(0.0), {0.5 * size.x, 0.0, 0.0}, {0.0, 0.5 * size.y, 0.0}, cell);
  return mesh;
}

Mesh MakeBox(const glm::dvec3& size, const Placement& placement, double cell) {
  Mesh mesh;
  const glm::dvec3 x(0.5 * size.x, 0.0, 0.0);
  const glm::dvec3 y(0.0, 0.5 * size.y, 0.0);
  const glm::dvec3 z(0.0, 0.0, 0.5 * size.z);
  AddRectangle(mesh, placement, x, y, z, cell);
  AddRectangle(mesh, placement, -x, -y, z, cell);
  AddRectangle(mesh, placement, y, -x, z, cell);
  AddRectangle(mesh, placement, -y, x, z, cell);
  AddRectangle(mesh, placement, z, x, y, cell);
  AddRectangle(mesh, placement, -z, x, -y, cell);
  return mesh;
}

Mesh MakeSphere(double radius, const Placement& placement) {
  Mesh mesh;
  std::uint32_t above = 0;  // first vertex of the ring before
  for (int ring = 0; ring <= kSphereRings; ++ring) {
    const double v = static_cast<double>(ring) / kSphereRings;
    const double theta = v * glm::pi<double>();
    const int segments = SphereSegments(ring);
    const auto here = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int segment = 0; segment <= segments; ++segment) {
      const double u = static_cast<double>(segment) / segments;
      const double phi = u * glm::two_pi<double>();
      const glm::dvec3 normal(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                              std::cos(theta));
      AddVertex(mesh, placement, radius * normal, normal, {-std::sin(phi), std::cos(phi), 0.0}, {u, v});
    }
    if (ring > 0) {
      // Walks both rings eastward, always on the one that lags behind.
      const int segments_above = SphereSegments(ring - 1);
      int a = 0, b = 0;
      while (a < segments_above || b < segments) {
        const std::uint32_t upper = above + static_cast<std::uint32_t>(a);
        const std::uint32_t lower = here + static_cast<std::uint32_t>(b);
        const bool lower_lags = (2 * b + 1) * segments_above <= (2 * a + 1) * segments;
        if (a == segments_above || (b < segments && lower_lags)) {
          if (ring < kSphereRings) mesh.indices.insert(mesh.indices.end(), {upper, lower, lower + 1});
          ++b;
        } else {
          if (ring > 1) mesh.indices.insert(mesh.indices.end(), {upper, lower, upper + 1});
          ++a;
        }
      }
    }
    above = here;
  }
  return mesh;
}

Mesh MakeHeightField(const glm::dvec2& size, const glm::ivec2& cells, const HeightFunction& height,
                     const Placement& placement) {
  Mesh mesh;
  for (int j = 0; j <= cells.y; ++j) {
    for (int i = 0; i <= cells.x; ++i) {
      const glm::dvec2 uv(static_cast<double>(i) / cells.x, static_cast<double>(j) / cells.y);
      const double x = (uv.x - 0.5) * size.x;
      const double y = (0.5 - uv.y) * size.y;
      const glm::dvec3 h = height(x, y);
      AddVertex(mesh, placement, {x, y, h.x}, glm::normalize(glm::dvec3(-h.y, -h.z, 1.0)),
                glm::normalize(glm::dvec3(1.0, 0.0, h.y)), uv);
    }
  }
  const auto row = static_cast<std::uint32_t>(cells.x + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(cells.y); ++j) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(cells.x); ++i) {
      const std::uint32_t far = j * row + i;
      const std::uint32_t near = far + row;
      mesh.indices.insert(mesh.indices.end(), {near, near + 1, far + 1, near, far + 1, far});
    }
  }
  return mesh;
}

}  // namespace arealab
