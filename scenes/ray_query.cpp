#include "scenes/ray_query.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

namespace arealab {
namespace {

// Embree computes in float. The distance to a facet's plane, from coordinates of size c and corners at
// distance r, is off by a few 2⁻²⁴(c + r); sixteen of them are room enough.
constexpr double kRounding = 0x1p-20;

double MaxNorm(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}
double SumNorm(const glm::dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

using Corners = std::array<glm::vec3, 3>;

// A bounding volume of some triangles. Inner nodes: children at the next index and at `right`.
struct Node {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
  std::uint32_t first = 0, count = 0;  // of the triangles; count 0: an inner node
  std::uint32_t right = 0;
};

constexpr std::size_t kLeafSize = 4;

// Splits at the median along the longest axis: even on any input, 64 deep at most.
void Build(std::vector<Node>& nodes, std::span<Corners> triangles, std::uint32_t first) {
  const std::size_t index = nodes.size();
  nodes.emplace_back();
  Node node;
  for (const Corners& triangle : triangles) {
    for (const glm::vec3& corner : triangle) {
      node.low = glm::min(node.low, corner);
      node.high = glm::max(node.high, corner);
    }
  }
  if (triangles.size() <= kLeafSize) {
    node.first = first;
    node.count = static_cast<std::uint32_t>(triangles.size());
    nodes[index] = node;
    return;
  }
  const glm::vec3 size = node.high - node.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = triangles.size() / 2;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end(),
                   [axis](const Corners& a, const Corners& b) {
                     return a[0][axis] + a[1][axis] + a[2][axis] < b[0][axis] + b[1][axis] + b[2][axis];
                   });
  Build(nodes, triangles.first(half), first);
  node.right = static_cast<std::uint32_t>(nodes.size());
  Build(nodes, triangles.subspan(half), first + static_cast<std::uint32_t>(half));
  nodes[index] = node;
}

}  // namespace

struct RayQuery::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<const Mesh*> meshes;  // by Embree's geometry number
  std::vector<Corners> triangles;
  std::vector<Node> nodes;

  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayQuery::RayQuery(const Scene& scene) : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.device = rtcNewDevice(nullptr);
  if (state.device == nullptr) {
    throw std::runtime_error(
        fmt::format("Embree gives no device (error {}); expected libembree 3 on a processor with SSE2",
                    static_cast<int>(rtcGetDeviceError(nullptr))));
  }
  state.scene = rtcNewScene(state.device);
  rtcSetSceneFlags(state.scene, RTC_SCENE_FLAG_ROBUST);
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.indices.empty()) continue;
    RTCGeometry geometry = rtcNewGeometry(state.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.vertices.data(),
                               offsetof(Vertex, position), sizeof(Vertex), mesh.vertices.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                               3 * sizeof mesh.indices[0], mesh.indices.size() / 3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(state.scene, geometry, static_cast<unsigned>(state.meshes.size()));
    rtcReleaseGeometry(geometry);
    state.meshes.push_back(&mesh);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      state.triangles.push_back({mesh.vertices[mesh.indices[i]].position,
                                 mesh.vertices[mesh.indices[i + 1]].position,
                                 mesh.vertices[mesh.indices[i + 2]].position});
    }
  }
  rtcCommitScene(state.scene);
  if (const RTCError error = rtcGetDeviceError(state.device); error != RTC_ERROR_NONE) {
    throw std::runtime_error(
        fmt::format("Embree refuses the scene's triangles (error {}); expected room for {} of them",
                    static_cast<int>(error), state.triangles.size()));
  }
  if (!state.triangles.empty()) Build(state.nodes, state.triangles, 0);
}

RayQuery::~RayQuery() = default;

bool RayQuery::Occluded(const glm::dvec3& origin, const glm::dvec3& direction, double near,
                        double far) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x);
  ray.org_y = static_cast<float>(origin.y);
  ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tnear = static_cast<float>(near);
  ray.tfar = static_cast<float>(far);
  ray.mask = ~0u;
  rtcOccluded1(state_->scene, &context, &ray);
  return ray.tfar < 0.0f;  // Embree's mark of a hit: −infinity
}

void RayQuery::Occluded(const glm::dvec3& origin, std::span<const ShadowRay> rays,
                        std::span<std::uint8_t> occluded) const {
  // Not as coherent packets nor as a stream: both lose hits where a direction has a component that is 0 (Embree 3.13), and
  // the coherent ones take twice the time.
  constexpr std::size_t kLanes = 8;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  alignas(32) std::array<int, kLanes> valid;
  RTCRay8 packet{};
  for (std::size_t i = 0; i < kLanes; ++i) {
    packet.org_x[i] = static_cast<float>(origin.x);
    packet.org_y[i] = static_cast<float>(origin.y);
    packet.org_z[i] = static_cast<float>(origin.z);
    packet.mask[i] = ~0u;
  }
  for (std::size_t begin = 0; begin < rays.size(); begin += kLanes) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const bool real = begin + i < rays.size();
      const ShadowRay& ray = rays[real ? begin + i : begin];
      valid[i] = real ? -1 : 0;
      packet.dir_x[i] = ray.direction.x;
      packet.dir_y[i] = ray.direction.y;
      packet.dir_z[i] = ray.direction.z;
      packet.tfar[i] = ray.far;
    }
    rtcOccluded8(valid.data(), state_->scene, &context, &packet);
    for (std::size_t i = 0; i < kLanes && begin + i < rays.size(); ++i) {
      occluded[begin + i] = packet.tfar[i] < 0.0f ? 1 : 0;
    }
  }
}

