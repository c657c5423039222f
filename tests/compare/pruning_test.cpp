// Pruning never changes the picture: what a scene is proven not to call for can be left out of the program, or be left in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "compare/context.h"
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
    const Difference difference = Pruned(renderer, scene, variant);
    EXPECT_LE(difference.largest, kTolerance) << difference.where;
    worst.Add(difference);
  }
  // A generator that calls for everything would test nothing.
  for (const auto& [name, times] : off) EXPECT_GT(times, static_cast<int>(count / 50)) << name << " is hardly ever off";
  fmt::print("{} scenes, largest difference {:.2g} ({}), {} of {} pixels exactly equal\n", count, worst.largest, worst.where,
             worst.exact, worst.pixels);
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
