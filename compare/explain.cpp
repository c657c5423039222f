#include "compare/explain.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/timing.h"
#include "glsl/expand.h"
#include "scenes/error.h"

namespace arealab {
namespace {

Estimate Inverse(const Estimate& ratio) { return {1.0 / ratio.value, 1.0 / ratio.high, 1.0 / ratio.low}; }

bool IsShape(const std::string& effect) {
  return std::ranges::any_of(kLightShapes,
                             [&](LightShape shape) { return effect == Name(shape); });
}

// Turned off, a shape of the scene or all lights but one would be missing: that is another scene, not a saving.
bool MayBeTurned(const Effect& effect, const Variant& all) {
  if (effect.on) return !IsShape(effect.name) && effect.name != "many_lights";
  return all.effects.count(effect.name) > 0;
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
      Expand(library, "lighting.frag", variant, Defines(effects, variant.effects), Precision::kFloat, scene.brdf).text;
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

  TimingOptions timing;
  timing.seconds = options.seconds;
  timing.progress = options.progress;
  const std::vector<Timing> times =
      MeasureTimes(context, renderer, {programs.begin() + 1, programs.end()}, variant, 1, timing);
  explanation.pruned_over_all = Inverse(times[0].ratio_to_point);
  explanation.rounds = times[0].rounds;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    EffectPrice& price = explanation.effects[turned[i]];
    const Estimate& ratio = times[i + 1].ratio_to_point;
    price.time_ratio = price.effect.on ? Inverse(ratio) : ratio;
  }
  if (!options.meter) return explanation;
  const auto costs = options.meter->Measure(library, programs, scene);
  for (const std::string& gpu : options.meter->gpus()) {
    const int own = costs[0].at(gpu).full.cycles;
    explanation.cycles[gpu] = {own, costs[1].at(gpu).full.cycles};
    for (std::size_t i = 0; i < turned.size(); ++i) {
      EffectPrice& price = explanation.effects[turned[i]];
      const int more = costs[i + 2].at(gpu).full.cycles - own;
      price.cycles[gpu] = price.effect.on ? -more : more;
    }
  }
  return explanation;
}

}  // namespace arealab
