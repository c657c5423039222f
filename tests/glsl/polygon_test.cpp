// The rectangle's form factor, clipped in every way that the techniques offer, in double, against a polygon
// clipper and an edge integral written here.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <random>
#include <vector>

#include "glsl/dual_begin.h"
#include "glsl/near.glsl"
#include "glsl/path.glsl"
#include "glsl/directions.glsl"
#include "glsl/polygon.glsl"
namespace half_angle {
#include "glsl/edge/half_angle.glsl"
namespace arc {
#include "glsl/clip/arc.glsl"
}
namespace switched {
#include "glsl/clip/switch.glsl"
}
namespace stream {
#include "glsl/clip/stream.glsl"
}
namespace none {
#include "glsl/clip/none.glsl"
}
namespace proxy {
#include "glsl/sphere/exact.glsl"
#include "glsl/clipped_proxy.glsl"
}  // namespace proxy
namespace cheap {
#include "glsl/sphere/cheap.glsl"
}
namespace fitted {
#include "glsl/sphere/fit.glsl"
#include "glsl/clipped_proxy.glsl"
}  // namespace fitted
}  // namespace half_angle
namespace mirrored {
#include "glsl/edge/mirrored.glsl"
namespace arc {
#include "glsl/clip/arc.glsl"
}
namespace switched {
#include "glsl/clip/switch.glsl"
}
namespace proxy {
#include "glsl/sphere/exact.glsl"
#include "glsl/clipped_proxy.glsl"
}  // namespace proxy
}  // namespace mirrored
namespace rational {
#include "glsl/edge/rational.glsl"
namespace arc {
#include "glsl/clip/arc.glsl"
}
namespace switched {
#include "glsl/clip/switch.glsl"
}
}  // namespace rational
namespace quadratic {
#include "glsl/edge/quadratic.glsl"
namespace arc {
#include "glsl/clip/arc.glsl"
}
}  // namespace quadratic
namespace acos_edge {
#include "glsl/edge/acos.glsl"
namespace arc {
#include "glsl/clip/arc.glsl"
}
namespace stream {
#include "glsl/clip/stream.glsl"
}
}  // namespace acos_edge
namespace fast_acos {
#include "glsl/edge/fast_acos.glsl"
namespace stream {
#include "glsl/clip/stream.glsl"
}
}  // namespace fast_acos
namespace exact {
// The edges without any approximation: what is left is the clip's own error.
const float kTurn = 2.0 * kPi;
const bool kEdgeMirrored = false;
const bool kEdgeUnit = false;
vec4 EdgeVertex(vec3 v) {
  return vec4(v, dot(v, v));
}
double EdgeAngle(double d, double, double area) {
  return std::atan2(area, d);
}
double EdgeRatio(double d, double, double share, double line2) {
  return line2 > 0.0 ? std::atan2(share * std::sqrt(line2), d) / std::sqrt(line2) : 0.0;
}
double LambertEdgeRatio(double d, double m, double share, double line2) {
  return EdgeRatio(d, m, share, line2);
}
namespace arc {
#include "glsl/clip/arc.glsl"
}
namespace switched {
#include "glsl/clip/switch.glsl"
}
namespace stream {
#include "glsl/clip/stream.glsl"
}
namespace proxy {
#include "glsl/sphere/exact.glsl"
#include "glsl/clipped_proxy.glsl"
}  // namespace proxy
}  // namespace exact
#include "glsl/dual_end.h"

