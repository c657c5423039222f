#include "compare/light_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
// clang-format off: the order matters
#include "glsl/dual_begin.h"
#include "glsl/low_discrepancy.glsl"
#include "glsl/dual_end.h"
// clang-format on

namespace arealab {
namespace {

constexpr double kPi = glm::pi<double>();

double Unit(std::uint32_t x) {
  return (static_cast<double>(x) + 0.5) * 0x1p-32;
}

// Below this the corners' angles, each right to 1e-16, would not give the solid angle to 1e-8; and a light so
// small is as good by area.
constexpr double kTinySolidAngle = 1e-7;

}  // namespace

std::uint64_t Mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a + 0x9e3779b97f4a7c15 * (b + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

glm::dvec2 ScrambledSobol(std::uint32_t i, std::uint64_t seed) {
  static const auto kSecond = [] {  // as far as a pixel of the truth asks: its loop over bits would cost as much as the scrambling
    std::array<std::uint32_t, 512> values{};
    for (std::uint32_t k = 0; k < values.size(); ++k) values[k] = dual::SobolSecond(k);
    return values;
  }();
  const std::uint32_t second = i < kSecond.size() ? kSecond[i] : dual::SobolSecond(i);
  return {Unit(dual::OwenScramble(dual::ReverseBits(i), static_cast<std::uint32_t>(seed))),
          Unit(dual::OwenScramble(second, static_cast<std::uint32_t>(seed >> 32)))};
}

std::optional<LightDirections> LightDirections::From(const glm::dvec3& position, const glm::dvec3& normal,
                                                     const Light& light) {
  LightDirections result;
  result.shape_ = light.shape;
  result.center_ = light.center - position;
  result.half_size_ = light.half_size;
  const glm::dvec3& center = result.center_;
  if (light.shape == LightShape::kSphere) {
    const double distance = glm::length(center), radius = light.half_size.x;
    if (distance <= radius) return std::nullopt;
    result.cone_ = SphereCone(center, radius);
    result.axis_ = {result.cone_.axis_1, result.cone_.axis_2, -result.cone_.axis_3};
    // The rim that the point sees lies before the centre.
    result.back_ = distance;
    if (glm::dot(center, normal) + radius <= 0.0) return std::nullopt;
    result.solid_angle_ = kPi * result.cone_.sin_1 * result.cone_.sin_2;
    return result;
  }
  if (light.shape == LightShape::kTube) {
    // Third axis: from the tube's to the point.
    const double half = light.half_size.x, radius = light.half_size.y;
    const glm::dvec3 across = -center + light.axis_x * glm::dot(center, light.axis_x);
    const double distance = glm::length(across);
    if (distance <= radius) return std::nullopt;
    const glm::dvec3 toward = across / distance;
    const double rise = half * std::abs(glm::dot(light.axis_x, normal)) + radius * glm::length(glm::cross(light.axis_x, normal));
    if (glm::dot(center, normal) + rise <= 0.0) return std::nullopt;
    result.axis_ = {light.axis_x, glm::cross(toward, light.axis_x), toward};
    result.back_ = distance;
    result.widest_ = std::acos(radius / distance);
    result.area_ = 4.0 * result.widest_ * radius * half;
    const double distance2 = glm::dot(center, center);
    result.solid_angle_ = 4.0 * half * radius * distance / (distance2 * std::sqrt(distance2));
    return result;
  }
  result.axis_ = {light.axis_x, light.axis_y, light.normal};
  result.back_ = -glm::dot(center, light.normal);
  if (result.back_ < 0.0 && light.two_sided) {
    result.axis_[1] = -result.axis_[1];
    result.axis_[2] = -result.axis_[2];
    result.back_ = -result.back_;
  }
  if (!(result.back_ > 0.0)) return std::nullopt;
  const double x = glm::dot(center, result.axis_[0]), y = glm::dot(center, result.axis_[1]);
  if (light.shape == LightShape::kDisk || light.shape == LightShape::kEllipse) {
    const double rise = std::hypot(light.half_size.x * glm::dot(normal, light.axis_x), light.half_size.y * glm::dot(normal, light.axis_y));
    if (glm::dot(center, normal) + rise <= 0.0) return std::nullopt;
    result.cone_ = light.shape == LightShape::kDisk
                       ? DiskCone(center, result.axis_[2], light.half_size.x)
                       : EllipseCone(center, light.axis_x * light.half_size.x, light.axis_y * light.half_size.y, result.axis_[2]);
    result.solid_angle_ = kPi * result.cone_.sin_1 * result.cone_.sin_2;
    return result;
  }
  const double top = glm::dot(center, normal) + light.half_size.x * std::abs(glm::dot(light.axis_x, normal)) +
                     light.half_size.y * std::abs(glm::dot(light.axis_y, normal));
  if (top <= 0.0) return std::nullopt;
  if (light.shape == LightShape::kPolygon) {
    result.by_area_ = true;
    result.corners_ = light.corners;
    if (result.axis_[2] != light.normal) {
      for (glm::dvec2& corner : result.corners_) corner.y = -corner.y;
      std::reverse(result.corners_.begin(), result.corners_.end());
    }
    for (std::size_t i = 1; i + 1 < result.corners_.size(); ++i) {
      const glm::dvec2 a = result.corners_[i] - result.corners_[0], b = result.corners_[i + 1] - result.corners_[0];
      result.area_ += 0.5 * (a.x * b.y - a.y * b.x);
      result.shares_.push_back(result.area_);
    }
    for (double& share : result.shares_) share /= result.area_;
    const double distance2 = glm::dot(center, center);
    result.solid_angle_ = result.area_ * result.back_ / (distance2 * std::sqrt(distance2));
    return result;
  }
  result.x0_ = x - light.half_size.x;
  result.x1_ = x + light.half_size.x;
  result.y0_ = y - light.half_size.y;
  result.y1_ = y + light.half_size.y;
  // The planes through the point and the edges y0, x1, y1, x0 in turn; only what their z axes need.
  const double z = -result.back_;
  const auto normal_at = [&](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::normalize(glm::cross(a, b));
  };
  const glm::dvec3 v00(result.x0_, result.y0_, z), v10(result.x1_, result.y0_, z),
      v11(result.x1_, result.y1_, z), v01(result.x0_, result.y1_, z);
  const glm::dvec3 n0 = normal_at(v00, v10), n1 = normal_at(v10, v11), n2 = normal_at(v11, v01),
                   n3 = normal_at(v01, v00);
  const auto angle = [](const glm::dvec3& a, const glm::dvec3& b) {
    return std::acos(std::clamp(-glm::dot(a, b), -1.0, 1.0));
  };
  const double g2 = angle(n2, n3), g3 = angle(n3, n0);
  result.k_ = 2.0 * kPi - g2 - g3;
  result.solid_angle_ = angle(n0, n1) + angle(n1, n2) - result.k_;
  result.b0_ = n0.z;
  result.b1_ = n2.z;
  if (!(result.solid_angle_ > kTinySolidAngle)) {
    result.by_area_ = true;
    const double distance2 = glm::dot(center, center);
    result.solid_angle_ =
        light.half_size.x * light.half_size.y * 4.0 * result.back_ / (distance2 * std::sqrt(distance2));
  }
  return result;
}

LightDirections LightDirections::Sky(const glm::dvec3& normal) {
  LightDirections result;
  result.sky_ = true;
  const glm::dvec3 other = std::abs(normal.z) < 0.7 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, normal));
  result.axis_ = {x, glm::cross(normal, x), normal};
  result.solid_angle_ = 2.0 * kPi;
  return result;
}

