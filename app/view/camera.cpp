#include "app/view/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

namespace arealab {
Projection::Projection(const Camera& camera, glm::dvec2 picture) : position(camera.position), size(picture) {
  forward = glm::normalize(camera.target - camera.position);
  right = glm::cross(forward, camera.up);
  if (glm::length(right) < 1e-9) right = glm::cross(forward, std::abs(forward.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
  right = glm::normalize(right);
  up = glm::cross(right, forward);
  focal = 0.5 * size.y / std::tan(0.5 * camera.vertical_fov);
}

std::optional<glm::dvec2> Projection::Pixel(const glm::dvec3& world) const {
  const glm::dvec3 to = world - position;
  const double depth = glm::dot(to, forward);
  if (depth <= 1e-6) return std::nullopt;
  return 0.5 * size + focal / depth * glm::dvec2(glm::dot(to, right), -glm::dot(to, up));
}

glm::dvec3 Projection::Direction(glm::dvec2 pixel) const {
  const glm::dvec2 at = (pixel - 0.5 * size) / focal;
  return glm::normalize(forward + at.x * right - at.y * up);
}

double Projection::PixelSize(const glm::dvec3& world) const {
  return std::max(glm::dot(world - position, forward), 1e-6) / focal;
}

void Orbit(Camera& camera, double azimuth, double elevation) {
  constexpr double kPole = 0.5 * glm::pi<double>() / 180.0;
  const glm::dvec3 up = glm::normalize(camera.up);
  glm::dvec3 offset = glm::angleAxis(azimuth, up) * (camera.position - camera.target);
  const double polar = std::acos(std::clamp(glm::dot(glm::normalize(offset), up), -1.0, 1.0));
  const double turned = std::clamp(polar - elevation, kPole, glm::pi<double>() - kPole);
  const glm::dvec3 side = glm::cross(up, offset);
  if (glm::length(side) > 0.0) offset = glm::angleAxis(turned - polar, glm::normalize(side)) * offset;
  camera.position = camera.target + offset;
}

void Pan(Camera& camera, glm::dvec2 pixels, glm::dvec2 size) {
  const Projection view(camera, size);
  const glm::dvec3 move = view.PixelSize(camera.target) * (-pixels.x * view.right + pixels.y * view.up);
  camera.position += move;
  camera.target += move;
}

void Dolly(Camera& camera, double factor) {
  const glm::dvec3 offset = camera.position - camera.target;
  const double distance = glm::length(offset);
  camera.position = camera.target + offset * (std::clamp(distance * factor, 1e-3, 1e6) / distance);
}

void Focus(Camera& camera, const glm::dvec3& point) {
  if (glm::distance(point, camera.position) > 1e-6) camera.target = point;
}

}  // namespace arealab
