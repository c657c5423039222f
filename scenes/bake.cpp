#include "scenes/bake.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <mutex>

#include "scenes/ray_query.h"

namespace arealab {
namespace {

// Even over the hemisphere about +z: a Fibonacci spiral, even in height and in turn. The same for all vertices, so that
// neighbours differ by what they see and not by noise.
std::vector<glm::dvec3> EvenDirections(int count) {
  const double golden_turn = glm::two_pi<double>() * (2.0 - glm::golden_ratio<double>());
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = (i + 0.5) / count, r = std::sqrt(1.0 - z * z), phi = golden_turn * i;
    directions.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
  }
  return directions;
}

// Columns: two perpendiculars and the normal.
glm::dmat3 FrameAbout(const glm::dvec3& normal) {
  const glm::dvec3 other = std::abs(normal.z) < 0.7 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, normal));
  return {x, glm::cross(normal, x), normal};
}

double MeanEdge(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum += static_cast<double>(glm::distance(mesh.vertices[mesh.indices[i + k]].position,
                                               mesh.vertices[mesh.indices[i + (k + 1) % 3]].position));
    }
  }
  return mesh.indices.empty() ? 0.0 : sum / static_cast<double>(mesh.indices.size());
}

// Of the mesh's mean edge: how far above a vertex its rays begin, clear of the facets that meet there.
constexpr double kLift = 1e-3;

}  // namespace

void BakeApertures(Scene& scene, const std::function<void(double)>& progress) {
  const RayQuery query(scene);
  const std::vector<glm::dvec3> directions = EvenDirections(scene.aperture.value_or(ApertureSettings()).rays);
  std::size_t total = 0, done = 0;
  for (const Mesh& mesh : scene.meshes) total += mesh.vertices.size();
  std::mutex mutex;
  for (Mesh& mesh : scene.meshes) {
    const double lift = kLift * MeanEdge(mesh);
    std::vector<glm::vec4> apertures(mesh.vertices.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, apertures.size(), 64),
                      [&](const tbb::blocked_range<std::size_t>& range) {
      std::vector<RayQuery::ShadowRay> rays(directions.size());
      std::vector<std::uint8_t> occluded(directions.size());
      for (std::size_t v = range.begin(); v < range.end(); ++v) {
        const glm::dvec3 normal(mesh.vertices[v].normal);
        const glm::dmat3 frame = FrameAbout(normal);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          rays[i] = {glm::vec3(frame * directions[i]), std::numeric_limits<float>::infinity()};
        }
        query.Occluded(glm::dvec3(mesh.vertices[v].position) + lift * normal, rays, occluded);
        glm::dvec3 sum(0.0);
        std::size_t open = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (occluded[i] != 0) continue;
          ++open;
          sum += directions[i];
        }
        // With all of it open the mean is the normal, which the spiral meets to a few digits only.
        const bool whole = open == rays.size() || open == 0 || glm::length(sum) == 0.0;
        const glm::dvec3 axis = whole ? normal : frame * glm::normalize(sum);
        apertures[v] = glm::vec4(glm::vec3(axis), static_cast<float>(open) / static_cast<float>(rays.size()));
      }
      const std::lock_guard lock(mutex);
      done += range.size();
      if (progress) progress(static_cast<double>(done) / static_cast<double>(total));
    });
    mesh.apertures = std::move(apertures);
  }
}

bool HasApertures(const Scene& scene) {
  return std::all_of(scene.meshes.begin(), scene.meshes.end(),
                     [](const Mesh& mesh) { return mesh.apertures.size() == mesh.vertices.size(); });
}

}  // namespace arealab
