// Pruning never changes the picture: what a scene is proven not to call for can be left out of the program, or be left in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "compare/context.h"
#include "glsl/per_pixel.h"
#include "glsl/renderer.h"
#include "scenes/error.h"
#include "tests/compare/random_scenes.h"

namespace arealab::pruning_test {
namespace {

// Of the largest radiance that the lights together give a pixel, lobe by lobe.
constexpr float kTolerance = 1e-6f;

struct Difference {
  float largest = 0.0f;  // over the lobe's largest radiance
  std::size_t exact = 0, pixels = 0;
  std::string where;

  void Add(const Difference& other) {
    exact += other.exact;
    pixels += other.pixels;
    if (other.largest <= largest) return;
    largest = other.largest;
    where = other.where;
  }
};

Difference Between(const RadianceImage& pruned, const RadianceImage& all, const std::string& where) {
  Difference difference;
  difference.where = where;
  difference.pixels = all.size();
  for (const auto lobe : {&RadianceImage::diffuse, &RadianceImage::specular}) {
    float most = 0.0f, apart = 0.0f;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const float a = (pruned.*lobe)[i][c], b = (all.*lobe)[i][c];
        most = std::max(most, std::abs(b));
        // A pixel that is no number in one must be none in the other.
        const float here = std::isnan(a) && std::isnan(b) ? 0.0f : std::abs(a - b);
        apart = std::isnan(here) ? std::numeric_limits<float>::infinity() : std::max(apart, here);
      }
    }
    if (apart > 0.0f) difference.largest = std::max(difference.largest, apart / std::max(most, 1e-30f));
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    difference.exact += pruned.diffuse[i] == all.diffuse[i] && pruned.specular[i] == all.specular[i];
  }
  return difference;
}

// A draw of the scene by the variant, pruned and not.
Difference Pruned(Renderer& renderer, const Scene& scene, const Variant& variant) {
  const RadianceImage pruned = renderer.Shade(variant);
  const RadianceImage all = renderer.Shade(WithAllEffects(variant));
  return Between(pruned, all, variant.Name() + " in " + scene.name);
}

// A draw by tiles and, where there is a horizon to ask for, by a branch, against one program for all pixels.
Difference AskedPerPixel(Renderer& renderer, const Scene& scene, Variant variant) {
  const RadianceImage one = renderer.Shade(variant);
  variant.per_pixel = PerPixel::kTiles;
  const int asked = renderer.TileNeeds(variant).asked;
  Difference difference = Between(renderer.Shade(variant), one, variant.Name() + " in " + scene.name);
  if (asked & kHorizonNeeds) {
    variant.per_pixel = PerPixel::kBranch;
    difference.Add(Between(renderer.Shade(variant), one, variant.Name() + " in " + scene.name));
  }
  return difference;
}

// How far the light reaches from its centre along a unit normal, in double.
double Reach(const Light& light, const glm::dvec3& normal) {
  const double x = std::abs(glm::dot(normal, light.axis_x)) * light.half_size.x, y = std::abs(glm::dot(normal, light.axis_y)) * light.half_size.y;
  switch (light.shape) {
    case LightShape::kSphere:
      return light.half_size.x;
    case LightShape::kDisk:
    case LightShape::kEllipse:
      return std::hypot(x, y);
    case LightShape::kTube:
      return x + light.half_size.y * glm::length(glm::cross(normal, light.axis_x));
    case LightShape::kRectangle:
    case LightShape::kPolygon:
      break;
  }
  return x + y;
}

// What one pixel needs by itself, in double and without a margin.
int NeedsOf(const Scene& scene, const SurfacePixels& pixels, std::size_t i) {
  const glm::dvec3 position(pixels.position[i]), normal(pixels.normal[i]);
  if (pixels.position[i].w != 1.0f || glm::dot(normal, glm::dvec3(pixels.view_position) - position) <= 0.0) return 0;
  int needs = scene.sky ? kNeedsLight : 0;
  for (const Light& light : scene.lights) {
    const glm::dvec3 to_center = light.center - position;
    if (IsFlat(light.shape) && !light.two_sided && glm::dot(light.normal, to_center) >= 0.0) continue;
    needs |= kNeedsLight;
    if (std::abs(glm::dot(normal, to_center)) < Reach(light, normal)) needs |= kHorizonNeeds;
  }
  const glm::vec4& base = pixels.base_color[i];
  if (needs != 0) needs |= (base.w != 1.0f && glm::vec3(base) != glm::vec3(0.0f) ? 8 : 0) | (base.w != -1.0f ? 16 : 0);
  return needs;
}

class Pruning : public testing::Test {
 protected:
  Pruning() : context_(CreateContext(ContextKind::kOsmesa)), techniques_(LoadTechniques(library_)) {}

  std::unique_ptr<Context> context_;
  ShaderLibrary library_;
  std::vector<Technique> techniques_;
};

TEST_F(Pruning, KeepsTheBuiltInScenes) {
  Renderer renderer(context_->gl(), library_);
  Difference worst;
  for (const auto& file : BuiltInScenes()) {
    const Scene scene = LoadScene(file);
    renderer.DrawScene(scene, {48, 48});
    for (const Technique& technique : techniques_) {
      const Variant variant = DefaultVariant(technique);
      if (technique.yardstick || WhyUnsupported(variant, scene)) continue;
      const Difference difference = Pruned(renderer, scene, variant);
      EXPECT_LE(difference.largest, kTolerance) << difference.where;
      worst.Add(difference);
    }
  }
  fmt::print("largest difference {:.2g} ({}), {} of {} pixels exactly equal\n", worst.largest, worst.where, worst.exact, worst.pixels);
}

