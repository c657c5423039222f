#include "glsl/renderer.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <glad/gl.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <map>

#include "compare/context.h"
#include "glsl/light_block.h"
#include "glsl/table.h"
#include "scenes/error.h"
#include "scenes/shapes.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::renderer_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr glm::ivec2 kSize{48, 36};

// A float's rounding, relative.
constexpr double kFloatRounding = 6e-8;

std::string ErrorOf(const std::function<void()>& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// The direction through a pixel's centre, not unit, made again from the camera alone; (x, y) from the upper
// left.
glm::dvec3 PixelRay(const Camera& camera, glm::ivec2 size, double x, double y) {
  const glm::dvec3 forward = glm::normalize(camera.target - camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::dvec3 up = glm::cross(right, forward);
  const double scale = 2.0 * std::tan(0.5 * camera.vertical_fov) / size.y;
  return forward + scale * (x + 0.5 - 0.5 * size.x) * right - scale * (y + 0.5 - 0.5 * size.y) * up;
}

Light MakeLight(LightShape shape) {
  Light light;
  light.shape = shape;
  light.center = {0.3, 0.6, 1.2};
  light.axis_x = glm::normalize(glm::dvec3(1.0, 0.2, 0.0));
  light.normal = glm::normalize(glm::cross(light.axis_x, glm::dvec3(0.1, 1.0, 0.3)));
  if (light.normal.z > 0.0) {  // down, to the floor
    light.normal = -light.normal;
    light.axis_x = -light.axis_x;
  }
  light.axis_y = glm::cross(light.normal, light.axis_x);
  light.half_size = shape == LightShape::kRectangle ? glm::dvec2(0.4, 0.15) : glm::dvec2(0.2);
  light.radiance = {3.0, 2.0, 1.0};
  return light;
}

// A floor, a ball on it, one light above.
Scene MakeScene(LightShape shape) {
  Scene scene;
  scene.camera = {.position = {0.5, -3.0, 1.5}, .target = {0.0, 0.0, 0.2}};
  scene.materials.resize(2);
  scene.materials[0].roughness = glm::vec2(0.4f, 0.6f);
  scene.materials[0].base_color = {0.7f, 0.5f, 0.3f};
  scene.materials[1].roughness = glm::vec2(0.5f);
  scene.materials[1].base_color = {0.9f, 0.8f, 0.6f};
  scene.materials[1].metalness = 0.75f;
  scene.meshes.push_back(MakePlane({4.0, 4.0}, {}));
  scene.meshes.push_back(MakeSphere(0.4, {.position = {-0.5, -0.4, 0.4}}));
  scene.meshes[1].material = 1;
  scene.lights.push_back(MakeLight(shape));
  return scene;
}

// A scene that is all floor: the plane z = 0 seen from above.
Scene Floor() {
  Scene scene;
  scene.camera = {.position = {0.0, -1.0, 4.0}, .target = {0.0, 0.0, 0.0}, .vertical_fov = 0.6};
  scene.materials.resize(1);
  scene.meshes.push_back(MakePlane({40.0, 40.0}, {}));
  return scene;
}

class Drawing : public testing::TestWithParam<ContextKind> {
 protected:
  std::unique_ptr<Context> context_ = CreateContext(GetParam());
  ShaderLibrary library_;
};

INSTANTIATE_TEST_SUITE_P(Kind, Drawing, testing::Values(ContextKind::kOsmesa, ContextKind::kEgl),
                         [](const auto& kind) { return kind.param == ContextKind::kEgl ? "Egl" : "Osmesa"; });

class Rendering : public testing::Test {
 protected:
  Variant Named(const std::string& name) { return ParseVariant(techniques_, name); }

  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
  ShaderLibrary library_;
  std::vector<Technique> techniques_ = LoadTechniques(library_);
};

// --- The G-buffer
// -----------------------------------------------------------------------------------------------------

TEST_P(Drawing, PlaneIsWhereItsRaysMeetIt) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = Floor();
  scene.camera.position = {0.25, -3.0, 1.5};        // a float holds it exactly
  scene.meshes[0] = MakePlane({200.0, 200.0}, {});  // reaches far behind the camera
  scene.camera.target = {0.0, 0.0, -1.5};
  const SurfacePixels& pixels = renderer.DrawScene(scene, kSize);
  ASSERT_EQ(pixels.size(), 48u * 36u);
  EXPECT_EQ(pixels.view_position, glm::vec3(scene.camera.position));
  for (int y = 0; y < kSize.y; ++y) {
    for (int x = 0; x < kSize.x; ++x) {
      const auto i = static_cast<std::size_t>(y * kSize.x + x);
      ASSERT_TRUE(pixels.IsSurface(i));
      const glm::dvec3 ray = PixelRay(scene.camera, kSize, x, y);
      const glm::dvec3 expected = scene.camera.position - scene.camera.position.z / ray.z * ray;
      const glm::dvec3 found(pixels.position[i]);
      ASSERT_EQ(found.z, 0.0);
      for (int axis = 0; axis < 2; ++axis) {
        ASSERT_NEAR(found[axis], expected[axis], kFloatRounding * std::abs(expected[axis]) + 1e-12)
            << x << "," << y;
      }
      ASSERT_EQ(glm::vec3(pixels.normal[i]), glm::vec3(0.0f, 0.0f, 1.0f));
    }
  }
}

TEST_P(Drawing, TopRowIsUpAndXGoesRight) {
  Renderer renderer(context_->gl(), library_);
  const SurfacePixels& pixels = renderer.DrawScene(Floor(), kSize);
  const auto at = [&](int x, int y) { return pixels.position[static_cast<std::size_t>(y * kSize.x + x)]; };
  EXPECT_GT(at(24, 0).y, at(24, 35).y + 1.0f);  // far is up
  EXPECT_GT(at(47, 18).x,
            at(0, 18).x + 1.0f);  // +x is right of a viewer who looks along +y: right-handed, z up
}

TEST_P(Drawing, SphereHasItsPointsAndNormals) {
  Renderer renderer(context_->gl(), library_);
  Scene scene;
  scene.camera = {.position = {0.0, -4.0, 1.0}, .target = {0.5, 0.0, 0.5}};
  scene.materials.resize(1);
  const glm::dvec3 center(0.5, 0.25, 0.5);
  scene.meshes.push_back(MakeSphere(0.75, {.position = center}));
  const SurfacePixels& pixels = renderer.DrawScene(scene, kSize);
  int seen = 0;
  int beside =
      0;  // points beside their ray: on the outline, where coverage is decided on a grid of 1/256 pixel
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!pixels.IsSurface(i)) continue;
    ++seen;
    const glm::dvec3 outward = glm::dvec3(pixels.position[i]) - center;
    // The mesh's triangles lie at most 1.6e-4 radii inside (scenes/shapes.h).
    ASSERT_NEAR(glm::length(outward), 0.75, 0.75 * 1.6e-4 + 1e-6);
    ASSERT_LT(glm::distance(glm::dvec3(pixels.normal[i]), glm::normalize(outward)), 2e-4);
    const int x = static_cast<int>(i) % kSize.x;
    const int y = static_cast<int>(i) / kSize.x;
    const glm::dvec3 ray = glm::normalize(PixelRay(scene.camera, kSize, x, y));
    const double off = glm::length(glm::cross(glm::dvec3(pixels.position[i]) - scene.camera.position, ray));
    const double pixel = 4.0 * 2.0 * std::tan(0.35) / kSize.y;  // m, about
    ASSERT_LT(off, pixel / 64.0);
    beside += off > 1e-6;
  }
  EXPECT_LE(beside, seen / 50);
  // The cone's half angle is asin(r/d): its disk on the picture has this many pixels, seen nearly in the
  // middle.
  const double distance = glm::distance(center, scene.camera.position);
  const double radius =
      0.75 / std::sqrt(distance * distance - 0.75 * 0.75) * kSize.y / (2.0 * std::tan(0.35));
  EXPECT_NEAR(seen, glm::pi<double>() * radius * radius, 0.05 * seen);
}

