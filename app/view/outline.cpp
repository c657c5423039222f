#include "app/view/outline.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace arealab {
namespace {

constexpr int kRingPoints = 128;

struct Placed {
  glm::dvec2 at;
  glm::dvec3 point;
};

// Andrew's monotone chain [1979], counter-clockwise.
std::vector<glm::dvec3> Hull(std::vector<Placed> points) {
  std::ranges::sort(points, [](const Placed& a, const Placed& b) { return a.at.x < b.at.x || (a.at.x == b.at.x && a.at.y < b.at.y); });
  std::vector<Placed> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Placed& point : points) {
      const auto turns_right = [&](const Placed& a, const Placed& b) {
        const glm::dvec2 u = b.at - a.at, v = point.at - b.at;
        return u.x * v.y - u.y * v.x <= 0.0;
      };
      while (hull.size() >= first + 2 && turns_right(hull[hull.size() - 2], hull.back())) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  std::vector<glm::dvec3> edge;
  for (const Placed& point : hull) edge.push_back(point.point);
  return edge;
}

}  // namespace

std::vector<glm::dvec3> Circle(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) {
  std::vector<glm::dvec3> points;
  for (int i = 0; i <= kRingPoints; ++i) {
    const double angle = 2.0 * glm::pi<double>() * i / kRingPoints;
    points.push_back(center + std::cos(angle) * u + std::sin(angle) * v);
  }
  return points;
}

std::vector<glm::dvec3> Outline(const Light& light, const glm::dvec3& eye) {
  const glm::dvec3 x = light.half_size.x * light.axis_x, y = light.half_size.y * light.axis_y;
  switch (light.shape) {
    case LightShape::kRectangle: {
      const glm::dvec3 c = light.center;
      return {c - x - y, c + x - y, c + x + y, c - x + y, c - x - y};
    }
    case LightShape::kTube: {
      std::vector<glm::dvec3> points = Circle(light.center - x, y, light.half_size.y * light.normal);
      const std::vector<glm::dvec3> other = Circle(light.center + x, y, light.half_size.y * light.normal);
      points.insert(points.end(), other.begin(), other.end());
      return points;
    }
    case LightShape::kPolygon: {
      std::vector<glm::dvec3> points;
      for (const glm::dvec2& corner : light.corners) points.push_back(light.center + corner.x * light.axis_x + corner.y * light.axis_y);
      points.push_back(points.front());
      return points;
    }
    case LightShape::kDisk:
    case LightShape::kEllipse:
      return Circle(light.center, x, y);
    case LightShape::kSphere: {  // where lines of sight touch it
      const glm::dvec3 to = light.center - eye;
      const double ratio = light.half_size.x / glm::length(to);
      if (!(ratio < 1.0)) return {};
      const glm::dvec3 u = glm::normalize(glm::cross(to, std::abs(to.z) < 0.9 * glm::length(to) ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
      const glm::dvec3 v = glm::normalize(glm::cross(to, u));
      const double radius = light.half_size.x * std::sqrt(1.0 - ratio * ratio);
      return Circle(light.center - ratio * ratio * to, radius * u, radius * v);
    }
  }
  return {};
}

std::vector<glm::dvec3> Silhouette(const Light& light, const glm::dvec3& eye) {
  std::vector<glm::dvec3> rims = Outline(light, eye);
  if (light.shape != LightShape::kTube) return rims;
  // Projected along the way to the axis nothing is further off it than a right angle.
  const glm::dvec3 to = light.center - eye;
  const glm::dvec3 across = to - glm::dot(to, light.axis_x) * light.axis_x;
  const double distance = glm::length(across);
  if (!(distance > light.half_size.y)) return {};
  const glm::dvec3 forward = across / distance, side = glm::cross(forward, light.axis_x);
  std::vector<Placed> placed;
  for (const glm::dvec3& rim : rims) {
    const glm::dvec3 p = rim - eye;
    placed.push_back({glm::dvec2(glm::dot(p, light.axis_x), glm::dot(p, side)) / glm::dot(p, forward), rim});
  }
  std::vector<glm::dvec3> hull = Hull(std::move(placed));
  hull.push_back(hull.front());
  return hull;
}

}  // namespace arealab
