// A sky that shows an image: its prefiltered forms, the truth, and the techniques' pictures.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>

#include "compare/context.h"
#include "compare/harness.h"
#include "compare/metrics.h"
#include "compare/shadowed_truth.h"
#include "compare/textured_sky.h"
#include "compare/truth.h"
#include "glsl/effects.h"
#include "glsl/renderer.h"
#include "glsl/sky_maps.h"
#include "scenes/shapes.h"
#include "scenes/sky.h"

namespace arealab::textured_sky_test {
namespace {

using glm::dvec3;

std::shared_ptr<const Image> MakeImage(int height, const std::function<dvec3(const dvec3&)>& radiance) {
  auto image = std::make_shared<Image>(Image{2 * height, height, {}});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < 2 * height; ++x) {
      image->pixels.emplace_back(glm::vec3(radiance(SkyDirection(glm::dvec2(x + 0.5, y + 0.5) / glm::dvec2(2 * height, height), 0.0))), 1.0f);
    }
  }
  return image;
}

// Blue above, dark below the horizon, a sun of 12° whose middle is 50 times as bright.
dvec3 Day(const dvec3& d) {
  const dvec3 above = glm::mix(dvec3(0.9, 0.95, 1.0), dvec3(0.2, 0.4, 0.9), std::max(d.z, 0.0));
  const double sun = std::exp((glm::dot(d, glm::normalize(dvec3(0.5, -0.3, 0.7))) - 1.0) * 90.0);
  return (d.z > 0.0 ? above : dvec3(0.15, 0.12, 0.1)) + 50.0 * sun * dvec3(1.0, 0.9, 0.7);
}

// A ball over a floor, seen from the side; a lamp that hardly tells.
Scene BallUnder(const Sky& sky, float roughness) {
  Scene scene;
  scene.camera.position = {0.0, -4.0, 2.0};
  scene.camera.target = {0.0, 0.0, 0.6};
  Material material;
  material.roughness = glm::vec2(roughness);
  material.base_color = glm::vec3(0.5f);
  scene.materials.push_back(material);
  Placement ball;
  ball.position = {0.0, 0.0, 1.0};
  scene.meshes = {MakePlane({8.0, 8.0}, {}), MakeSphere(1.0, ball)};
  Light lamp;
  lamp.shape = LightShape::kSphere;
  lamp.center = {0.0, 0.0, 40.0};
  lamp.half_size = glm::dvec2(1e-3);
  scene.lights.push_back(lamp);
  scene.sky = sky;
  return scene;
}

Sky Showing(std::shared_ptr<const Image> image, double radiance = 1.0) {
  Sky sky{dvec3(radiance)};
  sky.texture = std::move(image);
  return sky;
}

class TexturedSkyPicture : public testing::Test {
 protected:
  const SurfacePixels& Draw(const Scene& scene) { return renderer_.DrawScene(scene, {32, 32}); }
  RadianceImage Shade(const std::string& variant) { return renderer_.Shade(ParseVariant(techniques_, variant)); }
  // The largest difference over the largest value.
  static double Distance(const RadianceImage& a, const RadianceImage& b) {
    double most = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < a.diffuse.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        most = std::max({most, std::abs(static_cast<double>(a.diffuse[i][c] - b.diffuse[i][c])), std::abs(static_cast<double>(a.specular[i][c] - b.specular[i][c]))});
        largest = std::max({largest, static_cast<double>(a.diffuse[i][c]), static_cast<double>(a.specular[i][c])});
      }
    }
    return most / largest;
  }

  std::unique_ptr<Context> context_ = CreateContext(ContextKind::kOsmesa);
  ShaderLibrary library_;
  std::vector<Technique> techniques_ = LoadTechniques(library_);
  Renderer renderer_{context_->gl(), library_};
};

// One colour all over is the even sky of that colour, in the techniques and in the truth, lights before it included.
TEST_F(TexturedSkyPicture, OneColourIsAnEvenSky) {
  const dvec3 color(0.25, 0.5, 1.0);
  Scene even = BallUnder(Sky(2.0 * color), 0.4f);
  even.lights[0].half_size = glm::dvec2(20.0);
  Scene shown = even;
  shown.sky = Showing(MakeImage(24, [&](const dvec3&) { return color; }), 2.0);
  shown.sky->turn = 1.0;
  Draw(even);
  const RadianceImage ltc = Shade("ltc"), point = Shade("point");
  Draw(shown);
  EXPECT_LT(Distance(Shade("ltc"), ltc), 5e-6);  // measured 1.5e-6
  EXPECT_LT(Distance(renderer_.Shade(ParseVariant(techniques_, "point"), Precision::kDouble), point), 1e-5);
  const SurfacePixels& pixels = Draw(shown);
  EXPECT_LT(Distance(ComputeTruth(shown, pixels).radiance, ComputeTruth(even, pixels).radiance), 1e-6);
  const std::vector<glm::vec3> a = EmissionImage(even, pixels), b = EmissionImage(shown, pixels);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(glm::distance(a[i], b[i]), 1e-6f);
}