TEST_P(Drawing, RampRoughnessAndConstantMaterialAreExact) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = Floor();
  scene.meshes[0] = MakePlane({4.0, 4.0}, {});
  scene.materials[0].base_color = {0.1f, 0.7f, 0.3f};
  scene.materials[0].metalness = 0.3f;
  scene.materials[0].roughness = {0.1f, 0.9f};
  const SurfacePixels& pixels = renderer.DrawScene(scene, kSize);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!pixels.IsSurface(i)) continue;
    const double u = pixels.position[i].x / 4.0 + 0.5;
    ASSERT_NEAR(pixels.normal[i].w, 0.1 + 0.8 * u, 2e-7);
    ASSERT_EQ(pixels.base_color[i], glm::vec4(0.1f, 0.7f, 0.3f, 0.3f));
  }
  scene.materials[0].roughness = glm::vec2(0.3f);
  for (const glm::vec4& normal : renderer.DrawScene(scene, kSize).normal)
    ASSERT_TRUE(normal.w == 0.3f || normal.w == 0.0f);
}

TEST_P(Drawing, TextureRowZeroIsTheTop) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = Floor();
  scene.camera.position = {0.0, -0.01, 4.0};  // from above, +y up
  scene.meshes[0] = MakePlane({2.0, 2.0}, {});
  auto image = std::make_shared<Image>(Image{2, 2, {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}}});
  scene.materials[0].base_color = glm::vec3(0.5f);
  scene.materials[0].base_color_texture = image;
  const SurfacePixels& pixels = renderer.DrawScene(scene, {64, 64});
  std::map<std::pair<bool, bool>, glm::vec3> seen;  // (right, top) → colour near the quadrant's centre
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const glm::vec2 p(pixels.position[i]);
    if (pixels.IsSurface(i) && glm::distance(glm::abs(p), glm::vec2(0.5f)) < 0.05f) {
      seen[{p.x > 0.0f, p.y > 0.0f}] = glm::vec3(pixels.base_color[i]);
    }
  }
  // Linear filtering mixes in at most 0.05 of a neighbour in either direction.
  ASSERT_EQ(seen.size(), 4u);
  const auto near = [](glm::vec3 a, glm::vec3 b) { return glm::distance(a, 0.5f * b) < 0.1f; };
  EXPECT_TRUE(near(seen.at({false, true}), {1, 0, 0}));
  EXPECT_TRUE(near(seen.at({true, true}), {0, 1, 0}));
  EXPECT_TRUE(near(seen.at({false, false}), {0, 0, 1}));
  EXPECT_TRUE(near(seen.at({true, false}), {1, 1, 1}));
}

