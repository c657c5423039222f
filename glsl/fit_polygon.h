// Linearly transformed cosines in the fit: density, closed-form integral over a quadrilateral with its
// derivatives, and the random quadrilaterals of loss and measurement. Internal to the fit; the public
// interface is glsl/fit.h.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace arealab::fit {

// The free terms of P = [[p0, 0, p2], [0, 1, 0], [p1, 0, p3]] (rows), the order of glsl/fit.h's channels.
using Terms = Eigen::Vector4d;

inline double Determinant(const Terms& p) {
  return p[0] * p[3] - p[1] * p[2];
}

// A linear map of directions that makes the fitted P close to the identity: first into the frame whose third
// axis is `axis` in the plane of incidence (columns (a.z, 0, −a.x), (0, 1, 0), a), then scaling by (width, 1,
// depth).
struct Whitening {
  double axis_x = 0.0, axis_z = 1.0;
  double width = 1.0, depth = 1.0;

  glm::dvec3 Apply(const glm::dvec3& v) const {
    return {width * (axis_z * v.x - axis_x * v.z), v.y, depth * (axis_x * v.x + axis_z * v.z)};
  }
  glm::dvec3 Undo(const glm::dvec3& w) const {
    const double x = w.x / width, z = w.z / depth;
    return {axis_z * x + axis_x * z, w.y, -axis_x * x + axis_z * z};
  }
  // M⁻¹ of the lobe P ∘ Whitening, in the local frame.
  Terms ToLocal(const Terms& p) const;
  // The reverse.
  Terms FromLocal(const Terms& m) const;
};

// The lobe's share below the true horizon, b [findings: ½(1 − m0/√(m0² + m1²)) in the local frame], and
// ∂b/∂p.
struct Leak {
  double share = 0.0;
  Terms gradient = Terms::Zero();
};
Leak BelowHorizon(const Whitening& whitening, const Terms& p);

// A convex quadrilateral seen from the shaded point, its corners counter-clockwise seen from there, so that
// the normals of the edges' planes point inwards. Only directions matter.
struct Quad {
  std::array<glm::dvec3, 5> corner{};
  std::array<glm::dvec3, 5> normal{};  // cross(corner[i], corner[i + 1]), inwards
  std::size_t count = 4;               // of corners; 5, 3 or 0 where a plane has cut it
};
Quad MakeQuad(std::array<glm::dvec3, 4> corners);
// Its part above the plane z = 0 of its own space.
Quad ClipAbove(const Quad& quad);
Quad Transform(const Whitening& whitening, const Quad& quad);

// ∫ over the quad of the cosine lobe transformed by P, clipped exactly at the lobe's own horizon, in [0, 1]
// [Heitz et al. 2016, § 3; Lambert]; `gradient`, where not null, is ∂/∂p by moving the edges' planes (the
// horizon's arc adds nothing, the cosine being 0 on it).
double QuadIntegral(const Terms& p, const Quad& quad, Terms* gradient = nullptr);

// The same value for the part of the quad above the plane z = 0 of its own space: both horizons clip.
double UpperQuadIntegral(const Terms& p, const Quad& quad);

// Random rectangles in the local frame, the scenes of loss and measurement: centre at distance 1, its
// direction uniform on the upper hemisphere, orientation uniform, half width and half height log-uniform in
// [0.1, 2]; parts below the horizon stay on. Same numbers for the same seed on every machine.
std::vector<Quad> RandomRectangles(int count, std::uint64_t seed);

// Random parallelograms about +z for a lobe of unit width there: scaled to a lobe by Whitening::Undo.
std::vector<Quad> RandomLobeQuads(int count, std::uint64_t seed);

}  // namespace arealab::fit
