#include "glsl/fit_polygon.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace arealab::fit {
namespace {

// SplitMix64 [Steele et al. 2014]: its stream is defined bit by bit, unlike the standard library's
// distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double Uniform() {  // [0, 1), 53 bits
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  glm::dvec3 Direction(double least_z) {  // uniform on the cap z ≥ least_z
    const double z = least_z + (1.0 - least_z) * Uniform();
    const double phi = glm::two_pi<double>() * Uniform();
    const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {radius * std::cos(phi), radius * std::sin(phi), z};
  }

 private:
  std::uint64_t state_;
};

// Half axes of a rectangle whose plane has a uniformly random orientation.
std::pair<glm::dvec3, glm::dvec3> RandomHalfAxes(Random& random, double least, double largest) {
  const glm::dvec3 normal = random.Direction(-1.0);
  const glm::dvec3 other = std::abs(normal.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 u = glm::normalize(glm::cross(other, normal));
  const glm::dvec3 v = glm::cross(normal, u);
  const double turn = glm::two_pi<double>() * random.Uniform();
  const double span = std::log(largest / least);
  const double width = least * std::exp(span * random.Uniform());
  const double height = least * std::exp(span * random.Uniform());
  return {width * (std::cos(turn) * u + std::sin(turn) * v),
          height * (std::cos(turn) * v - std::sin(turn) * u)};
}

Quad RectangleAround(const glm::dvec3& center, const glm::dvec3& a, const glm::dvec3& b) {
  return MakeQuad({center + a + b, center - a + b, center - a - b, center + a - b});
}

}  // namespace

Terms Whitening::ToLocal(const Terms& p) const {
  const double m0 = p[0] * width, m1 = p[1] * width, m2 = p[2] * depth, m3 = p[3] * depth;
  // Columns of the frame's transpose: (a.z, 0, a.x) and (−a.x, 0, a.z).
  return {m0 * axis_z + m2 * axis_x, m1 * axis_z + m3 * axis_x, m2 * axis_z - m0 * axis_x,
          m3 * axis_z - m1 * axis_x};
}

Terms Whitening::FromLocal(const Terms& m) const {
  return {(m[0] * axis_z - m[2] * axis_x) / width, (m[1] * axis_z - m[3] * axis_x) / width,
          (m[2] * axis_z + m[0] * axis_x) / depth, (m[3] * axis_z + m[1] * axis_x) / depth};
}

Leak BelowHorizon(const Whitening& whitening, const Terms& p) {
  // The horizon's plane in the lobe's own space has the normal M⁻ᵀ z; the cosine's mass beyond it is ½(1 −
  // its cosine).
  const double qx = -whitening.axis_x / whitening.width, qz = whitening.axis_z / whitening.depth;
  const double nx = p[3] * qx - p[1] * qz, nz = p[0] * qz - p[2] * qx;
  const double length = std::sqrt(nx * nx + nz * nz);
  const double f = nz / length;
  const double by_nx = -nx * nz / (length * length * length), by_nz = nx * nx / (length * length * length);
  Leak leak;
  leak.share = 0.5 * (1.0 - f);
  leak.gradient = -0.5 * Terms(by_nz * qz, -by_nx * qz, -by_nz * qx, by_nx * qx);
  return leak;
}

namespace {

// atan2(y, x) for y ≥ 0 within 3e-15, which takes the library three times as long: about the nearest of 0, π/4, π/2, by a
// minimax polynomial.
double UpperAngle(double y, double x) {
  const double least = std::min(y, std::abs(x)), most = std::max(y, std::abs(x));
  const bool middle = least > 0.41421356237309505 * most;  // tan π/8
  const double over = middle ? least + most : most;
  const double t = over > 0.0 ? (middle ? least - most : least) / over : 0.0, s = t * t;
  double angle =
      t * (1.0 +
           s * (-0.3333333333322733 +
                s * (0.1999999997938119 +
                     s * (-0.14285712724563196 +
                          s * (0.11111050853183427 +
                               s * (-0.09089565599265453 +
                                    s * (0.07673907636400906 +
                                         s * (-0.06508241431158518 + s * (0.05032130023152495 - s * 0.025416354691696633)))))))));
  if (middle) angle += glm::quarter_pi<double>();
  if (y > std::abs(x)) angle = glm::half_pi<double>() - angle;
  return x < 0.0 ? glm::pi<double>() - angle : angle;
}

void MakeNormals(Quad* quad) {
  for (std::size_t i = 0; i < quad->count; ++i)
    quad->normal[i] = glm::cross(quad->corner[i], quad->corner[(i + 1) % quad->count]);
}

}  // namespace

Quad MakeQuad(std::array<glm::dvec3, 4> corners) {
  const glm::dvec3 middle = corners[0] + corners[2];
  if (glm::dot(glm::cross(corners[0], corners[1]), middle) < 0.0) std::swap(corners[1], corners[3]);
  Quad quad;
  std::copy(corners.begin(), corners.end(), quad.corner.begin());
  MakeNormals(&quad);
  return quad;
}