TEST_P(Drawing, FineTextureIsAveragedByItsMipmaps) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = Floor();
  auto image = std::make_shared<Image>(Image{512, 512, {}});
  for (int i = 0; i < 512 * 512; ++i)
    image->pixels.emplace_back(glm::vec4((i + i / 512) % 2 == 0 ? 1.0f : 0.0f));
  scene.materials[0].base_color_texture = image;
  scene.materials[0].base_color = glm::vec3(1.0f);
  scene.meshes[0] = MakePlane({10.0, 10.0}, {});  // some ten texels a pixel
  const SurfacePixels& pixels = renderer.DrawScene(scene, {24, 24});
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!pixels.IsSurface(i)) continue;
    ASSERT_NEAR(pixels.base_color[i].x, 0.5f, 1e-3f);
  }
}

TEST_P(Drawing, NormalAndRoughnessMapsFollowGltf) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = Floor();
  const glm::vec3 tilted = glm::normalize(glm::vec3(0.3f, 0.2f, 0.9f));  // right along u, up against v
  scene.materials[0].normal_texture =
      std::make_shared<Image>(Image{1, 1, {glm::vec4(0.5f * tilted + 0.5f, 1.0f)}});
  scene.materials[0].metallic_roughness_texture =
      std::make_shared<Image>(Image{1, 1, {glm::vec4(0.9f, 0.5f, 0.25f, 1.0f)}});
  scene.materials[0].roughness = glm::vec2(0.8f);
  scene.materials[0].metalness = 1.0f;
  const SurfacePixels& pixels = renderer.DrawScene(scene, kSize);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ASSERT_LT(glm::distance(glm::vec3(pixels.normal[i]), tilted), 1e-6f);
    ASSERT_NEAR(pixels.normal[i].w, 0.4f, 1e-6f);
    ASSERT_NEAR(pixels.base_color[i].w, 0.25f, 1e-6f);
  }
}

TEST_P(Drawing, EmittersAreNumberedBySide) {
  Renderer renderer(context_->gl(), library_);
  Scene scene;
  scene.camera = {.position = {0.0, -4.0, 0.0}, .target = {0.0, 0.0, 0.0}};
  const auto add = [&](LightShape shape, double x, bool towards_viewer, bool two_sided) {
    Light light;
    light.shape = shape;
    light.center = {x, 0.0, 0.0};
    light.axis_x = {towards_viewer ? 1.0 : -1.0, 0.0, 0.0};
    light.axis_y = {0.0, 0.0, 1.0};
    light.normal = glm::cross(light.axis_x, light.axis_y);
    light.half_size = glm::dvec2(0.2);
    light.two_sided = two_sided;
    scene.lights.push_back(light);
  };
  add(LightShape::kRectangle, -1.2, true, false);
  add(LightShape::kRectangle, -0.6, false, false);
  add(LightShape::kDisk, 0.0, false, true);
  add(LightShape::kDisk, 0.6, false, false);
  add(LightShape::kSphere, 1.2, false, false);
  const SurfacePixels& pixels = renderer.DrawScene(scene, {97, 33});
  std::map<float, std::pair<int, double>> kinds;  // kind → pixels, sum of x
  for (const glm::vec4& p : pixels.position) {
    kinds[p.w].first += 1;
    kinds[p.w].second += p.x;
  }
  EXPECT_THAT(kinds,
              testing::UnorderedElementsAre(testing::Key(0.0f), testing::Key(2.0f), testing::Key(-3.0f),
                                            testing::Key(4.0f), testing::Key(-5.0f), testing::Key(6.0f)));
  for (const auto& [kind, sum] : kinds) {
    if (kind == 0.0f) continue;
    EXPECT_NEAR(sum.second / sum.first, -1.2 + 0.6 * (std::abs(kind) - 2.0), 0.05) << kind;
  }
}

TEST_P(Drawing, DepthTellsAMillimetreAtTwentyMetres) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = Floor();
  scene.camera.position = {0.0, -12.0, 16.0};
  scene.meshes[0] = MakePlane({400.0, 400.0}, {});
  // Drawn before and after the floor: neither the first nor the last wins, but the nearer.
  scene.meshes.insert(scene.meshes.begin(), MakePlane({400.0, 400.0}, {.position = {0.0, 0.0, 0.001}}));
  scene.meshes.push_back(MakePlane({400.0, 400.0}, {.position = {0.0, 0.0, -0.001}}));
  for (const glm::vec4& p : renderer.DrawScene(scene, kSize).position) ASSERT_EQ(p.z, 0.001f);
}

TEST_P(Drawing, NearSurfaceIsNotCutAway) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = Floor();
  scene.camera = {.position = {0.0, 0.0, 0.001953125},
                  .target = {0.0, 1.0, -0.5}};  // 2 mm above a floor of 40 m
  for (const glm::vec4& p : renderer.DrawScene(scene, kSize).position) ASSERT_EQ(p.w, 1.0f);
}

