// Which rays meet a scene's surfaces: shadow rays, and a proof without rays where nothing can be in the way.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "scenes/scene.h"

namespace arealab {

// A cut-off pyramid: the places x with dot(normal, x − apex) > offset for each of its planes.
struct Shaft {
  struct Plane {
    glm::dvec3 normal;  // unit, pointing inwards
    double offset;      // m
  };
  glm::dvec3 apex{0.0};  // m, world
  std::array<Plane, 6> planes;
  int plane_count = 0;

  void Add(const glm::dvec3& normal, double offset) {
    planes[static_cast<std::size_t>(plane_count++)] = {normal, offset};
  }
};

// Surfaces stop rays from either side, lights never do: a light is where light comes from, not a thing that
// stands in the way, as in every technique and in the unshadowed truth. Queries may run on any number of
// threads and give the same answers on all.
class RayQuery {
 public:
  // Keeps the scene's vertices by reference: it must outlive this, unchanged. Throws std::runtime_error where
  // Embree refuses.
  explicit RayQuery(const Scene& scene);
  ~RayQuery();
  RayQuery(const RayQuery&) = delete;
  RayQuery& operator=(const RayQuery&) = delete;

  // True where a surface lies between origin + near·direction and origin + far·direction; direction is unit,
  // near and far in metres. No ray slips through an edge that two triangles share.
  bool Occluded(const glm::dvec3& origin, const glm::dvec3& direction, double near, double far) const;

  struct ShadowRay {
    glm::vec3 direction;  // unit
    float far;            // m
  };
  // The same for many rays from one origin, near = 0: occluded[i] becomes 1 or 0.
  void Occluded(const glm::dvec3& origin, std::span<const ShadowRay> rays,
                std::span<std::uint8_t> occluded) const;

  // Where rays that leave a shaded point begin: `position` (of a triangle, seen from `viewer`) lifted to the
  // smooth surface that the vertex normals describe, half of the way to the corners' tangent planes [Hanika
  // 2021, Hacking the shadow terminator, who goes all of it]: on a tessellated sphere that is the sphere to
  // second order. Else a facet would hide light that the shading normal's horizon lets in. Then off the facet by what float rounding may amount to: 2⁻²⁰ of the coordinates and of
  // the facet's extent.
  glm::dvec3 Origin(const glm::dvec3& position, const glm::dvec3& viewer) const;

  // False proves that no surface reaches into the shaft: each triangle lies outside one of its planes. Places
  // seen from the apex within 2⁻²⁰ radians of a plane (2⁻²⁰ of the apex's coordinates) count as outside, so
  // that a surface in the horizon plane or a wall behind a light that touches it is no obstacle.
  bool MayBlock(const Shaft& shaft) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arealab