LightDirections::Sample LightDirections::At(const glm::dvec2& u) const {
  if (shape_ == LightShape::kTube) {
    const double angle = widest_ * (2.0 * u.x - 1.0);
    const glm::dvec3 outwards = axis_[2] * std::cos(angle) + axis_[1] * std::sin(angle);
    return OnTube(center_ + axis_[0] * (half_size_.x * (2.0 * u.y - 1.0)) + outwards * half_size_.y, outwards);
  }
  if (shape_ == LightShape::kPolygon) {
    // A triangle by the shares of the area, then a point of it, even over the area.
    const auto found = std::upper_bound(shares_.begin(), shares_.end() - 1, u.x);
    const auto i = static_cast<std::size_t>(found - shares_.begin());
    const double before = i == 0 ? 0.0 : shares_[i - 1], r = std::sqrt(std::clamp((u.x - before) / (shares_[i] - before), 0.0, 1.0));
    const glm::dvec2 place = corners_[0] + r * (corners_[i + 1] - corners_[0] + u.y * (corners_[i + 2] - corners_[i + 1]));
    const glm::dvec3 to = center_ + axis_[0] * place.x + axis_[1] * place.y;
    const double distance = glm::length(to);
    return {to / distance, distance, distance * distance * distance / (back_ * area_)};
  }
  if (sky_) {
    const double radius = std::sqrt(u.x), phi = 2.0 * kPi * u.y, z = std::sqrt(1.0 - u.x);
    return {World({radius * std::cos(phi), radius * std::sin(phi), z}), std::numeric_limits<double>::infinity(), z / kPi};
  }
  if (shape_ != LightShape::kRectangle) {
    const double radius = std::sqrt(u.x), phi = 2.0 * kPi * u.y;
    const double x = cone_.sin_1 * radius * std::cos(phi), y = cone_.sin_2 * radius * std::sin(phi);
    const double z = std::sqrt(std::max(1.0 - x * x - y * y, 1e-30));
    const glm::dvec3 direction = cone_.axis_1 * x + cone_.axis_2 * y + cone_.axis_3 * z;
    const double density = z / (kPi * cone_.sin_1 * cone_.sin_2);
    if (IsFlat(shape_))
      return {direction, -back_ / std::min(glm::dot(direction, axis_[2]), -1e-30), density};
    const double along = glm::dot(center_, direction), radius2 = half_size_.x * half_size_.x;
    const double gap2 = std::max(radius2 - (glm::dot(center_, center_) - along * along), 0.0);
    return {direction, along - std::sqrt(gap2), density};
  }
  double x, y;
  if (by_area_) {
    x = x0_ + u.x * (x1_ - x0_);
    y = y0_ + u.y * (y1_ - y0_);
  } else {
    const double angle = u.x * solid_angle_ + k_;
    const double f = (std::cos(angle) * b0_ - b1_) / std::sin(angle);
    // The paper's c = ±1/√(f² + b₀²) and x = c·back/√(1 − c²), put together.
    x = std::clamp(std::copysign(back_ / std::sqrt(std::max(f * f + b0_ * b0_ - 1.0, 1e-30)), f), x0_, x1_);
    const double d2 = x * x + back_ * back_, d = std::sqrt(d2);
    const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_),
                 h = h0 + u.y * (h1 - h0);
    y = std::clamp(h * d / std::sqrt(std::max(1.0 - h * h, 1e-30)), y0_, y1_);
  }
  const double distance = std::sqrt(x * x + y * y + back_ * back_);
  const double density =
      by_area_ ? distance * distance * distance / (back_ * (x1_ - x0_) * (y1_ - y0_)) : 1.0 / solid_angle_;
  return {World(glm::dvec3(x, y, -back_)) / distance, distance, density};
}