TEST_P(Drawing, SizesAreChecked) {
  Renderer renderer(context_->gl(), library_);
  for (const glm::ivec2 size : {glm::ivec2(0, 10), glm::ivec2(10, 0), glm::ivec2(-1, 5),
                                glm::ivec2(100000, 10), glm::ivec2(10, 8193)}) {
    const std::string error = ErrorOf([&] { renderer.DrawScene(Floor(), size); });
    EXPECT_THAT(error, HasSubstr("; expected 1 to 8192"));
    EXPECT_THAT(error, Not(HasSubstr("\n")));
  }
  EXPECT_EQ(renderer.DrawScene(Floor(), {8192, 2}).size(), 16384u);
  EXPECT_EQ(renderer.DrawScene(Floor(), {1, 1}).size(), 1u);
}

TEST_P(Drawing, BuiltInScenesHaveUnitNormals) {
  Renderer renderer(context_->gl(), library_);
  for (const auto& file : BuiltInScenes()) {
    const Scene scene = LoadScene(file);
    const SurfacePixels& pixels = renderer.DrawScene(scene, {64, 64});
    int surfaces = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (!pixels.IsSurface(i)) continue;
      ++surfaces;
      ASSERT_NEAR(glm::length(glm::dvec3(pixels.normal[i])), 1.0, 2e-7) << scene.name;
      ASSERT_TRUE(pixels.normal[i].w >= 0.0f && pixels.normal[i].w <= 1.0f) << scene.name;
    }
    EXPECT_GT(surfaces, 64 * 64 / 10) << scene.name;
  }
}

// --- Shading
// ----------------------------------------------------------------------------------------------------------

// What `point` is by its definition, in double, from its formulas alone: GGX [Walter 2007, eq. 33],
// height-correlated Smith with Λ by its own definition [Heitz 2014, eqs. 72 and 99], Schlick.
std::pair<glm::dvec3, glm::dvec3> PointRadiance(const Light& light, const SurfacePixels& pixels,
                                                std::size_t i) {
  const glm::dvec3 p(pixels.position[i]);
  const glm::dvec3 n(pixels.normal[i]);
  const glm::dvec3 base(pixels.base_color[i]);
  const double metalness = pixels.base_color[i].w;
  const double alpha = std::pow(static_cast<double>(pixels.normal[i].w), 2.0);
  const glm::dvec3 v = glm::normalize(glm::dvec3(pixels.view_position) - p);
  const glm::dvec3 to_center = light.center - p;
  const glm::dvec3 l = glm::normalize(to_center);
  const double cos_light = -glm::dot(light.normal, l);
  double intensity = 0.0;  // per unit radiance, m²
  if (light.shape == LightShape::kSphere) {
    intensity = glm::pi<double>() * light.half_size.x * light.half_size.x;
  } else {
    const double area = light.shape == LightShape::kDisk
                            ? glm::pi<double>() * light.half_size.x * light.half_size.x
                            : 4.0 * light.half_size.x * light.half_size.y;
    intensity = area * (light.two_sided ? std::abs(cos_light) : std::max(cos_light, 0.0));
  }
  const double cos_i = glm::dot(n, l);
  const double cos_o = glm::dot(n, v);
  if (cos_i <= 0.0 || cos_o <= 0.0) return {};
  const glm::dvec3 irradiance = light.radiance * (intensity * cos_i / glm::dot(to_center, to_center));
  const glm::dvec3 h = glm::normalize(l + v);
  const double cos_h = glm::dot(n, h);
  const double t = cos_h * cos_h * (alpha * alpha - 1.0) + 1.0;
  const double d = alpha * alpha / (glm::pi<double>() * t * t);
  const auto lambda = [&](double c) {
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - c * c) / (c * c)) - 1.0);
  };
  const double g = 1.0 / (1.0 + lambda(cos_i) + lambda(cos_o));
  const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), base, metalness);
  const glm::dvec3 f = f0 + (1.0 - f0) * std::pow(1.0 - glm::dot(h, v), 5.0);
  return {base * (1.0 - metalness) / glm::pi<double>() * irradiance,
          f * d * g / (4.0 * cos_i * cos_o) * irradiance};
}

struct PointCase {
  const char* name;
  LightShape shape;
  bool two_sided;
};

class PointTechnique : public Rendering, public testing::WithParamInterface<PointCase> {};

TEST_P(PointTechnique, MatchesItsFormula) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = MakeScene(GetParam().shape);
  Light& light = scene.lights[0];
  light.two_sided = GetParam().two_sided;
  if (light.two_sided) {  // lit from the back alone
    light.normal = -light.normal;
    light.axis_x = -light.axis_x;
  }
  const SurfacePixels pixels = renderer.DrawScene(scene, kSize);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const RadianceImage image = renderer.Shade(Named("point"), precision);
    // In double what is left is the rounding of the light block's and the output's floats; in float the
    // cancellation in 1 − n·h, 6e-8 against alpha² ≥ 0.025, twice, and the directions'.
    const double tolerance = precision == Precision::kDouble ? 2e-6 : 3e-5;
    int lit = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (!pixels.IsSurface(i)) {
        ASSERT_EQ(image.Total(i), glm::vec3(0.0f));
        continue;
      }
      const auto [diffuse, specular] = PointRadiance(light, pixels, i);
      lit += diffuse.x > 0.0;
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(image.diffuse[i][c], diffuse[c], tolerance * diffuse[c] + 1e-9) << i;
        ASSERT_NEAR(image.specular[i][c], specular[c], tolerance * specular[c] + 1e-9) << i;
      }
    }
    EXPECT_GT(lit, 300);
  }
}