glm::dvec3 RayQuery::Origin(const glm::dvec3& position, const glm::dvec3& viewer) const {
  // The facet: the nearest one on the viewer's ray, which begins shortly before the point and ends behind it.
  const glm::dvec3 to_viewer = viewer - position;
  const double distance = glm::length(to_viewer);
  const glm::dvec3 away = distance > 0.0 ? to_viewer / distance : glm::dvec3(0.0, 0.0, 1.0);
  const double before =
      std::min(distance, 1e-4 * distance + 4.0 * kRounding * (MaxNorm(position) + MaxNorm(viewer)));
  const glm::dvec3 from = position + before * away;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(from.x);
  query.ray.org_y = static_cast<float>(from.y);
  query.ray.org_z = static_cast<float>(from.z);
  query.ray.dir_x = static_cast<float>(-away.x);
  query.ray.dir_y = static_cast<float>(-away.y);
  query.ray.dir_z = static_cast<float>(-away.z);
  query.ray.tfar = static_cast<float>(2.0 * before);
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
    // The pixel's centre lies just beside the triangle that covers it: the viewer's side will do.
    return position + 4.0 * kRounding * (MaxNorm(position) + before) * away;
  }
  const Mesh& mesh = *state_->meshes[query.hit.geomID];
  std::array<const Vertex*, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) corner[k] = &mesh.vertices[mesh.indices[3 * query.hit.primID + k]];
  const auto u = static_cast<double>(query.hit.u), v = static_cast<double>(query.hit.v);
  const std::array<double, 3> weight = {1.0 - u - v, u, v};
  glm::dvec3 lifted = position;
  double extent = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 from_corner = position - glm::dvec3(corner[k]->position), normal(corner[k]->normal);
    lifted -= 0.5 * weight[k] * std::min(0.0, glm::dot(from_corner, normal)) * normal;
    extent = std::max(extent, glm::length(from_corner));
  }
  const glm::dvec3 edge_b(corner[1]->position - corner[0]->position),
      edge_c(corner[2]->position - corner[0]->position);
  glm::dvec3 normal = glm::cross(edge_b, edge_c);
  const double length = glm::length(normal);
  normal = length > 0.0 ? normal / length : away;
  if (glm::dot(normal, away) < 0.0) normal = -normal;
  return lifted + kRounding * (MaxNorm(position) + extent) * normal;
}

bool RayQuery::MayBlock(const Shaft& shaft) const {
  const State& state = *state_;
  if (state.nodes.empty()) return false;
  const std::span planes(shaft.planes.data(), static_cast<std::size_t>(shaft.plane_count));
  const double slack = kRounding * SumNorm(shaft.apex);
  const auto box_outside = [&](const Node& node) {
    const glm::dvec3 center = 0.5 * (glm::dvec3(node.low) + glm::dvec3(node.high)) - shaft.apex,
                     half = 0.5 * (glm::dvec3(node.high) - glm::dvec3(node.low));
    const double room =
        slack + kRounding * (SumNorm(center) - SumNorm(half));  // of its nearest corner, at least
    return std::any_of(planes.begin(), planes.end(), [&](const Shaft::Plane& plane) {
      return glm::dot(center, plane.normal) + glm::dot(half, glm::abs(plane.normal)) <=
             plane.offset + std::max(room, 0.0);
    });
  };
  const auto triangle_outside = [&](const Corners& triangle) {
    std::array<glm::dvec3, 3> p;
    std::array<double, 3> room;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = glm::dvec3(triangle[k]) - shaft.apex;
      room[k] = slack + kRounding * SumNorm(p[k]);
    }
    return std::any_of(planes.begin(), planes.end(), [&](const Shaft::Plane& plane) {
      return glm::dot(p[0], plane.normal) <= plane.offset + room[0] &&
             glm::dot(p[1], plane.normal) <= plane.offset + room[1] &&
             glm::dot(p[2], plane.normal) <= plane.offset + room[2];
    });
  };
  std::array<std::uint32_t, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Node& node = state.nodes[index];
    if (box_outside(node)) continue;
    if (node.count == 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (std::uint32_t i = 0; i < node.count; ++i) {
      if (!triangle_outside(state.triangles[node.first + i])) return true;
    }
  }
  return false;
}

}  // namespace arealab