// Turning the image about z and turning its columns are the same; and so is turning all the rest the other way.
TEST_F(TexturedSkyPicture, TurnsWithItsImage) {
  const auto turned = [](double angle) {
    return MakeImage(64, [=](const dvec3& d) { return Day({d.x * std::cos(angle) + d.y * std::sin(angle), d.y * std::cos(angle) - d.x * std::sin(angle), d.z}); });
  };
  const double quarter = 0.5 * glm::pi<double>();
  Scene by_turn = BallUnder(Showing(turned(0.0)), 0.3f), by_image = BallUnder(Showing(turned(quarter)), 0.3f);
  by_turn.sky->turn = quarter;
  const SurfacePixels pixels = Draw(by_turn);
  const RadianceImage one = Shade("ltc");
  Draw(by_image);
  EXPECT_LT(Distance(one, Shade("ltc")), 1e-4);
  by_turn.sky->turn = 0.0;
  Draw(by_turn);
  EXPECT_GT(Distance(one, Shade("ltc")), 0.1);
  by_turn.sky->turn = quarter;
  const Truth a = ComputeTruth(by_turn, pixels), b = ComputeTruth(by_image, pixels);
  EXPECT_LT(RelativeRmse(a.radiance.diffuse, b.radiance.diffuse), 2e-3);
  const std::vector<glm::vec3> seen = EmissionImage(by_turn, pixels), expected = EmissionImage(by_image, pixels);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_LT(glm::distance(seen[i], expected[i]), 1e-3f * (1.0f + glm::length(expected[i])));
}

// GGX with height-correlated masking, of its own: over fine steps of direction about the normal, with an image's own texels.
struct Reflected {
  dvec3 diffuse{0.0}, specular{0.0};
};
Reflected BruteForce(const Sky& sky, const ShadedPixel& pixel, const std::function<bool(const dvec3&)>& hidden) {
  constexpr int kPolar = 400, kAround = 600;
  const ShadingPoint& p = pixel.point;
  const dvec3 x = glm::normalize(glm::cross(p.normal, dvec3(0.3, 0.5, 0.81))), y = glm::cross(p.normal, x);
  const double a2 = p.alpha * p.alpha, cos_v = glm::dot(p.normal, p.to_view);
  const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1.0 + a2 * (1.0 / (c * c) - 1.0)) - 1.0); };
  Reflected sum;
  for (int i = 0; i < kPolar; ++i) {
    const double z = (i + 0.5) / kPolar, s = std::sqrt(1.0 - z * z);
    for (int j = 0; j < kAround; ++j) {
      const double phi = 2.0 * glm::pi<double>() * (j + 0.5) / kAround;
      const dvec3 l = x * (s * std::cos(phi)) + y * (s * std::sin(phi)) + p.normal * z;
      if (hidden(l)) continue;
      const dvec3 radiance = SkyRadiance(sky, l) * (2.0 * glm::pi<double>() / (kPolar * static_cast<double>(kAround)));
      const dvec3 h = glm::normalize(l + p.to_view);
      const double cos_h = glm::dot(h, p.normal), q = cos_h * cos_h * (a2 - 1.0) + 1.0;
      const double f = a2 / (glm::pi<double>() * q * q) / (1.0 + lambda(cos_v) + lambda(z)) / (4.0 * cos_v * z);
      const dvec3 fresnel = pixel.f0 + (1.0 - pixel.f0) * std::pow(1.0 - glm::dot(h, p.to_view), 5.0);
      sum.diffuse += pixel.albedo / glm::pi<double>() * radiance * z;
      sum.specular += radiance * fresnel * (f * z);
    }
  }
  return sum;
}