INSTANTIATE_TEST_SUITE_P(Light, PointTechnique,
                         testing::Values(PointCase{"Rectangle", LightShape::kRectangle, false},
                                         PointCase{"Disk", LightShape::kDisk, false},
                                         PointCase{"Sphere", LightShape::kSphere, false},
                                         PointCase{"TwoSidedRectangle", LightShape::kRectangle, true},
                                         PointCase{"TwoSidedDisk", LightShape::kDisk, true}),
                         [](const auto& light) { return light.param.name; });

TEST_F(Rendering, ManyLightsAreTheSumOfEach) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = MakeScene(LightShape::kRectangle);
  scene.lights.push_back(MakeLight(LightShape::kDisk));
  scene.lights.push_back(MakeLight(LightShape::kSphere));
  scene.lights[1].center.x -= 1.0;
  scene.lights[2].center.x += 0.7;
  const SurfacePixels pixels = renderer.DrawScene(scene, kSize);
  const RadianceImage image = renderer.Shade(Named("point"), Precision::kDouble);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!pixels.IsSurface(i)) continue;
    glm::dvec3 sum(0.0);
    for (const Light& light : scene.lights) {
      const auto [diffuse, specular] = PointRadiance(light, pixels, i);
      sum += diffuse + specular;
    }
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(image.Total(i)[c], sum[c], 2e-6 * sum[c] + 1e-9);
  }
}

double RelativeRmse(const RadianceImage& a, const RadianceImage& b) {
  double difference = 0.0;
  double power = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(a.Total(i)) - glm::dvec3(b.Total(i));
    difference += glm::dot(d, d);
    power += glm::dot(glm::dvec3(b.Total(i)), glm::dvec3(b.Total(i)));
  }
  return std::sqrt(difference / power);
}

TEST_F(Rendering, DoubleIsCloseToFloatAndYetAnother) {
  Renderer renderer(context_->gl(), library_);
  renderer.DrawScene(MakeScene(LightShape::kRectangle), {96, 72});
  const RadianceImage in_float = renderer.Shade(Named("point"), Precision::kFloat);
  const RadianceImage in_double = renderer.Shade(Named("point"), Precision::kDouble);
  const double difference = RelativeRmse(in_float, in_double);
  EXPECT_LT(difference, 1e-5);
  EXPECT_GT(difference, 1e-9);
}

TEST_F(Rendering, OsmesaAndEglDrawTheSame) {
  const auto egl = CreateContext(ContextKind::kEgl);
  const Scene scene = MakeScene(LightShape::kDisk);
  context_->MakeCurrent();
  auto on_osmesa = std::make_unique<Renderer>(context_->gl(), library_);
  const SurfacePixels pixels = on_osmesa->DrawScene(scene, kSize);
  const RadianceImage image = on_osmesa->Shade(Named("point"));
  egl->MakeCurrent();
  auto on_egl = std::make_unique<Renderer>(egl->gl(), library_);
  const SurfacePixels other_pixels = on_egl->DrawScene(scene, kSize);
  const RadianceImage other = on_egl->Shade(Named("point"));
  // Coverage along an outline is the driver's to decide.
  int differing = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    differing += pixels.position[i].w != other_pixels.position[i].w;
  EXPECT_LT(differing, static_cast<int>(pixels.size()) / 200);
  EXPECT_LT(RelativeRmse(image, other), differing == 0 ? 1e-5 : 1e-2);
  on_egl.reset();
  context_->MakeCurrent();
  EXPECT_EQ(RelativeRmse(on_osmesa->Shade(Named("point")), image), 0.0);
}

TEST_F(Rendering, BlackWhereNothingEmits) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = MakeScene(LightShape::kRectangle);
  scene.lights[0].radiance = glm::dvec3(0.0);
  renderer.DrawScene(scene, kSize);
  const RadianceImage image = renderer.Shade(Named("point"));
  renderer.Draw(Named("point"));
  ASSERT_EQ(image.size(), 48u * 36u);
  for (std::size_t i = 0; i < image.size(); ++i) ASSERT_EQ(image.Total(i), glm::vec3(0.0f));
}

TEST_F(Rendering, FacesTurnedAwayAreBlack) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = MakeScene(LightShape::kSphere);
  scene.camera.position.z = -1.5;  // under the floor
  scene.meshes.pop_back();
  const SurfacePixels pixels = renderer.DrawScene(scene, kSize);
  const RadianceImage image = renderer.Shade(Named("point"));
  int surfaces = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    surfaces += pixels.IsSurface(i);
    ASSERT_EQ(image.Total(i), glm::vec3(0.0f));
  }
  EXPECT_GT(surfaces, 100);
}

TEST_F(Rendering, UnsupportedIsRefusedAndNotDrawnAsSomethingElse) {
  Renderer renderer(context_->gl(), library_);
  Technique rectangles_only = *Named("point").technique;
  rectangles_only.shapes = {LightShape::kRectangle};
  const Variant variant = DefaultVariant(rectangles_only);
  renderer.DrawScene(MakeScene(LightShape::kRectangle), kSize);
  EXPECT_EQ(renderer.Shade(variant).size(), 48u * 36u);
  renderer.DrawScene(MakeScene(LightShape::kDisk), kSize);
  EXPECT_THAT(ErrorOf([&] { renderer.Shade(variant); }), HasSubstr("is a disk; expected"));
  EXPECT_THAT(ErrorOf([&] { renderer.Draw(variant); }), HasSubstr("is a disk; expected"));
}

