// Textured lights through every technique that claims them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "compare/context.h"
#include "compare/metrics.h"
#include "compare/truth.h"
#include "glsl/light_textures.h"
#include "glsl/renderer.h"
#include "scenes/light_texture.h"
#include "scenes/shapes.h"

namespace arealab::textured_technique_test {
namespace {

std::shared_ptr<const Image> Checks(float bright, float dark) {
  auto image = std::make_shared<Image>();
  image->width = 6;
  image->height = 4;
  for (int i = 0; i < 24; ++i) {
    const float value = (i % 6 + i / 6) % 2 == 0 ? bright : dark;
    image->pixels.emplace_back(value, 0.5f * value, bright, 1.0f);
  }
  return image;
}

// A glossy floor under a light that faces it, seen from aside.
Scene FacingLight(std::shared_ptr<const Image> texture) {
  Scene scene;
  scene.camera.position = {0.0, -2.5, 2.0};
  scene.materials.emplace_back();
  scene.materials[0].roughness = {0.2f, 0.7f};
  scene.meshes.push_back(MakePlane({3.0, 3.0}, {}));
  Light light;
  light.center = {0.0, 0.0, 0.5};
  light.axis_y = {0.0, -1.0, 0.0};
  light.normal = {0.0, 0.0, -1.0};
  light.half_size = {0.6, 0.4};
  light.radiance = glm::dvec3(2.0);
  light.texture = std::move(texture);
  scene.lights.push_back(light);
  return scene;
}

class TexturedTechniques : public testing::Test {
 protected:
  RadianceImage Shade(const Scene& scene, const Variant& variant) {
    renderer_.DrawScene(scene, {48, 48});
    return renderer_.Shade(variant);
  }
  double Error(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) { return CompareImages(a, b, 48).rel_rmse; }

  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
  ShaderLibrary library_;
  std::vector<Technique> techniques_ = LoadTechniques(library_);
  Renderer renderer_{context_->gl(), library_};
};

// What is the same all over leaves every technique as it is without a texture, but for its brightness: whatever filter, level and
// border. The reference has another rule for textures.
TEST_F(TexturedTechniques, OfAConstantAreThePlainOnes) {
  const Scene plain = FacingLight(nullptr), half = FacingLight(std::make_shared<Image>(Image{3, 2, std::vector<glm::vec4>(6, glm::vec4(0.5f, 0.5f, 0.5f, 1.0f))}));
  int claims = 0;
  for (const Variant& variant : AllVariants(techniques_)) {
    if (WhyUnsupported(variant, half)) continue;
    const bool picks = variant == DefaultVariant(*variant.technique) || variant == PublishedVariant(*variant.technique) ||
                       (variant.options.contains("texture") && (variant.options.at("texture") != "normal" || variant.options.at("border") != "yes"));
    if (!picks) continue;
    ++claims;
    RadianceImage a = Shade(plain, variant);
    const RadianceImage b = Shade(half, variant);
    for (auto* lobe : {&a.diffuse, &a.specular}) {
      for (glm::vec3& pixel : *lobe) pixel *= 0.5f;
    }
    SCOPED_TRACE(variant.Name());
    const double bound = variant.technique->name == "reference" ? 2e-3 : 3e-7;
    EXPECT_LT(Error(b.diffuse, a.diffuse), bound);
    EXPECT_LT(Error(b.specular, a.specular), bound);
  }
  EXPECT_GE(claims, 12);
}

// The paper's look-up along the normal, with our kernel, is no approximation of the diffuse lobe where the light faces the surface; what is
// left is the interpolation between levels and texels.
TEST_F(TexturedTechniques, DiffuseFilterIsTheLobesOwnWhereTheLightFacesTheSurface) {
  Scene scene = FacingLight(Checks(1.0f, 0.0f));
  const RadianceImage truth = ComputeTruth(scene, renderer_.DrawScene(scene, {48, 48})).radiance;
  for (const char* name : {"ltc", "hill"}) {
    EXPECT_LT(Error(Shade(scene, ParseVariant(techniques_, name)).diffuse, truth.diffuse), 0.02) << name;
    // The vector form factor hardly leaves the normal there.
    EXPECT_LT(Error(Shade(scene, ParseVariant(techniques_, name + std::string("+texture=vector"))).diffuse, truth.diffuse), 0.02) << name;
  }
  EXPECT_LT(Error(Shade(scene, ParseVariant(techniques_, "reference")).specular, truth.specular), 2e-3);
  EXPECT_LT(Error(Shade(scene, ParseVariant(techniques_, "reference")).diffuse, truth.diffuse), 2e-3);
}

// Unbiased: the mean of many seeds goes to the truth.
TEST_F(TexturedTechniques, MonteCarloIsUnbiased) {
  const Scene scene = FacingLight(Checks(1.0f, 0.0f));
  const SurfacePixels& pixels = renderer_.DrawScene(scene, {24, 24});
  const RadianceImage truth = ComputeTruth(scene, pixels).radiance;
  const Variant variant = ParseVariant(techniques_, "monte_carlo+samples=64");
  std::vector<glm::vec3> sum(truth.size(), glm::vec3(0.0f));
  constexpr int kSeeds = 40;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const RadianceImage image = renderer_.Shade(variant, Precision::kFloat, {{"seed", seed}});
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += image.Total(i) / static_cast<float>(kSeeds);
  }
  EXPECT_LT(CompareImages(sum, TotalRadiance(truth), 24).rel_rmse, 0.02);
  EXPECT_LT(std::abs(CompareImages(sum, TotalRadiance(truth), 24).bias), 0.003);
}

// Half transparent all over: half the light, of both lobes; as Mayaux's listing samples, of the diffuse alone.
TEST_F(TexturedTechniques, AlphaDimsTheDiffuseAlone) {
  const auto white = std::make_shared<Image>(Image{2, 2, std::vector<glm::vec4>(4, glm::vec4(1.0f))}),
             half = std::make_shared<Image>(Image{2, 2, std::vector<glm::vec4>(4, glm::vec4(0.5f))});
  for (const auto& [name, specular] : {std::pair("mayaux", 0.5f), std::pair("mayaux+alpha=diffuse", 1.0f), std::pair("mayaux@published", 1.0f)}) {
    const Variant variant = ParseVariant(techniques_, name);
    RadianceImage expected = Shade(FacingLight(white), variant);
    const RadianceImage seen = Shade(FacingLight(half), variant);
    for (glm::vec3& pixel : expected.diffuse) pixel *= 0.5f;
    for (glm::vec3& pixel : expected.specular) pixel *= specular;
    EXPECT_LT(Error(seen.diffuse, expected.diffuse), 1e-6) << name;
    EXPECT_LT(Error(seen.specular, expected.specular), 1e-6) << name;
  }
}

// Two lights, two textures, a plain one between: each its own.
TEST_F(TexturedTechniques, SeveralLightsShowEachItsTexture) {
  Scene scene = FacingLight(Checks(1.0f, 0.0f));
  scene.lights[0].half_size = {0.3, 0.3};
  for (int i = 1; i < 3; ++i) {
    scene.lights.push_back(scene.lights[0]);
    scene.lights.back().center.x = 0.8 * i - 1.2;
  }
  scene.lights[1].texture = nullptr;
  scene.lights[2].texture = Checks(0.2f, 3.0f);
  const RadianceImage truth = ComputeTruth(scene, renderer_.DrawScene(scene, {48, 48})).radiance;
  EXPECT_LT(Error(Shade(scene, ParseVariant(techniques_, "reference")).diffuse, truth.diffuse), 2e-3);
  EXPECT_LT(Error(Shade(scene, ParseVariant(techniques_, "ltc")).diffuse, truth.diffuse), 0.03);
}

// Forms against a dense sum over the texture with the kernel as it is written in their description.
TEST(LightTextureForms, AreTheirKernelsMeans) {
  const ShownTexture texture{Checks(1.0f, 0.0f), 1.5};
  const double width = std::sqrt(1.5), height = 1.0 / width;
  const auto dense = [&](glm::dvec2 uv, const auto& kernel) {
    glm::dvec3 sum(0.0);
    double weight = 0.0;
    constexpr int kCells = 400;
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i) {
        const glm::dvec2 p((i + 0.5) / kCells, (j + 0.5) / kCells), d = (p - uv) * glm::dvec2(width, height);
        const double w = kernel(glm::dot(d, d));
        sum += w * TextureAt(*texture.image, p);
        weight += w;
      }
    }
    return sum / weight;
  };
  for (const char* name : {"light_cosine", "light_cosine_border", "light_solid_angle", "light_phong"}) {
    const TextureLevels form = MakeTextureLevels(name, texture, {texture});
    ASSERT_EQ(form.levels.size(), 8u);
    for (const int level : {1, 2, 3, 5, 7}) {
      const int side = 128 >> level;
      const double r = (std::exp2(level) - 1.0) / 32.0;
      const auto kernel = [&](double rho2) {
        if (std::string(name) == "light_solid_angle") return r / std::pow(rho2 + r * r, 1.5);
        if (std::string(name) == "light_phong") {
          const double angle = std::atan(r), g = std::max(2.0 / (angle * angle) - 2.0, 0.0);
          return std::pow(1.0 / std::sqrt(1.0 + rho2), g) / std::pow(1.0 + rho2, 1.5);
        }
        return r * r / std::pow(rho2 + r * r, 2);
      };
      for (const glm::ivec2 texel : {glm::ivec2(0, 0), glm::ivec2(side / 3, side / 2), glm::ivec2(side - 1, side / 4)}) {
        glm::dvec2 uv = (glm::dvec2(texel) + 0.5) / static_cast<double>(side);
        if (std::string(name) == "light_cosine_border") uv = (uv - 0.125) / 0.75;
        const glm::dvec3 expected = dense(uv, kernel), found(form.levels[static_cast<std::size_t>(level)][static_cast<std::size_t>(texel.y * side + texel.x)]);
        EXPECT_NEAR(found.r, expected.r, 0.01) << name << " level " << level << " at " << texel.x << ", " << texel.y;
      }
    }
  }
  const TextureLevels means = MakeTextureLevels("light_means", texture, {texture});
  EXPECT_NEAR(means.levels.back()[0].r, MeanTexel(*texture.image).r, 1e-6);
  EXPECT_NEAR(means.levels.back()[0].b, 1.0, 1e-6);
}

}  // namespace
}  // namespace arealab::textured_technique_test
