#include "compare/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace arealab {
namespace {

constexpr double kPi = glm::pi<double>();

// atanh(κ x)/κ and atan(κ x)/κ, continued to κ = 0. Below κx = 1e-4 the next term is under 1e-17.
double AtanhOver(double kappa, double x) {
  double y = kappa * x;
  return std::abs(y) < 1e-4 ? x * (1.0 + y * y / 3.0) : std::atanh(y) / kappa;
}
double AtanOver(double kappa, double x) {
  double y = kappa * x;
  return std::abs(y) < 1e-4 ? x * (1.0 - y * y / 3.0) : std::atan(y) / kappa;
}

// Unit vector across v, well defined for every unit v.
glm::dvec3 AnyPerpendicular(const glm::dvec3& v) {
  glm::dvec3 axis = std::abs(v.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  return glm::normalize(glm::cross(v, axis));
}

}  // namespace

HorizonPolygon ClipToHorizon(std::span<const glm::dvec3> corners) {
  HorizonPolygon result;
  auto add = [&](const glm::dvec3& p) { result.corners[static_cast<std::size_t>(result.count++)] = p; };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3& p = corners[i];
    const glm::dvec3& q = corners[(i + 1) % corners.size()];
    if (p.z >= 0.0) {
      add(p);
    }
    if ((p.z > 0.0 && q.z < 0.0) || (p.z < 0.0 && q.z > 0.0)) {
      double share = p.z / (p.z - q.z);
      glm::dvec3 cut = p + (q - p) * share;
      cut.z = 0.0;
      add(cut);
    }
  }
  return result;
}

double PolygonFormFactor(const HorizonPolygon& polygon) {
  double sum = 0.0;
  for (int i = 0; i < polygon.count; ++i) {
    glm::dvec3 p = glm::normalize(polygon.corners[static_cast<std::size_t>(i)]);
    glm::dvec3 q = glm::normalize(polygon.corners[static_cast<std::size_t>((i + 1) % polygon.count)]);
    // The edge's angle and plane from sum and difference of its ends: exact for short edges and for long
    // ones.
    glm::dvec3 along = q - p, middle = p + q;
    double along_length = glm::length(along), middle_length = glm::length(middle);
    if (along_length == 0.0 || middle_length == 0.0) {
      continue;
    }
    double plane_z = (middle.x * along.y - middle.y * along.x) / (along_length * middle_length);
    sum += 2.0 * std::atan2(along_length, middle_length) * plane_z;
  }
  return sum / (2.0 * kPi);
}

LightCone DiskCone(const glm::dvec3& center, const glm::dvec3& normal, double radius) {
  // In the plane of centre and normal, c = (ρ, h): the dual cone c cᵀ − R² (1 − n nᵀ) has there the matrix
  // [ρ² − R², ρh; ρh, h²] with eigenvalues μ > 0 and −R²h²/μ; across the plane −R².
  double h = -glm::dot(center, normal);
  glm::dvec3 in_plane = center + normal * h;
  in_plane -= normal * glm::dot(in_plane, normal);  // once more: on the axis the first difference is all rounding
  double rho = glm::length(in_plane);
  LightCone cone;
  glm::dvec3 radial = rho > 1e-13 * h ? in_plane / rho : AnyPerpendicular(normal);
  radial = glm::normalize(radial - normal * glm::dot(radial, normal));
  double half = 0.5 * (rho * rho + h * h - radius * radius);
  double root = std::sqrt(half * half + radius * radius * h * h);
  double mu = half > 0.0 ? half + root : radius * radius * h * h / (root - half);
  // Eigenvector of μ over (radial, −normal), by the row that does not cancel.
  double a = rho > radius ? (rho * rho - radius * radius - h * h) * 0.5 + root : rho * h;
  double b = rho > radius ? rho * h : mu + (radius - rho) * (radius + rho);
  double length = std::hypot(a, b);
  cone.axis_3 = (radial * a - normal * b) / length;
  cone.axis_1 = glm::cross(radial, normal);
  cone.axis_2 = glm::cross(cone.axis_3, cone.axis_1);
  double root_mu = std::sqrt(mu);
  double norm_1 = std::hypot(radius, root_mu), norm_2 = std::hypot(radius * h, mu);
  cone.sin_1 = radius / norm_1;
  cone.cos_1 = root_mu / norm_1;
  cone.sin_2 = radius * h / norm_2;
  cone.cos_2 = mu / norm_2;
  return cone;
}