namespace arealab {
namespace {

using dual::Light;
using dual::RectangleView;
using glm::dvec2;
using glm::dvec3;

constexpr double kPi = glm::pi<double>();

// The polygon's part with z > 0 [Sutherland & Hodgman 1974].
std::vector<dvec3> ClipAbove(const std::vector<dvec3>& polygon) {
  std::vector<dvec3> clipped;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec3 from = polygon[i], to = polygon[(i + 1) % polygon.size()];
    if (from.z > 0.0) clipped.push_back(from);
    if ((from.z > 0.0) != (to.z > 0.0)) clipped.push_back(from + (to - from) * (from.z / (from.z - to.z)));
  }
  return clipped;
}

// Lambert's edge sum, with the angle by atan2.
dvec3 VectorOf(const std::vector<dvec3>& polygon) {
  dvec3 sum(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec3 a = glm::normalize(polygon[i]), b = glm::normalize(polygon[(i + 1) % polygon.size()]);
    const dvec3 c = glm::cross(a, b);
    const double sine = glm::length(c);
    if (sine > 0.0) sum += c / sine * std::atan2(sine, glm::dot(a, b));
  }
  return sum / (2.0 * kPi);
}

struct Case {
  dvec3 center, a, b;  // half_a × half_b towards the origin

