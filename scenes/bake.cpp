#include "scenes/bake.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <mutex>
#include <span>
#include <utility>

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

// Of the root of a direction's share of the hemisphere, within which two directions are neighbours: the spiral's nearest ones are 0.9
// to 1.5 of it apart.
constexpr double kNeighbour = 1.7;

using Neighbours = std::vector<std::vector<std::uint32_t>>;

Neighbours NeighboursOf(const std::vector<glm::dvec3>& directions) {
  const double reach = kNeighbour * std::sqrt(glm::two_pi<double>() / static_cast<double>(directions.size()));
  Neighbours neighbours(directions.size());
  // The spiral climbs: what is near in direction is near in height.
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (std::size_t j = i + 1; j < directions.size() && directions[j].z - directions[i].z < reach; ++j) {
      if (glm::distance(directions[i], directions[j]) > reach) continue;
      neighbours[i].push_back(static_cast<std::uint32_t>(j));
      neighbours[j].push_back(static_cast<std::uint32_t>(i));
    }
  }
  return neighbours;
}

// Some of the directions.
struct DirectionSet {
  std::size_t count = 0;
  glm::dvec3 sum{0.0};

  void Add(const glm::dvec3& direction) {
    ++count;
    sum += direction;
  }
  // As a cap. The mean of all of them is the normal, which the spiral meets to a few digits only; what has no mean direction gets the
  // normal too.
  glm::vec4 Cap(const glm::dmat3& frame, std::size_t of) const {
    const bool no_mean = count == of || count == 0 || glm::length(sum) == 0.0;
    const glm::dvec3 axis = no_mean ? frame[2] : frame * glm::normalize(sum);
    return glm::vec4(glm::vec3(axis), static_cast<float>(count) / static_cast<float>(of));
  }
};

// The two largest contiguous sets of the directions that are not occluded; smaller ones join the nearer of them.
std::array<DirectionSet, 2> Regions(const std::vector<glm::dvec3>& directions, const Neighbours& neighbours,
                                    std::span<const std::uint8_t> occluded) {
  std::vector<DirectionSet> sets;
  std::vector<std::uint8_t> seen(occluded.begin(), occluded.end());
  std::vector<std::uint32_t> open;
  for (std::size_t start = 0; start < directions.size(); ++start) {
    if (seen[start] != 0) continue;
    DirectionSet& set = sets.emplace_back();
    seen[start] = 1;
    open.assign(1, static_cast<std::uint32_t>(start));
    while (!open.empty()) {
      const std::uint32_t i = open.back();
      open.pop_back();
      set.Add(directions[i]);
      for (const std::uint32_t j : neighbours[i]) {
        if (seen[j] != 0) continue;
        seen[j] = 1;
        open.push_back(j);
      }
    }
  }
  std::stable_sort(sets.begin(), sets.end(), [](const DirectionSet& a, const DirectionSet& b) { return a.count > b.count; });
  std::array<DirectionSet, 2> largest;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (i < 2) {
      largest[i] = sets[i];
      continue;
    }
    const auto nearness = [&](const DirectionSet& to) { return glm::dot(sets[i].sum, glm::normalize(to.sum)); };
    DirectionSet& nearer = nearness(sets[1]) > nearness(sets[0]) ? largest[1] : largest[0];
    nearer.count += sets[i].count;
    nearer.sum += sets[i].sum;
  }
  return largest;
}

double Likeness(const glm::vec4& a, const glm::vec4& b) {
  return static_cast<double>(std::min(a.w, b.w)) * glm::dot(glm::dvec3(a), glm::dvec3(b));
}

// Puts each vertex's two regions in the order of its neighbours', from one vertex on over the mesh's edges, so that what a triangle
// interpolates belongs together.
void OrderRegions(Mesh& mesh) {
  std::vector<std::vector<std::uint32_t>> edges(mesh.vertices.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) edges[mesh.indices[i + k]].push_back(mesh.indices[i + (k + 1) % 3]);
    for (std::size_t k = 0; k < 3; ++k) edges[mesh.indices[i + (k + 1) % 3]].push_back(mesh.indices[i + k]);
  }
  std::vector<bool> ordered(mesh.vertices.size(), false);
  std::deque<std::uint32_t> front;
  for (std::size_t start = 0; start < mesh.vertices.size(); ++start) {
    // One with two regions decides for those around it.
    if (ordered[start] || mesh.apertures[start].region[1].w == 0.0f) continue;
    ordered[start] = true;
    front.push_back(static_cast<std::uint32_t>(start));
    while (!front.empty()) {
      const std::uint32_t from = front.front();
      front.pop_front();
      const auto& a = mesh.apertures[from].region;
      for (const std::uint32_t to : edges[from]) {
        if (ordered[to]) continue;
        ordered[to] = true;
        front.push_back(to);
        auto& b = mesh.apertures[to].region;
        if (Likeness(a[0], b[1]) + Likeness(a[1], b[0]) > Likeness(a[0], b[0]) + Likeness(a[1], b[1])) std::swap(b[0], b[1]);
      }
    }
  }
}

}  // namespace

void BakeApertures(Scene& scene, const std::function<void(double)>& progress) {
  const RayQuery query(scene);
  const std::vector<glm::dvec3> directions = EvenDirections(scene.aperture.value_or(ApertureSettings()).rays);
  const Neighbours neighbours = NeighboursOf(directions);
  std::size_t total = 0, done = 0;
  for (const Mesh& mesh : scene.meshes) total += mesh.vertices.size();
  std::mutex mutex;
  for (Mesh& mesh : scene.meshes) {
    const double lift = kLift * MeanEdge(mesh);
    std::vector<Aperture> apertures(mesh.vertices.size());
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
        DirectionSet open, blocked;
        for (std::size_t i = 0; i < rays.size(); ++i) (occluded[i] != 0 ? blocked : open).Add(directions[i]);
        Aperture& aperture = apertures[v];
        aperture.open = open.Cap(frame, rays.size());
        aperture.blocked = blocked.Cap(frame, rays.size());
        aperture.region = {aperture.open, glm::vec4(glm::vec3(aperture.open), 0.0f)};
        if (blocked.count == 0 || open.count == 0) continue;
        const std::array<DirectionSet, 2> regions = Regions(directions, neighbours, occluded);
        aperture.region[0] = regions[0].Cap(frame, rays.size());
        if (regions[1].count > 0) aperture.region[1] = regions[1].Cap(frame, rays.size());
      }
      const std::lock_guard lock(mutex);
      done += range.size();
      if (progress) progress(static_cast<double>(done) / static_cast<double>(total));
    });
    mesh.apertures = std::move(apertures);
    OrderRegions(mesh);
  }
}

bool HasApertures(const Scene& scene) {
  return std::all_of(scene.meshes.begin(), scene.meshes.end(),
                     [](const Mesh& mesh) { return mesh.apertures.size() == mesh.vertices.size(); });
}

}  // namespace arealab