TEST_F(Rendering, LightsAreLimited) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = MakeScene(LightShape::kRectangle);
  scene.meshes.pop_back();
  const Light light = scene.lights[0];
  renderer.DrawScene(scene, kSize);
  const RadianceImage one = renderer.Shade(Named("point"));
  scene.lights.assign(kMaxLights, light);
  for (Light& each : scene.lights) each.radiance = light.radiance / static_cast<double>(kMaxLights);
  renderer.DrawScene(scene, kSize);
  EXPECT_LT(RelativeRmse(renderer.Shade(Named("point")), one), 1e-5);
  scene.lights.push_back(light);
  EXPECT_THAT(ErrorOf([&] { renderer.DrawScene(scene, kSize); }),
              HasSubstr("257 lights in the scene; expected at most 256"));
}

// --- What techniques are given
// ------------------------------------------------------------------------------------------

constexpr const char* kHeader =
    "/*---\nsummary = \"a probe\"\ncitation = \"none\"\nauthor_note = \"none\"\n"
    "shapes = [\"rectangle\", \"disk\", \"sphere\"]\nlobes = [\"diffuse\", \"specular\"]\nbrdfs = [\"ggx\"]\n"
    "effects = [\"two_sided\", \"fresnel\", \"many_lights\"]\nexact = []\n";

// A technique of the test's own in an override folder.
class Probing : public testing::Test {
 protected:
  // `header`: more TOML; `body`: what ShadeLight returns as diffuse and specular, and above it whatever is
  // needed.
  void WriteProbe(const std::string& header, const std::string& body) {
    folder_.Write("techniques/probe.glsl", kHeader + header + "---*/\n" + body);
  }
  RadianceImage Shade(Renderer& renderer, Precision precision = Precision::kFloat,
                      const std::map<std::string, double>& knobs = {}) {
    techniques_ = LoadTechniques(library_);
    return renderer.Shade(ParseVariant(techniques_, "probe"), precision, knobs);
  }
  static constexpr const char* kShade = "Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {\n";

  TemporaryFolder folder_;
  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
  ShaderLibrary library_{folder_.path()};
  std::vector<Technique> techniques_;
};

TEST_F(Probing, EveryLightFacesThePointAndIsRightHanded) {
  WriteProbe("", std::string(kShade) +
                     "  float height = dot(light.normal, surface.position - light.center);\n"
                     "  if (light.shape == SHAPE_SPHERE) height = 1.0;\n"
                     "  float handed = dot(cross(light.axis_x, light.axis_y), light.normal);\n"
                     "  float halves = distance(light.half_axis_x, light.axis_x * light.half_size.x) +\n"
                     "                 distance(light.half_axis_y, light.axis_y * light.half_size.y);\n"
                     "  bool wrong = height <= 0.0 || abs(handed - 1.0) > 1e-5 || halves > 1e-5 ||\n"
                     "               dot(surface.normal, to_view) <= 0.0;\n"
                     "  return Radiance(vec3(wrong ? 1.0 : 0.0), vec3(1.0));\n}\n");
  Renderer renderer(context_->gl(), library_);
  Scene scene = MakeScene(LightShape::kRectangle);
  // One that stands upright in the middle: half of the floor is on either side.
  Light upright;
  upright.axis_x = {1.0, 0.0, 0.0};
  upright.axis_y = {0.0, 0.0, 1.0};
  upright.normal = {0.0, -1.0, 0.0};
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere}) {
    for (const bool two_sided : {false, true}) {
      upright.shape = shape;
      upright.two_sided = two_sided;
      scene.lights = {upright};
      for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
        const SurfacePixels pixels = renderer.DrawScene(scene, kSize);
        const RadianceImage image = Shade(renderer, precision);
        int front = 0;
        int back = 0;
        for (std::size_t i = 0; i < image.size(); ++i) {
          ASSERT_EQ(image.diffuse[i], glm::vec3(0.0f)) << Name(shape) << two_sided;
          if (image.specular[i].x == 0.0f) continue;
          (pixels.position[i].y < 0.0f ? front : back) += 1;
        }
        EXPECT_GT(front, 100);
        if (two_sided || shape == LightShape::kSphere) {
          EXPECT_GT(back, 100);
        } else {
          EXPECT_EQ(back, 0);
        }
      }
    }
  }
}

TEST_F(Probing, LightBlockArrivesWhole) {
  // Each quantity times a power of ten of its own would lose digits: two at a time.
  const Scene scene = MakeScene(LightShape::kRectangle);
  const Light& light = scene.lights[0];
  const std::vector<std::tuple<std::string, glm::dvec3>> quantities{
      {"light.center", light.center},
      {"light.normal", light.normal},
      {"light.axis_x", light.axis_x},
      {"light.axis_y", light.axis_y},
      {"light.half_axis_x", light.axis_x * 0.4},
      {"light.half_axis_y", light.axis_y * 0.15},
      {"light.radiance", light.radiance},
      {"light.products", {0.16, 0.0225, 0.12}},
      {"vec3(light.half_size, light.area)", {0.4, 0.15, 0.24}},
      {"vec3(light.shape, light.two_sided, 0.0)", {0.0, 0.0, 0.0}},
  };
  Renderer renderer(context_->gl(), library_);
  const SurfacePixels pixels = renderer.DrawScene(scene, kSize);
  const auto first = static_cast<std::size_t>(
      std::find_if(pixels.position.begin(), pixels.position.end(), [](glm::vec4 p) { return p.w == 1.0f; }) -
      pixels.position.begin());
  for (const auto& [expression, expected] : quantities) {
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      WriteProbe("", fmt::format("{}  return Radiance({}, vec3(1.0));\n}}\n", kShade, expression));
      const RadianceImage image = Shade(renderer, precision);
      // The very float in either precision.
      for (int c = 0; c < 3; ++c)
        EXPECT_EQ(image.diffuse[first][c], static_cast<float>(expected[c])) << expression;
    }
  }
}