  std::vector<dvec3> Corners() const {  // counter-clockwise seen from the origin
    return {center + a + b, center + a - b, center - a - b, center - a + b};
  }
  double Expected() const { return VectorOf(ClipAbove(Corners())).z; }
  int CornersAbove() const {
    int bits = 0;
    for (std::size_t i = 0; i < 4; ++i) bits |= (Corners()[i].z > 0.0 ? 1 : 0) << i;
    return bits;
  }
  // Distance of the origin from the nearest edge's line, over the longest side: near 0 the form factor jumps.
  double EdgeDistance() const {
    const auto corners = Corners();
    double least = 1e300;
    for (std::size_t i = 0; i < 4; ++i) {
      const dvec3 side = corners[(i + 1) % 4] - corners[i];
      least = std::min(least, glm::length(glm::cross(side, corners[i])) / glm::dot(side, side));
    }
    return least;
  }
};

class Random {
 public:
  double operator()(double from, double to) { return from + (to - from) * uniform_(engine_); }
  double Log(double from, double to) { return from * std::pow(to / from, uniform_(engine_)); }
  dvec3 Direction() {
    const double z = (*this)(-1.0, 1.0), phi = (*this)(0.0, 2.0 * kPi), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937_64 engine_{20261};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

// A rectangle of any size, place and orientation, and its light block.
struct RandomRectangle {
  Case seen;
  RectangleView view;
};
RandomRectangle MakeRectangle(Random& random) {
  const dvec3 center = random.Direction();
  dvec3 normal = random.Direction();
  if (glm::dot(normal, center) > 0.0) normal = -normal;
  const dvec3 axis_x = glm::normalize(glm::cross(normal, random.Direction()));
  const dvec3 axis_y = glm::cross(normal, axis_x);
  const dvec2 half_size(random.Log(0.01, 30.0), random.Log(0.01, 30.0));
  Light light;
  light.center = center;
  light.normal = normal;
  light.axis_x = axis_x;
  light.axis_y = axis_y;
  light.half_axis_x = axis_x * half_size.x;
  light.half_axis_y = axis_y * half_size.y;
  light.half_size = half_size;
  RandomRectangle result;
  result.seen = {center, light.half_axis_x, light.half_axis_y};
  result.view = dual::ViewRectangle(light, dvec3(0.0), {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0});
  return result;
}

// A parallelogram, as an LTC's transform leaves it: sheared, flattened.
Case Transformed(Random& random, const Case& seen) {
  const glm::dmat3 m(random.Log(0.3, 3.0), 0.0, random(-1.0, 1.0), 0.0, 1.0, 0.0, random(-1.0, 1.0), 0.0,
                     random.Log(0.01, 3.0));
  if (glm::determinant(m) <= 0.0) return seen;
  return {m * seen.center, m * seen.a, m * seen.b};
}

struct Worst {
  double error = 0.0;
  double square_sum = 0.0, expected_square_sum = 0.0;
  void Add(double got, double expected) {
    ASSERT_TRUE(std::isfinite(got));
    ASSERT_GE(got, 0.0);
    ASSERT_LE(got, 1.0);
    error = std::max(error, std::abs(got - expected));
    square_sum += (got - expected) * (got - expected);
    expected_square_sum += expected * expected;
  }
  double RelativeRmse() const { return std::sqrt(square_sum / expected_square_sum); }
};

TEST(Polygon, ClippedFormFactorOfRandomRectangles) {
  Random random;
  Worst mirrored_lambert, mirrored, mirrored_switched;
  Worst arc_lambert, arc, exact_arc_lambert, exact_arc, switched, exact_switched, rational_arc,
      rational_switched, exact_stream, quadratic_lambert, quadratic, acos_arc, acos_stream, fast_acos;
  double vector_error = 0.0;
  std::array<int, 16> patterns{};
  for (int i = 0; i < 100000; ++i) {
    const RandomRectangle rectangle = MakeRectangle(random);
    const double lambert = rectangle.seen.Expected();
    arc_lambert.Add(dual::half_angle::arc::ClippedLambert(rectangle.view), lambert);
    exact_arc_lambert.Add(dual::exact::arc::ClippedLambert(rectangle.view), lambert);
    const Case c = Transformed(random, rectangle.seen);
    const double expected = c.Expected();
    mirrored_lambert.Add(dual::mirrored::arc::ClippedLambert(rectangle.view), lambert);
    mirrored.Add(dual::mirrored::arc::ClippedVector(c.center, c.a, c.b, true).z, expected);
    mirrored_switched.Add(dual::mirrored::switched::ClippedVector(c.center, c.a, c.b, true).z, expected);
    ++patterns[static_cast<std::size_t>(c.CornersAbove())];
    arc.Add(dual::half_angle::arc::ClippedVector(c.center, c.a, c.b, true).z, expected);
    vector_error = std::max(vector_error, glm::length(dual::exact::arc::ClippedVector(c.center, c.a, c.b, true) -
                                                      VectorOf(ClipAbove(c.Corners()))));
    exact_arc.Add(dual::exact::arc::ClippedVector(c.center, c.a, c.b, true).z, expected);
    switched.Add(dual::half_angle::switched::ClippedVector(c.center, c.a, c.b, true).z, expected);
    exact_switched.Add(dual::exact::switched::ClippedVector(c.center, c.a, c.b, true).z, expected);
    rational_arc.Add(dual::rational::arc::ClippedVector(c.center, c.a, c.b, true).z, expected);
    exact_stream.Add(dual::exact::stream::ClippedVector(c.center, c.a, c.b, true).z, expected);
    quadratic_lambert.Add(dual::quadratic::arc::ClippedLambert(rectangle.view), lambert);
    quadratic.Add(dual::quadratic::arc::ClippedVector(c.center, c.a, c.b, true).z, expected);
    acos_arc.Add(dual::acos_edge::arc::ClippedVector(c.center, c.a, c.b, true).z, expected);
    acos_stream.Add(dual::acos_edge::stream::ClippedVector(c.center, c.a, c.b, true).z, expected);
    fast_acos.Add(dual::fast_acos::stream::ClippedVector(c.center, c.a, c.b, true).z, expected);
    rational_switched.Add(dual::rational::switched::ClippedVector(c.center, c.a, c.b, true).z, expected);
  }
  for (int pattern = 0; pattern < 16; ++pattern) {
    const bool possible = pattern != 5 && pattern != 10;
    EXPECT_EQ(patterns[static_cast<std::size_t>(pattern)] > 0, possible) << "corners above: " << pattern;
  }
  // The polynomial's 3.0e-6; measured 2.4e-6 of all three.
  EXPECT_LT(mirrored_lambert.error, 4e-6);
  EXPECT_LT(mirrored.error, 4e-6);
  EXPECT_LT(mirrored_switched.error, 4e-6);
  // The clip itself, with exact edges: measured 2.4e-14, 1.7e-13, 2.4e-14; the vector 4.2e-11.
  EXPECT_LT(exact_arc_lambert.error, 1e-11);
  EXPECT_LT(exact_arc.error, 1e-11);
  EXPECT_LT(exact_switched.error, 1e-11);
  EXPECT_LT(vector_error, 1e-9);
  // The polynomial's 4.3e-7, and its cancellation near π in the side in the horizon;
  // measured 4.4e-7, 4.4e-7, 1.7e-5.
  EXPECT_LT(arc_lambert.error, 6e-6);
  EXPECT_LT(arc.error, 6e-6);
  EXPECT_LT(switched.error, 1e-4);
  // The rational fit needs the arc's own closing angle: measured 4.3e-7. In the switch its clamp breaks the
  // side in the horizon, which nears π as the point nears the light's plane: measured 0.50, relative RMSE
  // 0.021. Published so; if it heals, it is not theirs.
  EXPECT_LT(rational_arc.error, 1e-6);
  EXPECT_GT(rational_switched.error, 0.4);
  EXPECT_GT(rational_switched.RelativeRmse(), 0.01);
  EXPECT_LT(rational_switched.RelativeRmse(), 0.04);
  // In double the arc cosine is exact but for its own slope at 1; the four terms err by 6.75e-5 rad an edge,
  // over 2π.
  EXPECT_LT(exact_stream.error, 1e-11);
  EXPECT_LT(acos_arc.error, 1e-7);
  EXPECT_LT(acos_stream.error, 1e-7);
  EXPECT_GT(fast_acos.error, 1e-5);
  EXPECT_LT(fast_acos.error, 6e-5);
  // The quadratic is the diffuse lobe's alone.
  EXPECT_LT(quadratic.error, 1e-6);
  EXPECT_GT(quadratic_lambert.error, 1e-3);
  EXPECT_LT(quadratic_lambert.error, 1.5e-2);
}

// The published fits of θ/sin θ beside the best of their form, over the acute angles: what the comments of
// the edge files and the README say.
TEST(Polygon, PublishedEdgeFitsBesideTheBestOfTheirForm) {
  using Function = std::function<double(double)>;
  const auto error = [](const Function& fit, const Function& exact) {
    double worst = 0.0;
    for (int i = 0; i < 200000; ++i) {
      const double y = i / 200000.0;
      worst = std::max(worst, std::abs(fit(y) / exact(y) - 1.0));
    }
    return worst;
  };
  const auto angle_over_sine = [](double y) { return std::acos(y) / std::sqrt((1.0 - y) * (1.0 + y)); };
  const auto angle_over_root = [](double y) { return std::acos(y) / std::sqrt(1.0 - y); };
  EXPECT_NEAR(error([](double y) { return dual::rational::AcuteAngleOverSine(y); }, angle_over_sine),
              1.459e-6, 1e-9);
  EXPECT_NEAR(error(
                  [](double y) {
                    return (5.42776659 + (3.12996384 + 0.0899517101 * y) * y) /
                           (3.45542545 + (4.19225187 + y) * y);
                  },
                  angle_over_sine),
              5.57e-7, 1e-9);
  // EdgeRatio of unit vectors with a sine of 1 is θ/sin θ.
  EXPECT_NEAR(
      error([](double y) { return dual::quadratic::LambertEdgeRatio(y, 1.0, 1.0, 1.0); }, angle_over_sine),
      7.257e-3, 1e-6);
  EXPECT_NEAR(
      error([](double y) { return 1.56375926 + (-0.860683851 + 0.301404526 * y) * y; }, angle_over_sine),
      4.480e-3, 1e-6);
  EXPECT_NEAR(
      error([](double y) { return dual::fast_acos::ArcCosine(y) / std::sqrt(1.0 - y); }, angle_over_root),
      4.77e-5, 1e-7);
  EXPECT_NEAR(
      error([](double y) { return 1.57072542 + (-0.212052558 + (0.074093359 - 0.0186164972 * y) * y) * y; },
            angle_over_root),
      4.514e-5, 1e-8);
  double angle_error = 0.0, best_angle_error = 0.0;
  for (int i = -100000; i <= 100000; ++i) {
    const double x = i / 100000.0, y = std::abs(x);
    angle_error = std::max(angle_error, std::abs(dual::fast_acos::ArcCosine(x) - std::acos(x)));
    const double best = 1.57072882 + (-0.212115243 + (0.0742623484 - 0.0187298697 * y) * y) * y;
    best_angle_error = std::max(best_angle_error, std::abs(best * std::sqrt(1.0 - y) - std::acos(y)));
  }
  EXPECT_NEAR(angle_error, 6.753e-5, 1e-8);
  EXPECT_NEAR(best_angle_error, 6.751e-5, 1e-8);
}

TEST(Polygon, VectorFormFactorOfRandomRectangles) {
  Random random;
  Worst size, height, lambert_size, lambert_height, half_angle_size;
  for (int i = 0; i < 100000; ++i) {
    const RandomRectangle rectangle = MakeRectangle(random);
    const Case c = Transformed(random, rectangle.seen);
    const dvec3 expected = VectorOf(c.Corners());
    const auto f = dual::exact::proxy::ParallelogramVector(c.center, c.a, c.b, true);
    size.Add(std::min(f.size, 1.0), glm::length(expected));
    height.Add(0.5 + 0.5 * glm::clamp(f.height, -1.0, 1.0), 0.5 + 0.5 * expected.z);
    const dvec3 expected_lambert = VectorOf(rectangle.seen.Corners());
    const auto lambert = dual::exact::proxy::LambertVector(rectangle.view);
    lambert_size.Add(std::min(lambert.size, 1.0), glm::length(expected_lambert));
    lambert_height.Add(0.5 + 0.5 * glm::clamp(lambert.height, -1.0, 1.0), 0.5 + 0.5 * expected_lambert.z);
    half_angle_size.Add(std::min(dual::half_angle::proxy::ParallelogramVector(c.center, c.a, c.b, true).size, 1.0),
                        glm::length(expected));
    // Wholly above the horizon the proxy is not asked: both techniques give F_z.
    if (c.CornersAbove() == 15 &&
        expected.z * expected.z > glm::length(expected) * glm::dot(expected, expected)) {
      EXPECT_NEAR(dual::exact::proxy::ClippedProxy(f), dual::exact::arc::ClippedVector(c.center, c.a, c.b, true).z,
                  1e-6);
    }
  }
  EXPECT_LT(size.error, 1e-11);  // measured 8.0e-14, 3.9e-14, 5.0e-14, 2.4e-14
  EXPECT_LT(height.error, 1e-11);
  EXPECT_LT(lambert_size.error, 1e-11);
  EXPECT_LT(lambert_height.error, 1e-11);
  EXPECT_LT(half_angle_size.error, 6e-6);  // the polynomial's 4.3e-7
}

// A sphere's form factor above the horizon by integrating its disk of directions, in bands of height.
double SphereByQuadrature(double size, double y) {
  // Directions of the cap of half angle σ about (√(1 − y²), 0, y): ring of polar angle t about the centre.
  const double sigma = std::asin(std::sqrt(size)), sine = std::sqrt(1.0 - y * y);
  constexpr int kRings = 4000;
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double t = (i + 0.5) / kRings * sigma;
    // z = y cos t + sine sin t cos φ, positive for φ < limit.
    const double level = y * std::cos(t), swing = sine * std::sin(t);
    const double limit = level >= swing ? kPi : level <= -swing ? 0.0 : std::acos(-level / swing);
    sum += 2.0 * (level * limit + swing * std::sin(limit)) * std::sin(t) * sigma / kRings;
  }
  return sum / kPi;
}

TEST(Polygon, ClippedSphere) {
  double exact_error = 0.0, fit_error = 0.0, fit_sum = 0.0, fit_share = 0.0, cheap_error = 0.0,
         cheap_share = 0.0;
  int count = 0;
  for (int i = 1; i <= 40; ++i) {
    for (int j = -40; j <= 40; ++j) {
      const double size = i / 40.0, y = j / 40.0;
      const double expected = SphereByQuadrature(size, y);
      exact_error = std::max(exact_error, std::abs(dual::exact::proxy::ClippedSphere(size, y) - expected));
      const double error = std::abs(dual::half_angle::fitted::ClippedSphere(size, y) - expected);
      fit_error = std::max(fit_error, error);
      fit_sum += error;
      fit_share = std::max(fit_share, error / size);
      const double cheap = std::abs(dual::half_angle::cheap::ClippedSphere(size, y) - expected);
      cheap_error = std::max(cheap_error, cheap);
      cheap_share = std::max(cheap_share, cheap / size);
      ++count;
    }
  }
  EXPECT_LT(exact_error, 1e-7);        // the quadrature's own; measured 2.6e-8
  EXPECT_LT(fit_error, 0.0060);        // measured 0.0055
  EXPECT_LT(fit_sum / count, 0.0012);  // measured 0.0010
  EXPECT_LT(fit_share, 0.0060);        // of |F|; measured 0.0056, small spheres included below
  EXPECT_NEAR(cheap_error, 0.134, 0.002);
  EXPECT_NEAR(cheap_share, 0.18, 0.005);
  for (int i = 1; i <= 60; ++i) {
    for (int j = -200; j <= 200; ++j) {
      const double size = std::pow(10.0, -0.1 * i), y = std::sqrt(size) * 1.1 * j / 200.0;
      if (std::abs(y) > 1.0) continue;
      const double exact = dual::exact::proxy::ClippedSphere(size, y);
      EXPECT_LT(std::abs(dual::half_angle::fitted::ClippedSphere(size, y) - exact), 0.0060 * size)
          << size << ' ' << y;
    }
  }
  // Wholly above nothing is clipped, wholly below nothing is left.
  EXPECT_NEAR(dual::half_angle::fitted::ClippedSphere(0.25, 0.6), 0.15, 1e-15);
  EXPECT_NEAR(dual::half_angle::fitted::ClippedSphere(0.25, -0.6), 0.0, 1e-15);
}

// Seen from straight below a corner of a rectangle parallel to the surface, and the corner at the foot of one
// perpendicular to it [Hamilton & Morgan 1952, configurations P-1 and P-3].
TEST(Polygon, FormFactorOfParallelAndPerpendicularRectangle) {
  for (const double width : {1e-3, 0.1, 1.0, 7.0, 1e3}) {
    for (const double length : {1e-3, 0.3, 1.0, 20.0}) {
      const double u = std::sqrt(1.0 + width * width), v = std::sqrt(1.0 + length * length);
      const double parallel =
          (width / u * std::atan(length / u) + length / v * std::atan(width / v)) / (2.0 * kPi);
      const Case above{{0.5 * width, 0.5 * length, 1.0}, {0.5 * width, 0.0, 0.0}, {0.0, -0.5 * length, 0.0}};
      // The smallest is taken by its centre, which is off by a third of its squared extents.
      const double small = width + length < 0.01 ? 4e-7 : 1e-9;
      EXPECT_NEAR(dual::exact::arc::ClippedVector(above.center, above.a, above.b, true).z / parallel, 1.0, small);
      EXPECT_NEAR(dual::half_angle::arc::ClippedVector(above.center, above.a, above.b, true).z / parallel, 1.0,
                  1e-5);
      // The wall x = 1, y from 0 to width, z from 0 to length.
      const double far = std::sqrt(1.0 + length * length);
      const double perpendicular = (std::atan(width) - std::atan(width / far) / far) / (2.0 * kPi);
      const Case wall{{1.0, 0.5 * width, 0.5 * length}, {0.0, 0.5 * width, 0.0}, {0.0, 0.0, -0.5 * length}};
      EXPECT_NEAR(dual::exact::arc::ClippedVector(wall.center, wall.a, wall.b, true).z, perpendicular, 1e-13);
      EXPECT_NEAR(dual::half_angle::switched::ClippedVector(wall.center, wall.a, wall.b, true).z, perpendicular,
                  3e-6 * perpendicular + 1e-12);
    }
  }
}

TEST(Polygon, FormFactorOfHalfSpaceIsOneAndOfAnEndlessWallIsHalf) {
  const dvec3 a(1e6, 0.0, 0.0), b(0.0, -1e6, 0.0);
  EXPECT_NEAR(dual::half_angle::arc::ClippedVector({0.0, 0.0, 1.0}, a, b, true).z, 1.0, 5e-6);
  EXPECT_NEAR(dual::half_angle::arc::ClippedVector({1.0, 0.0, 0.0}, b, dvec3(0.0, 0.0, 1e6), true).z, 0.5, 5e-6);
  EXPECT_NEAR(dual::half_angle::proxy::ClippedProxy(
                  dual::half_angle::proxy::ParallelogramVector({0.0, 0.0, 1.0}, a, b, true)),
              1.0, 5e-6);
}

// Points on the light's plane, edges and corners, lights level with the horizon, of no size, tiny and huge.
TEST(Polygon, DegenerateInputsStayFormFactors) {
  int count = 0;
  for (const double scale : {1e-9, 1e-4, 1.0, 1e4, 1e8}) {
    for (const double height : {-1.0, -1e-9, 0.0, 1e-9, 1.0}) {
      for (const double along : {-1.0, -0.5, 0.0, 0.5, 1.0, 2.0}) {
        for (const double tilt : {0.0, 0.25 * kPi, 0.5 * kPi, kPi}) {
          for (const double width : {0.0, 1e-6, 1.0}) {
            const double c = std::cos(tilt), s = std::sin(tilt);
            const dvec3 normal(s, 0.0, -c);
            Light light;
            light.axis_x = dvec3(c, 0.0, s);
            light.axis_y = glm::cross(normal, light.axis_x);
            light.normal = normal;
            light.half_size = scale * dvec2(width, 1.0);
            light.half_axis_x = light.axis_x * light.half_size.x;
            light.half_axis_y = light.axis_y * light.half_size.y;
            light.center =
                -normal * std::abs(height) * scale + along * (light.half_axis_x + light.half_axis_y);
            light.center.z += height < 0.0 ? height * scale : 0.0;
            const RectangleView view =
                dual::ViewRectangle(light, dvec3(0.0), {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0});
            for (const double value :
                 {dual::mirrored::arc::ClippedLambert(view), dual::mirrored::switched::ClippedLambert(view),
                  dual::mirrored::arc::ClippedVector(view.center, view.half_a, view.half_b, true).z,
                  dual::mirrored::proxy::ClippedProxy(dual::mirrored::proxy::LambertVector(view)),
                  dual::half_angle::arc::ClippedLambert(view), dual::rational::arc::ClippedLambert(view),
                  dual::exact::arc::ClippedLambert(view),
                  dual::half_angle::arc::ClippedVector(view.center, view.half_a, view.half_b, true).z,
                  dual::half_angle::switched::ClippedLambert(view),
                  dual::rational::switched::ClippedLambert(view), dual::exact::switched::ClippedLambert(view),
                  dual::half_angle::none::ClippedLambert(view),
                  dual::half_angle::stream::ClippedLambert(view), dual::acos_edge::arc::ClippedLambert(view),
                  dual::acos_edge::stream::ClippedLambert(view),
                  dual::fast_acos::stream::ClippedLambert(view), dual::quadratic::arc::ClippedLambert(view),
                  dual::half_angle::proxy::ClippedProxy(dual::half_angle::proxy::LambertVector(view)),
                  dual::half_angle::fitted::ClippedProxy(dual::half_angle::fitted::ParallelogramVector(
                      view.center, view.half_a, view.half_b, true))}) {
              ASSERT_TRUE(value >= 0.0 && value <= 1.0)
                  << value << " at scale " << scale << " height " << height << " along " << along << " tilt "
                  << tilt << " width " << width;
              ++count;
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(count, 5 * 5 * 6 * 4 * 3 * 19);
}

}  // namespace
}  // namespace arealab
