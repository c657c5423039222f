// Every variant that the technique headers allow compiles and links, in both precisions. The list is
// generated: a new technique, option or built-in scene is in it by being there.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "compare/context.h"
#include "glsl/effects.h"
#include "glsl/expand.h"
#include "glsl/program.h"
#include "glsl/variant.h"
#include "scenes/error.h"

namespace arealab::variants_compile_test {
namespace {

// Everything on but the shapes that the technique does not do.
EffectDefines AllOn(const Technique& technique) {
  EffectDefines effects = Defines(SceneEffects(Scene{}));
  const auto does = [&](LightShape shape) {
    return std::count(technique.shapes.begin(), technique.shapes.end(), shape) > 0;
  };
  for (auto& [name, value] : effects) {
    value = 1;
    if (name == "EFFECT_RECTANGLE") value = does(LightShape::kRectangle);
    if (name == "EFFECT_DISK") value = does(LightShape::kDisk);
    if (name == "EFFECT_SPHERE") value = does(LightShape::kSphere);
    if (name == "EFFECT_POLYGON") value = does(LightShape::kPolygon);
    if (name == "EFFECT_TUBE") value = does(LightShape::kTube);
    if (name == "EFFECT_ELLIPSE") value = does(LightShape::kEllipse);
  }
  return effects;
}

class Variants : public testing::TestWithParam<Precision> {};

TEST_P(Variants, EverySupportedOneCompiles) {
  const auto context = CreateContext(ContextKind::kOsmesa);
  const ShaderLibrary library;
  const std::vector<Technique> techniques = LoadTechniques(library);
  const std::vector<Variant> variants = AllVariants(techniques);
  ASSERT_FALSE(variants.empty());
  std::vector<Scene> scenes;
  for (const auto& file : BuiltInScenes()) scenes.push_back(LoadScene(file));
  ASSERT_FALSE(scenes.empty());

  const ExpandedSource fullscreen = Expand(library, "fullscreen.vert", {}, {}, Precision::kFloat);
  int compiled = 0;
  const std::vector<Variant> forms = DefaultVariants(techniques);
  for (const Variant& variant : variants) {
    std::set<EffectDefines> effect_sets{AllOn(*variant.technique)};
    // Options do not look at effects: the scenes' own sets with each technique's default and published form.
    const bool is_form = std::find(forms.begin(), forms.end(), variant) != forms.end();
    for (const Scene& scene : scenes) {
      if (is_form && !WhyUnsupported(variant, scene)) effect_sets.insert(Defines(SceneEffects(scene)));
    }
    // Nor do they look at the BRDFs: the others with the two forms.
    std::vector<Brdfs> others;
    for (const Brdf brdf : kBrdfs) {
      if (brdf != Brdf::kGgx && std::ranges::count(variant.technique->brdfs, Name(brdf)) > 0) others.emplace_back(brdf);
    }
    for (const Brdf brdf : kDiffuseBrdfs) {
      if (brdf != Brdf::kLambert && std::ranges::count(variant.technique->diffuse_brdfs, Name(brdf)) > 0) others.emplace_back(Brdf::kGgx, brdf);
    }
    for (const Brdfs& brdfs : others) {
      if (!is_form) break;
      SCOPED_TRACE(fmt::format("{} with {} and {}", variant.Name(), Name(brdfs.specular), Name(brdfs.diffuse)));
      try {
        const Program program(context->gl(), fullscreen,
                              Expand(library, "lighting.frag", variant, AllOn(*variant.technique), GetParam(), brdfs));
      } catch (const InputError& error) {
        ADD_FAILURE() << error.what();
      }
    }
    for (const EffectDefines& effects : effect_sets) {
      std::string on;
      for (const auto& [name, value] : effects) on += value ? " " + name : "";
      SCOPED_TRACE(variant.Name() + " with" + on);
      try {
        const Program program(context->gl(), fullscreen,
                              Expand(library, "lighting.frag", variant, effects, GetParam()));
        ++compiled;
      } catch (const InputError& error) {
        ADD_FAILURE() << error.what();
      }
    }
  }
  EXPECT_GE(compiled, static_cast<int>(variants.size()));
}

INSTANTIATE_TEST_SUITE_P(Precision, Variants, testing::Values(Precision::kFloat, Precision::kDouble),
                         [](const auto& precision) {
                           return precision.param == Precision::kFloat ? "Float" : "Double";
                         });

}  // namespace
}  // namespace arealab::variants_compile_test
