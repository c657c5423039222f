// The LTC shaders' frame, look-up and transform, in double, and that they read the tables as the fit wrote
// them.
#include <gtest/gtest.h>

#include <random>

#include "glsl/fit.h"

#include "glsl/dual_begin.h"

#include "glsl/brdf.glsl"
#include "glsl/ltc.glsl"

namespace mirror {
#include "glsl/frame/mirror.glsl"
}
namespace normal {
#include "glsl/frame/normal.glsl"
}
namespace middle {
#include "glsl/norm/middle.glsl"
}
namespace none {
#include "glsl/norm/none.glsl"
}
namespace last {
#include "glsl/norm/last.glsl"
}
namespace polygon {
#include "glsl/fit/polygon.glsl"
#include "glsl/axis/sqrt.glsl"
}  // namespace polygon
namespace l3 {
#include "glsl/fit/l3.glsl"
#include "glsl/axis/sqrt.glsl"
}  // namespace l3
namespace over_cos {
#include "glsl/axis/cos.glsl"
}
namespace over_theta {
#include "glsl/axis/theta.glsl"
}
namespace one {
#include "glsl/lobes/one.glsl"
}
namespace cosine {
#include "glsl/lobes/cosine.glsl"
}
namespace two {
#include "glsl/lobes/two.glsl"
}
namespace whole {
#include "glsl/fresnel/lobe.glsl"
}
namespace towards {
#include "glsl/fresnel/direction.glsl"
}
#include "glsl/edge/mirrored.glsl"
namespace clipped {
#include "glsl/clip/arc.glsl"
}
namespace own_horizon {
using clipped::ClippedVector;
#include "glsl/horizon/lobe.glsl"
}  // namespace own_horizon
namespace true_horizon {
#include "glsl/horizon/true.glsl"
}

#include "glsl/dual_end.h"

namespace arealab {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

dvec3 RandomDirection(std::mt19937_64& engine) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (;;) {
    const dvec3 v(uniform(engine), uniform(engine), uniform(engine));
    const double length = glm::length(v);
    if (length > 0.01 && length < 1.0) return v / length;
  }
}

TEST(Ltc, FrameIsOrthonormalAndFacesTheViewer) {
  std::mt19937_64 engine(1);
  for (int i = 0; i < 2000; ++i) {
    const dvec3 normal = RandomDirection(engine);
    dvec3 to_view = RandomDirection(engine);
    if (i % 4 == 1) to_view = normal;
    if (i % 4 == 2) to_view = glm::normalize(normal + std::pow(0.1, i % 12) * to_view);
    if (glm::dot(normal, to_view) < 0.0) to_view = -to_view;
    const dual::ShadingFrame frame = dual::MakeShadingFrame(normal, to_view);
    EXPECT_NEAR(glm::length(frame.tangent), 1.0, 1e-12);
    EXPECT_NEAR(glm::length(frame.bitangent), 1.0, 1e-9);
    EXPECT_NEAR(glm::dot(frame.tangent, normal), 0.0, 1e-9);
    EXPECT_NEAR(glm::dot(frame.tangent, frame.bitangent), 0.0, 1e-12);
    EXPECT_GT(glm::dot(glm::cross(frame.tangent, frame.bitangent), normal), 0.999);
    EXPECT_GE(glm::dot(frame.tangent, to_view), -1e-4);
    EXPECT_NEAR(frame.sine, glm::length(glm::cross(normal, to_view)), 1e-15);
  }
}

TEST(Ltc, MirrorFrameStorageTurnsBack) {
  const double c = 0.3, s = std::sqrt(1.0 - c * c);
  const dvec4 m(1.7, -0.2, 0.4, 0.9);  // m0, m1, m2, m3
  const dvec4 stored(m[0] * c + m[2] * s, m[1] * c + m[3] * s, m[2] * c - m[0] * s, m[3] * c - m[1] * s);
  EXPECT_LT(glm::length(dual::mirror::LtcUnturned(stored, c, s) - m), 1e-15);
}

// With the identity the transformed cosine is the clamped cosine, and nothing else than the Lambert form
// factor may come out.
TEST(Ltc, IdentityIsTheClampedCosine) {
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> uniform(0.1, 2.0);
  for (int i = 0; i < 2000; ++i) {
    dual::Light light;
    light.center = 2.0 * RandomDirection(engine);
    light.normal = RandomDirection(engine);
    if (glm::dot(light.normal, light.center) > 0.0) light.normal = -light.normal;
    light.axis_x = glm::normalize(glm::cross(light.normal, RandomDirection(engine)));
    light.axis_y = glm::cross(light.normal, light.axis_x);
    light.half_size = {uniform(engine), uniform(engine)};
    light.half_axis_x = light.axis_x * light.half_size.x;
    light.half_axis_y = light.axis_y * light.half_size.y;
    const dual::ShadingFrame frame = dual::MakeShadingFrame(RandomDirection(engine), RandomDirection(engine));
    const auto view = dual::ViewRectangle(light, dvec3(0.0), frame.tangent, frame.bitangent, frame.normal);
    const dvec4 identity(1.0, 0.0, 0.0, 1.0);
    const double lobe = dual::clipped::ClippedVector(dual::LtcTransform(identity, view.center),
                                                     dual::LtcTransform(identity, view.half_a),
                                                     dual::LtcTransform(identity, view.half_b), true)
                            .z;
    EXPECT_NEAR(lobe, dual::clipped::ClippedLambert(view), 1e-6);  // the two edge polynomials'
  }
}

