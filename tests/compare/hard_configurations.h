// Random lights that are hard to integrate: near, edge-on, grazing, across the horizon, tiny, huge, thin;
// roughness 0.03 to 1.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "compare/truth.h"

namespace arealab {

struct HardConfiguration {
  ShadingPoint point;
  Light light;
};

// The i-th of a fixed sequence: kind, roughness, shape and view follow from i, the rest from `engine`.
inline HardConfiguration MakeHardConfiguration(std::mt19937_64& engine, int i) {
  using glm::dvec3;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal;
  auto direction = [&] {
    double x = normal(engine), y = normal(engine), z = normal(engine);
    return glm::normalize(dvec3(x, y, z));
  };
  auto power = [&](double low, double high) { return std::pow(10.0, low + (high - low) * uniform(engine)); };
  constexpr std::array<double, 8> kRoughness = {0.03, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0};
  HardConfiguration c;
  dvec3 n = direction();
  double cos_v = uniform(engine);
  if ((i / 64) % 2 == 1) cos_v = power(-3.0, 0.0);  // half of the views graze
  dvec3 t = glm::normalize(glm::cross(n, direction()));
  double roughness = kRoughness[static_cast<std::size_t>(i / 8 % 8)];
  c.point = {dvec3(0.0), n, glm::normalize(n * cos_v + t * std::sqrt(1.0 - cos_v * cos_v)),
             std::max(roughness * roughness, 1e-4)};
  dvec3 mirror = n * (2.0 * cos_v) - c.point.to_view;
  dvec3 to_light = direction();
  if (glm::dot(to_light, n) < 0.0) to_light = -to_light;
  if (uniform(engine) < 0.5) to_light = glm::normalize(mirror + direction() * (0.5 * uniform(engine)));
  double distance = 1.0;
  double width = power(-1.5, 0.2), height = power(-1.5, 0.2);
  c.light.half_size = {width, height};
  dvec3 facing = direction();
  switch (i % 8) {
    case 1: {  // near the light's plane
      double above = power(-3.0, 0.0);
      dvec3 along = glm::normalize(glm::cross(facing, direction()));
      to_light = glm::normalize(along * (1.5 * uniform(engine)) - facing * above);
      distance = above + 0.1 * uniform(engine);
      break;
    }
    case 2: {  // edge-on
      dvec3 across = glm::normalize(glm::cross(to_light, direction()));
      facing = glm::normalize(across - to_light * power(-4.0, 0.0));
      break;
    }
    case 3:  // across the horizon
      to_light = glm::normalize(glm::normalize(to_light - n * glm::dot(to_light, n)) +
                                n * (0.4 * uniform(engine) - 0.2));
      break;
    case 4:  // tiny
      c.light.half_size *= power(-3.0, 0.0);
      break;
    case 5:  // huge
      c.light.half_size = {power(0.0, 2.0), power(0.0, 2.0)};
      break;
    case 6:  // thin
      c.light.half_size.y = 0.01 * c.light.half_size.x;
      break;
    case 7: {  // at the horizon where a grazing lobe points
      dvec3 low = glm::normalize(mirror - n * (0.9 * glm::dot(mirror, n)));
      to_light = glm::normalize(low + n * (0.1 * uniform(engine) - 0.03) + direction() * 0.05);
      break;
    }
    default:
      break;
  }
  if (glm::dot(facing, to_light) > 0.0) facing = -facing;
  c.light.center = to_light * distance;
  c.light.normal = facing;
  c.light.axis_x = glm::normalize(glm::cross(facing, direction()));
  c.light.axis_y = glm::cross(facing, c.light.axis_x);
  constexpr std::array<LightShape, 4> kShapes = {LightShape::kRectangle, LightShape::kRectangle,
                                                 LightShape::kDisk, LightShape::kSphere};
  c.light.shape = kShapes[static_cast<std::size_t>(i / 3 % 4)];
  if (c.light.shape != LightShape::kRectangle) c.light.half_size.y = c.light.half_size.x;
  if (c.light.shape == LightShape::kSphere && c.light.half_size.x > 0.95 * distance) {
    c.light.half_size = glm::dvec2(distance * (1.0 - power(-3.0, 0.0)));  // the point stays outside
  }
  return c;
}

}  // namespace arealab
