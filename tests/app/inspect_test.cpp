// What the window shows of one pixel: lights drawn on the disc, and the test case that is copied.
#include "app/view/inspect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "compare/stress_families.h"
#include "glsl/shader_library.h"

namespace arealab::inspect_test {
namespace {

// A point of a floor, its normal leaning, under one light.
Scene OneLight(const std::string& light) {
  return ParseScene("one.toml", "# ?\n[camera]\nposition = [1.0, -3.0, 2.0]\ntarget = [0.0, 0.0, 0.0]\n[[material]]\nname = \"floor\"\n[[surface]]\ntype = \"plane\"\n"
                                "size = [4.0, 4.0]\nmaterial = \"floor\"\n[[light]]\nname = \"light\"\nradiance = 2.0\n" + light);
}

SurfacePixels At(const Scene& scene, const glm::vec3& position, const glm::vec3& normal) {
  return {1, 1, glm::vec3(scene.camera.position), {glm::vec4(position, 1.0f)}, {glm::vec4(glm::normalize(normal), 0.4f)}, {glm::vec4(0.5f, 0.5f, 0.5f, 0.0f)}, {}};
}

double Area(const std::vector<glm::vec2>& polygon) {
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a(polygon[i]), b(polygon[(i + 1) % polygon.size()]);
    area += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return std::abs(area);
}

const char* const kLights[] = {
    "shape = \"rectangle\"\nposition = [0.3, 0.8, 1.0]\nnormal = [0.0, -1.0, -0.6]\nsize = [1.2, 0.7]\n",
    "shape = \"rectangle\"\nposition = [0.3, 0.8, 0.1]\nnormal = [0.0, -1.0, 0.0]\nsize = [2.0, 1.5]\n",  // cut by the horizon
    "shape = \"disk\"\nposition = [-0.5, 0.9, 0.2]\nnormal = [0.2, -1.0, 0.0]\nradius = 0.6\n",
    "shape = \"ellipse\"\nposition = [-0.5, 0.9, 0.8]\nnormal = [0.2, -1.0, 0.0]\nradii = [0.6, 0.2]\n",
    "shape = \"sphere\"\nposition = [0.2, 0.9, 0.3]\nradius = 0.5\n",
    "shape = \"tube\"\nposition = [0.2, 0.9, 0.4]\naxis = [1.0, 0.3, 0.1]\nlength = 1.6\nradius = 0.1\n",
    "shape = \"polygon\"\nposition = [0.0, 0.9, 0.7]\nnormal = [0.0, -1.0, 0.0]\ncorners = [[-0.6, -0.3], [0.6, -0.4], [0.1, 0.5]]\n",
    "shape = \"rectangle\"\nposition = [0.3, 0.8, 1.0]\nnormal = [0.1, 1.0, 0.6]\nsize = [1.2, 0.7]\ntwo_sided = true\n",  // its back
    "shape = \"polygon\"\nposition = [0.0, 0.9, 0.7]\nnormal = [0.0, 1.0, 0.0]\ncorners = [[-0.6, -0.3], [0.6, -0.4], [0.1, 0.5]]\ntwo_sided = true\n",
};

TEST(Inspect, ALightsShareOfTheDiscIsItsFormFactor) {
  for (const char* light : kLights) {
    const Scene scene = OneLight(light);
    for (const glm::vec3& normal : {glm::vec3(0.0f, 0.0f, 1.0f), glm::vec3(0.3f, -0.2f, 1.0f)}) {
      const Inspection seen = InspectPixel(scene, At(scene, {0.1f, 0.0f, 0.0f}, normal), 0);
      ASSERT_TRUE(seen.surface);
      ASSERT_EQ(seen.picture.lights.size(), 1u) << light;
      EXPECT_GT(seen.form_factor, 0.003) << light;
      // 128 points of a circle lack (2π/128)²/6 = 0.04 % of its area, of a slice of it three times that; edges drawn 1° at a time less.
      EXPECT_NEAR(Area(seen.picture.lights[0]) / glm::pi<double>() / seen.form_factor, 1.0, 2e-3) << light;
    }
  }
}

TEST(Inspect, ALightThatFacesAwayIsNotDrawn) {
  const Scene scene = OneLight("shape = \"rectangle\"\nposition = [0.3, 0.8, 1.0]\nnormal = [0.0, 1.0, 0.6]\nsize = [1.2, 0.7]\n");
  const Inspection seen = InspectPixel(scene, At(scene, {0.1f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}), 0);
  EXPECT_TRUE(seen.surface);
  EXPECT_TRUE(seen.picture.lights.empty());
  EXPECT_EQ(seen.form_factor, 0.0);
}

TEST(Inspect, TheTestCaseReadBackIsThePixel) {
  for (const char* light : kLights) {
    const Scene scene = OneLight(light);
    const Inspection seen = InspectPixel(scene, At(scene, {0.1f, 0.0f, 0.0f}, {0.3f, -0.2f, 1.0f}), 0);
    const PointCase read = ParseCase(CaseLine(seen.lights.at(0).test_case));
    const LightIntegrals truth = read.Truth(1e-6);
    EXPECT_NEAR(0.5 * read.radiance * truth.form_factor / seen.truth.diffuse.x, 1.0, 2e-6) << light;
    const double specular = read.radiance * (read.f0 * (truth.specular - truth.specular_grazing) + truth.specular_grazing);
    EXPECT_NEAR(specular / seen.truth.specular.x, 1.0, 2e-4) << light;  // the tolerance of the truth that is shown
  }
}

TEST(Inspect, TheLobeFromTheSideReachesTheRimAtItsPeakAndEndsAtTheHorizon) {
  const Scene scene = OneLight(kLights[0]);
  Inspection seen = InspectPixel(scene, At(scene, {0.1f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}), 0);
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  AddFittedLobe(seen, scene.brdf, *FindFittedLobe(library, ParseVariant(techniques, "ltc"), scene.brdf, seen.roughness, seen.n_dot_v), "ltc");
  const auto farthest = [](const std::vector<glm::vec2>& line) {
    return *std::ranges::max_element(line, {}, [](const glm::vec2& p) { return glm::length(p); });
  };
  const glm::vec2 brdf = farthest(seen.picture.brdf), ltc = farthest(seen.picture.ltc);
  EXPECT_NEAR(glm::length(brdf), 1.0, 1e-4);
  EXPECT_NEAR(-brdf.x, seen.picture.to_view.x, 0.05f);  // about the mirrored view
  EXPECT_NEAR(glm::length(ltc), 1.0, 0.03);             // a tenth is a third of the radius
  EXPECT_LT(glm::distance(brdf, ltc), 0.1f);
  for (const glm::vec2& p : seen.picture.brdf) EXPECT_GE(p.y, 0.0f);
  // Rays of the plane of incidence meet the light just within the span that is drawn, and not just without.
  ASSERT_EQ(seen.picture.spans.size(), 1u);
  const Light& light = scene.lights[0];
  const glm::dvec3 position(0.1f, 0.0, 0.0), across = glm::normalize((scene.camera.position - position) * glm::dvec3(1.0, 1.0, 0.0));
  const auto meets = [&](double angle) {
    const glm::dvec3 direction = std::sin(angle) * across + std::cos(angle) * glm::dvec3(0.0, 0.0, 1.0);
    const double t = glm::dot(light.center - position, light.normal) / glm::dot(direction, light.normal);
    const glm::dvec3 from_center = position + t * direction - light.center;
    return t > 0.0 && std::abs(glm::dot(from_center, light.axis_x)) < light.half_size.x && std::abs(glm::dot(from_center, light.axis_y)) < light.half_size.y;
  };
  const auto& [from, to] = seen.picture.spans[0];
  EXPECT_TRUE(meets(from + 1e-3) && meets(0.5 * (from + to)) && meets(to - 1e-3));
  EXPECT_FALSE(meets(from - 1e-3) || meets(to + 1e-3));
}

}  // namespace
}  // namespace arealab::inspect_test