LightDirections::Sample LightDirections::OnTube(const glm::dvec3& to, const glm::dvec3& outwards) const {
  const double distance = glm::length(to);
  return {to / distance, distance, distance * distance * distance / std::max(-glm::dot(to, outwards) * area_, 1e-300)};
}

std::optional<LightDirections::Sample> LightDirections::Towards(const glm::dvec3& direction) const {
  if (shape_ == LightShape::kTube) {
    // The nearer meeting of the ray and the wall.
    const glm::dvec3 across = direction - axis_[0] * glm::dot(direction, axis_[0]);
    const double a = glm::dot(across, across), b = glm::dot(across, axis_[2]) * back_;
    const double c = (back_ - half_size_.y) * (back_ + half_size_.y), d = b * b - a * c;
    if (b >= 0.0 || d <= 0.0) return std::nullopt;
    const glm::dvec3 to = direction * (c / (std::sqrt(d) - b)), from_center = to - center_;
    const double along = glm::dot(from_center, axis_[0]);
    if (std::abs(along) > half_size_.x) return std::nullopt;
    return OnTube(to, (from_center - axis_[0] * along) / half_size_.y);
  }
  if (shape_ == LightShape::kPolygon) {
    const double facing = -glm::dot(direction, axis_[2]);
    if (facing <= 0.0) return std::nullopt;
    const double distance = back_ / facing;
    const glm::dvec3 from_center = distance * direction - center_;
    const glm::dvec2 place(glm::dot(from_center, axis_[0]), glm::dot(from_center, axis_[1]));
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const glm::dvec2 side = corners_[(i + 1) % corners_.size()] - corners_[i], at = place - corners_[i];
      if (side.x * at.y - side.y * at.x < 0.0) return std::nullopt;
    }
    return Sample{direction, distance, distance * distance * distance / (back_ * area_)};
  }
  if (sky_) {
    const double z = glm::dot(direction, axis_[2]);
    if (z <= 0.0) return std::nullopt;
    return Sample{direction, std::numeric_limits<double>::infinity(), z / kPi};
  }
  if (shape_ != LightShape::kRectangle) {
    const double x = glm::dot(direction, cone_.axis_1) / cone_.sin_1,
                 y = glm::dot(direction, cone_.axis_2) / cone_.sin_2, z = glm::dot(direction, cone_.axis_3);
    if (z <= 0.0 || x * x + y * y >= 1.0) return std::nullopt;
    const double density = z / (kPi * cone_.sin_1 * cone_.sin_2);
    if (IsFlat(shape_)) {
      const double facing = -glm::dot(direction, axis_[2]);
      if (facing <= 0.0) return std::nullopt;
      return Sample{direction, back_ / facing, density};
    }
    const double along = glm::dot(center_, direction), radius2 = half_size_.x * half_size_.x;
    const double gap2 = std::max(radius2 - (glm::dot(center_, center_) - along * along), 0.0);
    return Sample{direction, along - std::sqrt(gap2), density};
  }
  const double facing = -glm::dot(direction, axis_[2]);
  if (facing <= 0.0) return std::nullopt;
  const double distance = back_ / facing;
  const double x = distance * glm::dot(direction, axis_[0]), y = distance * glm::dot(direction, axis_[1]);
  if (x < x0_ || x > x1_ || y < y0_ || y > y1_) return std::nullopt;
  return Sample{
      direction, distance,
      by_area_ ? distance * distance * distance / (back_ * (x1_ - x0_) * (y1_ - y0_)) : 1.0 / solid_angle_};
}