Quad ClipAbove(const Quad& quad) {
  Quad clipped;
  clipped.count = 0;
  for (std::size_t i = 0; i < quad.count; ++i) {
    const glm::dvec3& a = quad.corner[i];
    const glm::dvec3& b = quad.corner[(i + 1) % quad.count];
    if (a.z > 0.0) clipped.corner[clipped.count++] = a;
    if ((a.z > 0.0) != (b.z > 0.0)) {
      const double t = a.z / (a.z - b.z);
      clipped.corner[clipped.count++] = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), 0.0};
    }
  }
  MakeNormals(&clipped);
  return clipped;
}

Quad Transform(const Whitening& whitening, const Quad& quad) {
  Quad transformed = quad;
  for (std::size_t i = 0; i < quad.count; ++i) transformed.corner[i] = whitening.Apply(quad.corner[i]);
  MakeNormals(&transformed);
  return transformed;
}

double QuadIntegral(const Terms& p, const Quad& quad, Terms* gradient) {
  std::array<glm::dvec3, 5> u;
  std::array<double, 5> length;
  bool above = false;
  for (std::size_t i = 0; i < quad.count; ++i) {
    const glm::dvec3& v = quad.corner[i];
    u[i] = {p[0] * v.x + p[2] * v.z, v.y, p[1] * v.x + p[3] * v.z};
    above = above || u[i].z > 0.0;
  }
  if (gradient) gradient->setZero();
  if (!above) return 0.0;
  for (std::size_t i = 0; i < quad.count; ++i) length[i] = glm::length(u[i]);
  const double determinant = Determinant(p);
  double sum = 0.0;
  glm::dvec3 leaves(0.0), enters(0.0);  // where the outline crosses the lobe's horizon
  bool crosses = false;
  for (std::size_t i = 0; i < quad.count; ++i) {
    const std::size_t next = (i + 1) % quad.count;
    const double za = u[i].z, zb = u[next].z;
    if (za <= 0.0 && zb <= 0.0) continue;
    glm::dvec3 a = u[i], b = u[next];
    double length_a = length[i], length_b = length[next];
    double share = 1.0;  // of |n| that |a × b| is
    if (za <= 0.0) {
      a = {(zb * a.x - za * b.x), (zb * a.y - za * b.y), 0.0};
      length_a = glm::length(a);
      share = zb;
      enters = a;
      crosses = true;
    } else if (zb <= 0.0) {
      b = {(za * b.x - zb * a.x), (za * b.y - zb * a.y), 0.0};
      length_b = glm::length(b);
      share = za;
      leaves = b;
      crosses = true;
    }
    // The plane's normal is the cofactor matrix of P times that before the transform; clipping keeps the
    // plane.
    const glm::dvec3& n0 = quad.normal[i];
    const glm::dvec3 n(p[3] * n0.x - p[1] * n0.z, determinant * n0.y, p[0] * n0.z - p[2] * n0.x);
    const double n_length = glm::length(n);
    if (!(n_length > 0.0)) continue;
    const double dot = glm::dot(a, b), area = share * n_length;
    const double angle = UpperAngle(area, dot), inverse_n = 1.0 / n_length;
    sum += angle * n.z * inverse_n;
    if (!gradient) continue;
    // ∂/∂n of the integral = (1/π) ∫ along the arc of ω ω_z ds / |n|, with ω = â cos t + ê sin t.
    const double inverse_a = 1.0 / length_a, scale = inverse_a / length_b, sine = area * scale, cosine = dot * scale;
    const glm::dvec3 a_unit = a * inverse_a;
    const glm::dvec3 e = glm::cross(n, a_unit) * inverse_n;
    const double cc = 0.5 * (angle + sine * cosine), ss = 0.5 * (angle - sine * cosine),
                 cs = 0.5 * sine * sine;
    const glm::dvec3 g = ((a_unit.z * cc + e.z * cs) * a_unit + (a_unit.z * cs + e.z * ss) * e) *
                         (glm::one_over_pi<double>() * inverse_n);
    (*gradient)[0] += g.y * p[3] * n0.y + g.z * n0.z;
    (*gradient)[1] += -g.x * n0.z - g.y * p[2] * n0.y;
    (*gradient)[2] += -g.y * p[1] * n0.y - g.z * n0.x;
    (*gradient)[3] += g.x * n0.x + g.y * p[0] * n0.y;
  }
  if (crosses)
    sum += std::atan2(leaves.x * enters.y - leaves.y * enters.x, leaves.x * enters.x + leaves.y * enters.y);
  return sum * (0.5 * glm::one_over_pi<double>());
}

double UpperQuadIntegral(const Terms& p, const Quad& quad) {
  return QuadIntegral(p, ClipAbove(quad));
}

std::vector<Quad> RandomRectangles(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Quad> quads;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 center = random.Direction(0.0);
    const auto [a, b] = RandomHalfAxes(random, 0.1, 2.0);
    quads.push_back(RectangleAround(center, a, b));
  }
  return quads;
}

std::vector<Quad> RandomLobeQuads(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Quad> quads;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 center = random.Direction(0.2);
    const auto [a, b] = RandomHalfAxes(random, 0.1, 2.0);
    quads.push_back(RectangleAround(center, a, b));
  }
  return quads;
}

}  // namespace arealab::fit
