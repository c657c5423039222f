#include "glsl/per_pixel.h"

#include <fmt/format.h>

#include <algorithm>

#include "glsl/declarations.h"

namespace arealab {
namespace {

// The defines of a text that asks for needs: the scene's, but for effects that are not worth asking for.
EffectDefines AskingDefines(const Variant& variant, const std::vector<Effect>& effects, int asked) {
  EffectDefines defines = Defines(effects, VariantFor(variant, asked, ~0).effects);
  defines.emplace_back("NEEDS_LIGHT", kNeedsLight);
  for (const PixelNeed& need : kPixelNeeds) defines.emplace_back("NEEDS_" + Effect{need.effect, true, ""}.Define().substr(7), need.bit);
  return defines;
}

// Whether some of the scene's surfaces may be without the lobe.
bool SomeLack(const std::string& lobe, const Scene& scene) {
  return std::ranges::any_of(scene.materials, [&](const Material& material) {
    const bool metal = material.metalness >= 1.0f || material.metallic_roughness_texture;
    return lobe == "diffuse" ? metal || material.base_color == glm::vec3(0.0f) || material.base_color_texture : material.specular == 0.0f;
  });
}

}  // namespace

int NeedsToAsk(const ShaderLibrary& library, const Variant& variant, const std::vector<Effect>& effects, const Scene& scene) {
  const EffectDefines defines = Defines(effects, variant.effects);
  std::string text;
  if (variant.technique) text = Expand(library, "lighting.frag", variant, defines, Precision::kFloat, scene.brdfs()).text;
  int asked = 0;
  for (const PixelNeed& need : kPixelNeeds) {
    const std::string name = need.effect, define = Effect{name, true, ""}.Define();
    const bool lobe = name == "diffuse" || name == "specular";
    const bool on = std::ranges::find(defines, std::pair(define, 1)) != defines.end();
    const bool read = text.empty() || text.find(define, text.find(define) + 1) != std::string::npos;  // beside its definition
    if (on && read && (!lobe || SomeLack(name, scene))) asked |= need.bit;
  }
  return asked;
}

ExpandedSource NeedsSource(const ShaderLibrary& library, const Variant& variant, const std::vector<Effect>& effects, int asked, int tile_size) {
  EffectDefines defines = AskingDefines(variant, effects, asked);
  defines.emplace_back("TILE_SIZE", tile_size);
  return Expand(library, "needs.frag", {}, defines, Precision::kFloat);
}

Variant VariantFor(Variant variant, int needs, int asked) {
  for (const PixelNeed& need : kPixelNeeds) {
    if (asked & ~needs & need.bit) variant.effects[need.effect] = false;
  }
  return variant;
}

ExpandedSource BranchSource(const ShaderLibrary& library, const Variant& variant, const std::vector<Effect>& effects, Precision precision, Brdfs brdfs) {
  const Variant without = VariantFor(variant, 0, kHorizonNeeds);
  ExpandedSource fused = Expand(library, "lighting.frag", variant, Defines(effects, variant.effects), precision, brdfs);
  std::map<std::string, std::set<std::string>> shared;  // code by name
  for (const Declaration& declaration : Declarations(Decide(fused).lines)) {
    for (const std::string& name : declaration.names) shared[name].insert(WithoutComments(declaration.text));
  }
  const auto append = [&](const Declaration& declaration, const std::map<std::string, std::string>& renamed) {
    const std::string text = ReplaceWords(declaration.text, renamed);
    fused.text += text;
    fused.origins.resize(fused.origins.size() + static_cast<std::size_t>(std::ranges::count(text, '\n')), {declaration.file, 1});
  };
  // What differs, or calls what differs, gets another name.
  const std::vector<Declaration> second =
      Declarations(Decide(Expand(library, "lighting.frag", without, Defines(effects, without.effects), precision, brdfs)).lines);
  std::map<std::string, std::string> renamed{{"main", "ShadeWithoutHorizon"}};
  const auto own = [&](const Declaration& declaration) {
    const auto is_renamed = [&](const std::string& name) { return renamed.contains(name); };
    return std::ranges::any_of(declaration.names, [&](const std::string& name) { return !shared[name].contains(WithoutComments(declaration.text)); }) ||
           std::ranges::any_of(declaration.names, is_renamed) || std::ranges::any_of(declaration.uses, is_renamed);
  };
  for (std::size_t before = 0; before != renamed.size();) {
    before = renamed.size();
    for (const Declaration& declaration : second) {
      if (!own(declaration)) continue;
      for (const std::string& name : declaration.names) renamed.emplace(name, name + "WithoutHorizon");
    }
  }
  const std::map<std::string, std::string> first{{"main", "ShadeWithHorizon"}};
  fused.text = ReplaceWords(fused.text, first);
  for (const Declaration& declaration : second) {
    if (!declaration.names.empty() && own(declaration)) append(declaration, renamed);
  }
  const DecidedText branch = Decide(Expand(library, "branch.frag", {}, AskingDefines(variant, effects, kHorizonNeeds), precision));
  for (const Declaration& declaration : Declarations(branch.lines)) {
    const auto known = [&](const std::string& name) { return name != "main" && shared.contains(name); };
    if (!declaration.names.empty() && std::ranges::none_of(declaration.names, known)) append(declaration, branch.host);
  }
  return fused;
}

}  // namespace arealab