TEST_F(Probing, KnobsHaveTheirInitialValueOrTheOneAskedFor) {
  WriteProbe(
      "[[knob]]\nname = \"gain\"\nlabel = \"Gain\"\nunit = \"1\"\ninitial = 0.25\nmin = 0.0\nmax = 2.0\n",
      std::string(kShade) + "  return Radiance(vec3(knob_gain), vec3(0.0));\n}\n");
  Renderer renderer(context_->gl(), library_);
  const SurfacePixels pixels = renderer.DrawScene(MakeScene(LightShape::kSphere), kSize);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const auto brightest = [&](const std::map<std::string, double>& knobs) {
      const RadianceImage image = Shade(renderer, precision, knobs);
      float value = 0.0f;
      for (const glm::vec3& diffuse : image.diffuse) value = std::max(value, diffuse.x);
      return value;
    };
    EXPECT_EQ(brightest({}), 0.25f);
    EXPECT_EQ(brightest({{"gain", 1.5}}), 1.5f);
    EXPECT_EQ(brightest({}), 0.25f);  // not remembered
  }
  EXPECT_THAT(ErrorOf([&] {
                Shade(renderer, Precision::kFloat, {{"grain", 1.0}});
              }),
              HasSubstr("probe has no knob grain; expected one of gain"));
}

std::string WriteExr(const TemporaryFolder& folder, const std::string& name, glm::ivec2 size, int channels,
                     const std::vector<float>& values) {
  const std::string path = folder.Write(name, "");
  const auto out = OIIO::ImageOutput::create(path);
  out->open(path, OIIO::ImageSpec(size.x, size.y, channels, OIIO::TypeDesc::FLOAT));
  out->write_image(OIIO::TypeDesc::FLOAT, values.data());
  out->close();
  return path;
}

TEST_F(Probing, TablesAreBilinearAndClampedInBothPrecisions) {
  // f(i, j) = 1 + i + 10 j on 4 × 3 texels: bilinear interpolation gives it back between the centres.
  std::vector<float> values;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i) {
      for (int c = 0; c < 4; ++c)
        values.push_back(static_cast<float>(c + 1) * (1.0f + static_cast<float>(i + 10 * j)));
    }
  }
  WriteExr(folder_, "tables/probe_bent.exr", {4, 3}, 4, values);
  Renderer renderer(context_->gl(), library_);
  const SurfacePixels pixels = renderer.DrawScene(MakeScene(LightShape::kSphere), {16, 16});
  const auto first = static_cast<std::size_t>(
      std::find_if(pixels.position.begin(), pixels.position.end(), [](glm::vec4 p) { return p.w == 1.0f; }) -
      pixels.position.begin());
  struct Case {
    const char* uv;
    float expected;
  };
  for (const Case& c : {Case{"0.125, 0.1666666667", 1.0f}, Case{"0.375, 0.5", 12.0f}, Case{"0.5, 0.5", 12.5f},
                        Case{"0.5, 0.75", 20.0f - 0.0f}, Case{"-3.0, 0.0", 1.0f}, Case{"1.0, 1.0", 24.0f},
                        Case{"7.0, 0.5", 14.0f}}) {
    WriteProbe(
        "[[option]]\nname = \"shape_of_table\"\nsummary = \"s\"\nchoices = [[\"bent\", \"b\"], [\"flat\", "
        "\"f\"]]\n"
        "[tables]\nlut = \"probe_{shape_of_table}.exr\"\n[published]\nshape_of_table = \"bent\"\n",
        std::string(kShade) + "  vec4 t = SampleTable(table_lut, vec2(" + c.uv +
            "));\n  return Radiance(t.xyz, vec3(t.w));\n}\n");
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      const RadianceImage image = Shade(renderer, precision);
      // Samplers may weigh in steps of 1/256.
      const float tolerance = precision == Precision::kFloat ? 11.0f / 256.0f : 1e-5f;
      EXPECT_NEAR(image.diffuse[first].x, c.expected, tolerance) << c.uv;
      EXPECT_NEAR(image.diffuse[first].z, 3.0f * c.expected, 3.0f * tolerance) << c.uv;
      EXPECT_NEAR(image.specular[first].x, 4.0f * c.expected, 4.0f * tolerance) << c.uv;
    }
  }
  techniques_ = LoadTechniques(library_);
  EXPECT_THAT(ErrorOf([&] { renderer.Shade(ParseVariant(techniques_, "probe+shape_of_table=flat")); }),
              testing::AllOf(StartsWith((folder_.path() / "techniques/probe.glsl").generic_string() + ":1: "),
                             HasSubstr("probe_flat.exr, which does not exist")));
}