std::array<glm::dvec3, 4> LightDirections::Corners() const {
  const auto corner = [&](double a, double b) {
    if (shape_ == LightShape::kTube) {
      // In the plane of the axis that faces the point: the wall's places seen there lie at most back/(back − radius) as far along, and
      // its lines of contact at radius/√(1 − (radius/back)²).
      const double radius = half_size_.y, grown = back_ / (back_ - radius), beside = radius / std::sqrt(1.0 - radius * radius / (back_ * back_));
      const double along = glm::dot(center_, axis_[0]), near = along + a * half_size_.x;
      const double end = a < 0.0 ? std::min(near, near * grown) : std::max(near, near * grown);
      return center_ + axis_[0] * (end - along) + axis_[1] * (b * beside);
    }
    if (shape_ == LightShape::kSphere) {
      return cone_.axis_3 * cone_.cos_1 + cone_.axis_1 * (a * cone_.sin_1) + cone_.axis_2 * (b * cone_.sin_2);
    }
    return center_ + axis_[0] * (a * half_size_.x) + axis_[1] * (b * half_size_.y);
  };
  return {corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)};
}

glm::dvec3 SampleVisibleGgx(const glm::dvec3& to_view, double alpha, const glm::dvec2& u) {
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * to_view.x, alpha * to_view.y, to_view.z));
  const double phi = 2.0 * kPi * u.x, z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
  const double sine = std::sqrt(std::clamp(1.0 - z * z, 0.0, 1.0));
  const glm::dvec3 half = glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), z) + stretched;
  const glm::dvec3 facet = glm::normalize(glm::dvec3(alpha * half.x, alpha * half.y, half.z));
  return 2.0 * glm::dot(to_view, facet) * facet - to_view;
}

}  // namespace arealab
