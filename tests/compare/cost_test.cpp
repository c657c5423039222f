#include "compare/cost.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "glsl/effects.h"
#include "scenes/error.h"
#include "tests/glsl/temporary_folder.h"

namespace arealab::cost_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<std::string> kUsual = {"rectangle", "diffuse", "specular", "fresnel"};

std::vector<Variant> Variants(const std::vector<Technique>& techniques, const std::vector<std::string>& names) {
  std::vector<Variant> variants;
  for (const std::string& name : names) variants.push_back(ParseVariant(techniques, name));
  return variants;
}

TEST(Cost, SixteenHundredCyclesAreTheTalksNineTenthsOfAMillisecond) {
  EXPECT_NEAR(MillisecondsAt1080p("bonaire", 1600.0), 0.9, 1e-12);
  EXPECT_FALSE(std::isfinite(MillisecondsAt1080p("navi21", 1600.0)));  // no console that anybody measured on
}

TEST(Cost, FiguresRepeatExactlyAndCostNothingTheSecondTime) {
  const TemporaryFolder folder;
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  const std::vector<Variant> variants = Variants(techniques, {"point", "ltc@published", "karis", "hill"});
  const Scene scene = SceneOfEffects(kUsual);
  const CostMeter meter({"bonaire", "navi21"}, folder.path() / "cache");
  const auto first = meter.Measure(library, variants, scene);
  const auto again = CostMeter({"bonaire", "navi21"}, folder.path() / "other").Measure(library, variants, scene);
  int compiled = 0;
  const auto cached = meter.Measure(library, variants, scene, [&](double) { ++compiled; });
  EXPECT_EQ(compiled, 0);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    for (const auto& [gpu, cost] : first[v]) {
      EXPECT_EQ(again[v].at(gpu).core, cost.core) << gpu;
      EXPECT_EQ(again[v].at(gpu).full, cost.full) << gpu;
      EXPECT_EQ(cached[v].at(gpu).core, cost.core) << gpu;
      EXPECT_EQ(cached[v].at(gpu).paths, cost.paths) << gpu;
    }
  }
  EXPECT_TRUE(first[2].empty()) << "karis takes no rectangle";

  const GpuCost& point = first[0].at("bonaire");
  const GpuCost& ltc = first[1].at("bonaire");
  EXPECT_TRUE(point.paths.empty());
  EXPECT_GT(point.core.cycles, 200);
  EXPECT_GT(ltc.core.cycles, 2 * point.core.cycles);
  // A wave that takes one path pays for all of it; one below the horizon learns that first.
  EXPECT_GT(ltc.paths.at("crossing").cycles, ltc.paths.at("above").cycles);
  EXPECT_GT(ltc.paths.at("above").cycles, 2 * ltc.paths.at("below").cycles);
  EXPECT_GT(ltc.paths.at("below").cycles, 200);
  EXPECT_FALSE(ltc.paths.contains("near"));
  // A proxy asks for no horizon; what a near light's obtuse sides need stands behind a branch.
  const GpuCost& hill = first[3].at("bonaire");
  ASSERT_EQ(hill.paths.size(), 2u);
  EXPECT_GT(hill.paths.at("near").cycles, 1.1 * hill.paths.at("far").cycles);
  // The pass adds reading and writing the G-buffer: guards that are assumed passed discount nothing.
  EXPECT_NEAR(ltc.full.cycles, ltc.core.cycles, 0.1 * ltc.core.cycles);
  EXPECT_GT(first[1].at("navi21").core.cycles, 0);
}

TEST(Cost, MoreWorkIsMoreCycles) {
  const TemporaryFolder folder;
  const ShaderLibrary plain;
  std::string text = *plain.Find("far_field.glsl");
  const std::string end = "  return radiance;\n}\n";
  text.replace(text.rfind(end), end.size(), "  radiance.specular *= exp(sin(surface.position.x));\n" + end);
  const TemporaryFolder live;
  live.Write("far_field.glsl", text);
  const ShaderLibrary changed(live.path());
  const std::vector<Technique> techniques = LoadTechniques(plain), changed_techniques = LoadTechniques(changed);
  const CostMeter meter({"bonaire"}, folder.path() / "cache");
  const Scene scene = SceneOfEffects(kUsual);
  const auto before = meter.Measure(plain, Variants(techniques, {"point"}), scene);
  const auto after = meter.Measure(changed, Variants(changed_techniques, {"point"}), scene);
  EXPECT_GT(after[0].at("bonaire").core.cycles, before[0].at("bonaire").core.cycles + 16);
}

TEST(Cost, AnErrorNamesTheAuthorsLine) {
  const TemporaryFolder folder, live;
  live.Write("techniques/point.glsl", *ShaderLibrary().Find("techniques/point.glsl") + "float Broken() { return nothing; }\n");
  const ShaderLibrary library(live.path());
  const std::vector<Technique> techniques = LoadTechniques(library);
  const CostMeter meter({"bonaire"}, folder.path() / "cache");
  EXPECT_THAT([&] { meter.Measure(library, Variants(techniques, {"point"}), SceneOfEffects(kUsual)); },
              ThrowsMessage<InputError>(testing::AllOf(HasSubstr("techniques/point.glsl:"), HasSubstr("nothing"))));
}

TEST(Cost, WhatIsMissingIsSaidInALine) {
  const auto meter = [](std::string gpu, CostTools tools) { return CostMeter({gpu}, "", std::move(tools)); };
  CostTools tools = CostTools::FromEnvironment();
  EXPECT_THAT([&] { meter("voodoo", tools); }, ThrowsMessage<InputError>(HasSubstr("no GPU \"voodoo\"; expected of")));
  tools.driver = "/nowhere/radeon_icd.json";
  EXPECT_THAT([&] { meter("bonaire", tools); }, ThrowsMessage<InputError>(HasSubstr("package mesa-vulkan-drivers")));
  tools = CostTools::FromEnvironment();
  tools.vulkan = "libnowhere.so";
  EXPECT_THAT([&] { meter("bonaire", tools); }, ThrowsMessage<InputError>(HasSubstr("libvulkan does not load")));
}

TEST(Cost, ASceneOfEffectsHasThemAndNoOthers) {
  const auto on = [](const Scene& scene) {
    std::vector<std::string> names;
    for (const char* name : {"rectangle", "disk", "sphere", "two_sided", "diffuse", "specular", "fresnel", "many_lights"}) {
      if (SceneEffect(scene, name).on) names.push_back(name);
    }
    for (const char* name : {"horizon", "proxy_horizon", "behind", "turned_away"}) EXPECT_TRUE(SceneEffect(scene, name).on) << name;
    return names;
  };
  EXPECT_THAT(on(SceneOfEffects(kUsual)),
              testing::UnorderedElementsAre("rectangle", "diffuse", "specular", "fresnel"));
  EXPECT_THAT(on(SceneOfEffects({"disk", "two_sided", "specular", "many_lights", "fresnel"})),
              testing::UnorderedElementsAre("disk", "two_sided", "specular", "fresnel",
                                            "many_lights"));
  EXPECT_THAT([] { SceneOfEffects({"rectangle", "glow"}); }, ThrowsMessage<InputError>(HasSubstr("no effect \"glow\"")));
  EXPECT_THAT([] { SceneOfEffects({"rectangle", "sphere", "specular", "diffuse", "fresnel"}); },
              ThrowsMessage<InputError>(HasSubstr("without many_lights")));
}

}  // namespace
}  // namespace arealab::cost_test