TEST(Table, FewerChannelsAreFilledUpAndOthersRefused) {
  const TemporaryFolder folder;
  const ShaderLibrary library(folder.path());
  WriteExr(folder, "tables/one.exr", {2, 1}, 1, {0.5f, 0.75f});
  const TableTexels one = DecodeTable(*library.Find("tables/one.exr"), "one.exr");
  EXPECT_EQ(one.size, glm::ivec2(2, 1));
  EXPECT_EQ(one.texels[1], glm::vec4(0.75f, 0.0f, 0.0f, 0.0f));
  WriteExr(folder, "tables/five.exr", {1, 1}, 5, {1, 2, 3, 4, 5});
  EXPECT_THAT(ErrorOf([&] { DecodeTable(*library.Find("tables/five.exr"), "five.exr"); }),
              StartsWith("five.exr:1: 5 channels; expected"));
  EXPECT_THAT(ErrorOf([&] { DecodeTable("no picture", "broken.exr"); }),
              StartsWith("broken.exr:1: not readable"));
}

TEST_F(Probing, BrokenTextIsReportedWithItsFileAndLine) {
  Renderer renderer(context_->gl(), library_);
  renderer.DrawScene(MakeScene(LightShape::kRectangle), kSize);
  WriteProbe("", std::string(kShade) + "  vec3 colour = vec3(1.0);\n  return Radiance(color, colour);\n}\n");
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    const std::string error = ErrorOf([&] { Shade(renderer, precision); });
    const int line = static_cast<int>(std::count(kHeader, kHeader + std::string(kHeader).size(), '\n')) + 4;
    EXPECT_THAT(error, StartsWith((folder_.path() / "techniques/probe.glsl").generic_string() + ":" +
                                  std::to_string(line) + ": "));
    EXPECT_THAT(error, HasSubstr("color"));
    EXPECT_THAT(error, HasSubstr("; expected "));
    EXPECT_THAT(error, Not(HasSubstr("\n")));
  }
  WriteProbe("", "Radiance ShadeLight(Surface surface, Light light, vec3 to_view);\n");
  EXPECT_THAT(ErrorOf([&] { Shade(renderer); }),
              testing::AllOf(HasSubstr("ShadeLight"), Not(HasSubstr("\n"))));
}

TEST_F(Probing, EditedTextIsUsedAtTheNextShade) {
  Renderer renderer(context_->gl(), library_);
  const SurfacePixels pixels = renderer.DrawScene(MakeScene(LightShape::kSphere), kSize);
  for (const float value : {1.0f, 2.0f, 1.0f}) {
    WriteProbe(
        "", std::string(kShade) + "  return Radiance(vec3(0.0), vec3(" + std::to_string(value) + "));\n}\n");
    const RadianceImage image = Shade(renderer);
    EXPECT_EQ(std::max_element(image.specular.begin(), image.specular.end(),
                               [](glm::vec3 a, glm::vec3 b) { return a.x < b.x; })
                  ->x,
              value);
    renderer.Draw(ParseVariant(techniques_, "probe"));
  }
}

// --- The light block, memory
// -------------------------------------------------------------------------------------

TEST_F(Rendering, PureMetalHasNoDiffuseAndTheSameSpecular) {
  Renderer renderer(context_->gl(), library_);
  Scene scene = MakeScene(LightShape::kRectangle);
  for (Material& material : scene.materials) material.metalness = 1.0f;
  const SurfacePixels pixels = renderer.DrawScene(scene, kSize);
  const RadianceImage image = renderer.Shade(Named("point"), Precision::kDouble);
  for (std::size_t i = 0; i < image.size(); ++i) {
    ASSERT_EQ(image.diffuse[i], glm::vec3(0.0f));
    if (!pixels.IsSurface(i)) continue;
    const double expected = PointRadiance(scene.lights[0], pixels, i).second.y;
    ASSERT_NEAR(image.specular[i].y, expected, 2e-6 * expected + 1e-9);
  }
}

// Names of objects that exist, among the first that a context hands out.
int ObjectsAlive(const GladGLContext& gl) {
  int alive = 0;
  for (GLuint name = 1; name < 300; ++name) {
    alive += gl.IsTexture(name) + gl.IsBuffer(name) + gl.IsFramebuffer(name) + gl.IsVertexArray(name) +
             gl.IsProgram(name) + gl.IsShader(name);
  }
  return alive;
}

TEST_F(Rendering, GpuMemoryIsGivenBack) {
  const int before = ObjectsAlive(context_->gl());
  {
    Renderer renderer(context_->gl(), library_);
    Scene scene = MakeScene(LightShape::kRectangle);
    scene.materials[0].base_color_texture = std::make_shared<Image>(Image{1, 1, {glm::vec4(1.0f)}});
    renderer.DrawScene(scene, kSize);
    renderer.Shade(Named("ltc"));
    const int once = ObjectsAlive(context_->gl());
    EXPECT_GT(once, before + 8);
    for (int i = 0; i < 3; ++i) {
      renderer.DrawScene(scene, kSize + i);
      renderer.Shade(Named("ltc"));
    }
    EXPECT_EQ(ObjectsAlive(context_->gl()), once);
  }
  EXPECT_EQ(ObjectsAlive(context_->gl()), before);
  EXPECT_EQ(context_->gl().GetError(), static_cast<GLenum>(GL_NO_ERROR));
}

}  // namespace
}  // namespace arealab::renderer_test