LightCone EllipseCone(const glm::dvec3& center, const glm::dvec3& half_a, const glm::dvec3& half_b, const glm::dvec3& normal) {
  // In the axes of the half axes and the normal, lengths over the longer half axis: the dual cone c cᵀ − diag(a², b², 0) has the
  // eigenvalue μ > 0 with x²/(μ + a²) + y²/(μ + b²) + z²/μ = 1, the largest of c's confocal coordinates, whose eigenvector is the
  // cone's axis. The other two have the product a² b² z²/μ, so that the lesser keeps its digits where the cone is thin.
  const double length_a = glm::length(half_a), length_b = glm::length(half_b), unit = std::max(length_a, length_b);
  const glm::dvec3 x_axis = half_a / length_a, y_axis = half_b / length_b;
  const double a2 = length_a * length_a / (unit * unit), b2 = length_b * length_b / (unit * unit);
  const glm::dvec3 c = glm::dvec3(glm::dot(center, x_axis), glm::dot(center, y_axis), glm::dot(center, normal)) / unit;
  const glm::dvec3 square = c * c;
  // Decreasing and convex in μ; Newton from below cannot overshoot. Below: what the greater bound on each share leaves.
  double mu = std::max({square.z, square.x + square.y + square.z - 1.0, 1e-300});
  for (int step = 0; step < 200; ++step) {
    const double u = square.x / (mu + a2), v = square.y / (mu + b2), w = square.z / mu;
    const double move = (u + v + w - 1.0) / (u / (mu + a2) + v / (mu + b2) + w / mu);
    mu += move;
    if (!(move > 1e-16 * mu)) break;
  }
  const glm::dvec3 e3 = glm::normalize(glm::dvec3(c.x / (mu + a2), c.y / (mu + b2), c.z / mu));
  const glm::dvec3 u = AnyPerpendicular(e3), v = glm::cross(e3, u);
  const auto spread = [&](const glm::dvec3& p, const glm::dvec3& q) {
    return a2 * p.x * q.x + b2 * p.y * q.y - glm::dot(c, p) * glm::dot(c, q);
  };
  const double uu = spread(u, u), vv = spread(v, v), uv = spread(u, v);
  const double root = std::hypot(0.5 * (uu - vv), uv), wide = 0.5 * (uu + vv) + root, narrow = a2 * b2 * square.z / (mu * wide);
  const double turn = 0.5 * std::atan2(uv, 0.5 * (uu - vv));
  const auto world = [&](const glm::dvec3& p) { return x_axis * p.x + y_axis * p.y + normal * p.z; };
  LightCone cone;
  cone.axis_3 = world(e3);
  cone.axis_1 = world(u * std::cos(turn) + v * std::sin(turn));
  cone.axis_2 = glm::cross(cone.axis_3, cone.axis_1);
  cone.sin_1 = std::sqrt(wide / (wide + mu));
  cone.cos_1 = std::sqrt(mu / (wide + mu));
  cone.sin_2 = std::sqrt(narrow / (narrow + mu));
  cone.cos_2 = std::sqrt(mu / (narrow + mu));
  return cone;
}

LightCone SphereCone(const glm::dvec3& center, double radius) {
  LightCone cone;
  double distance = glm::length(center);
  cone.axis_3 = center / distance;
  // Towards the highest point of the outline; any direction serves where the centre is overhead.
  glm::dvec3 up(-cone.axis_3.z * cone.axis_3.x, -cone.axis_3.z * cone.axis_3.y,
                cone.axis_3.x * cone.axis_3.x + cone.axis_3.y * cone.axis_3.y);
  cone.axis_1 = up.z > 1e-24 ? glm::normalize(up) : AnyPerpendicular(cone.axis_3);
  cone.axis_2 = glm::cross(cone.axis_3, cone.axis_1);
  cone.sin_1 = cone.sin_2 = radius / distance;
  cone.cos_1 = cone.cos_2 = std::sqrt((distance - radius) * (distance + radius)) / distance;
  return cone;
}