const double kSine = std::sqrt(0.75);

TEST(Ltc, FresnelOfTheWholeLobeLiesBetweenF0AndOne) {
  const dvec4 terms(0.9, 0.1, 0.0, 0.0), m(1.0, 0.0, 0.0, 1.0);
  EXPECT_NEAR(dual::whole::LtcReflectance(dvec3(1.0), terms, m, 0.5, kSine, dvec3(0.0)).x, 0.9, 1e-15);
  EXPECT_NEAR(dual::whole::LtcReflectance(dvec3(0.0), terms, m, 0.5, kSine, dvec3(0.0)).x, 0.1, 1e-15);
  EXPECT_NEAR(dual::whole::LtcReflectance(dvec3(0.04), terms, m, 0.5, kSine, dvec3(0.0)).x, 0.04 * 0.8 + 0.1,
              1e-15);
}

// A light that covers the lobe gets its average; a small one Schlick's value where it stands, brought back by
// M.
TEST(Ltc, FresnelTowardsTheLight) {
  const dvec4 terms(0.9, 0.1, 0.0, 0.0), m(1.3, -0.2, 0.4, 0.6);
  const double n_dot_v = 0.4, sine = std::sqrt(1.0 - n_dot_v * n_dot_v);
  EXPECT_NEAR(dual::towards::LtcReflectance(dvec3(0.04), terms, m, n_dot_v, sine, dvec3(0.0, 0.0, 1.0)).x,
              0.04 * 0.8 + 0.1, 1e-12);
  const dvec3 to_view(sine, 0.0, n_dot_v);
  for (const dvec3 to_light : {dvec3(-0.9, 0.1, 0.3), dvec3(0.2, 0.7, 0.6), dvec3(0.0, 0.0, 1.0)}) {
    const dvec3 transformed = 1e-9 * glm::normalize(dual::LtcTransform(m, to_light));
    const double v_dot_h = glm::dot(to_view, glm::normalize(to_view + glm::normalize(to_light)));
    const double expected = 0.9 * (0.04 + 0.96 * std::pow(1.0 - v_dot_h, 5.0));
    EXPECT_NEAR(dual::towards::LtcReflectance(dvec3(0.04), terms, m, n_dot_v, sine, transformed).x, expected,
                1e-8);
  }
  EXPECT_TRUE(
      std::isfinite(dual::towards::LtcReflectance(dvec3(0.04), terms, m, n_dot_v, sine, dvec3(0.0)).x));
}

// As a sampler does it: bilinear, clamped to the edge, texel (i, j)'s centre at (i + ½, j + ½) / size.
dvec4 Sample(const std::vector<glm::vec4>& texels, int size, dvec2 uv) {
  const glm::ivec2 sizes(size, static_cast<int>(texels.size()) / size);
  const dvec2 p = glm::clamp(uv * dvec2(sizes) - 0.5, dvec2(0.0), dvec2(sizes - 1));
  const glm::ivec2 low(p), high = glm::min(low + 1, sizes - 1);
  const dvec2 f = p - dvec2(low);
  const auto at = [&](int x, int y) { return dvec4(texels[static_cast<std::size_t>(y * size + x)]); };
  return glm::mix(glm::mix(at(low.x, low.y), at(high.x, low.y), f.x),
                  glm::mix(at(low.x, high.y), at(high.x, high.y), f.x), f.y);
}