// Floor and ball: what the truth says of a pixel, and of its own error, against brute force that shares nothing with it; where a
// dark sphere hides part of the sky as well.
TEST_F(TexturedSkyPicture, TruthIsBruteForceWithinItsError) {
  Scene scene = BallUnder(Showing(MakeImage(128, Day)), 0.5f);
  scene.lights[0].center = {3.0, -1.8, 4.2 + 1.0};
  scene.lights[0].half_size = glm::dvec2(1.5);
  scene.lights[0].radiance = dvec3(1e-9);
  const SurfacePixels& pixels = Draw(scene);
  const Truth truth = ComputeTruth(scene, pixels);
  const auto& lamp = scene.lights[0];
  double squares = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < pixels.size(); i += 37) {
    const auto pixel = ShadedPixelAt(scene, pixels, i);
    if (!pixel) continue;
    const dvec3 to_lamp = lamp.center - pixel->point.position;
    const double cosine = std::sqrt(1.0 - lamp.half_size.x * lamp.half_size.x / glm::dot(to_lamp, to_lamp));
    const Reflected expected = BruteForce(*scene.sky, *pixel, [&](const dvec3& l) { return glm::dot(l, glm::normalize(to_lamp)) > cosine; });
    const dvec3 whole = expected.diffuse + expected.specular, seen(truth.radiance.Total(i));
    const double sum = whole.x + whole.y + whole.z, error = (seen.x + seen.y + seen.z - sum) / sum;
    EXPECT_LT(std::abs(error), 4e-3) << i;
    squares += std::pow(error / std::max(static_cast<double>(truth.relative_error[i]), 2e-4), 2.0);
    ++count;
  }
  EXPECT_GT(count, 12);
  EXPECT_LT(std::sqrt(squares / count), 1.0);  // two standard errors are stated
  EXPECT_GT(truth.worst_relative_error, 0.0);
}

// Where a wall hides the bright half of the sky the shadowed truth has the dark half alone.
TEST_F(TexturedSkyPicture, ShadowsFollowTheImage) {
  Scene scene = BallUnder(Showing(MakeImage(64, [](const dvec3& d) { return dvec3(d.x < 0.0 ? 1.0 : 0.25); })), 1.0f);
  scene.materials[0].specular = 0.0f;
  Placement wall;
  wall.rotation = RotationFromDegrees({0.0, 90.0, 0.0});
  wall.position = {-0.01, 0.0, 0.0};
  scene.meshes = {MakePlane({1.0, 1.0}, {}), MakePlane({4000.0, 4000.0}, wall)};
  SurfacePixels pixels;
  pixels.width = pixels.height = 1;
  pixels.view_position = {1.0f, 0.0f, 5.0f};
  pixels.position = {{0.0f, 0.0f, 0.0f, 1.0f}};
  pixels.normal = {{0.0f, 0.0f, 1.0f, 1.0f}};
  pixels.base_color = {{1.0f, 1.0f, 1.0f, -1.0f}};
  const Truth truth = ComputeTruth(scene, pixels);
  EXPECT_NEAR(truth.radiance.diffuse[0].x, 0.625, 2e-3);
  const ShadowedTruth shadowed = ComputeShadowedTruth(scene, pixels, truth.radiance, {}, {0.005, {}});
  EXPECT_NEAR(shadowed.radiance.diffuse[0].x, 0.125, 0.01);
  scene.sky->turn = glm::pi<double>();
  const Truth other = ComputeTruth(scene, pixels);
  EXPECT_NEAR(ComputeShadowedTruth(scene, pixels, other.radiance, {}, {0.005, {}}).radiance.diffuse[0].x, 0.5, 0.02);
}

