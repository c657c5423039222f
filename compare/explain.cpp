#include "compare/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compare/timing.h"
#include "glsl/expand.h"
#include "glsl/per_pixel.h"
#include "scenes/error.h"

namespace arealab {
namespace {

Estimate Inverse(const Estimate& ratio) { return {1.0 / ratio.value, 1.0 / ratio.high, 1.0 / ratio.low}; }

bool IsShape(const std::string& effect) {
  return std::ranges::any_of(kLightShapes,
                             [&](LightShape shape) { return effect == Name(shape); });
}

// Whether a scene with that effect too, of which this one has no data to draw with, could be shaded: its cycles can be counted.
bool MayBeCounted(const Effect& effect, const Variant& variant, const Scene& scene, std::vector<Effect> effects) {
  static const std::set<std::string> kOfData{"aperture", "textured", "sky"};
  if (effect.on || !kOfData.contains(effect.name)) return false;
  std::ranges::find(effects, effect.name, &Effect::name)->on = true;
  return !WhyUnsupported(variant, scene, effects);
}

// Turned off, a shape of the scene or all lights but one would be missing: that is another scene, not a saving.
bool MayBeTurned(const Effect& effect, const Variant& all) {
  if (effect.on) return !IsShape(effect.name) && effect.name != "many_lights";
  return all.effects.count(effect.name) > 0;
}

Variant PerPixelForm(Variant variant, PerPixel way) {
  variant.per_pixel = way;
  return variant;
}

// What both ways cost on GPUs over the one program, from how many tiles, each a wave, are of which class. A wave is counted on the path that it
// takes there: some light crosses a horizon, or none does. Of a branch at least: a wave may need both sides.
void EstimateWays(const CostMeter& meter, const ShaderLibrary& library, const Scene& scene, const std::vector<Effect>& effects, const Variant& variant,
                  const Renderer::Needs& needs, Saving& saving) {
  std::map<int, int> tiles;  // that are lit, by what they need
  for (const int of_tile : needs.of_tile) {
    if (of_tile & kNeedsLight) ++tiles[of_tile];
  }
  std::vector<ExpandedSource> passes{NeedsSource(library, variant, effects, needs.asked, kTileSize),
                                     NeedsSource(library, variant, effects, needs.asked & kHorizonNeeds, 1)};
  const auto pass = [&](int needed, int asked) {
    const Variant own = VariantFor(variant, needed, asked);
    EffectDefines defines = Defines(effects, own.effects);
    for (const char* path : {"PATH_LIT", "PATH_FAR", needed & kHorizonNeeds ? "PATH_CROSSING" : "PATH_ABOVE"}) defines.emplace_back(path, 1);
    passes.push_back(Expand(library, "lighting.frag", own, defines, Precision::kFloat, scene.brdfs()));
  };
  for (const auto& [needed, count] : tiles) {
    pass(needed, 0);
    pass(needed, needs.asked);
    pass(needed, needs.asked & kHorizonNeeds);
  }
  const auto costs = meter.MeasurePasses(library, passes);
  for (const std::string& gpu : meter.gpus()) {
    const auto cycles = [&](std::size_t i) { return static_cast<double>(costs[i].at(gpu).cycles); };
    constexpr double kTilesInWave = 64.0;  // a lane asks for a tile
    double one = 0.0, by_tiles = cycles(0) * static_cast<double>(needs.of_tile.size()) / kTilesInWave, by_branch = 0.0;
    std::size_t first = 2;
    for (const auto& [needed, count] : tiles) {
      one += count * cycles(first);
      by_tiles += count * cycles(first + 1);
      by_branch += count * (cycles(1) + cycles(first + 2));
      first += 3;
    }
    if (saving.per_pixel.contains("tiles")) saving.per_pixel["tiles"].cycles[gpu] = by_tiles / one;
    if (saving.per_pixel.contains("branch")) saving.per_pixel["branch"].cycles[gpu] = by_branch / one;
  }
}

}  // namespace

Explanation Explain(const Context& context, Renderer& renderer, const ShaderLibrary& library, const Scene& scene, const Variant& variant,
                    const ExplainOptions& options) {
  std::vector<Effect> effects = SceneEffects(scene);
  if (const auto reason = WhyUnsupported(variant, scene, effects)) {
    throw InputError(fmt::format("{}: {}; expected a technique that supports the scene", scene.file.string(), *reason));
  }
  Explanation explanation;
  explanation.variant = variant.Name();
  // First the program itself, for its cycles, and the one with every effect, then one per effect with that turned the other way.
  const Variant all = WithAllEffects(variant);
  const std::string text =
      Expand(library, "lighting.frag", variant, Defines(effects, variant.effects), Precision::kFloat, scene.brdfs()).text;
  std::vector<Variant> programs{variant, all};
  std::vector<std::size_t> turned;  // by program, from the third
  for (std::size_t i = 0; i < effects.size(); ++i) {
    EffectPrice price{effects[i], false, true, {}, {}};
    const std::string define = effects[i].Define();
    price.asked = text.find(define, text.find(define) + 1) != std::string::npos;  // beside its definition
    if (const auto forced = variant.effects.find(effects[i].name); forced != variant.effects.end()) {
      price.effect.on = forced->second;
      price.forced = true;
    }
    if (options.prices && price.asked && MayBeTurned(price.effect, all)) {
      programs.push_back(variant);
      programs.back().effects[price.effect.name] = !price.effect.on;
      turned.push_back(i);
    }
    explanation.effects.push_back(std::move(price));
  }

  const bool lambert = scene.diffuse == Brdf::kLambert;
  if (!lambert) {
    const std::string name = Name(scene.diffuse);
    explanation.effects.push_back({{name, true, fmt::format("the scene's diffuse BRDF is {}, over Lambert's", name)}, false, true, {}, {}});
  }

  std::vector<std::string> ways;
  if (options.per_pixel) {
    ways.emplace_back("tiles");
    programs.push_back(PerPixelForm(variant, PerPixel::kTiles));
    if (renderer.TileNeeds(variant).asked & kHorizonNeeds) {
      ways.emplace_back("branch");
      programs.push_back(PerPixelForm(variant, PerPixel::kBranch));
    }
  }

  TimingOptions timing;
  timing.seconds = options.seconds;
  timing.progress = options.progress;
  const std::vector<Timing> times =
      MeasureTimes(context, renderer, {programs.begin() + 1, programs.end()}, variant, 1, timing);
  Saving& saving = explanation.saving;
  saving.time = Inverse(times[0].ratio_to_point);
  saving.rounds = times[0].rounds;
  for (std::size_t i = 0; i < ways.size(); ++i) saving.per_pixel[ways[i]].time = times[1 + turned.size() + i].ratio_to_point;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    EffectPrice& price = explanation.effects[turned[i]];
    const Estimate& ratio = times[i + 1].ratio_to_point;
    price.time_ratio = price.effect.on ? Inverse(ratio) : ratio;
  }
  if (!options.meter) return explanation;
  programs.resize(programs.size() - ways.size());
  for (std::size_t i = 0; options.prices && i < effects.size(); ++i) {
    const EffectPrice& price = explanation.effects[i];
    if (!price.asked || price.forced || !MayBeCounted(price.effect, variant, scene, effects)) continue;
    programs.push_back(variant);
    programs.back().effects[price.effect.name] = true;
    turned.push_back(i);
  }
  const auto costs = options.meter->Measure(library, programs, scene);
  for (const std::string& gpu : options.meter->gpus()) {
    const int own = costs[0].at(gpu).full.cycles;
    saving.cycles[gpu] = {own, costs[1].at(gpu).full.cycles};
    for (std::size_t i = 0; i < turned.size(); ++i) {
      EffectPrice& price = explanation.effects[turned[i]];
      const int more = costs[i + 2].at(gpu).full.cycles - own;
      price.cycles[gpu] = price.effect.on ? -more : more;
    }
  }
  if (!lambert) {
    Scene even = scene;
    even.diffuse = Brdf::kLambert;
    const auto without = options.meter->Measure(library, {variant}, even);
    for (const std::string& gpu : options.meter->gpus()) explanation.effects.back().cycles[gpu] = costs[0].at(gpu).full.cycles - without[0].at(gpu).full.cycles;
  }
  if (!ways.empty()) EstimateWays(*options.meter, library, scene, effects, variant, renderer.TileNeeds(variant), saving);
  return explanation;
}

}  // namespace arealab