TEST(Ltc, TablesAreReadAsTheFitWroteThem) {
  using Position = double (*)(double, double);
  using Normalised = dvec4 (*)(dvec4, dvec4);
  using Unturned = dvec4 (*)(dvec4, double, double);
  const Normalised norms[] = {dual::middle::LtcNormalised, dual::none::LtcNormalised,
                              dual::last::LtcNormalised};
  const Unturned frames[] = {dual::mirror::LtcUnturned, dual::normal::LtcUnturned};
  for (const FitKind kind : {FitKind::kPolygon, FitKind::kCosine, FitKind::kHorizon, FitKind::kPublished, FitKind::kTwo}) {
    for (const LtcStorage& storage : StoragesOf(Brdf::kGgx, kind)) {
      SCOPED_TRACE(MatrixFile(Brdf::kGgx, kind, storage));
      const Position root =
          kind == FitKind::kPublished ? dual::l3::LtcViewPosition : dual::polygon::LtcViewPosition;
      const Position positions[] = {root, dual::over_cos::LtcViewPosition, dual::over_theta::LtcViewPosition};
      const LtcTables tables = ReadLtcTables(AREALAB_SOURCE_DIR "/glsl/tables", Brdf::kGgx, kind, storage);
      ASSERT_EQ(tables.size, 64);  // TableCoordinates takes it for granted
      std::mt19937_64 engine(3);
      std::uniform_real_distribution<double> uniform(0.0, 1.0);
      for (int i = 0; i < 1000; ++i) {
        const double roughness = uniform(engine), cosine = std::max(uniform(engine), dual::kMinViewCosine),
                     sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
        const LtcLookup expected = Look(tables, roughness, cosine);
        const dvec2 uv =
            dual::TableCoordinates(roughness, positions[static_cast<int>(storage.axis)](cosine, sine));
        const dvec4 terms = Sample(tables.terms, tables.size, uv);
        const auto matrix = [&](dvec2 at) {
          return frames[static_cast<int>(storage.frame)](norms[static_cast<int>(storage.norm)](Sample(tables.matrix, tables.size, at), terms), cosine, sine);
        };
        const dvec4 m = matrix(kind == FitKind::kTwo ? dual::two::FirstLobe(uv) : dual::one::FirstLobe(uv));
        const dvec4 second = kind == FitKind::kTwo ? matrix(dual::two::SecondLobe(uv)) : expected.second;
        EXPECT_LT(glm::length(second - expected.second), 1e-9 * glm::length(second));
        EXPECT_LT(glm::length(m - expected.m), 1e-9 * glm::length(m)) << roughness << ' ' << cosine;
        EXPECT_LT(glm::length(terms - expected.terms), 1e-9 * (1.0 + glm::length(terms)));
        // Facing is kept, and with it the polygon's order.
        EXPECT_GT(m.x * m.w - m.y * m.z, 0.0) << roughness << ' ' << cosine;
      }
    }
  }
}

// Both horizons against the fit's own polygon clipper; a light wholly below the surface's gives nothing.
TEST(Ltc, TrueHorizonClipsTwice) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> uniform(-0.6, 0.6), size(0.1, 2.0);
  int leaks = 0;
  for (int i = 0; i < 4000; ++i) {
    const dvec4 m(1.0 + uniform(engine), uniform(engine), uniform(engine), 0.8 + uniform(engine));
    if (m.x * m.w - m.y * m.z < 0.05) continue;
    dual::RectangleView view{};
    view.center = RandomDirection(engine);
    const dvec3 axis = RandomDirection(engine);
    view.half_a = size(engine) * glm::normalize(glm::cross(axis, RandomDirection(engine)));
    view.half_b = size(engine) * glm::normalize(glm::cross(axis, view.half_a));
    if (glm::dot(glm::cross(view.half_a, view.half_b), view.center) > 0.0) view.half_b = -view.half_b;
    // The part above the surface's horizon, transformed and clipped by LtcQuadIntegral, in strips of one
    // quadrilateral each.
    const std::array<dvec3, 4> corners{
        view.center + view.half_a + view.half_b, view.center - view.half_a + view.half_b,
        view.center - view.half_a - view.half_b, view.center + view.half_a - view.half_b};
    std::vector<dvec3> above;
    for (std::size_t k = 0; k < 4; ++k) {
      const dvec3 a = corners[k], b = corners[(k + 1) % 4];
      if (a.z > 0.0) above.push_back(a);
      if ((a.z > 0.0) != (b.z > 0.0)) above.push_back(a + (b - a) * (a.z / (a.z - b.z)));
    }
    double expected = 0.0;
    for (std::size_t k = 2; k < above.size(); ++k)
      expected += LtcQuadIntegral(m, {above[0], above[k - 1], above[k], above[k]});
    const double both = dual::true_horizon::LobeVector(m, view).z;
    const double own = dual::own_horizon::LobeVector(m, view).z;
    EXPECT_NEAR(both, expected, 4e-6);  // the edge's polynomial: 3.0e-6; measured 2.0e-6
    EXPECT_LT(both, own + 4e-6);
    leaks += both < own - 1e-3 ? 1 : 0;
  }
  EXPECT_GT(leaks, 400);
}

TEST(Ltc, CosineLobeAddsTheFormFactorAndStaysALobe) {
  EXPECT_EQ(dual::one::LtcLobe(0.4, 0.2, dvec4(1.0, 0.0, 0.5, 0.0)), 0.4);
  EXPECT_NEAR(dual::cosine::LtcLobe(0.4, 0.2, dvec4(1.0, 0.0, 0.5, 0.0)), 0.5, 1e-15);
  EXPECT_EQ(dual::cosine::LtcLobe(0.0, 0.2, dvec4(1.0, 0.0, -0.5, 0.0)), 0.0);
}

}  // namespace
}  // namespace arealab