// The forms against finer rules of their own definitions.
TEST(SkyForms, AreTheirIntegrals) {
  const std::shared_ptr<const Image> shown = MakeImage(128, Day);
  const Image& image = *shown;
  const Sky sky = Showing(shown);
  const TextureLevels cosine = MakeSkyLevels("sky_cosine", image)[0];
  const std::vector<TextureLevels> lobes = MakeSkyLevels("sky_lobes", image);
  ASSERT_EQ(lobes.size(), 4U);
  const auto at = [](const TextureLevels& form, std::size_t level, int x, int y) {
    const int width = form.size.x >> level;
    return dvec3(form.levels[level][static_cast<std::size_t>(y * width + width / 10 + x)]);
  };
  double cosine_error = 0.0, lobe_error = 0.0;
  for (const auto& [level, layer] : {std::pair(1, 1), std::pair(2, 0), std::pair(3, 2), std::pair(5, 0)}) {
    const double alpha = 4.0 * glm::pi<double>() / 512.0 * std::exp2(level + 0.25 * layer);
    for (int k = 0; k < 6; ++k) {
      const int around = 512 >> level, x = around * k / 6, y = around / 2 * k / 8;
      const dvec3 axis = SkyDirection({(x + 0.5) / around, y / (around / 2 - 1.0)}, 0.0);
      // D(h) G1(l)/4 over the hemisphere, steps even in u.
      const dvec3 side = glm::normalize(glm::cross(axis, dvec3(0.3, 0.5, 0.81))), up = glm::cross(side, axis);
      dvec3 sum(0.0);
      double weight = 0.0;
      for (int i = 0; i < 300; ++i) {
        const double u = (i + 0.5) / 300.0 / (1.0 + alpha * alpha), tan2_h = alpha * alpha * u / (1.0 - u), z = 2.0 / (1.0 + tan2_h) - 1.0, s = std::sqrt(1.0 - z * z);
        const double w = 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * (1.0 / (z * z) - 1.0)));
        for (int j = 0; j < 200; ++j) {
          const double phi = 2.0 * glm::pi<double>() * (j + 0.5) / 200.0;
          sum += w * SkyRadiance(sky, side * (s * std::cos(phi)) + up * (s * std::sin(phi)) + axis * z);
          weight += w;
        }
      }
      const dvec3 exact = sum / weight;
      lobe_error = std::max(lobe_error, glm::length(at(lobes[static_cast<std::size_t>(layer)], static_cast<std::size_t>(level), x, y) - exact) / glm::length(exact));
    }
  }
  for (int k = 0; k < 6; ++k) {
    const int x = 128 * k / 6, y = 64 * k / 8;
    ShadedPixel pixel{{dvec3(0.0), SkyDirection({(x + 0.5) / 128.0, y / 63.0}, 0.0), {}, 1.0}, dvec3(1.0), dvec3(0.0), 0.0};
    pixel.point.to_view = pixel.point.normal;
    const dvec3 exact = BruteForce(sky, pixel, [](const dvec3&) { return false; }).diffuse;
    cosine_error = std::max(cosine_error, glm::length(at(cosine, 0, x, y) - exact) / glm::length(exact));
  }
  EXPECT_LT(cosine_error, 1e-3);  // measured 5.3e-4
  EXPECT_LT(lobe_error, 0.08);  // measured 0.054, beside the sun
}

// The split sum against the truth, of metal: two-sided bands of the specular lobe. Of a dielectric the diffuse lobe is exact but for its form.
TEST_F(TexturedSkyPicture, SplitSumIsInItsBand) {
  Scene scene = BallUnder(Showing(MakeImage(256, Day)), 0.3f);
  const auto measured = [&](std::vector<glm::vec3> RadianceImage::*lobe) {
    const SurfacePixels& pixels = Draw(scene);
    return RelativeRmse(Shade("ltc").*lobe, ComputeTruth(scene, pixels).radiance.*lobe);
  };
  EXPECT_LT(measured(&RadianceImage::diffuse), 5e-4);  // 1.3e-4
  scene.materials[0].metalness = 1.0f;
  for (const auto& [roughness, expected] : {std::pair(0.1f, 0.035), std::pair(0.3f, 0.094), std::pair(0.6f, 0.119), std::pair(1.0f, 0.056)}) {
    scene.materials[0].roughness = glm::vec2(roughness);
    const double error = measured(&RadianceImage::specular);
    EXPECT_GT(error, 0.8 * expected) << roughness;
    EXPECT_LT(error, 1.2 * expected) << roughness;
  }
}

TEST_F(TexturedSkyPicture, OatFillsFromAnEvenSkyAlone) {
  const Scene scene = BallUnder(Showing(MakeImage(16, Day)), 0.5f);
  EXPECT_THAT(WhyUnsupported(ParseVariant(techniques_, "oat"), scene).value_or(""),
              testing::HasSubstr("oat fills from a sky that is the same everywhere; the scene's shows a texture"));
  EXPECT_FALSE(WhyUnsupported(ParseVariant(techniques_, "ltc"), scene));
  EXPECT_EQ(SceneEffect(scene, "sky_texture").reason, "the sky shows a texture");
  EXPECT_FALSE(SceneEffect(BallUnder(Sky(dvec3(1.0)), 0.5f), "sky_texture").on);
}

}  // namespace
}  // namespace arealab::textured_sky_test