ConeHorizon ClipToHorizon(const LightCone& cone) {
  // Height over the outline, times positive factors: m + a cosψ' + b sinψ' with the ellipse's own angle ψ'.
  double m = cone.axis_3.z * cone.cos_1 * cone.cos_2;
  double a = cone.axis_1.z * cone.sin_1 * cone.cos_2, b = cone.axis_2.z * cone.sin_2 * cone.cos_1;
  double amplitude = std::hypot(a, b);
  ConeHorizon result;
  if (m >= amplitude) {
    return result;
  }
  if (m <= -amplitude) {
    result.kind = ConeHorizon::Kind::kBelow;
    return result;
  }
  result.kind = ConeHorizon::Kind::kCrossing;
  double top = std::atan2(b, a), half = std::acos(std::clamp(-m / amplitude, -1.0, 1.0));
  // To the angle of the outline on the sphere, tanψ = tanψ'·cos_1/cos_2, in the same turn.
  auto on_sphere = [&](double angle) {
    double psi = std::atan2(std::sin(angle) * cone.cos_1, std::cos(angle) * cone.cos_2);
    return psi + 2.0 * kPi * std::round((angle - psi) / (2.0 * kPi));
  };
  result.psi_begin = on_sphere(top - half);
  result.psi_end = on_sphere(top + half);
  return result;
}

namespace {

// A place of a cone's outline.
struct ConePlace {
  double sine, cosine;  // of the ellipse's own angle ψ'
  glm::dvec3 direction;
};

ConePlace PlaceAt(const LightCone& cone, double psi) {
  const double c = std::cos(psi), s = std::sin(psi), w = std::hypot(c * cone.cos_1, s * cone.cos_2);
  return {s * cone.cos_2 / w, c * cone.cos_1 / w, cone.axis_1 * (cone.sin_1 * c) + cone.axis_2 * (cone.sin_2 * s) + cone.axis_3 * w};
}

}  // namespace

double ConeContour(const LightCone& cone, double psi_begin, double psi_end) {
  // ∮ n·(l × dl) over the arc, p = axis_3 + a cosψ' axis_1 + b sinψ' axis_2: p × p' = −b cosψ' axis_1 − a sinψ' axis_2 + ab axis_3,
  // |p|² = 1 + a² cos² + b² sin². With the sphere's angle ψ, sinψ' = s cos_2/w and cosψ' = c cos_1/w, w² = (c cos_1)² + (s cos_2)²,
  // tan_1 = a, tan_2 = b.
  const double cos_1 = cone.cos_1, cos_2 = cone.cos_2, sin_1 = cone.sin_1, sin_2 = cone.sin_2;
  const double tan2_difference = (sin_1 * cos_2 - sin_2 * cos_1) * (sin_1 * cos_2 + sin_2 * cos_1) / (cos_1 * cos_1 * cos_2 * cos_2);
  const double root = std::sqrt(std::max(tan2_difference, 0.0)), kappa = root * cos_1, j = root * cos_2;
  const ConePlace begin = PlaceAt(cone, psi_begin), end = PlaceAt(cone, psi_end);
  const double i1 = (sin_2 / cos_2) * cos_1 * cos_1 * (AtanhOver(kappa, end.sine) - AtanhOver(kappa, begin.sine));
  const double i2 = -(sin_1 / cos_1) * cos_2 * cos_2 * (AtanOver(j, end.cosine) - AtanOver(j, begin.cosine));
  return -cone.axis_1.z * i1 - cone.axis_2.z * i2 + cone.axis_3.z * sin_1 * sin_2 * (psi_end - psi_begin);
}

double ConeFormFactor(const LightCone& cone, const ConeHorizon& horizon) {
  using Kind = ConeHorizon::Kind;
  if (horizon.kind == Kind::kBelow) {
    return 0.0;
  }
  if (horizon.kind == Kind::kAbove) {
    return cone.axis_3.z * cone.sin_1 * cone.sin_2;
  }
  // The chord on the horizon closes the outline.
  const glm::dvec3 p = PlaceAt(cone, horizon.psi_end).direction, q = PlaceAt(cone, horizon.psi_begin).direction;
  const double chord = std::atan2(p.x * q.y - p.y * q.x, p.x * q.x + p.y * q.y);
  return std::max((ConeContour(cone, horizon.psi_begin, horizon.psi_end) + chord) / (2.0 * kPi), 0.0);
}

}  // namespace arealab