// AREALAB_RANDOM_SCENES: how many, default 500. Each kind of scene is drawn by one variant that supports it, the next one with every
// further 500: what takes long is compiling.
TEST_F(Pruning, KeepsRandomScenes) {
  const char* asked = std::getenv("AREALAB_RANDOM_SCENES");
  const unsigned count = asked ? static_cast<unsigned>(std::stoul(asked)) : 500;
  Renderer renderer(context_->gl(), library_);
  Difference worst;
  std::map<std::string, int> off;
  std::map<int, std::size_t> turn;
  for (unsigned seed = 0; seed < count; ++seed) {
    const Scene scene = RandomScenes::Make(seed);
    std::vector<Variant> variants;
    for (const Technique& technique : techniques_) {
      for (const Variant& variant : {DefaultVariant(technique), PublishedVariant(technique)}) {
        if (!technique.yardstick && technique.name != "reference" && !WhyUnsupported(variant, scene)) variants.push_back(variant);
      }
    }
    for (const Effect& effect : SceneEffects(scene)) off[effect.name] += !effect.on;
    renderer.DrawScene(scene, {24, 24});
    const Variant& variant = variants[(seed % RandomScenes::kKinds + seed / 500) % variants.size()];
    SCOPED_TRACE(fmt::format("seed {}", seed));
    Difference difference = Pruned(renderer, scene, variant);
    if (seed < count / 10) difference.Add(AskedPerPixel(renderer, scene, variant));
    EXPECT_LE(difference.largest, kTolerance) << difference.where;
    worst.Add(difference);
  }
  // A generator that calls for everything would test nothing.
  for (const auto& [name, times] : off) EXPECT_GT(times, static_cast<int>(count / 50)) << name << " is hardly ever off";
  fmt::print("{} scenes, largest difference {:.2g} ({}), {} of {} pixels exactly equal\n", count, worst.largest, worst.where,
             worst.exact, worst.pixels);
}

// Asking each pixel what it needs changes nothing either, on sizes that no tile divides.
TEST_F(Pruning, AskingPixelsKeepsTheBuiltInScenes) {
  Renderer renderer(context_->gl(), library_);
  Difference worst;
  for (const auto& file : BuiltInScenes()) {
    const Scene scene = LoadScene(file);
    renderer.DrawScene(scene, {61, 45});
    for (const char* name : {"ltc", "oat"}) {
      const Variant variant = ParseVariant(techniques_, name);
      if (WhyUnsupported(variant, scene)) continue;
      const Difference difference = AskedPerPixel(renderer, scene, variant);
      EXPECT_LE(difference.largest, kTolerance) << difference.where;
      worst.Add(difference);
    }
  }
  fmt::print("largest difference {:.2g} ({}), {} of {} pixels exactly equal\n", worst.largest, worst.where, worst.exact, worst.pixels);
}

// Tiles need at least what each of their pixels needs, and seldom more: a classification that says yes to everything would be right too.
TEST_F(Pruning, TilesNeedWhatTheirPixelsNeed) {
  Renderer renderer(context_->gl(), library_);
  constexpr glm::ivec2 kSize(192, 150);
  std::size_t lit = 0, dark = 0, crossed = 0, needed_light = 0, needed_horizon = 0;
  for (const auto& file : BuiltInScenes()) {
    const Scene scene = LoadScene(file);
    const SurfacePixels& pixels = renderer.DrawScene(scene, kSize);
    const Renderer::Needs needs = renderer.TileNeeds();
    std::vector<int> together(needs.of_tile.size(), 0);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const int x = static_cast<int>(i) % kSize.x / kTileSize, y = static_cast<int>(i) / kSize.x / kTileSize;
      together[static_cast<std::size_t>(y * needs.tiles.x + x)] |= NeedsOf(scene, pixels, i);
    }
    for (std::size_t t = 0; t < together.size(); ++t) {
      const int asked = needs.asked | kNeedsLight;
      EXPECT_EQ(together[t] & asked & ~needs.of_tile[t], 0) << scene.name << ", tile " << t;
      lit += (needs.of_tile[t] & kNeedsLight) != 0;
      dark += needs.of_tile[t] == 0;
      crossed += (needs.of_tile[t] & 2) != 0;
      needed_light += (together[t] & kNeedsLight) != 0;
      needed_horizon += (together[t] & needs.asked & 2) != 0;
    }
  }
  fmt::print("{} tiles are lit, {} of them need be; {} black; {} are crossed by a horizon, {} need be\n", lit, needed_light, dark, crossed, needed_horizon);
  EXPECT_LT(static_cast<double>(lit), 1.02 * static_cast<double>(needed_light));
  EXPECT_LT(static_cast<double>(crossed), 1.3 * static_cast<double>(needed_horizon));
  EXPECT_GT(dark, lit / 10);
}

// The instrument: a wrongly dropped effect is seen.
TEST_F(Pruning, AWronglyDroppedEffectIsSeen) {
  Renderer renderer(context_->gl(), library_);
  const Scene scene = LoadScene(FindScene("sinking"));
  renderer.DrawScene(scene, {48, 48});
  const Variant wrong = ParseVariant(techniques_, "ltc+effect_horizon=0");
  EXPECT_EQ(wrong.Name(), "ltc+effect_horizon=0");
  EXPECT_GT(Pruned(renderer, scene, wrong).largest, 0.0f);
  const RadianceImage all = renderer.Shade(ParseVariant(techniques_, "ltc+effects=all"));
  EXPECT_GT(Between(renderer.Shade(wrong), all, "").largest, 1e-2f);
}

}  // namespace
}  // namespace arealab::pruning_test
